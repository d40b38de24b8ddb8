// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The noise by a handle: which alarms would stay were it larger than it is believed to be.
import {lastOnly} from './bench_api.js';
import {by, inputBy} from './dom.js';

/** @type {(body: object) => Promise<NoiseReply | null>} */
const noise = lastOnly('noise');
/** @type {BenchState} */
let state;
let version = 0;

/** @param {number} factor @param {NoiseReply} reply */
function words(factor, reply) {
  const alarms = state.cards.filter(one => one.significant);
  const lost = alarms.filter(one => reply.p[one.finding] >= reply.level);
  /** @type {NodeListOf<HTMLElement>} */
  const items = document.querySelectorAll('#parts .card');
  for (const item of items) {
    item.classList.toggle('swallowed', reply.p[Number(item.dataset.finding)] >= reply.level && factor > 1);
  }
  const missing = alarms.filter(one => one.status === 'missing');
  const gone = missing.filter(one => lost.includes(one)).map(one => one.name);
  if (!alarms.length) return 'No effect is more than chance as it is.';
  return `${alarms.length - lost.length} of ${alarms.length} effects would still be more than chance` +
      (!missing.length ? '.' : gone.length ? `; so much noise would swallow ${gone.join(' and ')}.`
                                           : `; ${missing.map(one => one.name).join(' and ')} would still be seen.`);
}

async function moved() {
  const factor = 2 ** Number(inputBy('handle').value);
  by('handle-factor').textContent = factor.toPrecision(2);
  const reply = await noise({version, factor}).catch(() => null);  // another state is on its way
  if (reply) by('handle-words').textContent = words(factor, reply);
}

export function begin() {
  by('handle').addEventListener('input', moved);
}

/** @param {BenchState} next @param {number} its version */
export function renew(next, its) {
  state = next;
  version = its;
  inputBy('handle').value = '0';
  return moved();
}
