// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/content_hash.hpp"
#include "trussmap/pages.hpp"

#include <fmt/format.h>

namespace trussmap {
namespace {

/// The frame; the script fills it in (page/workbench.js).
// clang-format off
constexpr const char* kBody = R"html(<header id="head">
<p class="command">trussmap serve <span id="subject"></span></p>
<h1 id="verdict">Fitting the map &#8230;</h1>
<p id="unsure" hidden></p>
<p id="drive" hidden></p>
<ul id="others" class="notes" hidden></ul>
<div id="doing" role="status" hidden><progress aria-label="Step under way"></progress> <span></span>
<button type="button" id="stop" hidden>Stop it</button></div>
<p id="failed" class="failed" role="alert" hidden></p>
<div class="acts">
<span class="takes">Export:
<a href="export/model.toml" download>model.toml</a>
<a href="export/constants.toml" download>constants</a>
<a href="export/commands.sh" download>commands</a>
<a href="export/odometry.cpp" download>C++</a>
<a href="export/report.html" download>report</a></span>
</div>
</header>
<div id="bar" role="region" aria-label="How far off">
<p id="figure"><span id="figure-now">&#8211;</span> <span id="figure-floor"></span> <span id="provisional" class="tag plain" hidden>provisional: the noise is still being estimated</span></p>
<div id="bar-steps"></div>
<p class="acts"><button type="button" id="undo" disabled>Undo</button>
<button type="button" id="redo" disabled>Redo</button></p>
</div>
<main class="bench">
<section id="effects" aria-labelledby="effects-title" tabindex="0">
<h2 id="effects-title">Effects</h2>
<h3>In the model</h3>
<ul id="on" class="cards"></ul>
<h3>What each would save</h3>
<div id="parts"></div>
<details id="unseen"><summary>What these recordings cannot show</summary><ul></ul></details>
</section>
<section id="view" aria-label="The effect that is looked at, and the map" tabindex="0">
<details id="own"><summary>An effect of your own</summary>
<form id="own-form">
<label>Name <input id="own-name" maxlength="80" value="my effect" autocomplete="off"></label>
<label>Acts on <select id="own-channel"></select></label>
<p id="own-does" class="hint"></p>
<div id="own-terms"></div>
<datalist id="own-words"></datalist>
<p id="own-fault" class="failed" role="status"></p>
<p class="hint">A coefficient is fitted for each term. + - * / ^ ( ), &lt; &gt; (1 where it holds, else
0), sin cos tan abs sign min max exp log sqrt, and: <span id="own-variables"></span></p>
<p class="acts"><button type="button" id="own-term">Another term</button>
<button type="submit" id="own-add" disabled>Add it</button></p>
</form></details>
<div id="looked" aria-live="polite">
<h2 id="looked-name">Point at an effect</h2>
<p id="looked-words">Its curve appears here before anything is fitted.</p>
<p id="looked-saves" class="saves"></p>
<div id="sliders"></div>
<p id="duel-line" hidden><label>Set against <select id="duel"></select></label>
<span id="duel-words"></span></p>
<button type="button" id="add" hidden>Add it to the model</button>
<p id="looked-why"></p>
</div>
<figure class="chart" id="plot" hidden><h3></h3><div class="picture tall-260"></div>
<details class="read"><summary>How to read it</summary><p></p></details></figure>
<figure class="chart" id="map"><h3></h3><div class="picture tall-320"></div>
<details class="read"><summary>How to read it</summary><p></p></details></figure>
<section id="legs" aria-labelledby="legs-title">
<h3 id="legs-title">Legs</h3>
<p id="legs-words" aria-live="polite"></p>
<p class="acts"><button type="button" id="choose-area" aria-pressed="false">Choose on the map</button>
<button type="button" id="all-legs" disabled>Show all</button>
<button type="button" id="exclude" disabled>Exclude and refit</button>
<button type="button" id="include" hidden>Take all back in</button></p>
<form id="choose-time"><label>From <input id="time-from" type="number" min="0" step="any" required> s</label>
<label>to <input id="time-to" type="number" min="0" step="any" required> s</label>
<button type="submit">Choose in time</button></form>
<p id="legs-fault" class="failed" role="status"></p>
<p class="hint">Or drag across a strip of time, below. What is chosen is shown alone; a leg that is
excluded counts in no fit.</p>
</section>
</section>
<section id="error" aria-labelledby="error-title" tabindex="0">
<h2 id="error-title">How far off, and why</h2>
<p id="figure-more"></p>
<figure class="chart" id="staircase"><h3></h3><div class="picture"></div>
<details class="read"><summary>How to read it</summary><p></p></details></figure>
<h3>Steps</h3>
<ol id="steps"></ol>
<details id="compare" hidden><summary>Set two steps side by side</summary>
<p class="pair"><label>One <select id="compare-one"></select></label>
<label>Other <select id="compare-other"></select></label></p>
<div id="compared" class="table" aria-live="polite"></div></details>
<h3>Noise</h3>
<div id="noise"></div>
<label id="handle-line">If the noise were <input type="range" id="handle" min="0" max="3" step="0.05" value="0"> <output id="handle-factor">1</output> times as large as believed:</label>
<p id="handle-words" aria-live="polite"></p>
</section>
<section id="time" aria-label="In time"></section>
</main>
<div id="tip" role="tooltip" hidden></div>
<div id="said" class="unseen" aria-live="polite"></div>
<div class="paper" hidden></div>
)html";
// clang-format on

}  // namespace

std::string workbench_page(const PageRuntime& runtime) {
  const std::string style =
      fmt::format("\n{}.tall-320 {{ min-height: 320px; }}\n.tall-260 {{ min-height: 260px; }}\n",
                  runtime.style);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
      "script-src '{}'; style-src '{}'; connect-src 'self'; base-uri 'none'; form-action "
      "'none'\">\n"
      "<title>trussmap workbench</title>\n<style>{}</style>\n</head>\n<body>\n{}"
      "<script>{}</script>\n</body>\n</html>\n",
      report::content_hash(runtime.script), report::content_hash(style), style, kBody,
      runtime.script);
}

}  // namespace trussmap
