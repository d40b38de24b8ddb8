// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/compiled_shape.hpp"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <muParser.h>

namespace trussmap {
using namespace effects;

namespace {

double sign(double value) {
  return value > 0.0 ? 1.0 : value < 0.0 ? -1.0 : 0.0;
}

constexpr const char* kLanguage =
    "+ - * / ^ ( ) < >, numbers, variables, and sin cos tan abs sign min max exp log sqrt";

[[noreturn]] void refuse(const std::string& expression, const std::string& why) {
  throw std::invalid_argument(fmt::format("shape \"{}\" {}", expression, why));
}

/// The same with every "(...)^2" as a product's function: a general power takes ten times as long.
std::string with_squares(const std::string& expression) {
  std::string text = expression;
  for (std::size_t at = text.find(")^2"); at != std::string::npos; at = text.find(")^2", at + 1)) {
    const std::size_t next = at + 3;
    if (next < text.size() && (std::isalnum(static_cast<unsigned char>(text[next])) != 0 ||
                               text[next] == '.' || text[next] == '^' || text[next] == '_')) {
      continue;
    }
    int depth = 1;
    std::size_t begin = at;
    while (begin > 0 && depth > 0) {
      --begin;
      depth += text[begin] == ')' ? 1 : text[begin] == '(' ? -1 : 0;
    }
    const auto is_name = [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
    };
    while (begin > 0 && is_name(text[begin - 1])) --begin;
    if (depth > 0 || (begin > 0 && text[begin - 1] == '^')) continue;
    text.replace(at, 3, "))");
    text.insert(begin, "square_(");
    at += 8;
  }
  return text;
}

/// muParser knows more than a shape may have: assignments, "? :", lists.
void check_syntax(const std::string& expression) {
  std::vector<bool> lists;  // per open parenthesis: of min or max
  std::string word;         // the last
  char before = ' ';
  for (const char c : expression) {
    const bool name = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
    if (c == '(') lists.push_back(word == "min" || word == "max");
    if (c == ')' && !lists.empty()) lists.pop_back();
    const bool known = name || std::string_view("+-*/^()<> ").find(c) != std::string_view::npos ||
                       (c == '=' && (before == '<' || before == '>')) ||
                       (c == ',' && !lists.empty() && lists.back());
    if (!known) {
      refuse(expression,
             fmt::format("cannot be read: {} has no meaning there, expected {}",
                         c == '\n' ? std::string("a line's end") : fmt::format("\"{}\"", c),
                         kLanguage));
    }
    if (name) {
      word += c;
    } else {
      word.clear();
    }
    before = c;
  }
}

/// A parser that knows our functions and no others.
mu::Parser make_parser() {
  mu::Parser parser;
  parser.ClearFun();
  parser.ClearConst();
  const auto define = [&parser](const char* name, double (*function)(double)) {
    parser.DefineFun(name, function);
  };
  define("sin", [](double v) { return std::sin(v); });
  define("cos", [](double v) { return std::cos(v); });
  define("tan", [](double v) { return std::tan(v); });
  define("abs", [](double v) { return std::abs(v); });
  define("exp", [](double v) { return std::exp(v); });
  define("log", [](double v) { return std::log(v); });
  define("sqrt", [](double v) { return std::sqrt(v); });
  define("sign", sign);
  define("square_", [](double v) { return v * v; });
  const auto define_list = [&parser](const char* name, double (*function)(const double*, int)) {
    parser.DefineFun(name, function);
  };
  define_list("min", [](const double* v, int count) { return *std::min_element(v, v + count); });
  define_list("max", [](const double* v, int count) { return *std::max_element(v, v + count); });
  return parser;
}

std::string reason(const mu::Parser::exception_type& error) {
  std::string text = error.GetMsg();
  while (!text.empty() && (text.back() == '.' || text.back() == '\n')) text.pop_back();
  return "cannot be read: " + text + ", expected " + kLanguage;
}

/// A word, a number or a sign of an expression.
struct Token {
  enum class Kind { word, number, sign, end } kind = Kind::end;
  std::string text;
  double value = 0.0;  ///< of a number
};

std::vector<Token> tokens_of(const std::string& text) {
  std::vector<Token> tokens;
  for (std::size_t at = 0; at < text.size();) {
    const auto c = static_cast<unsigned char>(text[at]);
    std::size_t end = at + 1;
    Token token{Token::Kind::sign, text.substr(at, 1)};
    if (std::isdigit(c) != 0 || c == '.') {
      token.kind = Token::Kind::number;
      const auto read = std::from_chars(text.data() + at, text.data() + text.size(), token.value);
      end = std::max(end, static_cast<std::size_t>(read.ptr - text.data()));
    } else if (std::isalpha(c) != 0 || c == '_') {
      token.kind = Token::Kind::word;
      while (end < text.size() &&
             (std::isalnum(static_cast<unsigned char>(text[end])) != 0 || text[end] == '_')) {
        ++end;
      }
      token.text = text.substr(at, end - at);
    }
    if (c != ' ') tokens.push_back(std::move(token));
    at = end;
  }
  return tokens;
}

/// Reads the parameters off an expression's tokens (shape.hpp says what they are).
class ParameterReader {
 public:
  ParameterReader(const std::string& text, const std::vector<std::string>& variables)
      : tokens_(tokens_of(text)), variables_(variables) {}

  [[nodiscard]] std::vector<ShapeParameter> parameters() const {
    std::vector<ShapeParameter> result;
    for (std::size_t k = 0; k < tokens_.size(); ++k) {
      if (const std::optional<double> offset = offset_at(k)) {
        result.push_back({tokens_[k].text, *offset});
      } else if (const std::optional<double> threshold = compared_at(k)) {
        result.push_back({tokens_[k].text, *threshold});
      } else if (is_radius(k)) {
        result.push_back({"r", tokens_[k].value});
      }
    }
    // The place, then its radius, whichever the text has first.
    std::stable_partition(result.begin(), result.end(),
                          [](const ShapeParameter& one) { return one.name != "r"; });
    return result;
  }

 private:
  [[nodiscard]] const Token& at(std::size_t k) const {
    static const Token end;
    return k < tokens_.size() ? tokens_[k] : end;
  }
  [[nodiscard]] bool is_sign(std::size_t k, std::string_view any_of) const {
    const Token& token = at(k);
    return token.kind == Token::Kind::sign && any_of.find(token.text) != std::string_view::npos;
  }
  [[nodiscard]] bool is_variable(std::size_t k) const {
    return at(k).kind == Token::Kind::word &&
           std::find(variables_.begin(), variables_.end(), at(k).text) != variables_.end();
  }
  [[nodiscard]] bool begins_a_sum(std::size_t k) const { return k == 0 || is_sign(k - 1, "(,"); }
  [[nodiscard]] bool ends_a_term(std::size_t k) const { return !is_sign(k, "*/^"); }

  /// What the variable at k has subtracted from it: "x-12", "x-(-12)", "x+12".
  [[nodiscard]] std::optional<double> offset_at(std::size_t k) const {
    if (!is_variable(k) || !begins_a_sum(k) || !is_sign(k + 1, "+-")) return std::nullopt;
    double sense = is_sign(k + 1, "-") ? 1.0 : -1.0;
    std::size_t number = k + 2;
    const bool bracketed = is_sign(number, "(");
    if (bracketed) ++number;
    if (bracketed && is_sign(number, "-")) {
      sense = -sense;
      ++number;
    }
    if (at(number).kind != Token::Kind::number) return std::nullopt;
    if (bracketed && !is_sign(number + 1, ")")) return std::nullopt;
    if (!ends_a_term(number + (bracketed ? 2 : 1))) return std::nullopt;
    return sense * at(number).value;
  }

  /// What the variable at k is compared with: "speed>0.5", "t<=-3".
  [[nodiscard]] std::optional<double> compared_at(std::size_t k) const {
    if (!is_variable(k) || !is_sign(k + 1, "<>")) return std::nullopt;
    std::size_t number = is_sign(k + 2, "=") ? k + 3 : k + 2;
    const double sense = is_sign(number, "-") ? -1.0 : 1.0;
    if (is_sign(number, "-")) ++number;
    if (at(number).kind != Token::Kind::number || !ends_a_term(number + 1)) return std::nullopt;
    return sense * at(number).value;
  }

  [[nodiscard]] bool is_radius(std::size_t k) const {
    const auto speaks_of = [this](const char* name) {
      return std::find(variables_.begin(), variables_.end(), name) != variables_.end();
    };
    return at(k).kind == Token::Kind::number && is_sign(k + 1, "^") && at(k + 2).value == 2.0 &&
           speaks_of("x") && speaks_of("y");
  }

  std::vector<Token> tokens_;
  const std::vector<std::string>& variables_;
};

/// "f" and "argument" where the whole text is f(argument).
void find_call(ShapeFacts& facts) {
  const std::string& text = facts.text;
  const std::size_t open = text.find('(');
  if (open == std::string::npos || open == 0 || text.back() != ')') return;
  const std::string name = text.substr(0, open);
  if (!std::all_of(name.begin(), name.end(),
                   [](unsigned char c) { return std::isalpha(c) != 0; })) {
    return;
  }
  int depth = 0;
  for (std::size_t k = open; k + 1 < text.size(); ++k) {
    depth += text[k] == '(' ? 1 : text[k] == ')' ? -1 : 0;
    if (depth == 0) return;
  }
  facts.function = name;
  facts.argument = text.substr(open + 1, text.size() - open - 2);
}

std::atomic<std::size_t> reads{0};

/// An expression in a parser of its own, its variables bound to one row's state.
class ReadShape : public CompiledShape {
 public:
  ReadShape(ShapeFacts facts, const mu::Parser& parser)
      : CompiledShape(std::move(facts)), parser_(parser), state_(this->facts().variables.size()) {
    for (std::size_t k = 0; k < state_.size(); ++k) {
      parser_.DefineVar(this->facts().variables[k], &state_[k]);
    }
    static_cast<void>(parser_.Eval());  // reads it now rather than at the first row
  }

  void evaluate(const std::vector<const double*>& columns, std::size_t rows,
                double* values) const override {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t k = 0; k < state_.size(); ++k) state_[k] = columns[k][row];
      values[row] = parser_.Eval();
    }
  }

 private:
  mutable std::mutex mutex_;
  mu::Parser parser_;
  mutable std::vector<double> state_;
};

/// One call at a time.
std::shared_ptr<const CompiledShape> read_shape(const std::string& text) {
  // Making a parser takes as long as reading with it: one is made, and copied.
  static mu::Parser parser = make_parser();
  check_syntax(text);
  ++reads;
  try {
    parser.SetExpr(with_squares(text));
    ShapeFacts facts{text, {}, {}, "", ""};
    for (const auto& [name, address] : parser.GetUsedVar()) facts.variables.push_back(name);
    facts.parameters = ParameterReader(text, facts.variables).parameters();
    find_call(facts);
    return std::make_shared<const ReadShape>(std::move(facts), parser);
  } catch (const mu::Parser::exception_type& error) {
    refuse(text, reason(error));
  }
}

/// What has been read and is still in use.
class SharedShapes {
 public:
  std::shared_ptr<const CompiledShape> get(const std::string& text) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (const auto found = shapes_.find(text); found != shapes_.end()) {
      if (std::shared_ptr<const CompiledShape> shape = found->second.lock()) return shape;
    }
    std::shared_ptr<const CompiledShape> shape = read_shape(text);
    shapes_[text] = shape;
    if (shapes_.size() > tidy_at_) tidy();
    return shape;
  }

 private:
  void tidy() {
    std::erase_if(shapes_, [](const auto& one) { return one.second.expired(); });
    tidy_at_ = 2 * shapes_.size() + 1000;
  }

  std::mutex mutex_;
  std::map<std::string, std::weak_ptr<const CompiledShape>> shapes_;
  std::size_t tidy_at_ = 1000;
};

}  // namespace

}  // namespace trussmap

namespace trussmap::effects {

std::shared_ptr<const CompiledShape> compile_shape(const std::string& text) {
  static SharedShapes shapes;
  return shapes.get(text);
}

std::size_t shapes_read() {
  return reads;
}

}  // namespace trussmap::effects

namespace trussmap {

Shape::Shape(const char* text) : compiled_(compile_shape(text)) {}
Shape::Shape(const std::string& text) : compiled_(compile_shape(text)) {}
Shape::Shape(const std::string& pattern, const std::vector<ShapeParameter>& parameters)
    : compiled_(compile_shape(filled(pattern, parameters))) {}

}  // namespace trussmap
