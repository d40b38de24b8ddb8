// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The effect that is looked at: its curve and what it would leave, before any fit. Pointing looks
// for a while, pressing pins; sliders move its place, radius, threshold, and let go they snap to the
// best value near, where that is wanted; a duel sets it against another.
import {lastOnly, Refused} from './bench_api.js';
import {showFigure} from './bench_view.js';
import {by, make, messageOf, selectBy} from './dom.js';

/**
 * What is asked of the program about an effect: a finding (with values of its own), an effect of
 * one's own, or, of the model's, its place there.
 * @typedef {object} Question
 * @property {number} [finding]
 * @property {number[]} [values]
 * @property {number[]} [rivals]
 * @property {number | import('./bench_own.js').OwnEffect} [effect]
 */
/**
 * An effect that is looked at.
 * @typedef {object} Target
 * @property {string} name
 * @property {boolean} on the model has it
 * @property {Question} ask
 * @property {Card} [card]
 * @property {(text: string | null) => void} [fault] where to say that it cannot be read; null: it can
 */

/** @type {(body: object) => Promise<Preview | null>} */
const preview = lastOnly('preview');
/** @type {(body: object) => Promise<Preview | null>} */
const shown = lastOnly('shown');
/** @type {(body: object) => Promise<BestReply | null>} */
const best = lastOnly('best');

/** @type {BenchState} */
let state;
let version = 0;     // of the state
/** @type {Target | null} */
let pinned = null;   // what to go back to
let byDefault = false;  // nobody chose it
/** @type {Target | null} */
let looked = null;   // what is shown
let asked = 0;
let snaps = true;    // sliders, to the best value near
/** @type {object | null} */
let choice = null;   // of legs; null: all
/** @type {Map<string, Preview>} */
const answers = new Map();  // of this state

export const request = () => looked && {...looked.ask};

/** @param {Preview} reply @param {Target} target */
function saves(reply, target) {
  if (reply.leaves_mm === null) return '';
  const none = target.card?.status === 'missing' && reply.leaves_mm > reply.now_mm - 0.05;
  return `${none ? 'By itself it moves no leg\u2019s end nearer, yet it explains much: ' : ''}` +
         `${reply.now_mm.toFixed(1)} mm now, ${reply.leaves_mm.toFixed(1)} mm with it, as predicted; ` +
         `chi\u00b2 less by ${reply.chi2_less.toFixed(reply.chi2_less < 10 ? 1 : 0)} (${reply.dof} coefficient${reply.dof > 1 ? 's' : ''}), p ${reply.p}`;
}

/** @param {Preview} reply @param {Target} target */
function showWords(reply, target) {
  by('looked-name').textContent = reply.name;
  by('looked-words').textContent = reply.words;
  by('looked-saves').textContent = target.on ? '' : saves(reply, target);
  by('looked-why').textContent = [
    reply.formula, reply.does && `Acts on ${reply.does}.`, reply.cause && `Comes from ${reply.cause}.`,
    reply.remedy && `What helps for good: ${reply.remedy}.`].filter(Boolean).join(' \u00b7 ');
  by('add').hidden = target.on;
  // Sliders and the duel are of what is pinned.
  const passing = target.name !== pinned?.name;
  by('sliders').hidden = passing;
  by('duel-line').classList.toggle('passing', passing);
  const rival = reply.rivals[0];
  by('duel-words').textContent = !rival ? ''
      : (rival.leaves_mm === null ? '' : `${rival.name} would leave ${rival.leaves_mm.toFixed(1)} mm. `) +
        rival.verdict;
}

/**
 * Nothing is shown of an effect that cannot be read.
 * @param {string} name
 */
export function clear(name) {
  looked = null;
  ++asked;
  by('looked-name').textContent = name;
  for (const id of ['looked-words', 'looked-saves', 'looked-why', 'duel-words']) by(id).textContent = '';
  by('sliders').replaceChildren();
  by('duel-line').hidden = by('add').hidden = by('plot').hidden = true;
}

/** @param {Target} target */
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
    showWords(reply, target);
    showFigure('plot', reply.chart);
    target.fault?.(null);
    document.documentElement.dataset.looked = target.name;
  } catch (error) {
    if (mine !== asked || (error instanceof Refused && error.status === 409)) return;  // another state is on its way
    if (target.fault) {
      clear(target.name);
      target.fault(messageOf(error));
    } else by('looked-words').textContent = messageOf(error);
  }
}

/** @param {Target} target */
function showPinned(target) {
  pinned = target;
  byDefault = false;
  return show(target);
}

/**
 * @param {Target} target
 * @param {BenchParameter} one
 * @param {number} k of its parameters
 * @param {number[]} values
 */
function sliderOf(target, one, k, values) {
  const input = make('input', {type: 'range', min: String(one.least), max: String(one.most),
                               step: String(one.step / 20), value: String(values[k])});
  const text = () => `${+values[k].toPrecision(4)} ${one.unit}`.trim();
  const value = make('output', {textContent: text()});
  /// With the rival that it was set against meanwhile.
  const withValues = () => {
    const {ask, ...rest} = pinned || target;
    return {...rest, ask: {...ask, values: values.slice()}};
  };
  input.addEventListener('input', () => {
    values[k] = Number(input.value);
    value.textContent = text();
    showPinned(withValues());
  });
  input.addEventListener('change', async () => {
    if (!snaps) return;
    const reply = await best({version, finding: target.ask.finding, values, only: k}).catch(() => null);
    if (!reply) return;
    reply.values.forEach((at, j) => { values[j] = at; });
    showSliders(target, values);
    showPinned(withValues());
  });
  return make('label', {}, one.name + ' ', input, ' ', value);
}

/** @param {Target} target @param {number[]} values */
function showSliders(target, values) {
  const parameters = target.card?.parameters || [];
  const snap = make('input', {type: 'checkbox', checked: snaps});
  snap.addEventListener('change', () => { snaps = snap.checked; });
  by('sliders').replaceChildren(
      ...parameters.map((one, k) => sliderOf(target, one, k, values)),
      ...(parameters.length ? [make('label', {className: 'snap'}, snap, ' snap to the best fit nearby')] : []));
}

/** @param {string} label @param {Card[]} cards */
const groupOf = (label, cards) => make('optgroup', {label}, ...cards.map(one => make('option', {
  value: String(one.finding),
  textContent: one.saves_mm > 0 ? `${one.name} (\u2212${one.saves_mm.toFixed(1)} mm)` : one.name})));

/** @param {Card} [card] */
function showDuel(card) {
  const rivals = card ? state.cards.filter(one => one.id !== card.id) : [];
  const alike = card?.looks_like || [];
  const first = rivals.filter(one => alike.includes(one.id));
  const same = rivals.filter(one => !alike.includes(one.id) && one.part === card?.part);
  const rest = rivals.filter(one => !alike.includes(one.id) && one.part !== card?.part);
  const bySaving = (/** @type {Card} */ a, /** @type {Card} */ b) => b.saves_mm - a.saves_mm;
  by('duel').replaceChildren(
      make('option', {value: '', textContent: 'nothing'}),
      ...[{label: 'these recordings cannot tell it from', cards: first},
          {label: `of the same part (${card?.part})`, cards: same.sort(bySaving).slice(0, 20)},
          {label: 'of other parts', cards: rest.sort(bySaving).slice(0, 20)}]
          .filter(group => group.cards.length).map(group => groupOf(group.label, group.cards)));
  by('duel-line').hidden = !rivals.length;
}

/** @type {(card: Card) => Target} */
const ofCard = card => ({name: card.id, card, on: false, ask: {finding: card.finding}});
/** @type {(one: OnCard) => Target} */
const ofOn = one => ({name: one.id, on: true, ask: {effect: one.effect}});

/** @param {Target} target @param {boolean} [unasked] */
function pin(target, unasked = false) {
  pinned = target;
  byDefault = unasked;
  showSliders(target, (target.card?.parameters || []).map(one => one.value));
  showDuel(target.card);
  /** @type {NodeListOf<HTMLElement>} */
  const items = document.querySelectorAll('.card');
  for (const item of items) {
    item.classList.toggle('pinned', item.dataset.effect === target.name);
  }
  return show(target);
}

export const look = (/** @type {Card} */ card) => show(ofCard(card));
export const lookOn = (/** @type {OnCard} */ one) => show(ofOn(one));
export const pinCard = (/** @type {Card} */ card) => pin(ofCard(card));
export const pinOn = (/** @type {OnCard} */ one) => pin(ofOn(one));
/** @type {(effect: import('./bench_own.js').OwnEffect, fault: (text: string | null) => void) => Promise<void>} */
export const pinOwn = (effect, fault) =>
    pin({name: effect.name, on: false, ask: {effect}, fault});

/// Back to what is pinned.
export function leave() {
  if (pinned && looked !== pinned) show(pinned);
}

/**
 * Points of these legs alone.
 * @param {object | null} next choice
 */
export function choose(next) {
  choice = next;
  if (looked) show(looked);
}

export function begin() {
  by('duel').addEventListener('change', () => {
    if (!pinned) return;
    const rival = selectBy('duel').value;
    showPinned({...pinned, ask: {...pinned.ask, rivals: rival === '' ? [] : [Number(rival)]}});
  });
}

/**
 * Another model: what was looked at is pinned again where it still is there, else the best.
 * @param {BenchState} next
 * @param {number} its version
 */
export function renew(next, its) {
  state = next;
  version = its;
  answers.clear();
  const before = pinned;
  const on = state.on.find(one => one.id === before?.name);
  const card = state.cards.find(one => one.id === before?.name && !before.on);
  if (on) return pin(ofOn(on), byDefault);
  if (card && !byDefault) return pinCard(card);
  if (state.cards.length) {
    return pin(ofCard(state.cards.find(one => one.status === 'missing') || state.cards[0]), true);
  }
  if (state.on.length) return pin(ofOn(state.on[0]), true);
  return undefined;
}
