// The absorber: one of the service's, a colour, or a spectrum of one's own.

import {element, field, uniqueId} from './dom.js';
import {
  absorberOfColor, colorOfAbsorber, parseSpectrum, relativeSpectrum, spectrumText, swatch,
} from './spectrum.js';

const kinds = {named: 'Named', color: 'Colour', spectrum: 'Spectrum'};

function kindOf(absorber) {
  if (typeof absorber === 'string') return 'named';
  return absorber.rgb ? 'color' : 'spectrum';
}

export class AbsorberPicker {
  #change;
  #named = [];
  #panels = {};
  #radios = {};
  #list;
  #color;
  #text;
  #fault;
  #plot;
  #shown = '';

  constructor(root, change) {
    this.#change = change;
    const group = uniqueId('kind');
    const choice = element('div', {class: 'choice', role: 'radiogroup', 'aria-label': 'Kind of absorber'});
    for (const [kind, label] of Object.entries(kinds)) {
      const radio = element('input', {
        type: 'radio', name: group, id: `absorber-${kind}`,
        onchange: () => this.#chooseKind(kind),
      });
      this.#radios[kind] = radio;
      choice.append(radio, element('label', {htmlFor: radio.id}, label));
    }
    this.#list = element('div', {class: 'swatches', role: 'radiogroup', 'aria-label': 'Named absorbers'});
    this.#color = element('input', {
      type: 'color', id: 'absorber-rgb',
      oninput: () => this.#change({absorber: absorberOfColor(this.#color.value)}, false),
      onchange: () => this.#change({absorber: absorberOfColor(this.#color.value)}, true),
    });
    this.#text = element('textarea', {
      id: 'absorber-table', rows: 6, spellcheck: false, placeholder: '400 1\n550 0.2\n700 0.05',
      onchange: () => this.#takeText(),
    });
    this.#fault = element('p', {class: 'fault', id: 'absorber-fault', role: 'status'});
    this.#text.setAttribute('aria-describedby', this.#fault.id);
    this.#plot = element('canvas', {class: 'plot', width: 320, height: 60, 'aria-hidden': 'true'});
    this.#panels = {
      named: this.#list,
      color: field('What it lets through', this.#color, {
        pointer: '/material/absorber',
        hint: 'plain exponentials of the three channels, without a spectrum',
      }),
      spectrum: element('div', {},
          element('label', {htmlFor: this.#text.id}, 'Wavelength [nm] and absorption, a line each'),
          this.#text, this.#fault),
    };
    root.append(choice, ...Object.values(this.#panels), this.#plot);
  }

  setList(absorbers) {
    this.#named = absorbers;
    const group = uniqueId('absorber');
    this.#list.replaceChildren(...absorbers.map(absorber => {
      const radio = element('input', {
        type: 'radio', name: group, value: absorber.name, id: `named-${absorber.name}`,
        onchange: () => this.#change({absorber: absorber.name}, true),
      });
      const label = element('label', {htmlFor: radio.id, title: absorber.description},
          element('span', {class: 'swatch', style: {background: swatch(absorber)}}),
          absorber.name.replaceAll('-', ' '));
      return element('div', {class: 'named'}, radio, label);
    }));
  }

  /// The absorber with values. Its colour is wanted before the list may be there.
  spectrumOf(absorber) {
    if (typeof absorber !== 'string') return absorber;
    return this.#named.find(({name}) => name === absorber) ?? {rgb: [0.5, 0.5, 0.5]};
  }

  set({absorber}) {
    const kind = kindOf(absorber);
    for (const [name, panel] of Object.entries(this.#panels)) panel.hidden = name !== kind;
    this.#radios[kind].checked = true;
    for (const radio of this.#list.querySelectorAll('input')) radio.checked = radio.value === absorber;
    if (kind === 'color') this.#color.value = colorOfAbsorber(absorber);
    const text = JSON.stringify(absorber);
    if (kind === 'spectrum' && text !== this.#shown) this.#text.value = spectrumText(absorber);
    this.#shown = text;
    this.#draw(this.spectrumOf(absorber));
  }

  #chooseKind(kind) {
    if (kind === 'named') this.#change({absorber: this.#named[0]?.name ?? 'red-glass'}, true);
    if (kind === 'color') this.#change({absorber: {rgb: [0.2, 0.6, 1]}}, true);
    if (kind === 'spectrum') {
      // From the one that is shown, to begin with something.
      const known = this.#named.find(({name}) => `"${name}"` === this.#shown);
      const {wavelengths_nm, values} = known ?? {wavelengths_nm: [400, 550, 700], values: [1, 0.2, 0.05]};
      this.#change({absorber: {wavelengths_nm, values}}, true);
    }
  }

  #takeText() {
    try {
      const absorber = parseSpectrum(this.#text.value);
      this.#fault.textContent = '';
      this.#text.removeAttribute('aria-invalid');
      this.#change({absorber}, true);
    } catch (error) {
      this.#fault.textContent = error.message;
      this.#text.setAttribute('aria-invalid', 'true');
    }
  }

  /// Relative absorption from 390 to 710 nm.
  #draw(absorber) {
    this.#plot.hidden = Boolean(absorber.rgb);
    if (absorber.rgb) return;
    const paint = this.#plot.getContext('2d'), {width, height} = this.#plot;
    const k = relativeSpectrum(absorber);
    paint.clearRect(0, 0, width, height);
    paint.strokeStyle = getComputedStyle(this.#plot).color;
    paint.lineWidth = 1.5;
    paint.beginPath();
    for (let x = 0; x <= width; x += 2)
      paint.lineTo(x, height - 3 - (height - 6) * k(390 + 320 * x / width));
    paint.stroke();
  }
}
