// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "bench_requests.hpp"

#include "bench_exports.hpp"
#include "formula_limits.hpp"
#include "page_runtime.hpp"
#include "trussmap/error.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace trussmap::app {
namespace {

using nlohmann::json;

constexpr std::size_t kMostShapes = 8;
constexpr std::size_t kLongestName = 80;
constexpr std::size_t kMostRivals = 3;
constexpr double kLargestFactor = 100.0;  // of the noise

/// An answer that is none.
struct Refusal {
  unsigned status;
  std::string why;
};

LocalReply refusal(unsigned status, const std::string& why) {
  const json body = {{"error", why}};
  return {status, "application/json", body.dump(-1, ' ', false, json::error_handler_t::replace)};
}

std::shared_ptr<const BenchView> shown(const BenchWork& work) {
  std::shared_ptr<const BenchView> view = work.view();
  if (!view) throw Refusal{503, "the first model is still being fitted"};
  return view;
}

std::size_t finding_of(const json& asked, const BenchView& view) {
  const auto finding = asked.at("finding").get<std::size_t>();
  const std::size_t count = view.now.diagnosis().findings.size();
  if (finding >= count)
    throw Refusal{400, fmt::format("there is no finding {} of {}", finding, count)};
  return finding;
}

Effect own_effect(const json& asked) {
  Effect effect;
  effect.name = asked.at("name").get<std::string>();
  if (effect.name.empty() || effect.name.size() > kLongestName) {
    throw Refusal{400, fmt::format("an effect needs a name of up to {} bytes", kLongestName)};
  }
  effect.channel = channel_named(asked.at("channel").get<std::string>());
  const json& shapes = asked.at("shape");
  if (shapes.empty() || shapes.size() > kMostShapes) {
    throw Refusal{400, fmt::format("an effect needs 1 to {} shapes", kMostShapes)};
  }
  for (const json& one : shapes) {
    const auto formula = one.get<std::string>();
    if (const std::string fault = fault_of_formula(formula); !fault.empty()) {
      throw Refusal{400, fault};
    }
    effect.shape.emplace_back(formula);
  }
  return effect;
}

/// A finding, with its values where some are given, or an effect of the user's own.
Effect effect_of(const json& asked, const BenchView& view) {
  if (asked.contains("effect")) return own_effect(asked.at("effect"));
  const std::size_t finding = finding_of(asked, view);
  if (asked.contains("values")) {
    return view.now.moved(finding, asked.at("values").get<std::vector<double>>());
  }
  Effect effect = view.now.diagnosis().findings[finding].effect;
  effect.coefficients.clear();
  return effect;
}

/// Numbers of the legs in an area of the map, or in a span of elapsed time; empty without a choice.
std::vector<std::size_t> legs_of(const json& asked, const BenchView& view) {
  if (!asked.contains("choice")) return {};
  const json& choice = asked.at("choice");
  std::vector<std::size_t> legs;
  if (choice.contains("area")) {
    const auto [x, y, x2, y2] = choice.at("area").get<std::array<double, 4>>();
    legs = legs_in_area(view.now, {x, y}, {x2, y2});
  } else {
    const auto [from, to] = choice.at("time").get<std::array<double, 2>>();
    legs = legs_in_time(view.now, {std::min(from, to), std::max(from, to)});
  }
  if (legs.empty()) throw Refusal{400, "no leg is there"};
  return legs;
}

LocalReply preview(const json& asked, const BenchView& view) {
  const Effect effect = effect_of(asked, view);
  std::vector<Effect> rivals;
  for (const json& rival : asked.value("rivals", json::array())) {
    if (rivals.size() == kMostRivals) break;
    const std::size_t finding = finding_of({{"finding", rival}}, view);
    rivals.push_back(view.now.diagnosis().findings[finding].effect);
    rivals.back().coefficients.clear();
  }
  return {.body = preview_json(view.now.preview(effect, rivals, legs_of(asked, view)),
                               view.now.diagnosis().held_out.arrival_rms)};
}

LocalReply best(const json& asked, const BenchView& view) {
  const std::size_t finding = finding_of(asked, view);
  std::optional<std::size_t> only;
  if (asked.contains("only")) only = asked.at("only").get<std::size_t>();
  const json body = {
      {"values", view.now.best_near(finding, asked.at("values").get<std::vector<double>>(), only)}};
  return {.body = body.dump()};
}

std::size_t place_of_effect(const json& asked, const BenchView& view) {
  const auto effect = asked.at("effect").get<std::size_t>();
  if (effect >= view.now.fit().effects.size()) throw Refusal{400, "the model has no such effect"};
  return effect;
}

LocalReply explain(const json& asked, const BenchView& view) {
  if (asked.contains("effect")) {
    const std::size_t effect = place_of_effect(asked, view);
    return {.body = explanation_json(view.now.fit().effects[effect].effect)};
  }
  const Finding& finding = view.now.diagnosis().findings[finding_of(asked, view)];
  Effect effect = finding.effect;
  if (!finding.joint.empty()) effect.coefficients = finding.joint;
  return {.body = explanation_json(effect)};
}

LocalReply shown_effect(const json& asked, const BenchView& view) {
  EffectPreview preview;
  preview.evidence = view.now.shown(place_of_effect(asked, view), legs_of(asked, view));
  preview.dof = 1;
  return {.body = preview_json(preview, view.now.diagnosis().held_out.arrival_rms)};
}

/// Of every finding, its adjusted p-value were the noise so many times as large.
LocalReply with_noise(const json& asked, const BenchView& view) {
  const auto factor = asked.at("factor").get<double>();
  if (!(factor > 0.0) || factor > kLargestFactor) {
    throw Refusal{400,
                  fmt::format("a factor of the noise is above 0 and at most {}", kLargestFactor)};
  }
  json p = json::array();
  const std::size_t count = view.now.diagnosis().findings.size();
  for (std::size_t k = 0; k < count; ++k)
    p.push_back(p_with_noise(view.now.diagnosis(), k, factor));
  return {.body = json{{"level", kSignificance}, {"p", std::move(p)}}.dump()};
}

std::size_t place_of_step(const json& asked, const BenchView& view) {
  const auto step = asked.at("step").get<std::size_t>();
  if (step >= view.log.steps.size()) throw Refusal{400, "there is no such step"};
  return step;
}

BenchWork::Step step_of(const json& asked, const BenchView& view) {
  const auto what = asked.at("do").get<std::string>();
  if (what == "add") {
    const Effect effect = effect_of(asked, view);
    return {"Adding " + name_in_words(effect),
            [effect](Workbench& bench, const WorkbenchWatch& watch) { bench.add(effect, watch); }};
  }
  if (what == "remove") {
    const std::size_t effect = place_of_effect(asked, view);
    return {
        "Taking off " + name_in_words(view.now.fit().effects[effect].effect),
        [effect](Workbench& bench, const WorkbenchWatch& watch) { bench.remove(effect, watch); }};
  }
  if (what == "name") {
    auto label = asked.at("label").get<std::string>();
    if (label.size() > kLongestName) {
      throw Refusal{400, fmt::format("a step's name has up to {} bytes", kLongestName)};
    }
    return {"Naming a step",
            [step = place_of_step(asked, view), label = std::move(label)](
                Workbench& bench, const WorkbenchWatch&) { bench.rename(step, label); }};
  }
  if (what == "exclude") {
    return {"Leaving legs out",
            [legs = legs_of(asked, view)](Workbench& bench, const WorkbenchWatch& watch) {
              bench.exclude(legs, watch);
            }};
  }
  if (what == "include") {
    return {"Taking all legs back in",
            [](Workbench& bench, const WorkbenchWatch& watch) { bench.include_all(watch); }};
  }
  if (what == "go") {
    const std::size_t step = place_of_step(asked, view);
    return {"Going to another step",
            [step](Workbench& bench, const WorkbenchWatch& watch) { bench.go_to(step, watch); }};
  }
  throw Refusal{400, fmt::format("a step does not do \"{}\", expected add, remove, exclude, "
                                 "include, go or name",
                                 what)};
}

LocalReply step(const json& asked, BenchWork& work, const BenchView& view) {
  switch (work.begin(asked.at("version").get<std::size_t>(), step_of(asked, view))) {
    case BenchWork::Taken::yes:
      return {202, "application/json", "{}"};
    case BenchWork::Taken::busy:
      return refusal(409, "a step is under way already");
    case BenchWork::Taken::outdated:
      break;
  }
  return refusal(409, "the model has changed meanwhile; the page shows it now");
}

LocalReply answer_get(const LocalRequest& request, const BenchWork& work,
                      const BenchOrigin& origin) {
  if (request.path.empty()) {
    const std::string page = workbench_page(workbench_runtime());
    return {.type = "text/html; charset=utf-8", .body = page, .policy = "frame-ancestors 'none'"};
  }
  if (request.path == "status") return {.body = work.status()};
  if (request.path == "state") return {.body = shown(work)->json};
  constexpr std::string_view kExport = "export/";
  if (request.path.starts_with(kExport)) {
    if (auto file = bench_export(request.path.substr(kExport.size()), *shown(work), origin)) {
      return *file;
    }
  }
  return refusal(404, "there is nothing here");
}

LocalReply answer_post(const LocalRequest& request, BenchWork& work) {
  const std::shared_ptr<const BenchView> view = shown(work);
  const json asked = json::parse(request.body);
  // Findings are numbered anew by every step.
  if (asked.value("version", view->version) != view->version) {
    throw Refusal{409, "the model has changed meanwhile; the page shows it now"};
  }
  if (request.path == "preview") return preview(asked, *view);
  if (request.path == "best") return best(asked, *view);
  if (request.path == "explain") return explain(asked, *view);
  if (request.path == "shown") return shown_effect(asked, *view);
  if (request.path == "legs")
    return {.body = selection_json(view->now, view->log, legs_of(asked, *view))};
  if (request.path == "noise") return with_noise(asked, *view);
  if (request.path == "step") return step(asked, work, *view);
  if (request.path == "stop") {
    work.stop();
    return {202, "application/json", "{}"};
  }
  return refusal(404, "there is nothing here");
}

}  // namespace

LocalReply bench_reply(const LocalRequest& request, BenchWork& work, const BenchOrigin& origin) {
  try {
    return request.post ? answer_post(request, work) : answer_get(request, work, origin);
  } catch (const Refusal& one) {
    return refusal(one.status, one.why);
  } catch (const json::exception&) {
    return refusal(400, "the request is not the JSON that is expected");
  } catch (const std::invalid_argument& error) {
    return refusal(400, error.what());
  } catch (const std::exception& error) {
    return refusal(422, error.what());
  }
}

}  // namespace trussmap::app
