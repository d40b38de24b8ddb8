// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A browser that is driven: real pointer and keys, over the DevTools protocol through two pipes.
#pragma once

#include "apps/browser.hpp"
#include "child_process.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <deque>
#include <filesystem>
#include <memory>
#include <poll.h>
#include <stdexcept>
#include <string>
#include <thread>
#include <unistd.h>
#include <vector>

#include <nlohmann/json.hpp>

namespace trussmap::testing {

/// Headless Chromium with its profile in a folder of the test's own.
class Chrome {
 public:
  using Json = nlohmann::json;

  explicit Chrome(const std::filesystem::path& folder, int width = 1400, int height = 1000) {
    std::array<int, 2> to{}, from{};
    if (::pipe(to.data()) != 0 || ::pipe(from.data()) != 0) throw std::runtime_error("no pipe");
    const std::string profile = "--user-data-dir=" + (folder / "profile").string();
    const std::string size =
        "--window-size=" + std::to_string(width) + "," + std::to_string(height);
    child_ = std::make_unique<ChildProcess>([&] {
      // Chromium reads commands from 3 and answers to 4.
      ::dup2(to[0], 100);
      ::dup2(from[1], 101);
      ::dup2(100, 3);
      ::dup2(101, 4);
      for (int one = 5; one < 200; ++one) ::close(one);
      FILE* ignored = std::freopen("/dev/null", "w", stderr);
      ignored = std::freopen("/dev/null", "w", stdout);
      static_cast<void>(ignored);
      ::execlp(browser().c_str(), "chromium", "--headless", "--no-sandbox", "--disable-gpu",
               "--disable-dev-shm-usage", "--no-first-run", "--disable-extensions",
               "--disable-background-networking", "--remote-debugging-pipe", profile.c_str(),
               size.c_str(), "about:blank", nullptr);
    });
    ::close(to[0]);
    ::close(from[1]);
    to_ = to[1];
    from_ = from[0];
    open_tab();
  }
  ~Chrome() {
    ::close(to_);
    ::close(from_);
  }
  Chrome(const Chrome&) = delete;
  Chrome& operator=(const Chrome&) = delete;

  /// A further tab, which is the one that is driven from now on; its number.
  std::size_t open_tab() {
    session_.clear();
    const std::string target = call("Target.createTarget", {{"url", "about:blank"}}).at("targetId");
    session_ =
        call("Target.attachToTarget", {{"targetId", target}, {"flatten", true}}).at("sessionId");
    tabs_.push_back(session_);
    call("Page.enable");
    call("Runtime.enable");
    call("Log.enable");
    return tabs_.size() - 1;
  }
  void to_tab(std::size_t tab) { session_ = tabs_.at(tab); }

  void go(const std::string& url) { call("Page.navigate", {{"url", url}}); }
  void reload() { call("Page.reload"); }

  /// The window's size from now on, and whether the screen is a dark one.
  void look_as(int width, int height, bool dark) {
    call("Emulation.setDeviceMetricsOverride",
         {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
    const char* scheme = dark ? "dark" : "light";
    call("Emulation.setEmulatedMedia",
         {{"features", Json::array({{{"name", "prefers-color-scheme"}, {"value", scheme}}})}});
  }

  /// The page as it is printed: a PDF, in base 64.
  std::string print() {
    return call("Page.printToPDF", {{"preferCSSPageSize", true}, {"printBackground", true}})
        .at("data")
        .get<std::string>();
  }

  /// What a script comes to.
  Json eval(const std::string& script) {
    const Json result =
        call("Runtime.evaluate",
             {{"expression", script}, {"awaitPromise", true}, {"returnByValue", true}});
    if (result.contains("exceptionDetails")) throw std::runtime_error(result.dump());
    return result.at("result").value("value", Json());
  }

  /// Until a script is true; else throws after so long.
  void wait(const std::string& script, std::chrono::seconds most = std::chrono::seconds(60)) {
    const auto end = std::chrono::steady_clock::now() + most;
    while (std::chrono::steady_clock::now() < end) {
      // Between two pages there is nothing to ask.
      const Json value =
          eval("(() => { try { return Boolean(" + script + "); } catch { return false; } })()");
      if (value.is_boolean() && value.get<bool>()) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    throw std::runtime_error("in vain waited for " + script + " at " +
                             eval("document.body.innerText.slice(0, 600)").dump());
  }

  std::string text(const std::string& selector) {
    return eval("document.querySelector(" + Json(selector).dump() + ").textContent")
        .get<std::string>();
  }

  void point_at(const std::string& selector) { mouse("mouseMoved", middle_of(selector)); }

  void click(const std::string& selector) {
    const auto at = middle_of(selector);
    for (const char* what : {"mouseMoved", "mousePressed", "mouseReleased"}) mouse(what, at);
  }

  /// From one part of an element to another: shares of its width and height.
  void drag(const std::string& selector, const std::array<double, 2>& from,
            const std::array<double, 2>& to) {
    const Json box = eval("(() => { const one = document.querySelector(" + Json(selector).dump() +
                          "); one.scrollIntoView({block: 'center'}); const box = "
                          "one.getBoundingClientRect(); return [box.left, box.top, box.width, "
                          "box.height]; })()");
    const auto at = [&box](const std::array<double, 2>& share) {
      return Place{box[0].get<double>() + share[0] * box[2].get<double>(),
                   box[1].get<double>() + share[1] * box[3].get<double>()};
    };
    mouse("mouseMoved", at(from));
    mouse("mousePressed", at(from));
    mouse("mouseMoved", at({0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])}));
    mouse("mouseMoved", at(to));
    mouse("mouseReleased", at(to));
  }

  void type(const std::string& text) { call("Input.insertText", {{"text", text}}); }

  /// Errors, warnings and violations of the policy that pages have reported.
  [[nodiscard]] std::vector<std::string> complaints() {
    eval("0");  // whatever was said before has arrived
    return complaints_;
  }

 private:
  using Place = std::array<double, 2>;

  Place middle_of(const std::string& selector) {
    const Json at = eval("(() => { const e = document.querySelector(" + Json(selector).dump() +
                         "); if (!e) return null; e.scrollIntoView({block: 'center'}); "
                         "const b = e.getBoundingClientRect(); "
                         "return [b.x + b.width / 2, b.y + b.height / 2]; })()");
    if (!at.is_array()) throw std::runtime_error("there is no " + selector);
    return {at[0].get<double>(), at[1].get<double>()};
  }

  void mouse(const char* what, const Place& at) {
    call("Input.dispatchMouseEvent",
         {{"type", what}, {"x", at[0]}, {"y", at[1]}, {"button", "left"}, {"clickCount", 1}});
  }

  Json call(const std::string& method, const Json& parameters = Json::object()) {
    Json message = {{"id", ++last_}, {"method", method}, {"params", parameters}};
    if (!session_.empty()) message["sessionId"] = session_;
    const std::string text = message.dump() + '\0';
    for (std::size_t sent = 0; sent < text.size();) {
      const ssize_t count = ::write(to_, text.data() + sent, text.size() - sent);
      if (count <= 0) throw std::runtime_error("the browser is gone");
      sent += static_cast<std::size_t>(count);
    }
    while (true) {
      const Json answer = next_message();
      if (answer.value("id", 0) == last_) {
        if (answer.contains("error")) throw std::runtime_error(answer.at("error").dump());
        return answer.at("result");
      }
      note(answer);
    }
  }

  Json next_message() {
    std::size_t end = 0;
    while ((end = read_.find('\0')) == std::string::npos) {
      pollfd ready{from_, POLLIN, 0};
      if (::poll(&ready, 1, 60'000) <= 0) throw std::runtime_error("the browser is silent");
      std::array<char, 65536> buffer{};
      const ssize_t count = ::read(from_, buffer.data(), buffer.size());
      if (count <= 0) throw std::runtime_error("the browser is gone");
      read_.append(buffer.data(), static_cast<std::size_t>(count));
    }
    Json message = Json::parse(read_.substr(0, end));
    read_.erase(0, end + 1);
    return message;
  }

  void note(const Json& event) {
    const std::string method = event.value("method", "");
    if (method == "Runtime.exceptionThrown") complaints_.push_back(event.dump());
    if (method == "Runtime.consoleAPICalled") {
      const std::string type = event.at("params").value("type", "");
      if (type == "error" || type == "warning") complaints_.push_back(event.dump());
    }
    if (method == "Log.entryAdded") {
      const Json& entry = event.at("params").at("entry");
      // A formula that is half typed is answered by 400: that is no complaint.
      const bool refused = entry.value("text", "").find("status of 400") != std::string::npos;
      if (entry.value("level", "") == "error" && !refused) complaints_.push_back(event.dump());
    }
  }

  std::unique_ptr<ChildProcess> child_;
  int to_ = -1;
  int from_ = -1;
  int last_ = 0;
  std::string read_;
  std::string session_;
  std::vector<std::string> tabs_;
  std::vector<std::string> complaints_;
};

}  // namespace trussmap::testing
