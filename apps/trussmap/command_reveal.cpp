// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap reveal: what simulate --hide has hidden, and how near a model comes to it.
#include "commands.hpp"
#include "effect_options.hpp"
#include "model_recordings.hpp"
#include "results/json.hpp"
#include "results/simulation.hpp"
#include "sealed_answer.hpp"
#include "terminal.hpp"
#include "trussmap/error.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/simulated_recording.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/write_files.hpp"

#include <memory>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace trussmap::app {
namespace {

struct RevealOptions {
  std::string folder;
  std::string model;
  std::string json;
};

/// A model and how sure its coefficients are by this recording.
struct Estimated {
  std::vector<Effect> effects;
  std::vector<std::vector<double>> sd;
  std::string note;  ///< why there is no standard error
};

Estimated estimated(const RevealOptions& options) {
  ModelRecordingsOptions input;
  input.recordings = {options.folder};
  input.model = options.model;
  const Session session = read_session(input);
  Estimated result;
  result.effects = session.model.effects;
  if (result.effects.empty()) return result;
  try {
    const ModelFit fit = fit_model(session.rows.recordings, session.model, session.options.fit);
    for (std::size_t k = 0; k < fit.effects.size(); ++k) {
      result.sd.push_back(fit.effects[k].sd);
      if (result.effects[k].coefficients.empty()) result.effects[k] = fit.effects[k].effect;
    }
  } catch (const std::invalid_argument& error) {
    throw InputError(options.model, 0, error.what());
  } catch (const SolveError& error) {
    result.sd.clear();
    result.note =
        fmt::format("no z: the model cannot be fitted to {} ({})", options.folder, error.what());
  }
  return result;
}

void run_reveal(const RevealOptions& options) {
  const nlohmann::ordered_json answer = opened(options.folder);
  const std::vector<Effect> truth = effects_from(answer.at("effects"));
  results::Revealed revealed{answer.at("seed").get<std::uint64_t>(), &truth};
  std::string text = fmt::format("revealed: what is hidden in {}\n\n{}", options.folder,
                                 effects_text(truth, style_of(stdout)));
  if (!options.model.empty()) {
    const Estimated model = estimated(options);
    revealed.score = score_answer(truth, model.effects, model.sd);
    text = score_text(*revealed.score, style_of(stdout));
    if (!model.note.empty()) text += "\n" + notes_text({model.note});
  }
  if (!options.json.empty()) write_file(options.json, results::json_text(revealed));
  fmt::print("{}", text);
}

}  // namespace

void setup_reveal(const Command& app) {
  auto options = std::make_shared<RevealOptions>();
  const Command command =
      app.add_subcommand("reveal",
                         "Open the answer that simulate --hide sealed: the effects, and how near a "
                         "model comes to them.");
  command.add_option("FOLDER", options->folder, "Recording that simulate --hide wrote")
      .required()
      .type_name("DIR");
  command
      .add_option("--model", options->model,
                  "Model that was found (TOML): truth beside its estimates, z = (estimate - truth) "
                  "over the standard error by this recording, and a score")
      .type_name("FILE");
  command.add_option("--json", options->json, "Write the answer as JSON").type_name("FILE");
  command.callback([options] { run_reveal(*options); });
}

}  // namespace trussmap::app
