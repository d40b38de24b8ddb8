// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Drawing a rectangle, or a stretch of the x axis, on a chart.
import {make} from './figure.js';

const LEAST = 4;  // pixels: less is a click

/// Listens to a chart in its figure. `alongX`: the whole height is chosen. `done` gets the two
/// corners [x, y, x, y], in the units of the axes. While `allowed` says no, others have the mouse.
export function addBrush(entry, alongX, allowed, done) {
  const {figure, picture} = entry;
  let from = null, box = null;
  const place = event => {
    const outer = picture.getBoundingClientRect();
    const [left, top] = entry.view.origin();
    const within = (at, most) => Math.max(0, Math.min(most, at));
    return [within(event.clientX - outer.left - left, entry.view.width()),
            alongX ? null : within(event.clientY - outer.top - top, entry.view.height())];
  };
  const showBox = (a, b) => {
    const [left, top] = entry.view.origin();
    const [y, y2] = alongX ? [0, entry.view.height()] : [a[1], b[1]];
    Object.assign(box.style, {
      left: left + Math.min(a[0], b[0]) + 'px', width: Math.abs(a[0] - b[0]) + 'px',
      top: top + Math.min(y, y2) + 'px', height: Math.abs(y - y2) + 'px'});
  };
  const end = () => {
    box?.remove();
    from = box = null;
  };
  figure.addEventListener('pointerdown', event => {
    if (event.button !== 0 || !allowed() || !picture.contains(event.target)) return;
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
    const x = entry.view.scale('x'), y = entry.view.scale('y');
    done([a, b].flatMap(([across, down]) => [x.invert(across), alongX ? 0 : y.invert(down)]));
  });
  addEventListener('pointercancel', end);
  addEventListener('keydown', event => { if (event.key === 'Escape') end(); });
}
