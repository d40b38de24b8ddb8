// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A page looked at by a real browser: headless Chromium, without which these tests are skipped.
#pragma once

#include "policy/source_files.hpp"
#include "report/content_hash.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::testing {

inline std::string output_of(const std::string& command) {
  FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return {};
  std::string text;
  std::array<char, 65536> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    text.append(buffer.data(), count);
  }
  ::pclose(pipe);
  return text;
}

/// The browser's command; empty where there is none.
inline const std::string& browser() {
  static const std::string kBrowser = [] {
    std::string found = output_of("command -v chromium || command -v chromium-browser");
    return found.substr(0, found.find('\n'));
  }();
  return kBrowser;
}

#define TRUSSMAP_NEEDS_BROWSER() \
  if (trussmap::testing::browser().empty()) GTEST_SKIP() << "needs a browser (chromium)"

inline std::string text_in(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The page's DOM after its scripts have run. With `patient`, timers run to their end as well.
inline std::string dom_of(const std::filesystem::path& page, bool patient) {
  const std::string profile = (page.parent_path() / "profile").string();
  return output_of(
      browser() +
      " --headless --no-sandbox --disable-gpu --disable-dev-shm-usage "
      "--no-first-run --disable-extensions --disable-background-networking "
      "--disable-component-update --disable-sync --window-size=1200,900 --user-data-dir=" +
      profile + (patient ? " --virtual-time-budget=30000" : "") + " --dump-dom file://" +
      page.string() + " 2>/dev/null");
}

/// Inserts a script that notes errors before everything, and `last` after everything. The page's
/// policy allows these two besides its own.
inline std::filesystem::path instrumented(const std::filesystem::path& page,
                                          const std::string& last) {
  std::string html = text_in(page);
  const std::string first =
      "window.pageErrors = [];\n"
      "addEventListener('error', e => pageErrors.push(e.message));\n"
      "addEventListener('securitypolicyviolation', e =>\n"
      "  pageErrors.push(e.violatedDirective + ' ' + e.blockedURI + ' ' + e.sample));\n"
      "addEventListener('unhandledrejection', e => pageErrors.push(String(e.reason)));\n"
      "for (const kind of ['error', 'warn']) {\n"
      "  console[kind] = (...what) => pageErrors.push(what.map(String).join(' '));\n"
      "}";
  const std::string scripts = "script-src ";
  const std::size_t allowed = html.find(scripts);
  if (allowed == std::string::npos) throw std::runtime_error("the page has no policy");
  html.insert(allowed + scripts.size(),
              "'" + report::content_hash(first) + "' '" + report::content_hash(last) + "' ");
  const std::size_t after = html.find("Content-Security-Policy");
  html.insert(html.find('\n', after) + 1, "<script>" + first + "</script>\n");
  html.insert(html.rfind("</body>"), "<script>" + last + "</script>");
  const std::filesystem::path copy = page.parent_path() / ("checked_" + page.filename().string());
  std::ofstream(copy, std::ios::binary) << html;
  return copy;
}

/// What a script left in <pre id="checked">.
inline nlohmann::json checked(const std::filesystem::path& page, const std::string& script,
                              bool patient) {
  const std::string dom = dom_of(instrumented(page, script), patient);
  const std::string open = "<pre id=\"checked\">";
  const std::size_t at = dom.rfind(open);
  if (at == std::string::npos) throw std::runtime_error("the page's check did not end");
  return nlohmann::json::parse(
      dom.substr(at + open.size(), dom.find("</pre>", at) - at - open.size()));
}

/// Opens the page and tries all of it (page_check.js).
inline nlohmann::json checked_page(const std::filesystem::path& page) {
  return checked(page, text_of("tests/apps/page_check.js"), true);
}

}  // namespace trussmap::testing
