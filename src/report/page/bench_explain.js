// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// An effect explained within its card: what it does to a robot, with a drawing; what to look at, and
// what to drive to be sure.
import {make, messageOf} from './dom.js';

/** @type {Set<string>} */
const open = new Set();  // effects that are explained
/** @type {Map<string, ExplainReply>} */
const known = new Map();

/** @param {string} text */
const drawn = text => document.importNode(
    new DOMParser().parseFromString(text, 'image/svg+xml').documentElement, true);

/** @param {ExplainReply} reply */
function explanationOf(reply) {
  const {explanation, unusual, cause, remedy, drawing} = reply;
  const box = make('div', {className: 'explanation'});
  if (drawing) {
    box.append(make('figure', {}, drawn(drawing), make('figcaption', {
      textContent: 'Dashed: as the robot believes it to be. Blue: as it is. Orange: the cause.' +
                   (unusual ? ' Drawn as it mostly is; here it goes the other way.' : '')})));
  }
  const lines = [['What it does', explanation.does], ['What makes it', cause && cause + '.'],
                 ['Look at', explanation.look], ['Drive to be sure', explanation.drive],
                 ['What helps for good', remedy && remedy + '.']];
  const list = make('dl');
  for (const [what, text] of lines) {
    if (!text) continue;
    list.append(make('dt', {textContent: what}),
                make('dd', {textContent: text.slice(0, 1).toUpperCase() + text.slice(1)}));
  }
  box.append(list);
  return box;
}

/**
 * The button that explains an effect in its card; what was open stays open when a card is made anew.
 * @param {HTMLElement} item the card
 * @param {{id: string, name: string, words: string}} one
 * @param {() => Promise<ExplainReply>} ask
 */
export function explainButton(item, one, ask) {
  const button = make('button', {type: 'button', className: 'explain', textContent: 'Explain'});
  button.setAttribute('aria-label', `Explain ${one.name}`);
  const show = async () => {
    button.setAttribute('aria-expanded', String(open.has(one.id)));
    item.querySelector(':scope > .explanation')?.remove();
    if (!open.has(one.id)) return;
    try {
      const key = `${one.id}: ${one.words}`;  // by the sign that it has here
      const reply = known.get(key) || await ask();
      known.set(key, reply);
      if (!open.has(one.id) || item.querySelector(':scope > .explanation')) return;
      const alike = item.querySelector(':scope > .or');  // comes last
      item.insertBefore(explanationOf(reply), alike);
    } catch (error) {
      item.append(make('p', {className: 'explanation failed', textContent: messageOf(error)}));
    }
  };
  button.addEventListener('click', () => {
    if (!open.delete(one.id)) open.add(one.id);
    show();
  });
  show();
  return button;
}
