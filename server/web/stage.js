// The pictures: the current one, and a pinned one beside it or under a wipe.

import {byId, element} from './dom.js';
import {digits} from './optics.js';

export function errorText(error) {
  return error === null || error === undefined ? '' : `error ${digits(100 * error)} %`;
}

export function pointText({absorption, roughness, scattering, absorber}) {
  const name = typeof absorber === 'string' ? absorber.replaceAll('-', ' ')
      : absorber.rgb ? 'a colour' : 'an own spectrum';
  return `(${absorption}, ${roughness}, ${scattering}) in ${name}`;
}

/// Shows a blob in an image, in the place of what was there.
function put(image, blob, alt) {
  const url = URL.createObjectURL(blob), old = image.src;
  image.src = url;
  image.alt = alt;
  if (old.startsWith('blob:')) image.decode().catch(() => {}).finally(() => URL.revokeObjectURL(old));
}

export class Stage {
  #pins = [];          // {state, blob, error, samples, thumb, url}
  #now = null;         // the same, without thumb
  #compared = null;
  #onChange;
  #goTo;

  /// `goTo(state)`: a pin's view is wanted again. `onChange()`: other pins than before.
  constructor({goTo, onChange}) {
    this.#goTo = goTo;
    this.#onChange = onChange;
    byId('pin').addEventListener('click', () => this.pin());
    byId('compare-none').addEventListener('click', () => this.#compare(null, 'single'));
    byId('wipe-at').addEventListener('input', event => this.#wipeAt(event.target.value));
    this.#dragWipe(byId('view'));
  }

  get pinnedPoints() {
    return this.#pins.map(({state}) => state);
  }

  show(view) {
    this.#now = view;
    put(byId('picture'), view.blob, `Rendered at ${pointText(view.state)}`);
    this.#caption();
  }

  pin() {
    if (!this.#now) return;
    const pin = {...this.#now, state: structuredClone(this.#now.state)};
    const url = URL.createObjectURL(pin.blob);
    const name = pointText(pin.state);
    const button = (label, about, onclick) =>
        element('button', {type: 'button', onclick, 'aria-label': `${label}: ${about} ${name}`}, label);
    pin.url = url;
    pin.thumb = element('li', {class: 'pin'},
        element('button', {
          type: 'button', class: 'thumb', 'aria-label': `Go to ${name}`,
          onclick: () => this.#goTo(pin.state),
        }, element('img', {src: url, alt: '', width: 96, height: 96})),
        element('p', {}, name, element('br'), [errorText(pin.error), `${pin.samples} samples`].filter(Boolean).join(', ')),
        element('div', {class: 'actions'},
            button('Beside', 'compare with', () => this.#compare(pin, 'beside')),
            button('Wipe', 'between this view and', () => this.#compare(pin, 'wipe')),
            button('Remove', 'the view', () => this.#remove(pin))));
    this.#pins.push(pin);
    byId('pins').append(pin.thumb);
    this.#onChange();
  }

  #remove(pin) {
    if (this.#compared === pin) this.#compare(null, 'single');
    this.#pins = this.#pins.filter(other => other !== pin);
    pin.thumb.remove();
    URL.revokeObjectURL(pin.url);
    byId('pin').focus();
    this.#onChange();
  }

  #compare(pin, mode) {
    this.#compared = pin;
    const stage = byId('stage');
    stage.dataset.mode = mode;
    byId('frame-other').hidden = mode !== 'beside';
    byId('wipe').hidden = byId('wipe-control').hidden = mode !== 'wipe';
    byId('compare-none').hidden = pin === null;
    if (pin) {
      const alt = `Pinned at ${pointText(pin.state)}`;
      for (const id of ['other-picture', 'wipe-picture']) {
        byId(id).src = pin.url;
        byId(id).alt = alt;
      }
      byId('caption-other').textContent = `${pointText(pin.state)} ${errorText(pin.error)}`;
    }
    this.#wipeAt(byId('wipe-at').value);
    this.#caption();
  }

  #caption() {
    byId('caption-now').textContent = this.#compared && this.#now ? pointText(this.#now.state) : '';
  }

  #wipeAt(percent) {
    byId('wipe').style.clipPath = `inset(0 ${100 - percent}% 0 0)`;
    byId('stage').style.setProperty('--wipe', `${percent}%`);
  }

  #dragWipe(view) {
    const follow = event => {
      if (byId('stage').dataset.mode !== 'wipe' || event.buttons !== 1) return;
      const {left, width} = view.getBoundingClientRect();
      const percent = Math.min(100, Math.max(0, 100 * (event.clientX - left) / width));
      byId('wipe-at').value = percent;
      this.#wipeAt(percent);
    };
    view.addEventListener('pointerdown', follow);
    view.addEventListener('pointermove', follow);
    view.addEventListener('dragstart', event => event.preventDefault());
  }
}
