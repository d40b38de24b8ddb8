// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/page.hpp"

#include "report/content_hash.hpp"
#include "report/large_pages.hpp"
#include "report/some_charts.hpp"

#include <map>
#include <regex>
#include <stdexcept>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::page_test {
using namespace plot;
using namespace report;
namespace {

const PageRuntime kRuntime{"main { color: red }\n", "/* the script */"};

PageContent page_with(const std::string& name) {
  PageContent page;
  page.command = "compare";
  page.subject = name;
  page.verdict = "Verdict on " + name;
  page.facts = {{"1 " + name, "what " + name, Tone::good}};
  page.notes = {"Note on " + name};
  page.sections = {
      {"Section " + name,
       {"Text " + name, PageTable{"Caption " + name, {name, "n"}, {{name, name}}, 1, {Tone::bad}},
        testing::charts_of_every_kind(name)}}};
  return page;
}

PageContent hostile_page() {
  return page_with(testing::kHostile);
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
    ++found;
  }
  return found;
}

TEST(Page, HostileNamesStayText) {
  const std::string html = render_page(hostile_page(), kRuntime);
  EXPECT_EQ(html.find("<script>document"), std::string::npos);
  EXPECT_EQ(html.find("<img"), std::string::npos);
  EXPECT_EQ(html.find("<!--"), std::string::npos);
  // One element of data per chart and the script: nobody else's.
  EXPECT_EQ(count(html, "<script"), 5U);
  EXPECT_EQ(count(html, "</script"), 5U);
}

TEST(Page, ItsFootSaysHowItWasMade) {
  const Provenance from{"trussmap compare '" + std::string(testing::kHostile) + "'",
                        "9.8.7",
                        "2031-05-06",
                        {{std::string(testing::kHostile), "0123456789abcdef"}}};
  const std::string html = render_page(with_provenance(Page(page_with("A")), from), kRuntime);
  const std::size_t foot = html.find("<footer>");
  ASSERT_NE(foot, std::string::npos);
  EXPECT_NE(html.find("fingerprint 0123456789abcdef", foot), std::string::npos);
  EXPECT_NE(html.find("made on", foot), std::string::npos);
  EXPECT_NE(html.find("version = {9.8.7},\n  year = {2031}", foot), std::string::npos);
  EXPECT_EQ(html.find("<script>document"), std::string::npos);
  EXPECT_EQ(html.find("<img"), std::string::npos);
  EXPECT_EQ(render_page(Page(page_with("A")), kRuntime).find("How this page was made"),
            std::string::npos);
}

TEST(Page, AToleranceStandsAboveAllElse) {
  const Tolerance passed{0.02, 0.0199, 43};
  EXPECT_EQ(in_words(passed),
            "passed: legs end 19.9 mm off (root mean square of 43 held out), within the tolerance "
            "of 20 mm");
  const Tolerance failed{0.02, 0.0201, 43};
  const Page page = with_tolerance(Page(page_with("A")), failed);
  EXPECT_EQ(page.content().tone, Tone::bad);
  EXPECT_EQ(page.content().answers.front().answer,
            "Failed: legs end 20.1 mm off (root mean square of 43 held out), beyond the tolerance "
            "of 20 mm.");
}

TEST(Page, APartOfAnotherPageHasPicturesAndNoScript) {
  const std::string html = render_section(Page(page_with("A")));
  EXPECT_EQ(count(html, "<script"), 0U);
  EXPECT_EQ(count(html, "<svg"), draw_charts(Page(page_with("A"))).size());
  EXPECT_EQ(count(html, "<?xml"), 0U);
  for (const char* said : {"Verdict on A", "what A", "Note on A", "Section A", "Text A"}) {
    EXPECT_NE(html.find(said), std::string::npos) << said;
  }
  // Charts share the page's names, so that one name may stand for one plot area alone.
  std::map<std::string, std::string> clips;
  const std::regex clip("<clipPath id=\"([^\"]+)\">(.*?)</clipPath>");
  for (std::sregex_iterator at(html.begin(), html.end(), clip), end; at != end; ++at) {
    EXPECT_EQ(clips.emplace((*at)[1], (*at)[2]).first->second, (*at)[2]) << (*at)[1];
  }
  EXPECT_GE(clips.size(), 1U);
  const std::regex rule("[{}]([^{}]+)\\{");
  for (std::size_t from = html.find("<style>"); from != std::string::npos;
       from = html.find("<style>", from + 1)) {
    const std::string sheet = "}" + html.substr(from + 7, html.find("</style>", from) - from - 7);
    for (std::sregex_iterator at(sheet.begin(), sheet.end(), rule), end; at != end; ++at) {
      EXPECT_TRUE((*at)[1].str().starts_with(".trussmap")) << (*at)[1];
    }
  }
  // Every rule is for this part alone.
  const std::string style = html.substr(0, html.find("</style>"));
  EXPECT_EQ(count(style, "{"), count(style, "}"));
  EXPECT_EQ(style.find("body"), std::string::npos);
  EXPECT_EQ(render_section(Page(hostile_page())).find("<img"), std::string::npos);
}

TEST(Page, ThatPartIsAFileOfItsOwnWithoutAScript) {
  const std::string html = render_plain_page(Page(hostile_page()));
  EXPECT_TRUE(html.starts_with("<!DOCTYPE html>"));
  EXPECT_NE(html.find(render_section(Page(hostile_page()))), std::string::npos);
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
  EXPECT_EQ(html.find("script-src"), std::string::npos);
  EXPECT_EQ(count(html, "<script"), 0U);
  EXPECT_EQ(count(html, "<title>trussmap compare: "), 1U);
}

TEST(Page, LoadsNothing) {
  const std::string html = render_page(page_with("A"), kRuntime);
  EXPECT_FALSE(std::regex_search(html, std::regex("<[a-z]+[^<>]* src=")));
  EXPECT_FALSE(std::regex_search(html, std::regex("<[a-z]+[^<>]* href=\"[^#]")));
  EXPECT_EQ(html.find("<link"), std::string::npos);
  EXPECT_EQ(html.find("http:"), std::string::npos);
  EXPECT_EQ(html.find("https:"), std::string::npos);
}

/// What stands between the last `open` and the next `close`.
std::string last_between(const std::string& text, const std::string& open,
                         const std::string& close) {
  const std::size_t at = text.rfind(open) + open.size();
  return text.substr(at, text.find(close, at) - at);
}

TEST(Page, AllowsItsOwnScriptAndStyleAlone) {
  const std::string html = render_page(hostile_page(), kRuntime);
  const std::string policy = last_between(html, "Policy\" content=\"", "\"");
  EXPECT_TRUE(policy.starts_with("default-src 'none'; ")) << policy;
  EXPECT_EQ(policy.find("unsafe"), std::string::npos) << policy;
  const std::string script = content_hash(last_between(html, "<script>", "</script>"));
  const std::string style = content_hash(last_between(html, "<style>", "</style>"));
  EXPECT_NE(policy.find("script-src '" + script + "';"), std::string::npos) << policy;
  EXPECT_NE(policy.find("style-src '" + style + "';"), std::string::npos) << policy;
  EXPECT_LT(html.find("Content-Security-Policy"), html.find("<title>"));
  const std::string plain = render_page(page_with("A"), kRuntime);
  EXPECT_FALSE(std::regex_search(plain, std::regex("<[a-z]+[^<>]* (style|on[a-z]+)=")));
}

TEST(Page, IsTheSameForTheSameInput) {
  EXPECT_EQ(render_page(hostile_page(), kRuntime), render_page(hostile_page(), kRuntime));
}

TEST(Page, SaysTheVerdictFirst) {
  const std::string html = render_page(hostile_page(), kRuntime);
  EXPECT_LT(html.find("<h1>"), html.find("<h2>"));
  EXPECT_LT(html.find("<h1>"), html.find("<figure"));
  EXPECT_LT(html.find("<h1>"), html.find("<table"));
}

TEST(Page, EveryChartHasATitleACaptionAndItsData) {
  const PageContent page = hostile_page();
  const std::string html = render_page(page, kRuntime);
  EXPECT_EQ(count(html, "<figure class=\"chart\""), charts_of(page).size());
  EXPECT_EQ(count(html, "<figcaption>"), charts_of(page).size());
  const std::regex data("<script type=\"application/json\">([^<]*)</script>");
  std::size_t parsed = 0;
  for (std::sregex_iterator k(html.begin(), html.end(), data), end; k != end; ++k) {
    EXPECT_TRUE(nlohmann::json::accept((*k)[1].str()));
    ++parsed;
  }
  EXPECT_EQ(parsed, charts_of(page).size());
}

TEST(Page, ChartsOfOneNameAreRefused) {
  PageContent page = hostile_page();
  page.sections.push_back(page.sections.front());
  EXPECT_THROW(static_cast<void>(render_page(page, kRuntime)), std::invalid_argument);
}

TEST(Page, AnswersStandUnderTheirQuestions) {
  PageContent page = page_with("A");
  page.answers = {{"How sure?", "Very."},
                  {"What to do next?", "Drive."},
                  {"What to do next?", "Look."},
                  {testing::kHostile, testing::kHostile}};
  const std::string html = render_page(page, kRuntime);
  EXPECT_NE(html.find("<dt>What to do next?</dt>\n<dd>Drive.</dd>\n<dd>Look.</dd>"),
            std::string::npos);
  EXPECT_EQ(html.find("<script>document"), std::string::npos);
  EXPECT_LT(html.find("<dt>How sure?"), html.find("<h2>"));
}

TEST(MapPage, ShowsTheErrorsOfEveryTour) {
  BuiltMap built;
  built.method = Method::elastic;
  for (const char* name : {"a", "b"}) {
    built.map.add_landmark(name, Vector2(name[0] == 'a' ? 0.0 : 4.0, 1.0));
  }
  built.map.add_route(0, 1);
  built.tours = {{{0.04, 0.02, 0.3, 7}, true}, {{0.03, 0.01, 0.2, 8}, false}};
  const std::string subject = "a recording";
  const Page page = map_page(built, subject);
  std::map<std::string, const Chart*> charts;
  for (const Chart* chart : charts_of(page.content())) charts[chart->id] = chart;
  const std::map<std::string, std::vector<double>> expected{
      {"tours-stretch", {4.0, 3.0}},
      {"tours-orientation", {0.02 * 180.0 / 3.14159265358979, 0.01 * 180.0 / 3.14159265358979}},
      {"tours-position", {0.3, 0.2}}};
  for (const auto& [id, errors] : expected) {
    ASSERT_TRUE(charts.contains(id)) << id;
    const ChartLayer& dots = charts.at(id)->layers.back();
    EXPECT_EQ(dots.columns[0].numbers, (std::vector<double>{1.0, 2.0})) << id;
    ASSERT_EQ(dots.columns[1].numbers.size(), 2U);
    for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(dots.columns[1].numbers[k], errors[k], 1e-12);
    EXPECT_EQ(dots.columns[2].numbers, (std::vector<double>{7.0, 8.0})) << id;
    EXPECT_NE(dots.columns[3].texts[0], dots.columns[3].texts[1]) << id;
  }
  built.tours.clear();
  EXPECT_EQ(charts_of(map_page(built, subject).content()).size(), charts.size() - 3);
}

TEST(SlowPage, TenThousandLegsStaySmall) {
  for (const auto& [name, page] : {std::pair{"compare", testing::large_comparison_page(10000)},
                                   std::pair{"diagnose", testing::large_diagnosis_page(10000)},
                                   std::pair{"discover", testing::large_discovery_page(10000)},
                                   std::pair{"build", testing::large_map_page(10000)}}) {
    for (const Chart* chart : charts_of(page.content())) {
      EXPECT_LE(mark_count(*chart), kMostMarks) << name << ", " << chart->id;
      EXPECT_GT(mark_count(*chart), 0U) << name << ", " << chart->id;
    }
    const std::size_t size = render_page(page, kRuntime).size();
    RecordProperty(name, static_cast<int>(size));
    EXPECT_LT(size, 4'000'000U) << name;  // the script has half a megabyte
  }
}

}  // namespace
}  // namespace trussmap::page_test
