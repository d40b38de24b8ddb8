// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The effect that is looked at: its curve and what it would leave, before any fit. Pointing looks
// for a while, pressing pins; sliders move its place, radius, threshold, and let go they snap to the
// best value near; a duel sets it against another.
import {lastOnly} from './bench_api.js';
import {showFigure} from './bench_view.js';
import {make} from './figure.js';

const by = id => document.getElementById(id);
const preview = lastOnly('preview');
const shown = lastOnly('shown');
const best = lastOnly('best');

let state = null;
let version = 0;     // of the state
let pinned = null;   // what to go back to
let looked = null;   // what is shown
let asked = 0;
let choice = null;   // of legs; null: all
const answers = new Map();  // of this state

export const request = () => looked && {...looked.ask};

function saves(reply) {
  if (reply.leaves_mm === null) return '';
  if (state.on.length && looked.card?.status === 'missing' && reply.leaves_mm > reply.now_mm) {
    return 'How much it saves shows when it is fitted: what the model has already changes with it.';
  }
  return `${reply.now_mm.toFixed(1)} mm now, ${reply.leaves_mm.toFixed(1)} mm with it, as predicted; ` +
         `\u03c7\u00b2 less by ${reply.chi2_less.toFixed(reply.chi2_less < 10 ? 1 : 0)} (${reply.dof} coefficient${reply.dof > 1 ? 's' : ''}), p ${reply.p}`;
}

function showWords(reply) {
  by('looked-name').textContent = reply.name;
  by('looked-words').textContent = reply.words;
  by('looked-saves').textContent = looked.on ? '' : saves(reply);
  by('looked-why').textContent = [
    reply.formula, reply.does && `Acts on ${reply.does}.`, reply.cause && `Comes from ${reply.cause}.`,
    reply.remedy && `What helps for good: ${reply.remedy}.`].filter(Boolean).join(' \u00b7 ');
  by('add').hidden = looked.on;
  // Sliders and the duel are of what is pinned.
  const passing = looked.name !== pinned?.name;
  by('sliders').hidden = passing;
  by('duel-line').classList.toggle('passing', passing);
  const rival = reply.rivals[0];
  by('duel-words').textContent = !rival ? ''
      : (rival.leaves_mm === null ? '' : `${rival.name} would leave ${rival.leaves_mm.toFixed(1)} mm. `) +
        rival.verdict;
}

async function show(target) {
  const mine = ++asked;
  looked = target;
  const ask = choice ? {...target.ask, choice} : target.ask;
  const key = JSON.stringify([target.on, ask]);
  try {
    const known = answers.get(key);
    const reply = known || await (target.on ? shown : preview)({version, ...ask});
    if (!reply || mine !== asked) return;
    answers.set(key, reply);
    showWords(reply);
    showFigure('plot', reply.chart);
    target.fault?.('');
    document.documentElement.dataset.looked = target.name;
  } catch (error) {
    if (mine !== asked || error.status === 409) return;  // another state is on its way
    if (target.fault) target.fault(error.message);
    else by('looked-words').textContent = error.message;
  }
}

function showPinned(target) {
  pinned = target;
  return show(target);
}

function sliderOf(one, k, values) {
  const input = make('input', {type: 'range', min: one.least, max: one.most, step: one.step / 20,
                               value: values[k]});
  const value = make('output', {textContent: String(+values[k].toPrecision(4))});
  input.addEventListener('input', () => {
    values[k] = Number(input.value);
    value.textContent = String(+values[k].toPrecision(4));
    showPinned({...looked, ask: {...looked.ask, values: values.slice()}});
  });
  input.addEventListener('change', async () => {
    const reply = await best({version, finding: looked.ask.finding, values}).catch(() => null);
    if (!reply) return;
    reply.values.forEach((at, j) => { values[j] = at; });
    showSliders(looked.card, values);
    showPinned({...looked, ask: {...looked.ask, values: values.slice()}});
  });
  return make('label', {}, one.name + ' ', input, ' ', value);
}

function showSliders(card, values) {
  by('sliders').replaceChildren(...(card?.parameters || []).map((one, k) => sliderOf(one, k, values)));
}

function showDuel(card) {
  const rivals = card ? state.cards.filter(one => one.id !== card.id) : [];
  const first = rivals.filter(one => card.looks_like.includes(one.id));
  const rest = rivals.filter(one => !card.looks_like.includes(one.id)).slice(0, 40);
  by('duel').replaceChildren(
      make('option', {value: '', textContent: 'nothing'}),
      ...[...first, ...rest].map(one => make('option', {value: one.finding, textContent: one.name})));
  by('duel-line').hidden = !rivals.length;
}

const ofCard = card => ({name: card.id, card, on: false, ask: {finding: card.finding}});
const ofOn = one => ({name: one.id, on: true, ask: {effect: one.effect}});

function pin(target) {
  pinned = target;
  showSliders(target.card, (target.card?.parameters || []).map(one => one.value));
  showDuel(target.card);
  for (const item of document.querySelectorAll('.card')) {
    item.classList.toggle('pinned', item.dataset.effect === target.name);
  }
  return show(target);
}

export const look = card => show(ofCard(card));
export const lookOn = one => show(ofOn(one));
export const pinCard = card => pin(ofCard(card));
export const pinOn = one => pin(ofOn(one));
export const pinOwn = (effect, fault) =>
    pin({name: effect.name, on: false, ask: {effect}, fault});

/// Back to what is pinned.
export function leave() {
  if (pinned && looked !== pinned) show(pinned);
}

/// Points of these legs alone.
export function choose(next) {
  choice = next;
  if (looked) show(looked);
}

export function begin() {
  by('duel').addEventListener('change', () => {
    const rivals = by('duel').value === '' ? [] : [Number(by('duel').value)];
    showPinned({...looked, ask: {...looked.ask, rivals}});
  });
}

/// Another model: what was looked at is pinned again where it still is there, else the best.
export function renew(next, its) {
  state = next;
  version = its;
  answers.clear();
  const on = state.on.find(one => pinned && one.id === pinned.name);
  const card = state.cards.find(one => pinned && one.id === pinned.name && !pinned.on);
  if (on) return pinOn(on);
  if (card) return pinCard(card);
  if (state.cards.length) return pinCard(state.cards.find(one => one.status === 'missing') || state.cards[0]);
  if (state.on.length) return pinOn(state.on[0]);
  return undefined;
}
