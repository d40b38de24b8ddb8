// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Maps from nearer: buttons, the keys + - 0, a double click, the wheel with Ctrl (or two fingers);
// the mouse drags them.
import {make} from './dom.js';

const STEP = 1.6;
const MOST = 400;

/** @typedef {number[]} Ends of a range */

/**
 * Listens to a map, and returns its buttons.
 * @param {ChartEntry} entry that has been drawn
 */
export function addZoom(entry) {
  const {picture} = entry;
  const view = () => /** @type {VegaView} */ (entry.view);
  const shown = () => [view().signal('xs'), view().signal('ys')];
  const length = (/** @type {Ends} */ range) => range[1] - range[0];
  let whole = shown();
  /** @type {VegaView | undefined} */
  let of;
  /** @param {Ends} xs @param {Ends} ys */
  const show = (xs, ys) => {
    if (of !== view()) [of, whole] = [view(), shown()];  // drawn anew since
    const all = length(xs) >= length(whole[0]);
    view().signal('xs', all ? whole[0] : xs).signal('ys', all ? whole[1] : ys).run();
  };
  /**
   * So many times nearer, about a place given as shares of width and height (from below).
   * @param {number} times
   */
  const zoom = (times, across = 0.5, up = 0.5) => {
    const [xs, ys] = shown();
    if (of === view() && times > 1 && length(xs) * MOST < length(whole[0])) return;
    const about = (/** @type {Ends} */ range, /** @type {number} */ share) => {
      const at = range[0] + share * length(range);
      return [at - (at - range[0]) / times, at + (range[1] - at) / times];
    };
    show(about(xs, across), about(ys, up));
  };
  /** @param {MouseEvent} event @returns {[number, number]} */
  const place = event => {
    const box = picture.getBoundingClientRect();
    const [left, top] = view().origin();
    return [(event.clientX - box.left - left) / view().width(),
            1 - (event.clientY - box.top - top) / view().height()];
  };
  picture.addEventListener('keydown', event => {
    const times = new Map([['+', STEP], ['=', STEP], ['-', 1 / STEP], ['0', 1e-9]]).get(event.key);
    if (times && !event.ctrlKey && !event.metaKey) zoom(times);
  });
  picture.addEventListener('dblclick', event =>
      zoom(event.shiftKey ? 1 / STEP : STEP, ...place(event)));
  picture.addEventListener('wheel', event => {
    if (!event.ctrlKey) return;
    event.preventDefault();
    zoom(2 ** (-event.deltaY / 200), ...place(event));
  }, {passive: false});
  /** @type {{at: number[], ranges: Ends[]} | null} */
  let from = null;
  picture.addEventListener('pointerdown', event => {
    if (event.button === 0 && event.pointerType === 'mouse') from = {at: place(event), ranges: shown()};
  });
  addEventListener('pointerup', () => { from = null; });
  picture.addEventListener('pointermove', event => {
    if (!from || of !== entry.view) return;
    const {at, ranges} = from;
    const moved = place(event).map((share, k) => (at[k] - share) * length(ranges[k]));
    const [xs, ys] = ranges.map((range, k) => range.map(end => end + moved[k]));
    if (length(xs) < length(whole[0])) show(xs, ys);
  });
  /** @param {string} textContent @param {string} label @param {number} times */
  const button = (textContent, label, times) => {
    const made = make('button', {type: 'button', textContent, className: 'zoom'});
    made.setAttribute('aria-label', `${label} the chart "${entry.chart.title}"`);
    made.addEventListener('click', () => zoom(times));
    return made;
  };
  return [button('+', 'Zoom into', STEP), button('\u2212', 'Zoom out of', 1 / STEP),
          button('Show all', 'Show all of', 1e-9)];
}
