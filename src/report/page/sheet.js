// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A page on paper: what is first, on one sheet of A4. Everything is made smaller, as far as it can
// still be read; sections that then find no room are named at the foot. Where details are open all
// is printed, on as many sheets as it takes.
import {make} from './dom.js';
import {drawAnew} from './figure.js';

const MILLIMETRE = 96 / 25.4;  // pixels
const MARGIN = 10;             // mm, as the style sheet has it
const WIDTH = (210 - 2 * MARGIN) * MILLIMETRE;
const HEIGHT = (297 - 2 * MARGIN) * MILLIMETRE - 8;
const SMALLEST = 0.72;
const STEP = 0.04;

/** @param {number} size of everything; 1: as on the screen */
function lay(size) {
  document.body.style.width = WIDTH / size + 'px';
  document.body.style.zoom = String(size);
}

/// Pixels of the sheet.
const isTooHigh = (/** @type {number} */ size) => document.body.offsetHeight * size > HEIGHT;

/** @param {HTMLElement[]} sections */
function nameAtFoot(sections) {
  document.querySelector('footer .further')?.remove();
  if (!sections.length) return;
  const titles = sections.map(one => one.querySelector('h2')?.textContent);
  document.querySelector('footer')?.append(make('p', {
    className: 'further', textContent: `Further on the page itself: ${titles.join('; ')}.`}));
}

/// The largest size at which the first sections fit, as many as do at the smallest.
function fit() {
  /** @type {NodeListOf<HTMLElement>} */
  const all = document.querySelectorAll('main > section');
  const sections = [...all];
  for (const one of sections) one.classList.add('elsewhere');
  nameAtFoot(sections);
  const first = sections.findIndex(one => {
    one.classList.remove('elsewhere');
    return isTooHigh(SMALLEST);
  });
  const further = first < 0 ? [] : sections.slice(first);
  for (const one of further) one.classList.add('elsewhere');
  nameAtFoot(further);
  let size = 1;
  for (lay(size); size > SMALLEST && isTooHigh(size); lay(size)) size -= STEP;
}

const allIsPrinted = () => Boolean(document.querySelector('details.more[open]'));

export function printOnOneSheet() {
  // Charts are drawn between the two.
  addEventListener('beforeprint', () => {
    document.documentElement.classList.add('sheet');
    lay(SMALLEST);
    drawAnew();
  });
  addEventListener('beforeprint', () => { if (!allIsPrinted()) fit(); });
  addEventListener('afterprint', () => {
    document.documentElement.classList.remove('sheet');
    document.body.style.width = document.body.style.zoom = '';
    document.querySelector('footer .further')?.remove();
    for (const one of document.querySelectorAll('.elsewhere')) one.classList.remove('elsewhere');
    drawAnew();
  });
}
