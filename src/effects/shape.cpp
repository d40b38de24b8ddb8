// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/shape.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <muParser.h>

namespace trussmap {
namespace {

double sign(double value) {
  return value > 0.0 ? 1.0 : value < 0.0 ? -1.0 : 0.0;
}

constexpr const char* kLanguage =
    "+ - * / ^ ( ), numbers, variables, and sin cos tan abs sign min max exp log sqrt";

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

/// muParser knows more than a shape may have: assignments, comparisons, "? :", lists.
void check_syntax(const std::string& expression) {
  std::vector<bool> lists;  // per open parenthesis: of min or max
  std::string word;         // the last
  for (const char c : expression) {
    const bool name = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
    if (c == '(') lists.push_back(word == "min" || word == "max");
    if (c == ')' && !lists.empty()) lists.pop_back();
    const bool known = name || std::string_view("+-*/^() ").find(c) != std::string_view::npos ||
                       (c == ',' && !lists.empty() && lists.back());
    if (!known) {
      refuse(expression,
             fmt::format("cannot be read: {} has no meaning there, expected {}",
                         c == '\n' ? std::string("a line's end") : fmt::format("\"{}\"", c),
                         kLanguage));
    }
    word = name ? word + c : "";
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

/// The parser with the expression set and no variables. Making one takes longer than a thousand
/// rows: each thread has one. What it was given before is forgotten.
mu::Parser& parser_of(const std::string& expression) {
  check_syntax(expression);
  thread_local mu::Parser parser = make_parser();
  parser.ClearVar();
  parser.SetExpr(with_squares(expression));
  return parser;
}

std::string reason(const mu::Parser::exception_type& error) {
  std::string text = error.GetMsg();
  while (!text.empty() && (text.back() == '.' || text.back() == '\n')) text.pop_back();
  return "cannot be read: " + text + ", expected " + kLanguage;
}

std::string list(const RowVariables& variables) {
  std::string text;
  for (const auto& [name, values] : variables) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

std::vector<std::string> variables_of(const std::string& expression) {
  try {
    mu::Parser& parser = parser_of(expression);
    std::vector<std::string> names;
    for (const auto& [name, address] : parser.GetUsedVar()) names.push_back(name);
    return names;
  } catch (const mu::Parser::exception_type& error) {
    refuse(expression, reason(error));
  }
}

std::vector<double> evaluate_shape(const std::string& expression, const RowVariables& variables) {
  const std::vector<std::string> names = variables_of(expression);
  std::vector<const std::vector<double>*> columns;
  std::vector<double> present(names.size());
  std::size_t rows = variables.empty() ? 0 : variables.begin()->second.size();
  std::vector<double> result;
  result.reserve(rows);
  try {
    mu::Parser& parser = parser_of(expression);
    for (std::size_t k = 0; k < names.size(); ++k) {
      const auto found = variables.find(names[k]);
      if (found == variables.end()) {
        refuse(expression, fmt::format("names \"{}\", which is unknown, expected one of {}",
                                       names[k], list(variables)));
      }
      columns.push_back(&found->second);
      parser.DefineVar(names[k], &present[k]);
    }
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t k = 0; k < names.size(); ++k) present[k] = (*columns[k])[row];
      const double value = parser.Eval();
      if (!std::isfinite(value)) {
        std::string where;
        for (std::size_t k = 0; k < names.size(); ++k) {
          where += fmt::format("{}{} = {:g}", k == 0 ? "" : ", ", names[k], present[k]);
        }
        refuse(expression, fmt::format("has no finite value in row {} of the drive ({}), expected "
                                       "one in every row",
                                       row + 1, where));
      }
      result.push_back(value);
    }
  } catch (const mu::Parser::exception_type& error) {
    refuse(expression, reason(error));
  }
  return result;
}

}  // namespace trussmap
