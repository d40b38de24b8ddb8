// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The workbench's cards: the effects that the model has, and those that it could have, by part and
// by what each would save. Look-alikes are stacked in one card.
import {explainButton} from './bench_explain.js';
import {make, within} from './dom.js';

const SHOWN = 4;  // of a part, before "more": of those that are more than chance
/** @type {Set<string>} */
const open = new Set();  // parts whose cards are all shown

/** @typedef {Card & {stack?: Card[]}} Stacked a card with those that look like it */
/**
 * What pointing, focusing and pressing do to a card.
 * @typedef {object} CardActs
 * @property {() => void} look
 * @property {() => void} leave
 * @property {() => void} pin
 */
/**
 * The same for all cards.
 * @typedef {object} Acts
 * @property {() => boolean} busy
 * @property {(card: Card) => void} look
 * @property {(one: OnCard) => void} lookOn
 * @property {() => void} leave
 * @property {(card: Card) => void} pin
 * @property {(one: OnCard) => void} pinOn
 * @property {(asked: object) => Promise<ExplainReply>} explain
 * @property {(card: Card) => void} add
 * @property {(one: OnCard) => void} remove
 */

/** @param {number} mm */
function saving(mm) {
  const size = Math.abs(mm).toFixed(Math.abs(mm) < 10 ? 1 : 0);
  return (Number(size) === 0 ? '' : mm > 0 ? '\u2212' : '+') + size + ' mm';
}

/** @param {string} name @param {HTMLElement[]} more @param {CardActs} does */
function card(name, more, does) {
  const title = make('button', {type: 'button', className: 'name', textContent: name});
  const item = make('li', {className: 'card'}, make('div', {className: 'line'}, title, ...more));
  title.addEventListener('click', () => does.pin());
  title.addEventListener('focus', () => does.look());
  item.addEventListener('pointerenter', () => does.look());
  item.addEventListener('pointerleave', () => does.leave());
  return item;
}

/** @param {string} text @param {string} label @param {boolean} busy @param {() => void} run */
function act(text, label, busy, run) {
  const button = make('button', {type: 'button', className: 'act', textContent: text, disabled: busy});
  button.setAttribute('aria-label', label);
  button.addEventListener('click', run);
  return button;
}

const tag = (/** @type {string} */ text, /** @type {string} */ kind) =>
    make('span', {className: 'tag ' + kind, textContent: text});

/** @param {Card} one */
function tagOf(one) {
  if (one.status === 'missing') return tag('missing', 'bad');
  if (one.implausible) return tag('implausibly large', 'plain');
  if (one.status === 'negligible') return tag('too small to matter', 'plain');
  return one.significant ? tag('fits less well', 'plain') : tag('no more than chance', 'plain');
}

/**
 * Cards with those that look like them inside, each in one place.
 * @param {Card[]} cards
 * @returns {Stacked[]}
 */
function stacked(cards) {
  const inner = new Map();
  for (const one of cards) {
    for (const name of one.looks_like) if (!inner.has(name)) inner.set(name, one.id);
  }
  const byName = new Map(cards.map(one => [one.id, one]));
  return cards.filter(one => !inner.has(one.id) || one.looks_like.length)
      .map(one => ({...one, stack: one.looks_like.filter(name => inner.get(name) === one.id)
                                      .flatMap(name => byName.get(name) || [])}));
}

/** @param {HTMLElement} list @param {BenchState} state @param {Acts} does */
export function showOn(list, state, does) {
  list.replaceChildren(...state.on.map(one => {
    const item = card(one.name, [act('Remove', `Remove ${one.name}`, does.busy(), () => does.remove(one))], {
      look: () => does.lookOn(one), leave: does.leave, pin: () => does.pinOn(one)});
    item.dataset.effect = one.id;
    within(item, '.line').append(explainButton(item, one, () => does.explain({effect: one.effect})));
    item.append(make('p', {textContent: (state.provisional ? 'For now: ' : '') + one.words}),
                ...one.not_fitted.map(why => make('p', {className: 'failed', textContent: why})));
    return item;
  }));
  if (!state.on.length) list.append(make('li', {className: 'none', textContent: 'No effect yet.'}));
}

/** @param {Stacked} one @param {Acts} does @param {boolean} [rival] of the card it is stacked in */
function candidate(one, does, rival = false) {
  const item = card(one.name, [
    make('span', {className: 'save', textContent: saving(one.saves_mm) +
      (one.status === 'missing' && one.saves_mm < 0 ? ' alone' : '')}),
    act('Add', `Add ${one.name}`, does.busy(), () => does.add(one))], {
      look: () => does.look(one), leave: does.leave, pin: () => does.pin(one)});
  item.dataset.effect = one.id;
  item.dataset.finding = String(one.finding);
  within(item, '.line').append(explainButton(item, one, () => does.explain({finding: one.finding})));
  item.append(make('p', {}, rival ? '' : tagOf(one), ' ' + one.words));
  if (one.stack?.length) {
    item.append(make('p', {className: 'or', textContent: 'or, told apart by no data here:'}),
                make('ul', {className: 'cards'}, ...one.stack.map(inner => candidate(inner, does, true))));
  }
  return item;
}

/** @param {HTMLElement} box @param {BenchState} state @param {Acts} does */
export function showCandidates(box, state, does) {
  const cards = stacked(state.cards.filter(one => one.saves_mm > 0 || one.status === 'missing'));
  /** @type {Map<string, Stacked[]>} */
  const parts = new Map();
  for (const one of cards) parts.set(one.part, [...(parts.get(one.part) || []), one]);
  const again = () => showCandidates(box, state, does);
  box.replaceChildren(...[...parts].map(([part, all]) => {
    const telling = all.filter(one => one.significant || one.status === 'missing');
    const shown = open.has(part) ? all : telling.slice(0, SHOWN);
    const list = make('ul', {className: 'cards'}, ...shown.map(one => candidate(one, does)));
    const section = make('section', {className: 'part'}, make('h4', {textContent: part}), list);
    section.dataset.part = part;
    if (all.length > shown.length) {
      const count = all.length - shown.length;
      const text = count + (shown.length < telling.length ? ' more' : ' more, no more than chance');
      section.append(act(text, `${text}, ${part}`, false, () => { open.add(part); again(); }));
    }
    return section;
  }));
  if (!cards.length) {
    box.append(make('p', {textContent: 'None would make the error of held-out legs smaller.'}));
  }
}
