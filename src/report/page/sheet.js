// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A page on paper: what is first, on one sheet of A4, made as small as it must be. Details that are
// open are printed too, on as many sheets as they take.
const MILLIMETRE = 96 / 25.4;  // pixels
const MARGIN = 10;             // mm, as the style sheet has it
const WIDTH = (210 - 2 * MARGIN) * MILLIMETRE;
const HEIGHT = (297 - 2 * MARGIN) * MILLIMETRE - 4;
const SMALLEST = 0.4;
const STEPS = 7;

/** @param {number} size of everything; 1: as on the screen */
function lay(size) {
  document.body.style.width = WIDTH / size + 'px';
  document.body.style.zoom = String(size);
}

function fit() {
  let least = SMALLEST, most = 1;
  lay(most);
  if (document.body.getBoundingClientRect().height <= HEIGHT) return;
  for (let k = 0; k < STEPS; ++k) {
    const size = (least + most) / 2;
    lay(size);
    if (document.body.getBoundingClientRect().height <= HEIGHT) least = size;
    else most = size;
  }
  lay(least);
}

export function printOnOneSheet() {
  addEventListener('beforeprint', () => {
    document.documentElement.classList.add('sheet');
    if (!document.querySelector('details.more[open]')) fit();
  });
  addEventListener('afterprint', () => {
    document.documentElement.classList.remove('sheet');
    document.body.style.width = document.body.style.zoom = '';
  });
}
