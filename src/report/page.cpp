// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/page.hpp"

#include "plot/chart_svg.hpp"
#include "report/content_hash.hpp"
#include "report/page_words.hpp"
#include "text/xml_text.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace trussmap {
using namespace report;

namespace {

const char* class_of(Tone tone) {
  return tone == Tone::good ? "good" : tone == Tone::bad ? "bad" : "neutral";
}

/// What a colour says, for those who do not see it.
const char* sign_of(Tone tone) {
  return tone == Tone::good ? "\u2713 " : tone == Tone::bad ? "! " : "";
}

std::string element(const char* name, const std::string& text) {
  return fmt::format("<{0}>{1}</{0}>\n", name, text::xml_escaped(text));
}

long pixels_of(const plot::Chart& chart) {
  return std::lround(chart.height);
}

/// Room for the charts before they are drawn; attributes may hold no style.
std::string heights(const PageContent& page) {
  std::set<long> heights;
  for (const plot::Chart* chart : charts_of(page)) heights.insert(pixels_of(*chart));
  std::string text;
  for (const long height : heights) {
    text += fmt::format(".tall-{0} {{ min-height: {0}px; }}\n", height);
  }
  return text;
}

/// A chart as a picture.
std::string drawn(const plot::Chart& chart) {
  const std::string svg = plot::draw_chart(chart);
  return fmt::format("<figure>\n{}\n<figcaption>{}</figcaption>\n</figure>\n",
                     svg.substr(svg.find("<svg")), text::xml_escaped(chart.caption));
}

/// A figure of a chart: its caption and data are in the page, the script draws it.
std::string html(const plot::Chart& chart) {
  return fmt::format(
      "<figure class=\"chart\" id=\"{0}\">\n"
      "<h3>{1}</h3>\n"
      "<div class=\"picture tall-{2}\"></div>\n"
      "<figcaption>{3}</figcaption>\n"
      "<script type=\"application/json\">{4}</script>\n"
      "</figure>\n",
      text::xml_escaped(chart.id), text::xml_escaped(chart.title), pixels_of(chart),
      text::xml_escaped(chart.caption), plot::chart_json(chart));
}

std::string html(const PageTable& table) {
  std::string text = "<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"" +
                     text::xml_escaped(table.caption) + "\"><table>\n" +
                     (table.caption.empty() ? "" : element("caption", table.caption));
  const auto cell = [&table](std::size_t column) {
    return column < table.texts ? "" : " class=\"number\"";
  };
  // On a narrow screen a row is a card, with the headings beside its cells.
  const auto heading = [&table](std::size_t column) {
    return column < table.headings.size() ? text::xml_escaped(table.headings[column]) : "";
  };
  text += "<thead><tr>";
  for (std::size_t k = 0; k < table.headings.size(); ++k) {
    text +=
        fmt::format("<th scope=\"col\"{}>{}</th>", cell(k), text::xml_escaped(table.headings[k]));
  }
  text += "</tr></thead>\n<tbody>\n";
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const Tone tone = row < table.tones.size() ? table.tones[row] : Tone::neutral;
    text += fmt::format("<tr class=\"{}\">", class_of(tone));
    for (std::size_t k = 0; k < table.rows[row].size(); ++k) {
      text += fmt::format("<td{} data-heading=\"{}\">{}{}</td>", cell(k), heading(k),
                          k == 0 ? sign_of(tone) : "", text::xml_escaped(table.rows[row][k]));
    }
    text += "</tr>\n";
  }
  return text + "</tbody></table></div>\n";
}

struct BlockText {
  bool pictures = false;

  std::string operator()(const std::string& text) const { return element("p", text); }
  std::string operator()(const PageTable& table) const { return html(table); }
  std::string operator()(const ChartRow& charts) const {
    std::string text =
        fmt::format("<div class=\"charts {}\">\n", charts.size() > 1 ? "many" : "one");
    for (const plot::Chart& chart : charts) text += pictures ? drawn(chart) : html(chart);
    return text + "</div>\n";
  }
};

const char* tone_words(Tone tone) {
  switch (tone) {
    case Tone::good:
      return "<b class=\"tone\">\u2713 in order</b> ";
    case Tone::bad:
      return "<b class=\"tone\">! not in order</b> ";
    case Tone::neutral:
      break;
  }
  return "";
}

std::string html(const PageSection& section, bool pictures = false) {
  std::string text = element(pictures ? "h3" : "h2", section.title);
  for (const PageBlock& block : section.blocks) text += std::visit(BlockText{pictures}, block);
  if (section.details.empty()) return text;
  text += fmt::format(
      "<details class=\"more\"><summary>Details<span class=\"unseen\">: {}</span>"
      "</summary>\n",
      text::xml_escaped(section.title));
  for (const PageBlock& block : section.details) text += std::visit(BlockText{pictures}, block);
  return text + "</details>\n";
}

std::string first_screen(const PageContent& page) {
  std::string text = fmt::format(
      "<header class=\"{}\">\n<p class=\"command\">{}trussmap {} <span>{}</span></p>\n"
      "<h1>{}</h1>\n",
      class_of(page.tone), tone_words(page.tone), text::xml_escaped(page.command),
      text::xml_escaped(page.subject), text::xml_escaped(page.verdict));
  if (!page.facts.empty()) {
    text += "<dl class=\"facts\">\n";
    for (const PageFact& fact : page.facts) {
      text += fmt::format("<div class=\"{}\"><dt>{}</dt><dd>{}{}</dd></div>\n", class_of(fact.tone),
                          text::xml_escaped(fact.what), sign_of(fact.tone),
                          text::xml_escaped(fact.value));
    }
    text += "</dl>\n";
  }
  if (!page.answers.empty() || page.next) {
    text += "<dl class=\"answers\">\n";
    for (std::size_t k = 0; k < page.answers.size(); ++k) {
      const PageAnswer& one = page.answers[k];
      if (k == 0 || (!one.question.empty() && one.question != page.answers[k - 1].question)) {
        text += element("dt", one.question);
      }
      text += element("dd", one.answer);
    }
    if (page.next) {
      text += fmt::format("<dt>Next command</dt><dd class=\"next\">{}:<pre>{}</pre></dd>\n",
                          text::xml_escaped(capitalised(page.next->what_for)),
                          text::xml_escaped(page.next->line));
    }
    text += "</dl>\n";
  }
  if (!page.notes.empty()) {
    text += "<ul class=\"notes\">\n";
    for (const std::string& note : page.notes) text += element("li", note);
    text += "</ul>\n";
  }
  return text + "</header>\n";
}

/// What the page may do, whatever comes into it: its own script runs, and no other; nothing is
/// loaded, sent or embedded.
std::string policy(std::string_view script, const std::string& style) {
  return fmt::format(
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
      "script-src '{}'; style-src '{}'; base-uri 'none'; form-action 'none'\">\n",
      content_hash(script), content_hash(style));
}

std::string contents(const PageContent& page) {
  std::string text = "<nav aria-label=\"Sections\"><ul>\n";
  for (std::size_t k = 0; k < page.sections.size(); ++k) {
    text += fmt::format("<li><a href=\"#section-{}\">{}</a></li>\n", k + 1,
                        text::xml_escaped(page.sections[k].title));
  }
  return text + "</ul></nav>\n";
}

/// Made by what, of what, when; and an entry for a list of references.
std::string foot(const PageContent& page) {
  std::string text =
      "<footer><p>Made by trussmap. Charts drawn with Vega. This file holds all its data and "
      "loads nothing.</p>\n";
  if (page.provenance) {
    const Provenance& from = *page.provenance;
    text += "<details class=\"more\"><summary>How this page was made; how to cite it</summary>\n";
    text += fmt::format("<pre>{}</pre>\n", text::xml_escaped(from.command));
    PageTable table;
    table.headings = {"", ""};
    table.texts = 2;
    table.rows.push_back({"trussmap", from.version});
    if (!from.date.empty()) table.rows.push_back({"made on", from.date});
    for (const auto& [name, print] : from.data) {
      table.rows.push_back({name, "fingerprint " + print});
    }
    text += html(table);
    text += fmt::format(
        "<pre>@software{{trussmap,\n  title = {{trussmap: landmark maps as elastic trusses, and "
        "criticism of odometry models}},\n  author = {{The trussmap authors}},\n  version = "
        "{{{}}},\n  year = {{{}}}\n}}</pre>\n</details>\n",
        text::xml_escaped(from.version), from.date.substr(0, 4));
  }
  return text + "</footer>\n";
}

}  // namespace

}  // namespace trussmap

namespace trussmap::report {

PageSection told_section(std::string title, std::vector<std::string> sentences, ChartRow charts) {
  PageSection section{std::move(title), {}};
  for (std::string& one : sentences) section.blocks.emplace_back(std::move(one));
  section.blocks.emplace_back(std::move(charts));
  return section;
}

std::vector<const plot::Chart*> charts_of(const PageContent& page) {
  std::vector<const plot::Chart*> charts;
  for (const PageSection& section : page.sections) {
    for (const std::vector<PageBlock>* blocks : {&section.blocks, &section.details}) {
      for (const PageBlock& block : *blocks) {
        const auto* row = std::get_if<ChartRow>(&block);
        if (row == nullptr) continue;
        for (const plot::Chart& chart : *row) charts.push_back(&chart);
      }
    }
  }
  return charts;
}

std::string render_page(const PageContent& page, const PageRuntime& runtime) {
  std::set<std::string> ids;
  for (const plot::Chart* chart : charts_of(page)) {
    if (!ids.insert(chart->id).second) {
      throw std::invalid_argument("two charts of a page are called " + chart->id);
    }
  }
  std::string text =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n";
  const std::string style = fmt::format("\n{}{}", runtime.style, heights(page));
  text += policy(runtime.script, style);
  text += element("title", "trussmap " + page.command + ": " + page.verdict);
  text += fmt::format("<style>{}</style>\n</head>\n<body>\n<main>\n", style);
  text += first_screen(page);
  if (page.sections.size() > 1) text += contents(page);
  for (std::size_t k = 0; k < page.sections.size(); ++k) {
    text += fmt::format("<section id=\"section-{}\">\n", k + 1);
    text += html(page.sections[k]);
    text += "</section>\n";
  }
  text +=
      "</main>\n<noscript><p>The charts need JavaScript; the figures and tables above do not.</p>"
      "</noscript>\n" +
      foot(page) +
      "<div id=\"tip\" role=\"tooltip\" hidden></div>\n"
      "<div id=\"said\" class=\"unseen\" aria-live=\"polite\"></div>\n"
      "<div class=\"paper\" hidden></div>\n";
  text += fmt::format("<script>{}</script>\n</body>\n</html>\n", runtime.script);
  return text;
}

}  // namespace trussmap::report

namespace trussmap {

Page with_next_step(const Page& page, const NextStep& next) {
  PageContent content = page.content();
  content.next = next;
  return content;
}

Page with_provenance(const Page& page, const Provenance& provenance) {
  PageContent content = page.content();
  content.provenance = provenance;
  return content;
}

Page::Page(PageContent content)
    : content_(std::make_shared<const PageContent>(std::move(content))) {}

std::string render_page(const Page& page, const PageRuntime& runtime) {
  return render_page(page.content(), runtime);
}

std::string render_section(const Page& page) {
  constexpr const char* kStyle =
      ".trussmap .facts{display:flex;flex-wrap:wrap;gap:1em 2em}"
      ".trussmap .facts dd{font-size:1.4em;margin:0}.trussmap .charts{display:flex;flex-wrap:wrap}"
      ".trussmap figure{margin:.5em 1em .5em 0;flex:1 1 30em;max-width:40em}.trussmap "
      "svg{max-width:100%;height:auto}"
      ".trussmap td.number,.trussmap th.number{text-align:right}"
      ".trussmap .unseen{position:absolute;left:-999em}";
  std::string text = fmt::format("<style>{}</style>\n<section class=\"trussmap\">\n", kStyle);
  text += first_screen(page.content());
  for (const PageSection& section : page.content().sections) text += html(section, true);
  return text + "</section>\n";
}

std::string render_plain_page(const Page& page) {
  const PageContent& content = page.content();
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
         "'unsafe-inline'; base-uri 'none'; form-action 'none'\">\n" +
         element("title", "trussmap " + content.command + ": " + content.verdict) +
         "<style>body{font:16px/1.5 sans-serif;max-width:76em;margin:1em auto;padding:0 1em;"
         "background:#fff;color:#000}</style>\n</head>\n<body>\n" +
         render_section(page) + "</body>\n</html>\n";
}

std::vector<DrawnChart> draw_charts(const Page& page) {
  std::vector<DrawnChart> charts;
  for (const plot::Chart* chart : charts_of(page.content())) {
    charts.push_back({chart->id, plot::draw_chart(*chart)});
  }
  return charts;
}

}  // namespace trussmap
