// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// From the description of a chart (report/chart.hpp) to a Vega specification. A column's name is
// anybody's: in the data the columns are c0, c1, ...
const UNIT_CIRCLE = 'M-1,0A1,1,0,1,0,1,0A1,1,0,1,0,-1,0Z';
const SHADES = 7;

/** @param {string} role */
export const colourOf = role => /^\d+$/.test(role) ? `var(--c${role})` : `var(--${role})`;
const shadeColour = (/** @type {number} */ k) => `var(--d${k})`;
const isCategory = (/** @type {ChartAxis} */ axis) => Boolean(axis.categories);

/**
 * Rows of a layer, a mark each.
 * @param {ChartLayer} layer
 */
export function rowsOf(layer) {
  const count = layer.columns.length ? layer.columns[0].values.length : 0;
  /** @type {Row[]} */
  const rows = new Array(count);
  for (let k = 0; k < count; ++k) {
    /** @type {Row} */
    const row = {};
    layer.columns.forEach((column, c) => { row['c' + c] = column.values[k]; });
    if (layer.shade) {
      const shade = Math.max(-1, Math.min(1, layer.shade[k] ?? 0));
      row.strength = Math.abs(shade);
      row.below = shade < 0 ? 1 : 0;
      row.colour = shadeColour(Math.round((shade + 1) / 2 * (SHADES - 1)));
    }
    rows[k] = row;
  }
  return rows;
}

/**
 * Columns of a layer that lie on the x axis, and on the y axis.
 * @param {ChartLayer} layer
 * @param {Chart} chart
 */
function placesOf(layer, chart) {
  const sideways = isCategory(chart.y);
  switch (layer.kind) {
    case 'band': return [[0], [1, 2]];
    case 'segments': return [[0, 2], [1, 3]];
    case 'intervals': return sideways ? [[1, 2, 3], [0]] : [[0], [1, 2, 3]];
    case 'bars': return sideways ? [[1], [0]] : [[0], [1]];
    case 'level': return [[], [0]];
    case 'upright': return [[0], []];
    default: return [[0], [1]];
  }
}

/**
 * @param {Chart} chart
 * @param {0 | 1} which axis: x, y
 */
function extent(chart, which) {
  const axis = which ? chart.y : chart.x;
  if (axis.range) return axis.range.slice();
  let low = Infinity, high = -Infinity;
  const take = (/** @type {number | string | null} */ value) => {
    if (typeof value !== 'number' || (axis.log && !(value > 0))) return;
    if (value < low) low = value;
    if (value > high) high = value;
  };
  for (const layer of chart.layers) {
    for (const c of placesOf(layer, chart)[which]) layer.columns[c].values.forEach(take);
    if (layer.kind === 'bars' && placesOf(layer, chart)[which][0] === 1) take(0);
    if (layer.kind === 'ellipses') {
      const numbers = (/** @type {number} */ c) => layer.columns[c].values.map(Number);
      const a = numbers(2), b = numbers(3);
      numbers(which).forEach((at, k) => {
        const reach = Math.max(a[k], b[k]) || 0;
        take(at - reach);
        take(at + reach);
      });
    }
  }
  if (axis.zero) take(0);
  if (!(low <= high)) return axis.log ? [0.1, 1] : [0, 1];
  if (axis.log) return low < high ? [low * 0.9, high * 1.1] : [low / 2, high * 2];
  if (low === high) return [low - (Math.abs(low) || 1) / 2, high + (Math.abs(high) || 1) / 2];
  const margin = 0.03 * (high - low);
  return [axis.zero && low === 0 ? 0 : low - margin, axis.zero && high === 0 ? 0 : high + margin];
}

/**
 * Both ranges stretched about their middles until a unit is as long on both.
 * @param {number[][]} ranges
 * @param {number} width
 * @param {number} height
 */
function equalised([x, y], width, height) {
  const unit = Math.max((x[1] - x[0]) / width, (y[1] - y[0]) / height);
  const about = (/** @type {number[]} */ range, /** @type {number} */ pixels) => {
    const middle = (range[0] + range[1]) / 2;
    return [middle - unit * pixels / 2, middle + unit * pixels / 2];
  };
  return [about(x, width), about(y, height)];
}

/**
 * @param {'x' | 'y'} name
 * @param {ChartAxis} axis
 * @param {object} domain
 */
function scale(name, axis, domain) {
  const range = name === 'x' ? 'width' : 'height';
  if (isCategory(axis)) {
    const result = {name, type: 'band', domain: axis.categories, range, padding: 0.3};
    return name === 'y' ? {...result, range: [0, {signal: 'height'}]} : result;
  }
  return {name, type: axis.log ? 'log' : 'linear', domain, range, zero: false};
}

/**
 * How a layer's marks differ from those of other layers where colours cannot be told apart: lines by
 * their dash, dots by their shape.
 * @typedef {{dash: number[], shape: string}} Looks
 */
const SOLID = [1, 0];
const DASHES = [SOLID, [10, 3], [2, 3], [10, 3, 2, 3]];
const RIVALS = [[6, 4], [2, 2.5], [8, 2, 2, 2]];  // of lines that are dashed anyhow
const SHAPES = ['circle', 'square', 'diamond', 'triangle-up', 'cross', 'triangle-down'];
/** @type {LayerKind[]} */
const LINES = ['line', 'net', 'segments', 'ellipses', 'level', 'upright'];

/** @param {Chart} chart @returns {(layer: ChartLayer) => Looks} */
function looksIn(chart) {
  const named = chart.layers.filter(layer => layer.name && !layer.key);
  const colours = (/** @type {(layer: ChartLayer) => boolean} */ which) =>
      [...new Set(named.filter(which).map(layer => layer.colour))];
  const isLine = (/** @type {ChartLayer} */ layer) => LINES.includes(layer.kind);
  const strokes = colours(layer => isLine(layer) && !layer.dashed);
  const rivals = colours(layer => layer.kind === 'line' && Boolean(layer.dashed));
  const dots = colours(layer => !isLine(layer));
  const at = (/** @type {string[]} */ all, /** @type {string} */ colour, /** @type {number} */ count) =>
      Math.max(0, all.indexOf(colour)) % count;
  return layer => ({
    dash: layer.dashed ? RIVALS[at(rivals, layer.colour, RIVALS.length)]
        : layer.name ? DASHES[at(strokes, layer.colour, DASHES.length)] : SOLID,
    shape: SHAPES[at(dots, layer.colour, SHAPES.length)]});
}

/**
 * @param {ChartLayer} layer
 * @param {number} index
 * @param {Chart} chart
 * @returns {object[]}
 */
function marksOf(layer, index, chart) {
  const from = {data: 'd' + index};
  const vertical = isCategory(chart.y);
  /** @type {(name: 'x' | 'y', axis: ChartAxis) => (column: number) => object} */
  const across = (name, axis) => column => isCategory(axis)
      ? {scale: name, field: 'c' + column, band: 0.5, offset: layer.offset || 0}
      : {scale: name, field: 'c' + column};
  const x = across('x', chart.x), y = across('y', chart.y);
  const colour = layer.shade ? {field: 'colour'} : {value: colourOf(layer.colour)};
  const looks = looksIn(chart)(layer);
  const dash = layer.key ? {strokeDash: {signal: 'datum.below ? [7, 3] : [1, 0]'}}
                         : {strokeDash: {value: looks.dash}};
  const shape = {shape: {value: looks.shape}};
  const line = (/** @type {number} */ width) => ({stroke: colour, strokeWidth: {value: layer.size || width}, ...dash});
  const said = {tooltip: {signal: 'datum'}, cursor: {value: 'default'}};
  /** @type {(type: string, update: object, more?: object) => object} */
  const mark = (type, update, more = {}) =>
      ({type, name: 'layer' + index, from, aria: false, encode: {update}, clip: true, ...more});
  // What has nothing to say does not answer.
  /** @type {(type: string, update: object, hover: object) => object} */
  const lively = (type, update, hover) => layer.columns.some(column => column.name)
      ? mark(type, {}, {encode: {update: {...update, ...said}, hover}})
      : mark(type, update, {interactive: false});
  const defined = (/** @type {number[]} */ ...columns) =>
      ({signal: columns.map(c => `isValid(datum.c${c})`).join(' && ')});
  switch (layer.kind) {
    case 'dots': {
      const radius = layer.size || 4;
      return [lively('symbol', {x: x(0), y: y(1), fill: colour, ...shape, fillOpacity: {value: 0.8},
                                stroke: {value: 'var(--paper)'}, strokeWidth: {value: 0.5},
                                size: {value: Math.PI * radius * radius}},
                     {stroke: {value: 'var(--ink)'}, strokeWidth: {value: 2}})];
    }
    case 'line':
    case 'net':
      return [mark('line', {x: x(0), y: y(1), ...line(layer.kind === 'net' ? 1 : 2),
                            defined: defined(0, 1)}, {interactive: false})];
    case 'band':
      return [mark('area', {x: x(0), y: y(1), y2: y(2), fill: colour, fillOpacity: {value: 0.2},
                            defined: defined(0, 1, 2)}, {interactive: false})];
    case 'segments': {
      const width = layer.shade ? {signal: `${layer.size || 1} * (2 + 4 * datum.strength)`}
                                : {value: layer.size || 2.5};
      return [lively('rule', {x: x(0), y: y(1), x2: x(2), y2: y(3), ...line(2.5),
                              strokeWidth: width, strokeCap: {value: 'round'}},
                     {strokeWidth: {value: 8}})];
    }
    case 'ellipses': {
      const pixels = (/** @type {number} */ c) => ({signal: `max(1.5, datum.c${c} * abs(scale('x', 1) - scale('x', 0)))`});
      return [lively('path', {x: x(0), y: y(1), path: {value: UNIT_CIRCLE}, scaleX: pixels(2),
                              scaleY: pixels(3), angle: {signal: '-datum.c4 * 180 / PI'},
                              fill: colour, fillOpacity: {value: 0.18}, stroke: colour,
                              strokeWidth: {value: layer.size || 1.2}, ...dash},
                     {fillOpacity: {value: 0.5}})];
    }
    case 'intervals': {
      const ends = vertical ? {x: x(2), x2: x(3), y: y(0)} : {x: x(0), y: y(2), y2: y(3)};
      const middle = vertical ? {x: x(1), y: y(0)} : {x: x(0), y: y(1)};
      const radius = layer.size || 4;
      return [{...mark('rule', {...ends, stroke: colour, strokeWidth: {value: 2}},
                       {interactive: false}), name: 'reach' + index},
              lively('symbol', {...middle, fill: colour, ...shape,
                                size: {value: Math.PI * radius * radius}},
                     {stroke: {value: 'var(--ink)'}, strokeWidth: {value: 2}})];
    }
    case 'bars': {
      const thick = layer.size || 0;
      const name = vertical ? 'y' : 'x';
      const axis = vertical ? chart.y : chart.x;
      const middle = isCategory(axis)
          ? {scale: name, field: 'c0', band: 0.5, offset: layer.offset || 0}
          : {scale: name, field: 'c0'};
      const width = thick ? {value: thick} : isCategory(axis)
          ? {signal: `max(1, bandwidth('${name}'))`} : {value: 3};
      const across2 = vertical ? {yc: middle, height: width, x: x(1), x2: {scale: 'x', value: 0}}
                               : {xc: middle, width, y: y(1), y2: {scale: 'y', value: 0}};
      return [lively('rect', {...across2, fill: colour}, {stroke: {value: 'var(--ink)'}})];
    }
    case 'labels':
      return [mark('text', {x: x(0), y: y(1), text: {field: 'c2'}, dy: {value: -7},
                            align: {value: 'center'}, fontSize: {value: layer.size || 11},
                            limit: {value: 120}, fill: {value: colourOf(layer.colour)}},
                   {interactive: false})];
    case 'level':
      return [lively('rule', {y: y(0), x: {value: 0}, x2: {signal: 'width'}, ...line(1.5)},
                     {strokeWidth: {value: 3}})];
    case 'upright':
      return [lively('rule', {x: x(0), y: {value: 0}, y2: {signal: 'height'}, ...line(1.5)},
                     {strokeWidth: {value: 3}})];
  }
  return [];
}

/**
 * What is in the legend, each name once.
 * @typedef {Looks & {name: string, colour: string, width: number}} Key
 * @param {Chart} chart
 * @returns {Key[]}
 */
function legendOf(chart) {
  /** @type {Map<string, Key>} */
  const entries = new Map();
  const looks = looksIn(chart);
  for (const layer of chart.layers) {
    if (layer.name && !layer.key && !entries.has(layer.name)) {
      const line = LINES.includes(layer.kind);
      const {dash, shape} = looks(layer);
      const area = layer.kind === 'band' || layer.kind === 'bars';
      entries.set(layer.name, {name: layer.name, colour: colourOf(layer.colour), dash: line ? dash : SOLID,
                               shape: line ? 'stroke' : area ? 'square' : shape, width: line ? 2.5 : 0});
    }
    (layer.key || []).forEach((name, k) => {
      if (!name) return;
      entries.set(name, {name, colour: shadeColour(k * 3), dash: k === 0 ? [7, 3] : SOLID,
                         shape: 'stroke', width: k === 1 ? 2 : 6});
    });
  }
  return [...entries.values()];
}

/**
 * A scale from names in the legend to how they look.
 * @param {string} name
 * @param {Key[]} legend
 * @param {(key: Key) => unknown} look
 */
const keyScale = (name, legend, look) =>
    ({name, type: 'ordinal', domain: legend.map(key => key.name), range: legend.map(look)});

const LETTER = 6.4;       // pixels, about
const LINE = 13;
const MOST_LINES = 3;

/**
 * A name over several lines, each of so many letters at most; what does not fit is cut.
 * @param {string} name
 * @param {number} most
 */
export function wrapped(name, most) {
  /** @type {string[]} */
  const lines = [];
  for (const word of name.split(' ')) {
    const last = lines[lines.length - 1];
    if (last !== undefined && last.length + 1 + word.length <= most) lines[lines.length - 1] = last + ' ' + word;
    else lines.push(word);
  }
  if (lines.length > MOST_LINES) lines.splice(MOST_LINES - 1, lines.length, lines.slice(MOST_LINES - 1).join(' '));
  return lines.map(line => line.length > most + 1 ? line.slice(0, most - 1) + '\u2026' : line);
}

const text = {font: 'system-ui, Liberation Sans, sans-serif'};

/** @param {Chart} chart @param {number} width */
export function specOf(chart, width) {
  const legend = legendOf(chart);
  let domains = [extent(chart, 0), extent(chart, 1)];
  // Room for the axes, near enough for a map's proportions.
  if (chart.equal) domains = equalised(domains, width - 65, chart.height);
  const limit = {x: 110, y: Math.min(220, width * 0.4)};
  // Names of categories, over several lines, by name.
  const names = (/** @type {'x' | 'y'} */ name) => Object.fromEntries((chart[name].categories || [])
      .map(one => [one, wrapped(one, Math.floor(limit[name] / LETTER))]));
  const categories = (/** @type {'x' | 'y'} */ name) => ({encode: {labels: {update: {
    text: {signal: `${name}Names[datum.value]`},
    ...(name === 'y' ? {dy: {signal: `-${LINE / 2} * (length(yNames[datum.value]) - 1)`}} : {})}}}});
  const axis = (/** @type {string} */ orient, /** @type {ChartAxis} */ of,
                /** @type {'x' | 'y'} */ name) => ({
    orient, scale: name, title: of.title, grid: !isCategory(of), ticks: false, labelPadding: 6,
    domain: false, tickCount: {signal: `ceil(${name === 'x' ? 'width / 90' : 'height / 45'})`},
    labelLimit: limit[name] + 20, labelLineHeight: LINE, ...(isCategory(of) ? categories(name) : {}),
    ...(of.log ? {tickCount: 4, formatType: 'number', format: '~g'} : {}),
    aria: false});
  return {
    width, height: chart.height, padding: 4,
    autosize: {type: 'fit-x', contains: 'padding'},
    background: null,
    description: chart.title + '. ' + chart.caption,
    config: {
      axis: {labelFont: text.font, titleFont: text.font, labelFontSize: 12, titleFontSize: 12,
             titleFontWeight: 'normal', labelColor: 'var(--muted)', titleColor: 'var(--ink)',
             gridColor: 'var(--grid)', titlePadding: 8},
      legend: {labelFont: text.font, labelFontSize: 12, labelColor: 'var(--ink)',
               labelLimit: 260, columnPadding: 16}},
    // A map's part that is shown: page.js moves it.
    signals: [{name: 'xNames', value: names('x')}, {name: 'yNames', value: names('y')},
              ...(chart.equal ? [{name: 'xs', value: domains[0]}, {name: 'ys', value: domains[1]}] : [])],
    data: chart.layers.map((layer, k) => ({name: 'd' + k, values: rowsOf(layer)})),
    scales: [scale('x', chart.x, chart.equal ? {signal: 'xs'} : domains[0]),
             scale('y', chart.y, chart.equal ? {signal: 'ys'} : domains[1]),
             keyScale('colour', legend, key => key.colour), keyScale('shape', legend, key => key.shape),
             keyScale('dash', legend, key => key.dash), keyScale('width', legend, key => key.width),
             keyScale('size', legend, key => key.shape === 'stroke' ? 500 : 120)],
    axes: [axis('bottom', chart.x, 'x'), axis('left', chart.y, 'y')],
    legends: legend.length
        ? [{fill: 'colour', stroke: 'colour', shape: 'shape', strokeDash: 'dash', strokeWidth: 'width', size: 'size',
            orient: 'top', direction: 'horizontal', aria: false,
            columns: Math.max(1, Math.floor((width - 60 - (isCategory(chart.y) ? limit.y : 0)) /
                (36 + 7 * Math.max(...legend.map(key => Math.min(37, key.name.length))))))}]
        : [],
    marks: chart.layers.flatMap((layer, k) => marksOf(layer, k, chart))};
}
