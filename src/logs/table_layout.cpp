// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/table_layout.hpp"

#include "io/csv_record.hpp"
#include "logs/echoed_message.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

namespace trussmap::logs {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

using Row = std::vector<std::string_view>;

bool is_word(std::string_view text, std::string_view lower) {
  return text.size() == lower.size() &&
         std::equal(text.begin(), text.end(), lower.begin(), [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) == b;
         });
}

std::string_view without_sign(std::string_view text) {
  const bool sign = !text.empty() && (text[0] == '+' || text[0] == '-');
  return text.substr(sign ? 1 : 0);
}

CellKind kind_of(std::string_view cell, char separator) {
  return CellReader(decimal_mark(separator)).read(cell);
}

bool has(const Row& row, char separator, CellKind kind) {
  return std::any_of(row.begin(), row.end(), [separator, kind](std::string_view cell) {
    return kind_of(cell, separator) == kind;
  });
}

/// Whether a row has as many fields as the first one, with or without an empty last one.
bool fits(const Row& first, const Row& row) {
  if (row.size() == first.size()) return true;
  if (row.size() == first.size() + 1) return row.back().empty();
  return row.size() + 1 == first.size() && first.back().empty();
}

/// How well a separator divides the records.
struct Division {
  bool whole = false;    ///< all rows have as many fields
  double fitting = 0.0;  ///< share of the rows behind the first that have
  double numbers = 0.0;  ///< share of all their fields that are numbers or empty
};

Division divided(const std::vector<std::string>& records, char separator) {
  io::CsvRecord first;
  first.read(records[0], 0, separator, true);
  if (first.wrong() != nullptr || first.fields().size() < 2) return {};
  std::size_t rows = 0;
  std::size_t fitting = 0;
  std::size_t fields = 0;
  std::size_t numbers = 0;
  const auto count = [&](const Row& row) {
    fields += row.size();
    for (const std::string_view cell : row) {
      if (kind_of(cell, separator) != CellKind::text) ++numbers;
    }
  };
  count(first.fields());
  io::CsvRecord record;
  for (std::size_t k = 1; k < records.size(); ++k) {
    record.read(records[k], 0, separator, true);
    const bool good = record.wrong() == nullptr && fits(first.fields(), record.fields());
    if (!good && k + 1 == records.size() && !records[k].ends_with('\n')) continue;  // cut off
    ++rows;
    if (!good) continue;
    ++fitting;
    count(record.fields());
  }
  const auto share = [](std::size_t part, std::size_t all) {
    return all == 0 ? 1.0 : static_cast<double>(part) / static_cast<double>(all);
  };
  return {fitting == rows, share(fitting, rows), share(numbers, fields)};
}

char separator_of(const std::vector<std::string>& records) {
  char best = ',';
  Division reached;
  for (const char separator : {',', ';', '\t', ' '}) {
    const Division one = divided(records, separator);
    if (!(one.fitting >= 0.5)) continue;
    const bool better = one.whole != reached.whole ? one.whole
                        : one.whole                ? one.numbers > reached.numbers
                                                   : one.fitting > reached.fitting;
    if (!better) continue;
    best = separator;
    reached = one;
  }
  return best;
}

/// Whether the first row is one like the second.
bool is_data(const Row& first, const Row& second, char separator) {
  if (!has(first, separator, CellKind::number)) return false;
  if (!has(first, separator, CellKind::text)) return true;
  if (first.size() != second.size()) return false;
  for (std::size_t k = 0; k < first.size(); ++k) {
    const CellKind a = kind_of(first[k], separator);
    const CellKind b = kind_of(second[k], separator);
    if (a != b && a != CellKind::absent && b != CellKind::absent) return false;
  }
  return true;
}

std::vector<std::string> unique(std::vector<std::string> names) {
  std::set<std::string> used;
  std::map<std::string, std::size_t> last;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k].empty()) names[k] = "column " + std::to_string(k + 1);
    std::string name = names[k];
    for (std::size_t& number = last.try_emplace(name, 1).first->second; used.contains(name);) {
      name = names[k] + " (" + std::to_string(++number) + ")";
    }
    used.insert(name);
    names[k] = std::move(name);
  }
  return names;
}

/// Without a header: by the fields of the message that the rows are.
void name_echoed(const std::vector<std::string>& records, TableLayout& layout) {
  if (layout.separator != ',') return;
  std::vector<std::vector<std::string>> rows;
  io::CsvRecord record;
  for (const std::string& one : records) {
    record.read(one, 0, layout.separator, true);
    const bool whole = record.wrong() == nullptr && record.fields().size() == layout.columns.size();
    if (whole) rows.emplace_back(record.fields().begin(), record.fields().end());
  }
  if (rows.empty()) return;
  std::vector<std::string> names = echoed_columns(rows);
  if (!names.empty()) layout.columns = std::move(names);
}

bool could_be_unit(std::string_view text) {
  constexpr std::size_t kLongest = 16;  // bytes
  return text.size() <= kLongest && text.find('\n') == std::string_view::npos;
}

/// "[s]" of "[s]", "(s)" and "s".
std::string in_brackets(std::string_view unit) {
  const bool bare = unit.size() < 2 || (unit.front() != '[' && unit.front() != '(');
  if (!bare) unit = unit.substr(1, unit.size() - 2);
  return "[" + std::string(unit) + "]";
}

/// Whether the name has it already, in whatever brackets.
bool names_unit(const std::string& name, const std::string& unit) {
  const std::string bare = unit.substr(1, unit.size() - 2);
  return name.ends_with(unit) || name.ends_with("(" + bare + ")");
}

}  // namespace

CellKind CellReader::read(std::string_view cell) {
  whole_ = false;
  if (cell.empty()) return CellKind::absent;
  const std::string_view digits = without_sign(cell);
  for (const char* const word : {"nan", "inf", "infinity", "none", "null", "na", "n/a"}) {
    if (is_word(digits, word)) return CellKind::absent;
  }
  for (const char* const word : {"false", "true"}) {
    if (!is_word(cell, word)) continue;
    whole_ = true;
    integer_ = word[0] == 't' ? 1 : 0;
    number_ = static_cast<double>(integer_);
    return CellKind::number;
  }
  constexpr std::size_t kLongest = 64;
  const std::size_t place = digits.find_first_of(".,");
  const char mark = place == std::string_view::npos ? '\0' : digits[place];
  const bool begins = !digits.empty() && (mark == digits[0] ? digits.size() > 1 : true) &&
                      (std::isdigit(static_cast<unsigned char>(digits[0])) != 0 || place == 0);
  if (!begins || digits.size() > kLongest || (mark != '\0' && mark_ != '\0' && mark != mark_)) {
    return CellKind::text;
  }
  std::string text(cell[0] == '-' ? "-" : "");
  text += digits;
  if (mark == ',') text[text.size() - digits.size() + place] = '.';
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number_);
  if (read.ec != std::errc() || read.ptr != end || !std::isfinite(number_)) return CellKind::text;
  if (mark != '\0') mark_ = mark;
  const auto exact = std::from_chars(text.data(), end, integer_);
  whole_ = exact.ec == std::errc() && exact.ptr == end;
  return CellKind::number;
}

TableLayout table_layout(const std::vector<std::string>& records, std::string_view comment) {
  constexpr std::string_view kStated = "sep=";
  TableLayout layout;
  std::vector<std::string> rest(records.begin(), records.end());
  const std::string_view line =
      std::string_view(records[0]).substr(0, records[0].find_last_not_of("\r\n") + 1);
  if (line.starts_with(kStated) && line.size() == kStated.size() + 1) {
    layout.separator = line.back();
    layout.first_row = layout.header_record = 1;
    if (records.size() == 1) return layout;
    rest.erase(rest.begin());
  } else {
    layout.separator = separator_of(rest);
  }
  const auto split = [&layout](io::CsvRecord& record, std::string_view text) -> const Row& {
    record.read(text, 0, layout.separator, true);
    return record.fields();
  };
  io::CsvRecord one;
  io::CsvRecord two;
  io::CsvRecord three;
  const Row& first = split(one, rest[0]);
  layout.wrong = one.wrong();
  const Row& second = rest.size() > 1 ? split(two, rest[1]) : two.fields();
  if (is_data(first, second, layout.separator)) {
    comment = comment.substr(std::min(comment.find_first_not_of("#% \t"), comment.size()));
    const Row& named = split(three, comment);
    const bool names = three.wrong() == nullptr && first.size() > 1 &&
                       named.size() == first.size() && !is_data(named, first, layout.separator);
    layout.header = names;
    layout.columns.resize(first.size());
    if (names) layout.columns.assign(named.begin(), named.end());
    if (!names) name_echoed(rest, layout);
  } else {
    layout.header = true;
    ++layout.first_row;
    layout.columns.assign(first.begin(), first.end());
    const char separator = layout.separator;
    const bool units = rest.size() > 2 && second.size() == first.size() && two.wrong() == nullptr &&
                       has(second, separator, CellKind::text) &&
                       !has(second, separator, CellKind::number) &&
                       std::all_of(second.begin(), second.end(), could_be_unit) &&
                       has(split(three, rest[2]), separator, CellKind::number);
    if (units) {
      ++layout.first_row;
      for (std::size_t k = 0; k < second.size(); ++k) {
        if (second[k].empty()) continue;
        const std::string unit = in_brackets(second[k]);
        if (!names_unit(layout.columns[k], unit)) layout.columns[k] += " " + unit;
      }
    }
  }
  layout.open_header = layout.columns.size() > 1 && first.back().empty();
  layout.columns = unique(std::move(layout.columns));
  return layout;
}

}  // namespace trussmap::logs
