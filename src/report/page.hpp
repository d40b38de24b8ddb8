// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A page: what a command found, in one HTML file that needs nothing else.
//
//   verdict   one sentence, with sizes and units
//   facts     a handful of figures, large
//   answers   what a reader asks next, each with its question: "What else could it be?"
//   notes     what to know or to do, a sentence each
//   sections  texts, rows of charts, tables; what few ask for under "Details", which is closed
//
// Everything is text until it is drawn: names from anybody's files can hold whatever they like.
// Same input, same bytes.
#pragma once

#include "plot/chart.hpp"
#include "trussmap/pages.hpp"

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace trussmap::report {

enum class Tone { neutral, good, bad };

struct PageFact {
  std::string value;  ///< with its unit: "16.0 mm"
  std::string what;   ///< "held-out legs end so far off (rms)"
  Tone tone = Tone::neutral;
};

struct PageAnswer {
  std::string question;  ///< the same as before, or empty: one more answer to the one above
  std::string answer;
};

struct PageTable {
  std::string caption;
  std::vector<std::string> headings;
  std::vector<std::vector<std::string>> rows;
  std::size_t texts = 1;         ///< the first columns are texts, the others numbers (to the right)
  std::vector<Tone> tones = {};  ///< of the rows; may be empty
};

/// Side by side where there is room; one alone takes the whole width.
using ChartRow = std::vector<plot::Chart>;
using PageBlock = std::variant<std::string, PageTable, ChartRow>;

struct PageSection {
  std::string title;
  std::vector<PageBlock> blocks;
  std::vector<PageBlock> details = {};  ///< below, closed until asked for
};

/// Sentences, and charts below them.
[[nodiscard]] PageSection told_section(std::string title, std::vector<std::string> sentences,
                                       ChartRow charts);

struct PageContent {
  std::string command;  ///< "compare"
  std::string subject;  ///< what of: recordings, model
  Tone tone = Tone::neutral;
  std::string verdict;
  std::vector<PageFact> facts;
  std::vector<PageAnswer> answers;
  std::vector<std::string> notes;
  std::vector<PageSection> sections;
  std::optional<NextStep> next = std::nullopt;          ///< below the answers
  std::optional<Provenance> provenance = std::nullopt;  ///< at the foot
};

/// The file. Throws std::invalid_argument like chart_json, and where two charts share an id.
[[nodiscard]] std::string render_page(const PageContent& page, const PageRuntime& runtime);

/// All charts of a page, in order.
[[nodiscard]] std::vector<const plot::Chart*> charts_of(const PageContent& page);

}  // namespace trussmap::report
