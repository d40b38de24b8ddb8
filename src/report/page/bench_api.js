// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the workbench's page asks of the program that serves it.

async function answered(reply) {
  const body = await reply.json().catch(() => ({}));
  if (!reply.ok) {
    throw Object.assign(new Error(body.error || `the program answered ${reply.status}`),
                        {status: reply.status});
  }
  return body;
}

export const ask = path => fetch(path).then(answered);

export const tell = (path, body) => fetch(path, {
  method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(body)
}).then(answered);

/// One question at a time. Of those that come meanwhile the last is asked next; the others end in
/// nothing: pointing across many cards must not keep the program busy with what nobody looks at.
export function lastOnly(path) {
  let under = false;
  let next = null;
  const run = async body => {
    under = true;
    try {
      return await tell(path, body);
    } finally {
      under = false;
      if (next) {
        const {body: waiting, done, failed} = next;
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

/// Calls `changed` with every status; `lost` when the program is gone, and again when it is back.
export function follow(changed, lost) {
  const events = new EventSource('events');
  events.onmessage = event => { lost(false); changed(JSON.parse(event.data)); };
  events.onerror = () => lost(true);
}
