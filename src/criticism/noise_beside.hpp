// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Noise estimated beside the effects that a model may lack: what is missing looks like noise that
// lasts, and too much noise hides what is missing.
//
//   fit --> the few plain effects that explain most, as suspects --> fitted with them
//       --> fit_noise --> fitted again under that noise, without them
//
// Only where the errors are larger than the present noise allows (p < 0.05 of chi^2): noise that is
// stated too large costs power, but names nothing that is not there.
//
// A suspect need not be right: it costs a few degrees of freedom where it is not. What acts at a
// place or beyond a threshold is none, nor is a formula, for they have to be sought first: once
// they are found, the noise is asked for again beside them.
#pragma once

#include "criticism/candidates.hpp"
#include "fit/noise_fit.hpp"

#include <optional>
#include <vector>

namespace trussmap::criticism {

/// `stated`: the noise that sizes are kept at where they can be. Throws as refit does.
[[nodiscard]] FitWithNoise with_noise_beside(const std::vector<DrivenRecording>& recordings,
                                             const ModelFit& fit, const Noise& stated);

/// Where some of the effects found are no suspects, since they were sought: the noise beside all of
/// them, which are fitted in `with` (if_fitted_with, refits.hpp). `under`: as found beside the
/// suspects. Absent: it is the same, or cannot be told.
[[nodiscard]] std::optional<FitWithNoise> with_noise_beside_found(
    const std::vector<DrivenRecording>& recordings, const FitWithNoise& under,
    const std::optional<ModelFit>& with, const std::vector<Candidate>& found, const Noise& stated);

}  // namespace trussmap::criticism
