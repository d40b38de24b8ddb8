// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the program sends to its pages, as JSON. The type checker holds the pages' scripts to it, and
// a test the program (PageScripts.GetWhatTheirTypesSay): every key that is declared is sent, and no
// other. Written for that test: one key a line, no type but those below, literals, arrays, unions.

type LayerKind = 'dots' | 'line' | 'net' | 'band' | 'segments' | 'ellipses' | 'intervals' | 'bars' |
    'labels' | 'level' | 'upright';

// A chart (plot/chart.hpp).

interface ChartAxis {
  title: string;
  log?: boolean;
  zero?: boolean;
  range?: number[];
  categories?: string[];
}

interface ChartColumn {
  name: string;
  values: (number | string | null)[];
}

interface ChartLayer {
  kind: LayerKind;
  name: string;
  places: number;
  colour: string;
  columns: ChartColumn[];
  size?: number;
  dashed?: boolean;
  offset?: number;
  shade?: (number | null)[];
  key?: string[];
}

interface Chart {
  id: string;
  title: string;
  caption: string;
  x: ChartAxis;
  y: ChartAxis;
  equal: boolean;
  height: number;
  layers: ChartLayer[];
}

// The workbench: what it shows (report/workbench_json.cpp).

interface BenchStep {
  step: number;
  from: number;
  name: string;
  label: string;
  on_way: boolean;
  has: string[];
  mm: number;
  predicted_mm: number | null;
  chi2_per_dof: number;
}

interface BenchVerdict {
  text: string;
  tone: 'good' | 'bad' | 'neutral';
  unsure?: string;
  drive: string;
  others: string[];
  warnings: string[];
}

interface BenchFigure {
  now: string;
  now_mm: number;
  floor: string;
  floor_mm: number;
  median: string;
  worst: string;
  legs: number;
  worst_leg?: string;
}

interface BenchLegs {
  shown: number;
  all: number;
  held_out: number;
  excluded: number;
  free: number;
  words: string;
}

interface BenchParameter {
  name: string;
  value: number;
  step: number;
  least: number;
  most: number;
  unit: string;
}

interface OnCard {
  id: string;
  name: string;
  formula: string;
  part: string;
  channel: string;
  does: string;
  shape: string[];
  cause?: string;
  remedy?: string;
  effect: number;
  words: string;
  not_fitted: string[];
  could_be: string[];
}

interface Card {
  id: string;
  name: string;
  formula: string;
  part: string;
  channel: string;
  does: string;
  shape: string[];
  cause?: string;
  remedy?: string;
  finding: number;
  words: string;
  status: string;
  implausible: boolean;
  saves_mm: number;
  chi2_less: number;
  leaves_mm: number;
  p: string;
  significant: boolean;
  looks_like: string[];
  parameters: BenchParameter[];
}

interface Unseen {
  name: string;
  why: string;
  drive: string;
}

interface NoiseShare {
  source: string;
  share: number;
}

interface BenchNoise {
  lines: string[];
  shares: NoiseShare[];
}

interface BenchChannel {
  name: string;
  unit: string;
  words: string;
}

interface BenchVariable {
  name: string;
  unit: string;
}

interface BenchState {
  subject: string;
  provisional: boolean;
  at: number;
  steps: BenchStep[];
  verdict: BenchVerdict;
  fit: string;
  tried: number;
  on: OnCard[];
  cards: Card[];
  unseen: Unseen[];
  noise: BenchNoise;
  variables: BenchVariable[];
  channels: BenchChannel[];
  staircase: Chart;
  legs: BenchLegs;
  figure: BenchFigure | null;
  map: Chart;
  strips: Chart[];
}

// Of the legs that are chosen (report/workbench_views.cpp).

interface Selection {
  legs: BenchLegs;
  figure: BenchFigure | null;
  map: Chart;
  strips: Chart[];
}

// Answers of the workbench (report/preview_json.cpp, bench_requests.hpp, bench_work.hpp).

interface PreviewRival {
  name: string;
  leaves_mm: number | null;
  verdict: string;
}

interface Preview {
  id: string;
  name: string;
  formula: string;
  part: string;
  channel: string;
  does: string;
  shape: string[];
  cause?: string;
  remedy?: string;
  seen: boolean;
  words: string;
  now_mm: number;
  leaves_mm: number | null;
  chi2_less: number;
  dof: number;
  p: string;
  rivals: PreviewRival[];
  chart: Chart | null;
}

interface ExplanationWords {
  does: string;
  look: string;
  drive: string;
}

interface ExplainReply {
  id: string;
  name: string;
  formula: string;
  part: string;
  channel: string;
  does: string;
  shape: string[];
  cause?: string;
  remedy?: string;
  explanation: ExplanationWords;
  unusual: boolean;
  drawing: string;
}

interface BestReply {
  values: number[];
}

interface NoiseReply {
  level: number;
  p: number[];
}

interface BenchStatus {
  version: number;
  busy: boolean;
  step: string;
  stops: boolean;
  failed: string;
  note: string;
  doing?: string;
  left?: number | null;
}

interface Refusal {
  error: string;
}
