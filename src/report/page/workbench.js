// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The workbench: what the program shows, and what is asked of it.
//
//   status (events) --> state, when its version is another --> verdict, cards, map, error, steps
//   pointing, typing --> preview                 pressing --> step, of the version that is shown
import {ask, follow, tell} from './bench_api.js';
import {showCandidates, showOn} from './bench_cards.js';
import * as legs from './bench_legs.js';
import * as look from './bench_look.js';
import * as noise from './bench_noise.js';
import {beginOwn} from './bench_own.js';
import {showState} from './bench_view.js';
import {followWidth} from './figure.js';
import {notice} from './notice.js';

const by = id => document.getElementById(id);
let state = null;
let version = 0;
let busy = true;
let onward = [];  // steps that were undone

function fail(text) {
  by('failed').textContent = text || '';
  by('failed').hidden = !text;
}

async function step(what) {
  try {
    fail('');
    setBusy(true);
    await tell('step', {version, ...what});
  } catch (error) {
    fail(error.message);
    setBusy(false);
  }
}

const does = {
  busy: () => busy,
  look: look.look, lookOn: look.lookOn, leave: look.leave, pin: look.pinCard, pinOn: look.pinOn,
  add: card => { onward = []; step({do: 'add', finding: card.finding}); },
  remove: one => { onward = []; step({do: 'remove', effect: one.effect}); }
};

function go(to) {
  onward = [];
  step({do: 'go', step: to});
}

function setBusy(now) {
  busy = now;
  for (const button of document.querySelectorAll('.act, .step, #add, #own-add')) {
    button.disabled = busy || button.parentElement.getAttribute('aria-current') === 'step';
  }
  by('undo').disabled = busy || !state || state.at === 0;
  by('redo').disabled = busy || !onward.length;
  legs.setBusy(busy);
  document.documentElement.dataset.busy = String(busy);
}

function showAll() {
  showState(state, busy, go);
  showOn(by('on'), state, does);
  showCandidates(by('parts'), state, does);
  setBusy(busy);
}

async function renew(to) {
  const next = await ask('state');
  const first = !state;
  state = next;
  version = to;
  showAll();
  const chosen = legs.renew(state, version);
  if (first) {
    beginOwn(state, {look: look.pinOwn, add: what => { onward = []; step({do: 'add', ...what}); }});
    performance.mark('first-picture');
  }
  await Promise.all([chosen, look.renew(state, version), noise.renew(state, version)]);
  document.documentElement.dataset.at = String(state.at);
  document.documentElement.dataset.steps = String(state.steps.length);
}

let renewing = Promise.resolve();
function onStatus(status) {
  by('doing').hidden = !status.busy;
  by('doing').querySelector('span').textContent = [status.note, status.doing].filter(Boolean).join(' ');
  if (status.failed) fail(status.failed);
  renewing = renewing.then(async () => {
    if (status.version !== version && status.version > 0) await renew(status.version);
    setBusy(status.busy);
  }).catch(error => fail(error.message));
}

by('undo').addEventListener('click', () => {
  const back = state.steps[state.at].from;
  onward.push(state.at);
  step({do: 'go', step: back});
});
by('redo').addEventListener('click', () => {
  const to = onward.pop();
  if (to !== undefined) step({do: 'go', step: to});
});
by('add').addEventListener('click', () => {
  onward = [];
  const {finding, values, effect} = look.request();
  step({do: 'add', ...(effect ? {effect} : {finding, ...(values ? {values} : {})})});
});
look.begin();
legs.begin(look.choose, what => { onward = []; step(what); });
noise.begin();
followWidth();
follow(onStatus, gone => {
  if (gone) fail('The program does not answer. Started again with the same command, it goes on where it ended, at a new address.');
});
/// For programs that look at the page.
window.trussmap = {notice, state: () => state};
