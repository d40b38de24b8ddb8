// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/mat_file.hpp"

#include "io/mat_elements.hpp"
#include "logs/decompress.hpp"
#include "text/plain_text.hpp"
#include "trussmap/error.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <cctype>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

namespace trussmap::logs {
namespace {

constexpr int kDeepest = 16;                                 // structures within structures
constexpr std::int32_t kMostColumns = 64;                    // of a matrix
constexpr std::size_t kMostFields = 4096;                    // of a structure
constexpr std::size_t kMostNumbers = std::size_t{1} << 27U;  // in all: 1 GiB

std::string name_at(const std::string& path, const std::string& name) {
  return path.empty() ? name : path + "." + name;
}

/// Reads the variables one after the other.
class Variables {
 public:
  explicit Variables(std::string file) : file_(std::move(file)) {}

  void read(const io::MatElement& element) {
    if (element.type == io::kMatCompressed) {
      std::string bytes;
      try {
        bytes = decompressor_.zlib_of_any_size(element.data, kLargestChunk);
      } catch (const DecompressError& error) {
        throw InputError(file_, 0,
                         "at byte " + std::to_string(element.begin) + ": " + error.what() +
                             ", expected a variable");
      }
      io::MatElements within(bytes, element.begin, file_);
      read_variable(within.next(), within);
    } else {
      io::MatElements at(element.data, element.begin, file_);
      read_variable(element, at);
    }
  }

  [[nodiscard]] MatFile finish() {
    MatFile result;
    std::map<std::string, int> lengths;  // of a structure's tables
    for (const auto& one : tables_) lengths[one.first.first] += one.second.size() >= 2 ? 1 : 0;
    for (auto& [key, columns] : tables_) {
      if (columns.size() < 2) {
        pass_over("variables of a length of their own", columns.size());
        continue;
      }
      const auto& [structure, rows] = key;
      std::string name = structure;
      if (name.empty() || lengths.at(structure) > 1) {
        name += (name.empty() ? "" : " ") + std::to_string(rows) + " rows";
      }
      result.tables.push_back({std::move(name), std::move(columns)});
    }
    for (const auto& [what, number] : passed_over_) result.passed_over.push_back({number, what});
    return result;
  }

 private:
  void read_variable(const io::MatElement& element, const io::MatElements& where) {
    if (element.type != io::kMatMatrix) where.fail("has an element that is no variable");
    if (element.data.empty()) return;
    io::MatElements parts(element.data, element.begin, file_);
    const io::MatHead head = io::mat_head(parts);
    if (head.is_structure()) {
      read_structure(head, parts, head.name, "", 1);
    } else {
      take(head, parts, "", head.name);
    }
  }

  void read_structure(const io::MatHead& head, io::MatElements& parts, const std::string& table,
                      const std::string& path, int depth) {
    if (depth > kDeepest) parts.fail("has structures more than 16 deep");
    const std::vector<std::string> names = field_names(parts);
    const std::size_t count = head.elements();
    if (names.empty() || count == 0) return;
    if (count > kMostNumbers / names.size()) parts.fail("has a structure of too many fields");
    std::vector<std::vector<double>> each(names.size());
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t f = 0; f < names.size(); ++f) {
        const io::MatElement field = parts.next();
        if (field.type != io::kMatMatrix) parts.fail("has a field that is no array");
        if (count == 1) {
          read_field(field, table, name_at(path, names[f]), depth);
        } else {
          each[f].push_back(lone_number(field));
        }
      }
    }
    if (count == 1) return;
    for (std::size_t f = 0; f < names.size(); ++f) {
      const bool any = std::any_of(each[f].begin(), each[f].end(), [](double one) {
        return one == one;  // no NaN
      });
      if (any) {
        add(table, {name_at(path, names[f]), std::move(each[f]), false});
      } else {
        pass_over("fields that hold no single numbers", 1);
      }
    }
  }

  std::vector<std::string> field_names(io::MatElements& parts) const {
    const io::MatElement length = parts.next();
    if (length.type != io::kMatInt32 || length.data.size() != 4) {
      parts.fail("has a structure without names");
    }
    const auto each = io::mat_number<std::int32_t>(length.data, 0);
    const io::MatElement all = parts.next();
    if (all.type != io::kMatInt8 || each <= 0 ||
        all.data.size() % static_cast<std::size_t>(each) != 0) {
      parts.fail("has a structure without names");
    }
    std::vector<std::string> names;
    for (std::size_t at = 0; at < all.data.size(); at += static_cast<std::size_t>(each)) {
      const std::string_view one = all.data.substr(at, static_cast<std::size_t>(each));
      names.emplace_back(one.substr(0, one.find('\0')));
      if (names.back().empty() || !text::is_plain_text(names.back()) ||
          names.size() > kMostFields) {
        parts.fail("has a structure with a field without a name");
      }
    }
    return names;
  }

  void read_field(const io::MatElement& field, const std::string& table, const std::string& name,
                  int depth) {
    if (field.data.empty()) return;
    io::MatElements parts(field.data, field.begin, file_);
    const io::MatHead head = io::mat_head(parts);
    if (head.is_structure()) {
      read_structure(head, parts, table, name, depth + 1);
    } else {
      take(head, parts, table, name);
    }
  }

  /// A field of one of several structures; NaN of all else.
  double lone_number(const io::MatElement& field) {
    constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
    if (field.data.empty()) return kNothing;
    io::MatElements parts(field.data, field.begin, file_);
    const io::MatHead head = io::mat_head(parts);
    if (!head.is_numeric() || head.complex || head.elements() != 1) return kNothing;
    const std::optional<std::vector<double>> values = values_of(parts);
    return values->size() == 1 ? values->front() : kNothing;
  }

  std::optional<std::vector<double>> values_of(io::MatElements& parts) {
    const io::MatElement element = parts.next();
    std::optional<std::vector<double>> values = io::mat_numbers(element.type, element.data);
    if (!values) parts.fail("has values of an unknown type");
    numbers_ += values->size();
    if (numbers_ > kMostNumbers) parts.fail("has more than a thousand million bytes of numbers");
    return values;
  }

  /// Of a matrix each column, or row where these are longer.
  void take(const io::MatHead& head, io::MatElements& parts, const std::string& table,
            const std::string& name) {
    if (head.type > 15) return pass_over("objects (tables, timeseries, strings)", 1);
    if (!head.is_numeric()) return pass_over("texts, cells or sparse matrices", 1);
    if (head.complex) return pass_over("complex variables", 1);
    if (head.dimensions.size() != 2) return pass_over("arrays of more than two dimensions", 1);
    if (head.elements() <= 1) return pass_over("single numbers", head.elements());
    const std::vector<double> values = *values_of(parts);
    if (values.size() != head.elements()) parts.fail("has other numbers of values than it says");
    const bool lying = head.across() > head.rows();
    const std::size_t count = lying ? head.rows() : head.across();
    const std::size_t length = lying ? head.across() : head.rows();
    if (count > kMostColumns) return pass_over("matrices of more than 64 columns", 1);
    for (std::size_t k = 0; k < count; ++k) {
      MatColumn column{name, {}, head.is_whole()};
      if (count > 1) {
        const std::string number = std::to_string(k + 1);
        column.name += lying ? "(" + number + ",:)" : "(:," + number + ")";
      }
      column.values.reserve(length);
      for (std::size_t row = 0; row < length; ++row) {
        column.values.push_back(values[lying ? row * count + k : k * length + row]);
      }
      add(table, std::move(column));
    }
  }

  void add(const std::string& table, MatColumn column) {
    std::vector<MatColumn>& columns = tables_[{table, column.values.size()}];
    std::erase_if(columns, [&column](const MatColumn& one) { return one.name == column.name; });
    columns.push_back(std::move(column));
  }

  void pass_over(const char* what, std::size_t number) {
    if (number > 0) passed_over_[what] += number;
  }

  std::string file_;
  Decompressor decompressor_;
  std::map<std::pair<std::string, std::size_t>, std::vector<MatColumn>> tables_;
  std::map<std::string, std::uint64_t> passed_over_;
  std::size_t numbers_ = 0;
};

}  // namespace

bool is_mat_file(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending == ".mat";
}

MatFile read_mat_file(const std::filesystem::path& file) {
  const std::string bytes = read_file(file);
  const std::string name = file.string();
  io::require_mat_header(bytes, name);
  Variables variables(name);
  io::MatElements elements(std::string_view(bytes).substr(io::kMatHeader), io::kMatHeader, name);
  while (!elements.ends()) variables.read(elements.next());
  return variables.finish();
}

}  // namespace trussmap::logs
