// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/memory_file.hpp"

#include "geometry/index.hpp"
#include "map/memory_tables.hpp"
#include "text/fnv_hash.hpp"
#include "text/number_text.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <string_view>
#include <vector>

namespace trussmap::map {
namespace {

constexpr std::string_view kFirstLine = "trussmap map builder 1";
constexpr std::string_view kFirstWords = "trussmap map builder ";
constexpr std::string_view kEnd = "end ";
constexpr std::string_view kNull = "-";
constexpr std::string_view kHexDigits = "0123456789abcdef";

std::string check_sum(std::string_view text) {
  text::FnvHash hash;
  hash.take(text);
  return hash.digits();
}

std::string escaped(const std::string& text) {
  std::string field;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte > ' ' && c != '%' && byte != 127 && text != kNull) {
      field += c;
    } else {
      field += {'%', kHexDigits[byte >> 4U], kHexDigits[byte & 15U]};
    }
  }
  return field;
}

std::vector<std::string> names_of(const MemoryTable& table) {
  std::vector<std::string> names{""};
  for (const char* at = table.columns; *at != '\0'; ++at) {
    if (*at == ',') {
      names.emplace_back();
    } else if (*at != ' ') {
      names.back() += *at;
    }
  }
  return names;
}

// ---------------------------------------- writing

class TextRow final : public text::RowWriter {
 public:
  explicit TextRow(std::size_t columns) : fields_(columns, std::string(kNull)) {}

  using text::RowWriter::bind;
  TextRow& bind(int column, double value) override {
    return put(column, text::shortest_text(value));
  }
  TextRow& bind(int column, std::int64_t value) override {
    return put(column, std::to_string(value));
  }
  TextRow& bind(int column, const std::string& text) override { return put(column, escaped(text)); }

  void append_to(std::string& text) const {
    for (const std::string& field : fields_) text += field + ' ';
    text.back() = '\n';
  }

 private:
  TextRow& put(int column, std::string field) {
    fields_[idx(column)] = std::move(field);
    return *this;
  }
  std::vector<std::string> fields_;
};

/// `put`: of a row to write and its place.
template <typename Put>
void append_table(std::string& text, const MemoryTable& table, std::ptrdiff_t rows,
                  const Put& put) {
  text += text::joined(table.name, " ", rows, ": ", table.columns, "\n");
  const std::size_t columns = names_of(table).size();
  for (std::ptrdiff_t k = 0; k < rows; ++k) {
    TextRow row(columns);
    put(row, static_cast<int>(k));
    row.append_to(text);
  }
}

// ---------------------------------------- reading

/// The lines of a text, each ended.
class Lines {
 public:
  Lines(const std::string& text, const std::string& file) : text_(text), file_(file) {}

  std::string_view next(const std::string& expected) {
    ++number_;
    const std::size_t end = text_.find('\n', at_);
    if (end == std::string::npos) {
      refuse((at_ == text_.size() ? "ends here" : "ends within a line") +
             (", expected " + expected));
    }
    begin_ = at_;
    at_ = end + 1;
    return std::string_view(text_).substr(begin_, end - begin_);
  }
  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(file_, number_, what);
  }
  [[nodiscard]] bool done() const { return at_ == text_.size(); }
  [[nodiscard]] std::string_view before() const {
    return std::string_view(text_).substr(0, begin_);
  }

 private:
  const std::string& text_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::size_t begin_ = 0;  ///< of the present line
  std::size_t number_ = 0;
};

template <typename Number>
bool parsed(std::string_view field, Number& number) {
  const auto [end, failed] = std::from_chars(field.data(), field.data() + field.size(), number);
  return failed == std::errc() && end == field.data() + field.size();
}

class FieldRow final : public text::RowReader {
 public:
  FieldRow(const Lines& lines, const std::vector<std::string>& names)
      : lines_(lines), names_(names) {}

  void take(std::string_view line) {
    fields_.clear();
    for (std::size_t begin = 0; begin <= line.size();) {
      const std::size_t end = std::min(line.find(' ', begin), line.size());
      fields_.push_back(line.substr(begin, end - begin));
      begin = end + 1;
    }
    if (fields_.size() != names_.size()) {
      lines_.refuse(text::joined("has ", fields_.size(), " fields, expected ", names_.size()));
    }
  }

  [[nodiscard]] double real(int column) const override {
    double value = 0.0;
    if (!parsed(fields_[idx(column)], value)) refuse(column, "a number");
    return value;
  }
  [[nodiscard]] std::int64_t integer(int column) const override {
    std::int64_t value = 0;
    if (!parsed(fields_[idx(column)], value)) refuse(column, "a whole number");
    return value;
  }
  [[nodiscard]] std::string text(int column) const override {
    const std::string_view field = fields_[idx(column)];
    std::string text;
    for (std::size_t k = 0; k < field.size(); ++k) {
      if (field[k] != '%') {
        text += field[k];
        continue;
      }
      const std::string_view digits = field.substr(k + 1, 2);
      if (digits.size() < 2 || digits.find_first_not_of(kHexDigits) != std::string_view::npos) {
        refuse(column, "two hexadecimal digits behind each %");
      }
      text += static_cast<char>(16 * kHexDigits.find(digits[0]) + kHexDigits.find(digits[1]));
      k += 2;
    }
    return text;
  }
  [[nodiscard]] bool is_null(int column) const override { return fields_[idx(column)] == kNull; }

 private:
  [[noreturn]] void refuse(int column, const char* expected) const {
    lines_.refuse(text::joined(names_[idx(column)], " is \"", fields_[idx(column)], "\", expected ",
                               expected));
  }

  const Lines& lines_;
  const std::vector<std::string>& names_;
  std::vector<std::string_view> fields_;
};

/// Tables come in the order in which the memory asks for them.
class TextTables final : public MemoryTables {
 public:
  explicit TextTables(Lines& lines) : lines_(lines) {}

  int rows(const MemoryTable& table) override {
    if (open_ != table.name) {
      open_ = table.name;
      rows_ = head(table);
    }
    return rows_;
  }

  void each(const MemoryTable& table,
            const std::function<void(const text::RowReader&)>& visit) override {
    const int count = rows(table);
    const std::vector<std::string> names = names_of(table);
    FieldRow row(lines_, names);
    for (int k = 0; k < count; ++k) {
      row.take(lines_.next(text::joined("row ", k + 1, " of the ", count, " of ", table.name)));
      try {
        visit(row);
      } catch (const std::invalid_argument& error) {
        lines_.refuse(std::string("is damaged: it has ") + error.what());
      }
    }
  }

 private:
  [[nodiscard]] int head(const MemoryTable& table) {
    const std::string begin = text::joined(table.name, " ");
    const std::string end = text::joined(": ", table.columns);
    const std::string expected = begin + "ROWS" + end;
    const std::string_view line = lines_.next("\"" + expected + "\"");
    int rows = -1;
    const bool framed =
        line.size() > begin.size() + end.size() && line.starts_with(begin) && line.ends_with(end);
    if (!framed ||
        !parsed(line.substr(begin.size(), line.size() - begin.size() - end.size()), rows) ||
        rows < 0) {
      lines_.refuse(text::joined("is \"", line, "\", expected \"", expected, "\""));
    }
    return rows;
  }

  Lines& lines_;
  std::string open_;
  int rows_ = 0;
};

}  // namespace

std::string format_memory(const BuilderMemory& m, const MapBuilderOptions& options) {
  std::string text = text::joined(kFirstLine, "\n");
  const auto append = [&](const MemoryTable& table, std::ptrdiff_t rows, auto put) {
    append_table(text, table, rows, [&](text::RowWriter& row, int k) { put(row, m, k); });
  };
  append(kOptionsTable, 1,
         [&](text::RowWriter& row, const BuilderMemory&, int) { put_options(row, options); });
  append(kLandmarksTable, m.graph.landmarks(), put_landmark);
  append(kRoutesTable, m.graph.routes(), [&](text::RowWriter& row, const BuilderMemory&, int k) {
    put_route(row, m, k, weighs_each(options));
  });
  append(kCornersTable, std::ssize(m.corners), put_corner);
  append(kReckonedTable, std::ssize(m.reckoned), put_reckoned);
  append(kChainTable, std::ssize(m.chain.landmarks()), put_link);
  append(kMisfitsTable, std::ssize(m.gate.remembered()), put_misfit);
  append(kLeftOutTable, std::ssize(m.left_out), put_left_out);
  append(kStateTable, 1,
         [](text::RowWriter& row, const BuilderMemory& memory, int) { put_state(row, memory); });
  const std::string sum = check_sum(text);
  return text + text::joined(kEnd, sum, "\n");
}

KeptMemory parse_memory(const std::string& text, const std::string& file) {
  Lines lines(text, file);
  const std::string expected = text::joined("\"", kFirstLine, "\"");
  const std::string_view first = lines.next(expected);
  if (first != kFirstLine) {
    lines.refuse(
        first.starts_with(kFirstWords)
            ? text::joined("is of version ", first.substr(kFirstWords.size()), ", expected 1")
            : "is no map builder's file, expected " + expected);
  }
  TextTables tables(lines);
  MapBuilderOptions options;
  if (tables.rows(kOptionsTable) != 1) lines.refuse("other than one row of options, expected 1");
  tables.each(kOptionsTable, [&](const text::RowReader& row) { options = options_in(row); });
  KeptMemory kept{options, BuilderMemory(options.gate)};
  try {
    kept.memory = load_memory(tables, options);
  } catch (const std::invalid_argument& error) {  // of a table as a whole
    lines.refuse(std::string("is damaged: it has ") + error.what());
  }
  const std::string_view end = lines.next("\"end\" and the file's check sum");
  const std::string sum = text::joined(kEnd, check_sum(lines.before()));
  if (end != sum)
    lines.refuse(
        text::joined("is \"", end, "\", expected \"", sum, "\": what stands above was changed"));
  if (!lines.done()) lines.refuse("is not the last line, expected nothing behind it");
  return kept;
}

}  // namespace trussmap::map
