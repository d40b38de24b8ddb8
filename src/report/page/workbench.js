// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The workbench: what the program shows, and what is asked of it.
//
//   status (events) --> state, when its version is another --> verdict, cards, map, error, steps
//   pointing, typing --> preview                 pressing --> step, of the version that is shown
import {ask, follow, tell} from './bench_api.js';
import {showCandidates, showOn} from './bench_cards.js';
import {showHistory} from './bench_history.js';
import * as legs from './bench_legs.js';
import * as look from './bench_look.js';
import * as noise from './bench_noise.js';
import {beginOwn} from './bench_own.js';
import {showState} from './bench_view.js';
import {buttonBy, by, messageOf, within} from './dom.js';
import {followWidth} from './figure.js';
import {notice} from './notice.js';

/** @type {BenchState | null} */
let state = null;
let version = 0;
let busy = true;
let stopping = false;  // somebody asked for it
/** @type {number[]} */
let onward = [];  // steps that were undone

/** @param {string} [text] */
function fail(text) {
  by('failed').textContent = text || '';
  by('failed').hidden = !text;
}

/** @param {object} what */
async function step(what) {
  try {
    fail('');
    setBusy(true);
    await tell('step', {version, ...what});
  } catch (error) {
    fail(messageOf(error));
    setBusy(false);
  }
}

/** @type {import('./bench_cards.js').Acts} */
const does = {
  busy: () => busy,
  look: look.look, lookOn: look.lookOn, leave: look.leave, pin: look.pinCard, pinOn: look.pinOn,
  add: card => { onward = []; step({do: 'add', finding: card.finding}); },
  explain: asked => tell('explain', {version, ...asked}),
  remove: one => { onward = []; step({do: 'remove', effect: one.effect}); }
};

/** @param {number} to */
function go(to) {
  onward = [];
  step({do: 'go', step: to});
}

/** @type {import('./bench_history.js').HistoryActs} */
const past = {busy: () => busy, go, name: (at, label) => { step({do: 'name', step: at, label}); }};

/** @param {boolean} now */
function setBusy(now) {
  busy = now;
  /** @type {NodeListOf<HTMLButtonElement>} */
  const buttons = document.querySelectorAll('.act, .step, #add, #own-add');
  for (const button of buttons) {
    button.disabled = busy || button.dataset.here === 'true' || button.dataset.unread === 'true';
  }
  buttonBy('undo').disabled = busy || !state || state.at === 0;
  buttonBy('redo').disabled = busy || !onward.length;
  legs.setBusy(busy);
  document.documentElement.dataset.busy = String(busy);
}

/** @param {BenchState} state */
function showAll(state) {
  showState(state);
  showHistory(state, past);
  showOn(by('on'), state, does);
  showCandidates(by('parts'), state, does);
  setBusy(busy);
}

/** @param {number} to version */
async function renew(to) {
  const first = !state;
  /** @type {BenchState} */
  const next = await ask('state');
  state = next;
  version = to;
  showAll(next);
  const chosen = legs.renew(next, version);
  if (first) {
    beginOwn(next, {look: look.pinOwn, clear: look.clear, add: what => { onward = []; step({do: 'add', ...what}); }});
    performance.mark('first-picture');
  }
  await Promise.all([chosen, look.renew(next, version), noise.renew(next, version)]);
  document.documentElement.dataset.at = String(next.at);
  document.documentElement.dataset.steps = String(next.steps.length);
}

let renewing = Promise.resolve();
/** @param {BenchStatus} status */
function onStatus(status) {
  if (status.busy) {
    const step = status.step && `${status.step}: `;
    within(by('doing'), 'span').textContent = step + [status.note, status.doing].filter(Boolean).join(' ');
    by('stop').hidden = !status.stops;
    by('doing').hidden = false;
  }
  if (status.failed) fail(status.failed);
  renewing = renewing.then(async () => {
    if (status.version !== version && status.version > 0) await renew(status.version);
    setBusy(status.busy);
    if (stopping && !status.busy) {
      stopping = false;
      if (!status.failed) fail('Stopped: all is as it was before that step.');
    }
    by('doing').hidden = !status.busy;  // not before the whole screen is that of the state
  }).catch(error => fail(messageOf(error)));
}

by('stop').addEventListener('click', () => {
  by('stop').hidden = true;
  stopping = true;
  tell('stop', {}).catch(error => fail(messageOf(error)));
});
by('undo').addEventListener('click', () => {
  if (!state) return;
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
  const asked = look.request();
  if (!asked) return;
  const {finding, values, effect} = asked;
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
