// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Draws the charts of a page, one after the other.
import {within} from './dom.js';
import {addTableTools, charts, csvOf, drawAnew, followWidth, showChart, svgOf} from './figure.js';
import {notice} from './notice.js';
import {printOnOneSheet} from './sheet.js';

/// The first chart at once, the others when the browser has painted it.
function beginAll() {
  /** @type {NodeListOf<HTMLElement>} */
  const all = document.querySelectorAll('figure.chart');
  const figures = [...all];
  const next = () => {
    const figure = figures.shift();
    if (!figure) {
      document.documentElement.dataset.charts = String(charts.length);
      return;
    }
    showChart(figure, JSON.parse(within(figure, 'script').textContent || ''));
    if (charts.length === 1) {
      requestAnimationFrame(() => setTimeout(() => performance.mark('first-chart'), 0));
    }
    setTimeout(next, 0);
  };
  next();
}

/** @param {string} id */
function drawn(id) {
  const entry = charts.find(one => one.chart.id === id);
  if (!entry) throw new Error('there is no chart ' + id);
  return entry;
}

/// For programs that look at a page: window.trussmap.
window.trussmap = {
  notice,
  ids: () => charts.map(entry => entry.chart.id),
  svg: (/** @type {string} */ id) => svgOf(drawn(id)),
  csv: (/** @type {string} */ id) => csvOf(drawn(id).chart)
};
followWidth();
/// What is closed has no width: its charts are drawn again when it opens.
for (const more of document.querySelectorAll('details.more')) {
  more.addEventListener('toggle', drawAnew);
}
addTableTools();
printOnOneSheet();
beginAll();
