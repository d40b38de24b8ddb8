// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Maps from nearer: buttons, the keys + - 0, a double click, the wheel with Ctrl (or two fingers);
// the mouse drags them.
const STEP = 1.6;
const MOST = 400;

/// Listens to a map, and returns its buttons.
export function addZoom(entry, make) {
  const {picture} = entry;
  const shown = () => [entry.view.signal('xs'), entry.view.signal('ys')];
  const length = range => range[1] - range[0];
  let whole = null, of = null;
  const show = (xs, ys) => {
    if (of !== entry.view) [of, whole] = [entry.view, shown()];  // drawn anew since
    const all = length(xs) >= length(whole[0]);
    entry.view.signal('xs', all ? whole[0] : xs).signal('ys', all ? whole[1] : ys).run();
  };
  /// So many times nearer, about a place given as shares of width and height (from below).
  const zoom = (times, across = 0.5, up = 0.5) => {
    const [xs, ys] = shown();
    if (of === entry.view && times > 1 && length(xs) * MOST < length(whole[0])) return;
    const about = (range, share) => {
      const at = range[0] + share * length(range);
      return [at - (at - range[0]) / times, at + (range[1] - at) / times];
    };
    show(about(xs, across), about(ys, up));
  };
  const place = event => {
    const box = picture.getBoundingClientRect();
    const [left, top] = entry.view.origin();
    return [(event.clientX - box.left - left) / entry.view.width(),
            1 - (event.clientY - box.top - top) / entry.view.height()];
  };
  picture.addEventListener('keydown', event => {
    const times = {'+': STEP, '=': STEP, '-': 1 / STEP, 0: 1e-9}[event.key];
    if (times && !event.ctrlKey && !event.metaKey) zoom(times);
  });
  picture.addEventListener('dblclick', event =>
      zoom(event.shiftKey ? 1 / STEP : STEP, ...place(event)));
  picture.addEventListener('wheel', event => {
    if (!event.ctrlKey) return;
    event.preventDefault();
    zoom(2 ** (-event.deltaY / 200), ...place(event));
  }, {passive: false});
  let from = null;
  picture.addEventListener('pointerdown', event => {
    if (event.button === 0 && event.pointerType === 'mouse') from = {at: place(event), ranges: shown()};
  });
  addEventListener('pointerup', () => { from = null; });
  picture.addEventListener('pointermove', event => {
    if (!from || of !== entry.view) return;
    const moved = place(event).map((share, k) => (from.at[k] - share) * length(from.ranges[k]));
    const [xs, ys] = from.ranges.map((range, k) => range.map(end => end + moved[k]));
    if (length(xs) < length(whole[0])) show(xs, ys);
  });
  const button = (textContent, label, times) => {
    const made = make('button', {type: 'button', textContent, className: 'zoom'});
    made.setAttribute('aria-label', `${label} the chart "${entry.chart.title}"`);
    made.addEventListener('click', () => zoom(times));
    return made;
  };
  return [button('+', 'Zoom into', STEP), button('\u2212', 'Zoom out of', 1 / STEP),
          button('Show all', 'Show all of', 1e-9)];
}
