// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// An effect of the user's own: a channel and a formula, previewed as it is typed.
import {by, inputBy, make, selectBy} from './dom.js';

const WAIT = 150;  // ms after a key

/** @typedef {{name: string, channel: string, shape: string[]}} OwnEffect */

/** @returns {OwnEffect} */
const effect = () => ({
  name: inputBy('own-name').value.trim(), channel: selectBy('own-channel').value,
  shape: [inputBy('own-shape').value.trim()]});

/**
 * The formula so far, with each word that could go on from its last letters.
 * @param {string} text
 * @param {string[]} words
 */
function completions(text, words) {
  const last = /[A-Za-z_][A-Za-z_0-9]*$/.exec(text)?.[0] || '';
  const before = text.slice(0, text.length - last.length);
  return words.filter(word => word.startsWith(last) && word !== last).map(word => before + word);
}

/**
 * @param {BenchState} state
 * @param {{look: (effect: OwnEffect, fault: (text: string) => void) => void,
 *          add: (what: {effect: OwnEffect}) => void}} does
 */
export function beginOwn(state, does) {
  const words = [...state.variables, 'sin(', 'cos(', 'abs(', 'sign(', 'max(0, ', 'min(', 'exp(', 'sqrt('];
  by('own-channel').replaceChildren(...state.channels.map(one =>
      make('option', {value: one.name, textContent: one.name})));
  by('own-variables').textContent = state.variables.join(', ');
  const tellChannel = () => {
    const one = state.channels.find(channel => channel.name === selectBy('own-channel').value);
    by('own-does').textContent = one ? one.words + (one.unit ? ` [${one.unit}]` : '') : '';
  };
  const fault = (/** @type {string} */ text) => { by('own-fault').textContent = text; };
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let waiting;
  const changed = () => {
    tellChannel();
    by('own-words').replaceChildren(...completions(inputBy('own-shape').value, words).slice(0, 12)
        .map(value => make('option', {value})));
    clearTimeout(waiting);
    fault('');
    if (inputBy('own-shape').value.trim()) waiting = setTimeout(() => does.look(effect(), fault), WAIT);
  };
  for (const id of ['own-name', 'own-channel', 'own-shape']) by(id).addEventListener('input', changed);
  by('own-form').addEventListener('submit', event => {
    event.preventDefault();
    does.add({effect: effect()});
  });
  changed();
}
