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

/// Index, anisotropy, pigment.
export class BodyControls {
  #root;
  #change;

  constructor(root, change) {
    this.#root = root;
    this.#change = change;
  }

  set(state) {
    const change = key => value => this.#change({[key]: value}, true);
    this.#root.replaceChildren(
        field('Index', numberInput(state.ior, {min: 1, max: 4, step: 0.01, onchange: change('ior')}),
            {pointer: '/material/ior'}),
        field('Anisotropy g',
            numberInput(state.anisotropy, {min: -0.99, max: 0.99, step: 0.05, onchange: change('anisotropy')}),
            {pointer: '/material/anisotropy'}),
        field('Pigment κ',
            numberInput(state.pigment, {min: 0, step: 0.01, onchange: change('pigment')}),
            {
              pointer: '/material/pigment',
              hint: state.pigment ? 'σₐ = κ σₛ: the scatterers absorb, absorption a has no use' : '0: scatterers do not absorb',
            }));
  }
}

/// The object and its parameters, built from what GET /v1/objects lists.
export class ObjectControls {
  #root;
  #change;
  #objects = [{
    name: 'sphere', description: '',
    parameters: [{name: 'radius_mm', type: 'number', unit: 'mm', default: 20, minimum: 1e-6}],
  }];

  constructor(root, change) {
    this.#root = root;
    this.#change = change;
  }

  setList(objects) {
    if (objects.length > 0) this.#objects = objects;
  }

  set({object}) {
    const kind = this.#objects.find(({name}) => name === object.type);
    const choose = select(this.#objects.map(({name}) => name), object.type, name => {
      const chosen = this.#objects.find(other => other.name === name);
      this.#change({object: withDefaults(chosen)}, true);
    });
    choose.dataset.pointer = '/scene/object/type';
    this.#root.replaceChildren(
        field('Object', choose, {pointer: '/scene/object', hint: kind?.description}),
        ...(kind?.parameters ?? []).map(parameter => this.#parameter(parameter, object)));
  }

  #parameter(parameter, object) {
    const {name, type, unit, minimum, maximum, values, description} = parameter;
    const value = object[name] ?? parameter.default ?? '';
    const change = given => this.#change({object: {...object, [name]: given}}, true);
    const control = values ? select(values, value, change)
        : type === 'number' ? numberInput(value, {min: minimum, max: maximum, onchange: change})
        : type === 'boolean' ? element('input', {
            type: 'checkbox', checked: Boolean(value),
            onchange: event => change(event.target.checked),
          })
        : element('input', {type: 'text', value, onchange: event => change(event.target.value)});
    if (description) control.title = description;
    return field(caption(name, unit), control, {unit, pointer: `/scene/object/${name}`});
  }
}

/// A new object of a kind: what must be given and has no default stays empty.
export function withDefaults({name, parameters}) {
  const object = {type: name};
  for (const parameter of parameters)
    if (parameter.default !== undefined) object[parameter.name] = parameter.default;
  return object;
}

/// "radius_mm" as people write it.
export function caption(name, unit) {
  const bare = unit && name.endsWith(`_${unit}`) ? name.slice(0, -unit.length - 1) : name;
  const text = bare.replaceAll('_', ' ');
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/// Environment, camera, display and size.
export class SceneControls {
  #root;
  #change;
  #environments = ['forest'];
  #displays = [];

  constructor(root, change) {
    this.#root = root;
    this.#change = change;
  }

  setLists(environments, displays) {
    this.#environments = environments.map(({name}) => name);
    this.#displays = displays.flatMap(({name, views}) => views.map(view => `${name}/${view}`));
  }

  set(state) {
    const change = key => value => this.#change({[key]: value}, true);
    const constant = typeof state.environment !== 'string';
    const environments = [...this.#environments, {name: '', label: 'uniform white'}];
    if (!constant && !this.#environments.includes(state.environment))
      environments.unshift(state.environment);
    const angle = (key, low, high) =>
        numberInput(state[key], {min: low, max: high, step: 5, onchange: change(key)});
    const views = this.#displays.map(name => ({name, label: name.replace('/', ' · ')}));
    this.#root.replaceChildren(
        field('Environment', select(environments, constant ? '' : state.environment,
            name => this.#change({environment: name || {constant: [1, 1, 1]}}, true)),
            {pointer: '/scene/environment'}),
        field('Turned by', angle('rotation', -360, 360), {unit: '°', pointer: '/scene/environment/rotation_deg'}),
        field('Seen from', angle('azimuth', -180, 180), {unit: '° right'}),
        field('and', angle('elevation', -85, 85), {unit: '° above'}),
        field('Distance', numberInput(state.distance, {min: 1, step: 5, onchange: change('distance')}),
            {unit: 'mm', pointer: '/scene/camera'}),
        field('Shown for', select(views, state.view || views[0]?.name || '', change('view')),
            {pointer: '?view'}),
        field('Size', select(['256', '384', '512', '768', '1024'], String(state.size),
            text => this.#change({size: Number(text)}, true)), {unit: 'px', pointer: '/image'}),
        field('Samples', select(['16', '64', '256', '1024', '4096'], String(state.samples),
            text => this.#change({samples: Number(text)}, true)), {pointer: '/quality'}));
  }
}
