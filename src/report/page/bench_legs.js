// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Legs that are chosen, on the map or in time: every view shows them alone, and a fit can be made
// without them.
import {lastOnly} from './bench_api.js';
import {showViews} from './bench_view.js';
import {addBrush} from './brush.js';
import {charts} from './figure.js';

const by = id => document.getElementById(id);
const legs = lastOnly('legs');

let state = null;
let version = 0;
let choice = null;   // {area} or {time}; null: all
let views = null;    // of the choice
let busy = true;
let chosenElse = () => {};
const listening = new Set();  // figures

const onMap = () => by('choose-area').getAttribute('aria-pressed') === 'true';

function showButtons() {
  const now = views || state;
  by('legs-words').textContent = now.legs.words;
  by('exclude').disabled = busy || !choice || now.legs.free === 0;
  by('exclude').textContent = choice && now.legs.free ? `Exclude ${now.legs.free} and refit` : 'Exclude and refit';
  by('all-legs').disabled = !choice;
  by('include').hidden = state.legs.excluded === 0;
  by('include').disabled = busy;
}

function showAll() {
  showViews(views || state);
  listen();
  showButtons();
}

/// A choice, of what the program has now; null: of all.
async function choose(next) {
  by('legs-fault').textContent = '';
  try {
    const reply = next && await legs({version, choice: next});
    if (next && !reply) return;  // another came meanwhile
    [choice, views] = [next, reply];
  } catch (error) {
    if (error.status === 409) return;  // another state is on its way
    by('legs-fault').textContent = error.message[0].toUpperCase() + error.message.slice(1) + '.';
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

/// `changed` is told of every choice; `step` makes one.
export function begin(changed, step) {
  chosenElse = changed;
  by('choose-area').addEventListener('click', () => {
    const on = !onMap();
    by('choose-area').setAttribute('aria-pressed', String(on));
    by('map').classList.toggle('brushing', on);
  });
  by('choose-time').addEventListener('submit', event => {
    event.preventDefault();
    choose({time: [Number(by('time-from').value), Number(by('time-to').value)]});
  });
  by('all-legs').addEventListener('click', () => choose(null));
  by('exclude').addEventListener('click', () => {
    const without = choice;
    choose(null);
    step({do: 'exclude', choice: without});
  });
  by('include').addEventListener('click', () => step({do: 'include'}));
}

export function setBusy(now) {
  busy = now;
  if (state) showButtons();
}

/// Another model: the same choice of it.
export function renew(next, its) {
  state = next;
  version = its;
  views = null;
  showAll();
  return choice ? choose(choice) : undefined;
}
