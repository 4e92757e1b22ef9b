// The controls beside the picture. Each tells `change(part, last)`: a part of the state, and
// whether the user has let go of it.

import {element, field, numberInput, select} from './dom.js';
import {alpha, digits, meaning} from './optics.js';

const captions = {absorption: 'Absorption', roughness: 'Roughness', scattering: 'Scattering'};

/// The three sliders with their optical meaning.
export class AxisSliders {
  #rows = {};

  constructor(root, change) {
    for (const axis of Object.keys(captions)) {
      const slider = element('input', {
        type: 'range', min: 0, max: 1, step: 0.005, id: `axis-${axis}`,
        oninput: () => change({[axis]: slider.valueAsNumber}, false),
        onchange: () => change({[axis]: slider.valueAsNumber}, true),
      });
      slider.dataset.pointer = `/material/cube/${axis}`;
      const quantity = element('span', {class: 'quantity'});
      const coefficient = element('span', {class: 'coefficient'});
      const value = element('output', {htmlFor: slider.id});
      root.append(element('div', {class: 'axis'},
          element('label', {htmlFor: slider.id}, captions[axis]), value, slider, quantity,
          coefficient));
      this.#rows[axis] = {slider, quantity, coefficient, value};
    }
  }

  set(state) {
    for (const [axis, row] of Object.entries(this.#rows)) {
      const text = meaning(axis, state[axis], state.anisotropy);
      row.slider.value = state[axis];
      row.value.value = String(Number(state[axis].toFixed(3)));
      row.quantity.textContent = text.quantity;
      row.coefficient.textContent = text.coefficient;
      row.slider.setAttribute('aria-valuetext', `${row.value.value}: ${text.quantity}, ${text.coefficient}`);
    }
  }

  /// What the service says of the material, which is what counts: it knows the reference thickness.
  setReport({coefficients}, state) {
    const {roughness, scattering} = this.#rows;
    const isOf = Math.abs(coefficients.alpha - alpha(state.roughness)) < 1e-6;
    if (!isOf) return;
    roughness.coefficient.textContent = `α ${digits(coefficients.alpha)}`;
    scattering.coefficient.textContent = `σₛ ${digits(coefficients.sigma_s ?? Infinity)} /mm`;
  }
}

/// Controls of some parts of the state. They are made anew only where the state is another one than
/// they show: not under the hands of who changes it.
class Panel {
  #root;
  #change;
  #keys;
  #shown = '';
  #state = null;

  constructor(root, change, keys) {
    this.#root = root;
    this.#change = change;
    this.#keys = keys;
  }

  set(state) {
    const text = this.#text(state);
    this.#state = state;
    if (text === this.#shown) return;
    this.#shown = text;
    this.#root.replaceChildren(...this.build(state));
  }

  /// What they can show is other than before.
  remake() {
    this.#shown = '';
    if (this.#state) this.set(this.#state);
  }

  /// The user has changed a part; `anew` where the controls depend on it.
  tell(part, anew = false) {
    this.#state = {...this.#state, ...part};
    if (!anew) this.#shown = this.#text(this.#state);
    this.#change(part, true);
  }

  get state() {
    return this.#state;
  }

  #text(state) {
    return JSON.stringify(this.#keys.map(key => state[key]));
  }
}

/// Index, anisotropy, pigment.
export class BodyControls extends Panel {
  constructor(root, change) {
    super(root, change, ['ior', 'anisotropy', 'pigment']);
  }

  build(state) {
    const input = (key, bounds) =>
        numberInput(state[key], {...bounds, onchange: value => this.tell({[key]: value})});
    return [
      field('Index', input('ior', {min: 1, max: 4, step: 0.01}), {pointer: '/material/ior'}),
      field('Anisotropy g', input('anisotropy', {min: -0.99, max: 0.99, step: 0.05}),
          {pointer: '/material/anisotropy'}),
      field('Pigment κ', input('pigment', {min: 0, step: 0.01}), {
        pointer: '/material/pigment',
        hint: 'Above 0 the scatterers absorb, σₐ = κ σₛ, and absorption a has no use.',
      }),
    ];
  }
}

/// A control for a parameter as GET /v1/objects describes it; `change` gets its new value.
function parameterField({name, type, unit, minimum, maximum, values, description, default: usual},
    given, pointer, change) {
  const value = given ?? usual ?? '';
  const label = caption(name, unit);
  if (type === 'vector') {
    const vector = [...value];
    const part = i => {
      const input = numberInput(vector[i], {onchange: number => {
        vector[i] = number;
        change([...vector]);
      }});
      input.setAttribute('aria-label', `${label} ${'xyz'[i]}`);
      input.dataset.pointer = `${pointer}/${name}/${i}`;
      return input;
    };
    return element('div', {class: 'field', role: 'group', 'aria-label': label, title: description ?? ''},
        element('span', {}, label), element('span', {class: 'vector'}, [0, 1, 2].map(part)));
  }
  const control = values ? select(values, value, change)
      : type === 'number' ? numberInput(value, {min: minimum, max: maximum, onchange: change})
      : type === 'integer' ?
        numberInput(value, {min: minimum, max: maximum, step: 1, onchange: change})
      : type === 'boolean' ? element('input', {
          type: 'checkbox', checked: Boolean(value),
          onchange: event => change(event.target.checked),
        })
      : element('input', {type: 'text', value, onchange: event => change(event.target.value)});
  if (description) control.title = description;
  return field(label, control, {unit, pointer: `${pointer}/${name}`});
}

const sphere = {
  name: 'sphere', description: '',
  parameters: [{name: 'radius_mm', type: 'number', unit: 'mm', default: 20, minimum: 1e-6}],
};

/// The object and its parameters, built from what GET /v1/objects lists.
export class ObjectControls extends Panel {
  #objects = [sphere];

  constructor(root, change) {
    super(root, change, ['object']);
  }

  setList(objects) {
    if (objects?.length > 0) this.#objects = objects;
    this.remake();
  }

  build({object}) {
    const kind = this.#objects.find(({name}) => name === object.type);
    const names = this.#objects.map(({name}) => name);
    if (!kind) names.unshift(object.type);  // of a link; the service says what it thinks of it
    const choose = select(names, object.type, type => {
      const {parameters} = this.#objects.find(({name}) => name === type);
      this.tell({object: {type, ...withDefaults(parameters)}}, true);
    });
    const change = name => value => this.tell({object: {...this.state.object, [name]: value}});
    return [
      field('Object', choose, {pointer: '/scene/object', hint: kind?.description}),
      ...(kind?.parameters ?? []).map(parameter => parameterField(
          parameter, object[parameter.name], '/scene/object', change(parameter.name))),
    ];
  }
}

/// A part of the scene that may be there or not, as GET /v1/objects describes it.
export class PartControls extends Panel {
  #part = null;
  #key;
  #pointer;

  constructor(root, change, key, pointer) {
    super(root, change, [key]);
    this.#key = key;
    this.#pointer = pointer;
  }

  setPart(part) {
    this.#part = part ?? null;
    this.remake();
  }

  build(state) {
    const value = state[this.#key];
    if (!this.#part) return [];
    const {name, description, parameters} = this.#part;
    const use = element('input', {
      type: 'checkbox', checked: Boolean(value), title: description,
      onchange: () => this.tell({[this.#key]: use.checked ? withDefaults(parameters) : false}, true),
    });
    const change = key => given => this.tell({[this.#key]: {...this.state[this.#key], [key]: given}});
    return [
      field(caption(name), use, {pointer: this.#pointer}),
      ...(value ? parameters.map(parameter => parameterField(
          parameter, value[parameter.name], this.#pointer, change(parameter.name))) : []),
    ];
  }
}

/// What must be given and has no default stays out.
export function withDefaults(parameters) {
  return Object.fromEntries(parameters.filter(parameter => parameter.default !== undefined)
      .map(parameter => [parameter.name, parameter.default]));
}

/// "radius_mm" as people write it.
export function caption(name, unit) {
  const bare = unit && name.endsWith(`_${unit}`) ? name.slice(0, -unit.length - 1) : name;
  const text = bare.replaceAll('_', ' ');
  return text.charAt(0).toUpperCase() + text.slice(1);
}

const sizes = ['256', '384', '512', '768', '1024'], sampleCounts = ['16', '64', '256', '1024', '4096'];
const white = {constant: [1, 1, 1]};

/// Environment, camera, display and size.
export class SceneControls extends Panel {
  #environments = [];
  #views = [];

  constructor(root, change) {
    super(root, change, [
      'environment', 'rotation', 'azimuth', 'elevation', 'distance', 'view', 'size', 'samples',
    ]);
  }

  setLists(environments, displays) {
    this.#environments = environments.map(({name}) => name);
    this.#views = displays.flatMap(({name, views}) => views.map(view => `${name}/${view}`));
    this.remake();
  }

  build(state) {
    const named = typeof state.environment === 'string';
    const environments = [...this.#environments, {name: '', label: 'uniform white'}];
    if (named && !this.#environments.includes(state.environment))
      environments.unshift(state.environment);
    const number = (key, bounds) =>
        numberInput(state[key], {...bounds, onchange: value => this.tell({[key]: value})});
    const choice = (key, options) => {
      const value = String(state[key]);
      return select(options.includes(value) ? options : [value, ...options], value,
          text => this.tell({[key]: Number(text)}));
    };
    const views = this.#views.map(name => ({name, label: name.replace('/', ' · ')}));
    return [
      field('Environment', select(environments, named ? state.environment : '',
          name => this.tell({environment: name || white})), {pointer: '/scene/environment'}),
      field('Turned by', number('rotation', {min: -360, max: 360, step: 5}),
          {unit: '°', pointer: '/scene/environment/rotation_deg'}),
      field('Seen from', number('azimuth', {min: -180, max: 180, step: 5}), {unit: '° right'}),
      field('and', number('elevation', {min: -85, max: 85, step: 5}), {unit: '° above'}),
      field('Distance', number('distance', {min: 1, step: 5}), {unit: 'mm', pointer: '/scene/camera'}),
      field('Shown for', select(views, state.view || views[0]?.name || '', view => this.tell({view})),
          {pointer: '?view'}),
      field('Size', choice('size', sizes), {unit: 'px', pointer: '/image'}),
      field('Samples', choice('samples', sampleCounts), {pointer: '/quality'}),
    ];
  }
}
