// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Drawing a rectangle, or a stretch of the x axis, on a chart.
import {make} from './dom.js';

const LEAST = 4;  // pixels: less is a click

/**
 * Listens to a chart in its figure.
 * @param {ChartEntry} entry
 * @param {boolean} alongX the whole height is chosen
 * @param {() => boolean} allowed while it says no, others have the mouse
 * @param {(corners: number[]) => void} done gets two corners, x, y, x, y, in the axes' units
 */
export function addBrush(entry, alongX, allowed, done) {
  const {figure, picture} = entry;
  /** @type {number[] | null} */
  let from = null;
  /** @type {HTMLElement | null} */
  let box = null;
  const view = () => /** @type {VegaView} */ (entry.view);
  const place = (/** @type {MouseEvent} */ event) => {
    const outer = picture.getBoundingClientRect();
    const [left, top] = view().origin();
    const within = (/** @type {number} */ at, /** @type {number} */ most) => Math.max(0, Math.min(most, at));
    return [within(event.clientX - outer.left - left, view().width()),
            alongX ? 0 : within(event.clientY - outer.top - top, view().height())];
  };
  const showBox = (/** @type {number[]} */ a, /** @type {number[]} */ b) => {
    if (!box) return;
    const [left, top] = view().origin();
    const [y, y2] = alongX ? [0, view().height()] : [a[1], b[1]];
    Object.assign(box.style, {
      left: left + Math.min(a[0], b[0]) + 'px', width: Math.abs(a[0] - b[0]) + 'px',
      top: top + Math.min(y, y2) + 'px', height: Math.abs(y - y2) + 'px'});
  };
  const end = () => {
    box?.remove();
    from = box = null;
  };
  figure.addEventListener('pointerdown', event => {
    if (event.button !== 0 || !allowed() || !picture.contains(/** @type {Node} */ (event.target))) return;
    event.preventDefault();
    event.stopPropagation();  // a map would be dragged
    from = place(event);
    box = make('div', {className: 'brush'});
    picture.append(box);
    showBox(from, from);
  }, true);
  addEventListener('pointermove', event => { if (from) showBox(from, place(event)); });
  addEventListener('pointerup', event => {
    if (!from) return;
    const a = from, b = place(event);
    end();
    if (Math.max(Math.abs(a[0] - b[0]), alongX ? 0 : Math.abs(a[1] - b[1])) < LEAST) return;
    const x = view().scale('x'), y = view().scale('y');
    done([a, b].flatMap(([across, down]) => [x.invert(across), alongX ? 0 : y.invert(down)]));
  });
  addEventListener('pointercancel', end);
  addEventListener('keydown', event => { if (event.key === 'Escape') end(); });
}
