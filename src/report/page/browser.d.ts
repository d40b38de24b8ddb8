// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// As much of Vega's modules as the pages use: they come without types.

/// A mark as the scene has it.
interface SceneItem {
  mark: {name?: string};
  bounds: {x1: number, x2: number, y1: number, y2: number};
  tooltip?: Row;
}
interface SceneMark {
  name?: string;
  items: SceneItem[];
}

interface VegaView {
  run(): VegaView;
  finalize(): void;
  toSVG(): Promise<string>;
  signal(name: string): number[];
  signal(name: string, value: number[]): VegaView;
  origin(): [number, number];
  width(): number;
  height(): number;
  scale(name: 'x' | 'y'): {invert(pixel: number): number};
  scenegraph(): {root: {items: {items: SceneMark[]}[]}};
}

interface VegaOptions {
  renderer: 'svg';
  container: HTMLElement;
  hover: boolean;
  tooltip: (handler: unknown, event: MouseEvent, item: SceneItem | null, value: Row | null) => void;
}

declare module 'vega-dataflow' { export const transforms: Record<string, unknown>; }
declare module 'vega-encode';
declare module 'vega-interpreter' { export const expressionInterpreter: unknown; }
declare module 'vega-parser' {
  export function parse(spec: object, config: null, options: {ast: boolean}): unknown;
}
declare module 'vega-transforms';
declare module 'vega-view' {
  export const View: new (runtime: unknown, options: object) => VegaView;
}
declare module 'vega-view-transforms';

// What the scripts make of it for themselves.

/// A mark's values: columns are c0, c1, ...
type Row = Record<string, number | string | null>;

/// A chart in its place.
interface ChartEntry {
  figure: HTMLElement;
  picture: HTMLElement;
  chart: Chart;
  view?: VegaView;
  width?: number;
  at?: number;
  zoom?: HTMLButtonElement[];
}

/// For programs that look at a page.
interface Window {
  trussmap: object;
}
