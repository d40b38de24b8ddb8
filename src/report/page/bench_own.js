// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// An effect of the user's own: a channel and a formula, previewed as it is typed.
import {make} from './figure.js';

const WAIT = 150;  // ms after a key
const by = id => document.getElementById(id);

const effect = () => ({
  name: by('own-name').value.trim(), channel: by('own-channel').value,
  shape: [by('own-shape').value.trim()]});

/// The formula so far, with each word that could go on from its last letters.
function completions(text, words) {
  const last = /[A-Za-z_][A-Za-z_0-9]*$/.exec(text)?.[0] || '';
  const before = text.slice(0, text.length - last.length);
  return words.filter(word => word.startsWith(last) && word !== last).map(word => before + word);
}

export function beginOwn(state, does) {
  const words = [...state.variables, 'sin(', 'cos(', 'abs(', 'sign(', 'max(0, ', 'min(', 'exp(', 'sqrt('];
  by('own-channel').replaceChildren(...state.channels.map(one =>
      make('option', {value: one.name, textContent: one.name})));
  by('own-variables').textContent = state.variables.join(', ');
  const tellChannel = () => {
    const one = state.channels.find(channel => channel.name === by('own-channel').value);
    by('own-does').textContent = one ? one.words + (one.unit ? ` [${one.unit}]` : '') : '';
  };
  const fault = text => { by('own-fault').textContent = text; };
  let waiting = 0;
  const changed = () => {
    tellChannel();
    by('own-words').replaceChildren(...completions(by('own-shape').value, words).slice(0, 12)
        .map(value => make('option', {value})));
    clearTimeout(waiting);
    fault('');
    if (by('own-shape').value.trim()) waiting = setTimeout(() => does.look(effect(), fault), WAIT);
  };
  for (const id of ['own-name', 'own-channel', 'own-shape']) by(id).addEventListener('input', changed);
  by('own-form').addEventListener('submit', event => {
    event.preventDefault();
    does.add({effect: effect()});
  });
  changed();
}
