// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Elements of the page: found, and made.

/**
 * An element that every page of this kind has.
 * @param {string} id
 */
export function by(id) {
  const element = document.getElementById(id);
  if (!element) throw new Error('the page has no ' + id);
  return element;
}

/** @param {string} id */
export const inputBy = id => /** @type {HTMLInputElement} */ (by(id));

/** @param {string} id */
export const buttonBy = id => /** @type {HTMLButtonElement} */ (by(id));

/** @param {string} id */
export const selectBy = id => /** @type {HTMLSelectElement} */ (by(id));

/**
 * The first of these within an element that has one.
 * @param {ParentNode} parent
 * @param {string} selector
 */
export function within(parent, selector) {
  const element = parent.querySelector(selector);
  if (!element) throw new Error('there is no ' + selector);
  return /** @type {HTMLElement} */ (element);
}

/**
 * @template {keyof HTMLElementTagNameMap} Name
 * @param {Name} name
 * @param {Partial<HTMLElementTagNameMap[Name]>} properties
 * @param {...(Node | string)} children
 */
export function make(name, properties = {}, ...children) {
  const element = document.createElement(name);
  Object.assign(element, properties);
  element.append(...children);
  return element;
}

/**
 * @param {string} name
 * @param {Record<string, string | number>} attributes
 * @param {...Node} children
 */
export function drawn(name, attributes, ...children) {
  const element = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
  element.append(...children);
  return element;
}

/** What went wrong, in words. */
export const messageOf = (/** @type {unknown} */ error) =>
    error instanceof Error ? error.message : String(error);
