// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// An effect of the user's own: a channel and a formula per coefficient, previewed as it is typed.
// What cannot be read is shown nowhere and cannot be added.
import {buttonBy, by, inputBy, make, selectBy} from './dom.js';

const WAIT = 150;  // ms after a key
const MOST = 8;    // terms

/** @typedef {{name: string, channel: string, shape: string[]}} OwnEffect */

/** @returns {HTMLInputElement[]} */
const terms = () => [...by('own-terms').querySelectorAll('input')];

/** @returns {OwnEffect} */
const effect = () => ({
  name: inputBy('own-name').value.trim(), channel: selectBy('own-channel').value,
  shape: terms().map(one => one.value.trim()).filter(Boolean)});

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

/** @param {BenchVariable} one */
const inWords = ({name, unit}) => unit ? `${name} [${unit}]` : name;

/**
 * @param {BenchState} state
 * @param {{look: (effect: OwnEffect, fault: (text: string | null) => void) => void,
 *          clear: (name: string) => void, add: (what: {effect: OwnEffect}) => void}} does
 */
export function beginOwn(state, does) {
  const words = [...state.variables.map(one => one.name),
                 'sin(', 'cos(', 'abs(', 'sign(', 'max(0, ', 'min(', 'exp(', 'sqrt('];
  by('own-channel').replaceChildren(...state.channels.map(one =>
      make('option', {value: one.name, textContent: one.name})));
  by('own-variables').textContent = state.variables.map(inWords).join(', ');
  const tellChannel = () => {
    const one = state.channels.find(channel => channel.name === selectBy('own-channel').value);
    by('own-does').textContent = one ? one.words + (one.unit ? ` [${one.unit}]` : '') : '';
  };
  /** @param {boolean} now */
  const readable = now => {
    buttonBy('own-add').dataset.unread = String(!now);
    buttonBy('own-add').disabled = !now || document.documentElement.dataset.busy === 'true';
  };
  const fault = (/** @type {string | null} */ text) => {
    by('own-fault').textContent = text || '';
    readable(text === null);
  };
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let waiting;
  const changed = () => {
    tellChannel();
    clearTimeout(waiting);
    fault('');
    const now = effect();
    if (now.shape.length) waiting = setTimeout(() => does.look(now, fault), WAIT);
    else if (by('own-terms').contains(document.activeElement)) does.clear(now.name);
  };
  const another = () => {
    const input = make('input', {maxLength: 200, autocomplete: 'off', spellcheck: false,
                                 placeholder: terms().length ? 'cos(heading)' : 'max(0, speed-0.5)'});
    input.setAttribute('list', 'own-words');
    input.setAttribute('aria-describedby', 'own-fault');
    input.addEventListener('input', () => {
      by('own-words').replaceChildren(...completions(input.value, words).slice(0, 12)
          .map(value => make('option', {value})));
      changed();
    });
    by('own-terms').append(make('label', {}, terms().length ? 'and with ' : 'Goes with ', input));
    by('own-term').hidden = terms().length >= MOST;
    return input;
  };
  by('own-term').addEventListener('click', () => another().focus());
  for (const id of ['own-name', 'own-channel']) by(id).addEventListener('input', changed);
  by('own-form').addEventListener('submit', event => {
    event.preventDefault();
    if (!buttonBy('own-add').disabled) does.add({effect: effect()});
  });
  another().id = 'own-shape';
  changed();
}
