// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the workbench's page asks of the program that serves it.

async function answered(reply) {
  const body = await reply.json().catch(() => ({}));
  if (!reply.ok) throw new Error(body.error || `the program answered ${reply.status}`);
  return body;
}

export const ask = path => fetch(path).then(answered);

export const tell = (path, body, signal) => fetch(path, {
  method: 'POST', signal, headers: {'Content-Type': 'application/json'}, body: JSON.stringify(body)
}).then(answered);

/// Only the last of several questions is answered; the others end in nothing.
export function lastOnly(path) {
  let under = null;
  return async body => {
    under?.abort();
    const mine = under = new AbortController();
    try {
      const reply = await tell(path, body, mine.signal);
      return under === mine ? reply : null;
    } catch (error) {
      if (error.name === 'AbortError' || under !== mine) return null;
      throw error;
    }
  };
}

/// Calls `changed` with every status; `lost` when the program is gone, and again when it is back.
export function follow(changed, lost) {
  const events = new EventSource('events');
  events.onmessage = event => { lost(false); changed(JSON.parse(event.data)); };
  events.onerror = () => lost(true);
}
