// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Tables as loggers write them: table_layout.hpp says what is found out about them.
//
//   field                      in the tree
//   12, +3, true, FALSE        integer
//   0.5, 1e3, -.5 (0,5 where   number
//   semicolons separate)
//   empty, nan, inf, none      number NaN: absent
//   anything else              text
#include "io/csv_record.hpp"
#include "logs/message_log.hpp"
#include "logs/table_layout.hpp"
#include "logs/table_records.hpp"
#include "trussmap/error.hpp"

#include <cctype>
#include <functional>
#include <limits>

namespace trussmap::logs {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kRowsToLookAt = 20;
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// A record that outlives the reading of the next.
struct KeptRecord {
  std::string text;
  TableRecord record;
};

class Table {
 public:
  Table(const fs::path& file, const LogVisit& visit)
      : name_(file.string()), visit_(&visit), records_(file) {}

  LogEnd read() {
    std::vector<KeptRecord> head = read_head();
    topic_.wanted = visit_->wanted == nullptr || visit_->wanted(topic_.topic);
    for (std::size_t k = layout_.first_row; k < head.size(); ++k) {
      head[k].record.text = head[k].text;
      row(head[k].record);
    }
    while (cut_off_.empty() && records_.next()) row(records_.record());
    LogEnd end;
    end.topics.push_back(std::move(topic_.topic));
    end.cut_off = cut_off_.empty() ? records_.cut_off() : cut_off_;
    return end;
  }

 private:
  std::vector<KeptRecord> read_head() {
    std::vector<KeptRecord> head;
    std::vector<std::string> texts;
    std::string comment;
    while (head.size() < kRowsToLookAt && records_.next()) {
      if (head.empty()) comment = records_.comment();
      head.push_back({std::string(records_.record().text), records_.record()});
      texts.push_back(head.back().text);
    }
    if (head.empty()) {
      throw InputError(name_, 1, "the file is empty, expected the rows of a table");
    }
    layout_ = table_layout(texts, comment);
    cells_ = CellReader(decimal_mark(layout_.separator));
    if (layout_.wrong != nullptr) {
      throw InputError(name_, head[layout_.header_record].record.line, layout_.wrong);
    }
    return head;
  }

  void row(const TableRecord& record) {
    fields_.read(record.text, 0, layout_.separator, true);
    const std::size_t found = fields_.fields().size();
    const std::size_t columns = layout_.columns.size();
    const bool short_one = found < columns && !(layout_.open_header && found + 1 == columns);
    // A quote that is open over several lines is a stray one.
    const bool one_line = record.text.find('\n') == std::string_view::npos;
    if (!record.ended && one_line && (short_one || fields_.wrong() != nullptr)) {
      cut_off_ = "at byte " + std::to_string(record.byte) + ": ends in the middle of line " +
                 std::to_string(record.line);
      return;
    }
    if (fields_.wrong() != nullptr) throw InputError(name_, record.line, fields_.wrong());
    const bool long_one =
        found > columns && !(found == columns + 1 && fields_.fields().back().empty());
    if (short_one || long_one) {
      throw InputError(name_, record.line,
                       std::to_string(found) + (found == 1 ? " field" : " fields") + ", expected " +
                           std::to_string(columns) + " as in the " +
                           (layout_.header ? "header" : "first row"));
    }
    ++topic_.topic.messages;
    if (topic_.wanted && visit_->message) deliver(record);
  }

  void deliver(const TableRecord& record) {
    tree_.clear();
    const std::size_t group = tree_.open_group("");
    for (std::size_t k = 0; k < layout_.columns.size(); ++k) {
      const std::string& name = layout_.columns[k];
      const std::string_view cell =
          k < fields_.fields().size() ? fields_.fields()[k] : std::string_view();
      switch (cells_.read(cell)) {
        case CellKind::absent:
          tree_.add_number(name, kNothing, cell);
          break;
        case CellKind::text:
          tree_.add_text(name, cell);
          break;
        case CellKind::number:
          if (cells_.whole()) {
            tree_.add_integer(name, cells_.integer(), cell);
          } else {
            tree_.add_number(name, cells_.number(), cell);
          }
      }
    }
    tree_.close(group);
    const std::string_view text = record.text.substr(0, record.text.find_last_not_of("\r\n") + 1);
    visit_->message({topic_.topic, 0, false, 0, 0, tree_.root(), record.line,
                     std::hash<std::string_view>()(text)});
  }

  struct {
    LogTopic topic{.name = "", .type = "", .encoding = "csv", .unread = "", .table = true};
    bool wanted = false;
  } topic_;

  std::string name_;
  const LogVisit* visit_;
  TableRecords records_;
  TableLayout layout_;
  CellReader cells_{'.'};
  io::CsvRecord fields_;
  FieldTree tree_;
  std::string cut_off_;
};

}  // namespace

bool is_csv_log(const fs::path& file) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) return false;
  fs::path name = file.filename();
  const auto ending = [&name] {
    std::string text = name.extension().string();
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
  };
  if (ending() == ".xz") name = name.stem();
  return ending() == ".csv" || ending() == ".tsv" || ending() == ".txt";
}

LogEnd read_csv_log(const fs::path& file, const LogVisit& visit) {
  return Table(file, visit).read();
}

}  // namespace trussmap::logs
