// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A chart in its place on a page: drawn, and made to answer: hover, arrow keys, saving.
import {by, make, messageOf, within} from './dom.js';
import {rowsOf, specOf} from './spec.js';
import {viewOf} from './vega.js';
import {addZoom} from './zoom.js';

const MOST_TABLE_ROWS = 500;
const tip = by('tip');
const said = by('said');
/**
 * All that are drawn.
 * @type {ChartEntry[]}
 */
export const charts = [];

/** @param {number | string | null} value */
const shown = value => typeof value === 'number' ? String(+value.toPrecision(4)) : value ?? '';

/**
 * "name: value" for all that a mark knows; coordinates come last.
 * @param {ChartLayer} layer
 * @param {Row} row
 */
function linesOf(layer, row) {
  const order = layer.columns.map((_, c) => c);
  const named = [...order.slice(layer.places), ...order.slice(0, layer.places)];
  return named.filter(c => layer.columns[c].name && row['c' + c] !== null)
      .map(c => `${layer.columns[c].name}: ${shown(row['c' + c])}`);
}

/** @param {string[]} lines @param {string} title @param {number} x @param {number} y */
function showTip(lines, title, x, y) {
  tip.replaceChildren(...(title ? [make('b', {textContent: title})] : []),
                      ...lines.map(line => make('span', {textContent: line})));
  tip.hidden = false;
  const box = tip.getBoundingClientRect();
  tip.style.left = Math.max(4, Math.min(x + 14, innerWidth - box.width - 8)) + 'px';
  tip.style.top = Math.max(4, Math.min(y + 14, innerHeight - box.height - 8)) + 'px';
}

/** @type {(chart: Chart, item: SceneItem) => ChartLayer} */
const layerOf = (chart, item) => chart.layers[Number(item.mark.name?.slice('layer'.length))];

/**
 * @param {Chart} chart
 * @param {MouseEvent} event
 * @param {SceneItem | null} item
 * @param {Row | null} value
 */
function onTooltip(chart, event, item, value) {
  if (!value || !item?.mark?.name) {
    tip.hidden = true;
    return;
  }
  const layer = layerOf(chart, item);
  showTip(linesOf(layer, value), layer.key ? '' : layer.name, event.clientX, event.clientY);
}

const STEPS = new Map([['ArrowRight', 1], ['ArrowDown', 1], ['ArrowLeft', -1], ['ArrowUp', -1]]);

/**
 * Arrow keys go from mark to mark; what it says is read out.
 * @param {ChartEntry} entry
 * @param {KeyboardEvent} event
 */
function walkMarks(entry, event) {
  const step = STEPS.get(event.key);
  if (event.key === 'Escape') tip.hidden = true;
  if (!step || !entry.view) return;
  event.preventDefault();
  const frame = entry.view.scenegraph().root.items[0];
  const items = frame.items.filter(mark => /^layer/.test(mark.name || ''))
      .flatMap(mark => mark.items).filter(item => item.tooltip);
  if (!items.length) return;
  entry.at = entry.at === undefined ? (step > 0 ? 0 : items.length - 1)
                                    : (entry.at + step + items.length) % items.length;
  const item = items[entry.at];
  const layer = layerOf(entry.chart, item);
  const origin = entry.view.origin();
  const box = entry.picture.getBoundingClientRect();
  const lines = linesOf(layer, item.tooltip || {});
  showTip(lines, layer.name, box.left + origin[0] + (item.bounds.x1 + item.bounds.x2) / 2,
          box.top + origin[1] + (item.bounds.y1 + item.bounds.y2) / 2);
  said.textContent = [layer.name, ...lines].join(', ');
}

/** @param {string} cell */
const quoted = cell => /[",\r\n]/.test(cell) ? '"' + cell.replaceAll('"', '""') + '"' : cell;

/** @param {Chart} chart */
export function csvOf(chart) {
  return chart.layers.map(layer => [
    ['layer', ...layer.columns.map(column => column.name)],
    ...rowsOf(layer).map(row => [layer.name,
                                 ...layer.columns.map((_, c) => String(row['c' + c] ?? ''))])
  ]).flat().map(row => row.map(quoted).join(',') + '\r\n').join('');
}

/**
 * The picture by itself, in the colours for paper.
 * @param {ChartEntry} entry
 */
export async function svgOf({chart, view}) {
  const paper = getComputedStyle(within(document, '.paper'));
  const plain = (await /** @type {VegaView} */ (view).toSVG())
      .replaceAll(/var\((--[\w-]+)\)/g, (_, name) => paper.getPropertyValue(name).trim());
  const title = new XMLSerializer().serializeToString(make('span', {textContent: chart.title}))
      .replace(/^<[^>]*>|<\/[^>]*>$/g, '');
  return plain.replace(/<svg[^>]*>/, open => open + `<title>${title}</title>` +
                       '<rect width="100%" height="100%" fill="#ffffff"/>');
}

/** @param {string} name @param {string} type @param {string} content */
function save(name, type, content) {
  const url = URL.createObjectURL(new Blob([content], {type}));
  make('a', {href: url, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

/** @param {ChartLayer} layer */
function tableOf(layer) {
  const rows = rowsOf(layer);
  const head = make('tr', {}, ...layer.columns.map(column =>
      make('th', {scope: 'col', textContent: column.name})));
  const body = rows.slice(0, MOST_TABLE_ROWS).map(row =>
      make('tr', {}, ...layer.columns.map((column, c) => {
        const cell = make('td', {textContent: shown(row['c' + c]),
                                 className: typeof row['c' + c] === 'number' ? 'number' : ''});
        cell.dataset.heading = column.name;
        return cell;
      })));
  const table = make('table', {}, make('caption', {
    textContent: layer.name + (rows.length > MOST_TABLE_ROWS
        ? ` (first ${MOST_TABLE_ROWS} of ${rows.length}; the CSV file has all)` : '')}),
                     make('thead', {}, head), make('tbody', {}, ...body));
  return make('div', {className: 'table', tabIndex: 0}, table);
}

/** @param {HTMLElement} figure @param {ChartEntry} entry */
function addTools(figure, entry) {
  const {chart} = entry;
  figure.querySelector('.tools')?.remove();
  const svg = make('button', {type: 'button', textContent: 'Save SVG'});
  svg.addEventListener('click', async () =>
      save(chart.id + '.svg', 'image/svg+xml', await svgOf(entry)));
  svg.setAttribute('aria-label', `Save SVG of the chart "${chart.title}"`);
  const csv = make('button', {type: 'button', textContent: 'Save CSV'});
  csv.addEventListener('click', () => save(chart.id + '.csv', 'text/csv', csvOf(chart)));
  csv.setAttribute('aria-label', `Save CSV of the data of "${chart.title}"`);
  const details = make('details', {}, make('summary', {textContent: 'Data as a table'}));
  details.addEventListener('toggle', () => {
    if (details.open && details.children.length === 1) {
      details.append(...chart.layers.filter(layer => layer.kind !== 'labels').map(tableOf));
    }
  });
  entry.zoom ??= chart.equal ? addZoom(entry) : [];
  figure.append(make('div', {className: 'tools'}, ...entry.zoom, svg, csv, details));
}

/** @param {ChartEntry} entry */
export function draw(entry) {
  const width = Math.max(240, entry.picture.clientWidth);
  entry.width = width;
  entry.at = undefined;
  entry.view?.finalize();
  entry.picture.replaceChildren();
  entry.view = viewOf(specOf(entry.chart, width), {
    renderer: 'svg', container: entry.picture, hover: true,
    tooltip: (_, event, item, value) => onTooltip(entry.chart, event, item, value)});
  entry.view.run();
  const root = entry.picture;
  root.tabIndex = 0;
  root.setAttribute('role', 'img');
  root.setAttribute('aria-label', `${entry.chart.title}. ${entry.chart.caption} ` +
                    'Arrow keys go through the marks.' +
                    (entry.chart.equal ? ' Plus, minus and 0 zoom.' : ''));
}

/**
 * Draws a chart in a figure that has a place for its picture; again, with another chart, in the
 * same place.
 * @param {HTMLElement} figure
 * @param {Chart} chart
 */
export function showChart(figure, chart) {
  const known = charts.find(one => one.figure === figure);
  const entry = known || {figure, picture: within(figure, '.picture'), chart};
  if (!known) charts.push(entry);
  entry.chart = chart;
  try {
    draw(entry);
  } catch (error) {
    entry.picture.replaceChildren(make('p', {
      className: 'failed', textContent: 'This chart could not be drawn: ' + messageOf(error)}));
    console.error(error);
    return entry;
  }
  if (!known) {
    entry.picture.addEventListener('keydown', event => walkMarks(entry, event));
    entry.picture.addEventListener('blur', () => { tip.hidden = true; });
  }
  addTools(figure, entry);
  return entry;
}

/// Those whose place has another width than when they were drawn.
export function drawAnew() {
  for (const entry of charts) {
    const width = entry.picture.clientWidth;
    if (entry.view && width && Math.abs(width - (entry.width || 0)) > 1) draw(entry);
  }
}

/// Tables of the page itself can be saved, too.
export function addTableTools() {
  document.querySelectorAll('section .table').forEach((box, k) => {
    if (box.closest('.chart')) return;
    const cells = [...box.querySelectorAll('tr')].map(row =>
        [...row.cells].map(cell => quoted(cell.textContent || '')).join(',') + '\r\n').join('');
    const csv = make('button', {type: 'button', textContent: 'Save CSV'});
    csv.setAttribute('aria-label', `Save CSV of the table "${box.getAttribute('aria-label')}"`);
    csv.addEventListener('click', () => save(`table-${k + 1}.csv`, 'text/csv', cells));
    box.after(make('p', {className: 'tools'}, csv));
  });
}

/// Charts follow the width of the window.
export function followWidth() {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let waiting;
  addEventListener('resize', () => {
    clearTimeout(waiting);
    waiting = setTimeout(drawAnew, 150);
  });
  addEventListener('scroll', () => { tip.hidden = true; }, {passive: true});
}
