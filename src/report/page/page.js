// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Draws the charts of a page, one after the other.
import {addTableTools, charts, csvOf, drawAnew, followWidth, showChart, svgOf} from './figure.js';
import {notice} from './notice.js';

/// The first chart at once, the others when the browser has painted it.
function beginAll() {
  const figures = [...document.querySelectorAll('figure.chart')];
  const next = () => {
    const figure = figures.shift();
    if (!figure) {
      document.documentElement.dataset.charts = String(charts.length);
      return;
    }
    showChart(figure, JSON.parse(figure.querySelector('script').textContent));
    if (charts.length === 1) {
      requestAnimationFrame(() => setTimeout(() => performance.mark('first-chart'), 0));
    }
    setTimeout(next, 0);
  };
  next();
}

/// For programs that look at a page: window.trussmap.
window.trussmap = {
  notice,
  ids: () => charts.map(entry => entry.chart.id),
  svg: id => svgOf(charts.find(entry => entry.chart.id === id)),
  csv: id => csvOf(charts.find(entry => entry.chart.id === id).chart)
};
followWidth();
/// What is closed has no width: its charts are drawn again when it opens.
for (const more of document.querySelectorAll('details.more')) {
  more.addEventListener('toggle', drawAnew);
}
addTableTools();
beginAll();
