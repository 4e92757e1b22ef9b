// What the service refused, where the user sees it: all of it in a box, and at the control that
// each pointer means.

import {byId, element} from './dom.js';

let marked = [];

export function clearProblem() {
  byId('problems').replaceChildren();
  for (const control of marked) {
    control.removeAttribute('aria-invalid');
    control.removeAttribute('aria-describedby');
  }
  marked = [];
}

/// The control of a pointer: its own, or that of what holds it.
function controlOf(pointer) {
  for (let path = pointer; path; path = path.slice(0, path.lastIndexOf('/'))) {
    const control = document.querySelector(`[data-pointer="${CSS.escape(path)}"]`);
    if (control) return control;
  }
  return null;
}

export function showProblem(error) {
  clearProblem();
  const errors = error.errors ?? [];
  const id = 'problem-text';
  byId('problems').append(element('div', {class: 'problem', id},
      element('button', {type: 'button', class: 'close', 'aria-label': 'Close', onclick: clearProblem}, '×'),
      element('p', {}, element('strong', {}, error.title || 'Failed'), ' ', error.message),
      errors.length > 0
          ? element('ul', {}, errors.map(({pointer, detail}) =>
              element('li', {}, element('code', {}, pointer || '/'), ' ', detail)))
          : null));
  for (const {pointer} of errors) {
    // A sweep's base is the explorer's request.
    const control = controlOf(pointer) ?? controlOf(pointer.replace(/^\/base/, ''));
    if (!control) continue;
    control.setAttribute('aria-invalid', 'true');
    control.setAttribute('aria-describedby', id);
    marked.push(control);
  }
}
