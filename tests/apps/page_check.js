// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Put into a page under test: waits for its charts, tries everything out, and leaves what it found,
// as JSON, in <pre id="checked">.
(() => {
  const MARKS = ['symbol', 'rule', 'rect', 'line', 'area', 'path', 'text']
      .map(kind => `.mark-${kind}:not([class*="role-axis"]):not([class*="role-legend"]) > *`).join();

  const point = (element, ...types) => {
    const box = element.getBoundingClientRect();
    for (const type of types) {
      element.dispatchEvent(new MouseEvent(type, {
        bubbles: true, clientX: box.left + box.width / 2, clientY: box.top + box.height / 2}));
    }
  };

  async function checkChart(figure) {
    const picture = figure.querySelector('.picture');
    const tip = document.getElementById('tip');
    const marks = [...picture.querySelectorAll(MARKS)];
    const result = {id: figure.id, marks: marks.length, hover: ''};
    const kinds = '.mark-symbol > *, .mark-rule > *, .mark-rect > *, .mark-path > *';
    for (const mark of picture.querySelectorAll(kinds)) {
      if (mark.closest('[class*="role-axis"], [class*="role-legend"]')) continue;
      point(mark, 'pointerover', 'mouseover', 'pointermove', 'mousemove');
      result.hover = tip.hidden ? '' : tip.textContent;
      point(mark, 'pointerout', 'mouseout');
      if (result.hover) break;
    }
    picture.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight', bubbles: true}));
    result.said = document.getElementById('said').textContent;
    picture.dispatchEvent(new KeyboardEvent('keydown', {key: 'Escape', bubbles: true}));
    const svg = await window.trussmap.svg(figure.id);
    const parsed = new DOMParser().parseFromString(svg, 'image/svg+xml');
    result.svg_valid = !parsed.querySelector('parsererror') &&
        parsed.documentElement.nodeName === 'svg';
    result.svg_shapes = parsed.querySelectorAll('path, line, text').length;
    result.svg_plain = !svg.includes('var(') && !svg.includes('<script');
    result.csv_rows = window.trussmap.csv(figure.id).split('\r\n').length - 1;
    figure.querySelector('.tools details').open = true;
    const [closer, , whole] = figure.querySelectorAll('button.zoom');
    if (whole) {
      const places = async () => {
        await new Promise(done => setTimeout(done, 100));
        return [...picture.querySelectorAll('.mark-symbol > *, .mark-rule > *')]
            .filter(mark => !mark.closest('[class*="role-axis"], [class*="role-legend"]'))
            .map(mark => mark.getAttribute('transform')).join();
      };
      const before = await places();
      closer.click();
      const near = await places();
      whole.click();
      result.zoom = {nearer: near !== before, back: await places() === before};
    }
    return result;
  }

  async function check() {
    for (const more of document.querySelectorAll('details.more')) more.open = true;
    await new Promise(done => setTimeout(done, 50));
    const figures = [...document.querySelectorAll('figure.chart')];
    const charts = [];
    for (const figure of figures) charts.push(await checkChart(figure));
    await new Promise(done => setTimeout(done, 50));
    charts.forEach((chart, k) => {
      chart.table_rows = figures[k].querySelectorAll('details tr').length;
    });
    return {
      errors: window.pageErrors, title: document.title, verdict: document.querySelector('h1').textContent,
      scripts: document.scripts.length, images: document.images.length,
      labelled: figures.every(figure => figure.querySelector('.picture[aria-label]')), charts};
  }

  const begin = () => {
    if (!document.documentElement.dataset.charts) return setTimeout(begin, 20);
    return check().catch(error => ({errors: [...window.pageErrors, String(error)], charts: []}))
        .then(found => {
          const text = JSON.stringify(found).replace(/[<>&]/g, c =>
              '\\u' + c.charCodeAt(0).toString(16).padStart(4, '0'));
          document.body.append(Object.assign(document.createElement('pre'),
                                             {id: 'checked', textContent: text}));
        });
  };
  begin();
})();
