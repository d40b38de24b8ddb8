// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The workbench's verdict, map, error, steps and strips of time, as a state has them.
import {showBar, showNumber} from './bench_bar.js';
import {by, make, within} from './dom.js';
import {showChart} from './figure.js';

/** @param {string} id @param {string} [text] */
function say(id, text) {
  by(id).textContent = text || '';
  by(id).hidden = !text;
}

/**
 * A chart in its figure.
 * @param {string} id
 * @param {Chart | null} chart
 */
export function showFigure(id, chart) {
  const figure = by(id);
  figure.hidden = !chart;
  if (!chart) return;
  within(figure, 'h3').textContent = chart.title;
  const caption = figure.querySelector('.read p');
  if (caption) caption.textContent = chart.caption;
  showChart(figure, chart);
}

/** @param {BenchState} state */
function showVerdict(state) {
  by('subject').textContent = state.subject;
  by('verdict').textContent = state.verdict.text;
  by('head').className = state.verdict.tone;
  say('unsure', state.verdict.unsure);
  say('drive', state.verdict.drive);
  const notes = [...state.verdict.others, ...state.verdict.warnings];
  by('others').hidden = !notes.length;
  by('others').replaceChildren(...notes.map(textContent => make('li', {textContent})));
  document.title = 'trussmap: ' + state.verdict.text;
}

/** @param {BenchState | Selection} views */
function showError(views) {
  const {figure, legs} = views;
  const some = legs.shown < legs.all;
  showNumber(views);
  by('figure-more').textContent = figure
      ? `Dead reckoning is off by ${figure.now} at the end of a leg that no fit has seen (root mean ` +
        `square of ${figure.legs}` + (some ? ' among the chosen' : '') + '). ' +
        `Median ${figure.median}, worst ${figure.worst}` +
        (figure.worst_leg ? ` (${figure.worst_leg})` : '') +
        `. Noise alone would leave ${figure.floor}.`
      : some ? 'None of the chosen legs is held out.' : 'There are no legs to be held out of the fit.';
}

/** @param {BenchState} state */
function showNoise(state) {
  by('noise').replaceChildren(
      ...state.noise.lines.map(textContent => make('p', {textContent})));
}

/** @param {BenchState | Selection} views */
function showStrips({strips}) {
  for (const chart of strips) {
    if (!document.getElementById(chart.id)) {
      by('time').append(make('figure', {className: 'chart strip', id: chart.id},
                             make('h3'), make('div', {className: 'picture'})));
    }
    showFigure(chart.id, chart);
  }
}

/** @param {BenchState} state */
function showUnseen(state) {
  by('unseen').hidden = !state.unseen.length;
  within(by('unseen'), 'ul').replaceChildren(...state.unseen.map(one =>
      make('li', {textContent: `${one.name}: ${one.why}; ${one.drive}`})));
}

/** @param {BenchState} state */
export function showState(state) {
  showVerdict(state);
  showBar(state);
  showFigure('staircase', state.figure ? state.staircase : null);
  showNoise(state);
  showUnseen(state);
}

/**
 * What shows legs: all, or those chosen.
 * @param {BenchState | Selection} views
 */
export function showViews(views) {
  showFigure('map', views.map);
  showError(views);
  showStrips(views);
}
