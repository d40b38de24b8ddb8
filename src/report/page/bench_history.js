// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The workbench's steps: each can be returned to, given a name, and set beside another.
import {by, make, selectBy} from './dom.js';

/**
 * @typedef {object} HistoryActs
 * @property {() => boolean} busy
 * @property {(step: number) => void} go
 * @property {(step: number, label: string) => void} name
 */

/** @type {[number, number] | null} */
let beside = null;  // the two that are compared
/** @type {number | null} */
let naming = null;  // the step that is being named

/** @param {BenchStep} step */
const titleOf = step => step.label || step.name;

/** @param {BenchState} state @param {BenchStep} step */
function figuresOf(state, step) {
  const here = step.step === state.at;
  const less = step.mm - state.steps[state.at].mm;
  const against = here ? ' (here)'
      : ` (${less > 0 ? '+' : '\u2212'}${Math.abs(less).toFixed(1)} mm against here)`;
  const foretold = step.predicted_mm === null ? '' : `, ${step.predicted_mm.toFixed(1)} predicted`;
  const roughly = here && state.provisional ? '\u2248 ' : '';
  const branches = step.step > 0 && step.from !== step.step - 1 ? `from ${step.from + 1}: ` : '';
  return `${branches}${step.label ? step.name + ': ' : ''}${roughly}${step.mm.toFixed(1)} mm${foretold}${against}`;
}

/** @param {BenchStep} step @param {HistoryActs} does @param {() => void} again */
function namingForm(step, does, again) {
  const input = make('input', {value: step.label, maxLength: 60, autocomplete: 'off'});
  input.setAttribute('aria-label', `A name for the step ${step.name}`);
  const form = make('form', {className: 'naming'}, input,
                    make('button', {type: 'submit', textContent: 'Keep'}));
  form.addEventListener('submit', event => {
    event.preventDefault();
    naming = null;
    does.name(step.step, input.value.trim());
    again();
  });
  input.addEventListener('keydown', event => {
    if (event.key !== 'Escape') return;
    naming = null;
    again();
  });
  return form;
}

/** @param {BenchState} state @param {BenchStep} step @param {HistoryActs} does @param {() => void} again */
function itemOf(state, step, does, again) {
  const here = step.step === state.at;
  const title = make('button', {type: 'button', disabled: does.busy() || here,
                                className: 'step' + (step.on_way ? ' way' : ''),
                                textContent: titleOf(step)});
  title.dataset.step = String(step.step);
  title.dataset.here = String(here);
  title.setAttribute('aria-label', `Go back to ${titleOf(step)}`);
  title.addEventListener('click', () => does.go(step.step));
  const name = make('button', {type: 'button', className: 'act rename', textContent: 'Name',
                               disabled: does.busy()});
  name.setAttribute('aria-label', `Name the step ${titleOf(step)}`);
  name.addEventListener('click', () => { naming = step.step; again(); });
  const item = make('li', {}, make('div', {className: 'line'}, title, name),
                    make('span', {className: 'figures', textContent: figuresOf(state, step)}));
  if (here) item.setAttribute('aria-current', 'step');
  if (naming === step.step) item.append(namingForm(step, does, again));
  return item;
}

/** @param {BenchStep} one @param {BenchStep} other */
function comparisonOf(one, other) {
  const list = (/** @type {string[]} */ names) => names.join(', ') || 'none';
  const only = (/** @type {BenchStep} */ a, /** @type {BenchStep} */ b) =>
      list(a.has.filter(name => !b.has.includes(name)));
  const both = one.has.filter(name => other.has.includes(name));
  // On a narrow screen a row is a card, with the steps' names beside its cells.
  const cell = (/** @type {string} */ textContent, /** @type {BenchStep} */ step) => {
    const made = make('td', {textContent});
    made.dataset.heading = titleOf(step);
    return made;
  };
  const rowOf = (/** @type {string} */ what, /** @type {string} */ a, /** @type {string} */ b) =>
      make('tr', {}, make('th', {scope: 'row', textContent: what}), cell(a, one), cell(b, other));
  const head = make('tr', {}, make('td'), make('th', {scope: 'col', textContent: titleOf(one)}),
                    make('th', {scope: 'col', textContent: titleOf(other)}));
  return make('table', {}, make('thead', {}, head), make('tbody', {},
      rowOf('off by', one.mm.toFixed(1) + ' mm', other.mm.toFixed(1) + ' mm'),
      rowOf('chi\u00b2 per degree of freedom', one.chi2_per_dof.toFixed(2), other.chi2_per_dof.toFixed(2)),
      rowOf('effects it alone has', only(one, other), only(other, one)),
      rowOf('effects of both', list(both), list(both))));
}

/** @param {BenchState} state @param {HistoryActs} does */
function showComparison(state, does) {
  const box = by('compare');
  box.hidden = state.steps.length < 2;
  if (box.hidden) return;
  const last = state.steps.length - 1;
  if (!beside || Math.max(...beside) > last) beside = [state.steps[state.at].from, state.at];
  if (beside[0] === beside[1]) beside = [beside[0], beside[0] === last ? 0 : last];
  const [a, b] = beside;
  for (const [id, chosen] of /** @type {[string, number][]} */ ([['compare-one', a], ['compare-other', b]])) {
    selectBy(id).replaceChildren(...state.steps.map(step => make('option', {
      value: String(step.step), selected: step.step === chosen,
      textContent: `${step.step + 1}. ${titleOf(step)}`})));
  }
  const back = [a, b].map(k => {
    const button = make('button', {type: 'button', className: 'act', textContent: 'Go to it',
                                   disabled: does.busy() || k === state.at});
    button.dataset.here = String(k === state.at);
    button.setAttribute('aria-label', `Go to it: ${titleOf(state.steps[k])}`);
    button.addEventListener('click', () => does.go(k));
    return button;
  });
  const table = comparisonOf(state.steps[a], state.steps[b]);
  table.tBodies[0].append(make('tr', {}, make('td'), ...back.map(button => make('td', {}, button))));
  by('compared').replaceChildren(table);
}

/**
 * @param {BenchState} state
 * @param {HistoryActs} does
 */
export function showHistory(state, does) {
  const again = () => showHistory(state, does);
  by('steps').replaceChildren(...state.steps.map(step => itemOf(state, step, does, again)));
  by('steps').querySelector('input')?.focus();
  showComparison(state, does);
  const chosen = () => {
    beside = [Number(selectBy('compare-one').value), Number(selectBy('compare-other').value)];
    showComparison(state, does);
  };
  selectBy('compare-one').onchange = chosen;
  selectBy('compare-other').onchange = chosen;
}
