// Small helpers to build the page.

/// An element with properties (attributes where the name has a dash or is no property; functions
/// named on... listen) and children.
export function element(tag, properties = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
    else if (name === 'class') node.className = value;
    else if (name === 'style') Object.assign(node.style, value);
    else if (name in node && !name.includes('-') && name !== 'list') node[name] = value;
    else node.setAttribute(name, value === true ? '' : value);
  }
  node.append(...children.flat().filter(child => child !== null && child !== undefined));
  return node;
}

export const byId = id => document.getElementById(id);

let counter = 0;
export function uniqueId(prefix) {
  return `${prefix}-${++counter}`;
}

/// A label and its control on a line, with room for a unit and for what is wrong.
export function field(label, control, {unit = '', pointer = '', hint = ''} = {}) {
  control.id ||= uniqueId('field');
  if (pointer) control.dataset.pointer = pointer;
  return element('div', {class: 'field'},
      element('label', {htmlFor: control.id}, label),
      control,
      unit ? element('span', {class: 'unit'}, unit) : null,
      hint ? element('span', {class: 'hint'}, hint) : null);
}

export function numberInput(value, {min, max, step = 'any', onchange}) {
  return element('input', {
    type: 'number', value: String(value), min, max, step, inputMode: 'decimal',
    onchange: event => {
      const number = event.target.valueAsNumber;
      if (Number.isFinite(number)) onchange(number);
    },
  });
}

export function select(options, value, onchange) {
  return element('select', {onchange: event => onchange(event.target.value)},
      options.map(option => {
        const {name, label = name} = typeof option === 'string' ? {name: option} : option;
        return element('option', {value: name, selected: name === value}, label);
      }));
}

/// Saves a blob as a file of the user's.
export function download(blob, name) {
  const url = URL.createObjectURL(blob);
  const link = element('a', {href: url, download: name});
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/// True where the text came to the clipboard; browsers have none for pages without TLS that are
/// not of this machine.
export async function copyText(text, fallback) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    fallback?.focus();
    fallback?.select();
    return false;
  }
}
