// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The bar that stays in sight: how far off, what noise alone would leave, and the steps between.
import {by, drawn} from './dom.js';

const WIDTH = 160;
const HEIGHT = 32;
const EDGE = 3;

/**
 * The steps on the way to this one as a staircase, the floor dashed.
 * @param {BenchState} state
 */
function staircase(state) {
  const way = state.steps.filter(step => step.on_way);
  const floor = state.figure?.floor_mm ?? 0;
  const top = Math.max(floor, ...way.map(step => step.mm)) || 1;
  const y = (/** @type {number} */ mm) => EDGE + (HEIGHT - 2 * EDGE) * (1 - mm / top);
  const wide = WIDTH / way.length;
  const points = way.flatMap((step, k) => [`${k * wide},${y(step.mm)}`, `${(k + 1) * wide},${y(step.mm)}`]);
  const words = way.map(step => step.mm.toFixed(1)).join(', ') + ' mm step by step' +
      (floor > 0 ? `; noise alone ${floor.toFixed(1)} mm` : '');
  return drawn('svg', {preserveAspectRatio: 'none', viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: 'img', 'aria-label': words},
               drawn('line', {class: 'floor', x1: 0, x2: WIDTH, y1: y(floor), y2: y(floor)}),
               drawn('polyline', {points: points.join(' ')}));
}

/** @param {BenchState} state */
export function showBar(state) {
  by('provisional').hidden = !state.provisional;
  by('bar-steps').replaceChildren(...(state.figure ? [staircase(state)] : []));
}

/** @param {BenchState | Selection} views */
export function showNumber({figure, legs}) {
  by('figure-now').textContent = figure ? figure.now : '\u2013';
  by('figure-floor').textContent = !figure ? ''
      : `off at a leg\u2019s end${legs.shown < legs.all ? ', of those chosen' : ''}; noise alone ${figure.floor}`;
}
