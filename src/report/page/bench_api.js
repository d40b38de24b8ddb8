// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the workbench's page asks of the program that serves it.

/// An answer that is none. `status`: 409, where the page shows another state than the program has.
export class Refused extends Error {
  /** @param {string} why @param {number} status */
  constructor(why, status) {
    super(why);
    this.status = status;
  }
}

/** @param {Response} reply */
async function answered(reply) {
  const body = await reply.json().catch(() => ({}));
  if (!reply.ok) {
    throw new Refused(body.error || `the program answered ${reply.status}`, reply.status);
  }
  return body;
}

/** @type {(path: string) => Promise<any>} */
export const ask = path => fetch(path).then(answered);

/** @type {(path: string, body: object) => Promise<any>} */
export const tell = (path, body) => fetch(path, {
  method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(body)
}).then(answered);

/**
 * One question at a time. Of those that come meanwhile the last is asked next; the others end in
 * nothing: pointing across many cards must not keep the program busy with what nobody looks at.
 * @template Reply
 * @param {string} path
 * @returns {(body: object) => Promise<Reply | null>}
 */
export function lastOnly(path) {
  /** @typedef {{body: object, done: (reply: Reply | null) => void, failed: (why: unknown) => void}} Waiting */
  let under = false;
  /** @type {Waiting | null} */
  let next = null;
  /** @param {object} body @returns {Promise<Reply>} */
  const run = async body => {
    under = true;
    try {
      return await tell(path, body);
    } finally {
      under = false;
      if (next) {
        const {body: waiting, done, failed} = /** @type {Waiting} */ (next);
        next = null;
        run(waiting).then(done, failed);
      }
    }
  };
  return body => {
    if (!under) return run(body);
    next?.done(null);
    return new Promise((done, failed) => { next = {body, done, failed}; });
  };
}

/**
 * Calls `changed` with every status; `lost` when the program is gone, and again when it is back.
 * @param {(status: BenchStatus) => void} changed
 * @param {(gone: boolean) => void} lost
 */
export function follow(changed, lost) {
  const events = new EventSource('events');
  events.onmessage = event => { lost(false); changed(JSON.parse(event.data)); };
  events.onerror = () => lost(true);
}
