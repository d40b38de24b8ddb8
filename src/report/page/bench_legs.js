// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Legs that are chosen, on the map or in time: every view shows them alone, and a fit can be made
// without them.
import {lastOnly, Refused} from './bench_api.js';
import {showViews} from './bench_view.js';
import {addBrush} from './brush.js';
import {buttonBy, by, inputBy, messageOf} from './dom.js';
import {charts} from './figure.js';

/** @typedef {{area: number[]} | {time: number[]}} Choice of legs: x, y, x, y on the map; from, to */

/** @type {(body: object) => Promise<Selection | null>} */
const legs = lastOnly('legs');

/** @type {BenchState} */
let state;
let version = 0;
/** @type {Choice | null} */
let choice = null;   // null: all
/** @type {Selection | null} */
let views = null;    // of the choice
let busy = true;
let leaving = false;  // what is chosen is being excluded
/** @type {(choice: Choice | null) => void} */
let chosenElse = () => {};
/** @type {Set<HTMLElement>} */
const listening = new Set();  // figures

const onMap = () => by('choose-area').getAttribute('aria-pressed') === 'true';

function showButtons() {
  const now = views || state;
  by('legs-words').textContent = now.legs.words;
  buttonBy('exclude').disabled = busy || !choice || now.legs.free === 0;
  by('exclude').textContent = choice && now.legs.free ? `Exclude ${now.legs.free} and refit` : 'Exclude and refit';
  buttonBy('all-legs').disabled = !choice;
  by('include').hidden = state.legs.excluded === 0;
  buttonBy('include').disabled = busy;
}

function showAll() {
  showViews(views || state);
  listen();
  showButtons();
}

/**
 * A choice, of what the program has now; null: of all.
 * @param {Choice | null} next
 */
async function choose(next) {
  by('legs-fault').textContent = '';
  try {
    const reply = next && await legs({version, choice: next});
    if (next && !reply) return;  // another came meanwhile
    [choice, views] = [next, reply];
  } catch (error) {
    if (error instanceof Refused && error.status === 409) return;  // another state is on its way
    const why = messageOf(error);
    by('legs-fault').textContent = why.slice(0, 1).toUpperCase() + why.slice(1) + '.';
    [choice, views] = [null, null];
  }
  showAll();
  document.documentElement.dataset.chosen = views ? String(views.legs.shown) : '';
  chosenElse(choice);
}

/// Every chart of legs, once.
function listen() {
  for (const entry of charts) {
    const strip = entry.figure.classList.contains('strip');
    if (listening.has(entry.figure) || !(strip || entry.figure.id === 'map')) continue;
    listening.add(entry.figure);
    addBrush(entry, strip, strip ? () => true : onMap, ([x, y, x2, y2]) =>
        choose(strip ? {time: [x, x2]} : {area: [x, y, x2, y2]}));
  }
}

/**
 * @param {(choice: Choice | null) => void} changed is told of every choice
 * @param {(what: object) => void} step makes one
 */
export function begin(changed, step) {
  chosenElse = changed;
  by('choose-area').addEventListener('click', () => {
    const on = !onMap();
    by('choose-area').setAttribute('aria-pressed', String(on));
    by('map').classList.toggle('brushing', on);
  });
  by('choose-time').addEventListener('submit', event => {
    event.preventDefault();
    choose({time: [Number(inputBy('time-from').value), Number(inputBy('time-to').value)]});
  });
  by('all-legs').addEventListener('click', () => choose(null));
  by('exclude').addEventListener('click', () => {
    leaving = true;
    step({do: 'exclude', choice});
  });
  by('include').addEventListener('click', () => step({do: 'include'}));
}

/** @param {boolean} now */
export function setBusy(now) {
  busy = now;
  if (!busy) leaving = false;
  if (state) showButtons();
}

/**
 * Another model: the same choice of it.
 * @param {BenchState} next
 * @param {number} its version
 */
export function renew(next, its) {
  state = next;
  version = its;
  views = null;
  if (leaving) {
    leaving = false;
    choice = null;
    document.documentElement.dataset.chosen = '';
    chosenElse(null);
  }
  showAll();
  return choice ? choose(choice) : undefined;
}
