// The sweep: two or three axes, a sheet that fills in as its points finish.

import {byId, download, element, field, numberInput, select} from './dom.js';
import {clearProblem, showProblem} from './problems.js';
import {hasEnded} from './service.js';
import {displayQuery} from './state.js';
import {parseAxis, stateOfPoint, sweepAxes, sweepRequest, tablesOf} from './sweep-plan.js';

const presets = {absorption: '0 to 1 in 5', roughness: '0, 0.3, 0.7', scattering: '0, 0.5, 0.9'};
const captions = {absorption: 'Absorption', roughness: 'Roughness', scattering: 'Scattering'};
const picturesAtOnce = 4;   // browsers open six connections to a host; some are for the rest

export class SweepView {
  id = '';
  #service;
  #host;
  #axes = {};
  #absorbers;
  #size = 128;
  #samples = 64;
  #count;
  #status = null;        // of the sweep that is shown
  #cells = new Map();    // point -> button
  #waiting = [];         // points whose picture is to be fetched
  #fetching = 0;
  #controller = new AbortController();
  #counting = 0;

  /// `host`: {baseState(), absorberNames(), open(state), changed()}.
  constructor(service, host) {
    this.#service = service;
    this.#host = host;
    this.#build(byId('sweep-form'));
  }

  /// The form is seen: its counts may be others.
  refresh() {
    const names = this.#host.absorberNames();
    if (this.#absorbers.options.length !== names.length)
      this.#absorbers.replaceChildren(...names.map(name => element('option', {value: name}, name)));
    this.#showCount();
  }

  async restore(id) {
    if (id === this.id) return;
    try {
      this.#follow(await this.#service.json(`/v1/sweeps/${encodeURIComponent(id)}`));
    } catch (error) {
      showProblem(error);
    }
  }

  #build(form) {
    const rows = sweepAxes.map(axis => {
      const use = element('input', {
        type: 'checkbox', id: `sweep-${axis}`, checked: axis !== 'scattering',
        onchange: () => this.#changed(),
      });
      const values = element('input', {
        type: 'text', value: presets[axis], 'aria-label': `${captions[axis]} values`,
        oninput: () => this.#changed(),
      });
      values.dataset.pointer = `/axes/${axis}`;
      const fault = element('span', {class: 'fault', role: 'status'});
      this.#axes[axis] = {use, values, fault};
      return element('div', {class: 'sweep-axis'}, use,
          element('label', {htmlFor: use.id}, captions[axis]), values, fault);
    });
    this.#absorbers = element('select', {multiple: true, size: 4, onchange: () => this.#changed()});
    this.#count = element('p', {class: 'hint', role: 'status', id: 'sweep-count'});
    form.append(
        element('fieldset', {}, element('legend', {}, 'Axes'), rows,
            element('p', {class: 'hint'}, 'A list, or a range such as 0 to 1 in 5. Other axes and all else are as in the explorer.')),
        field('Absorbers', this.#absorbers, {pointer: '/absorbers', hint: 'none chosen: the explorer’s'}),
        field('Size', select(['64', '96', '128', '192', '256'], '128', text => {
          this.#size = Number(text);
          this.#changed();
        }), {unit: 'px', pointer: '/base/image'}),
        field('Samples', numberInput(64, {min: 1, step: 1, onchange: value => {
          this.#samples = value;
          this.#changed();
        }}), {pointer: '/base/quality'}),
        this.#count,
        element('div', {class: 'actions'},
            element('button', {type: 'submit', id: 'sweep-start'}, 'Start'),
            element('button', {type: 'button', id: 'sweep-cancel', hidden: true, onclick: () => this.#cancel()}, 'Cancel'),
            element('button', {type: 'button', id: 'sweep-sheet', hidden: true, onclick: () => this.#saveSheet()}, 'Sheet as PNG')));
    form.addEventListener('submit', event => {
      event.preventDefault();
      this.#start();
    });
  }

  /// The request of the form; null where it makes none, which is said beside its field.
  #request() {
    const axes = {};
    let good = true;
    for (const [axis, {use, values, fault}] of Object.entries(this.#axes)) {
      values.disabled = !use.checked;
      fault.textContent = '';
      if (!use.checked) continue;
      try {
        axes[axis] = parseAxis(values.value);
      } catch (error) {
        fault.textContent = error.message;
        good = false;
      }
    }
    const absorbers = [...this.#absorbers.selectedOptions].map(({value}) => value);
    return good ? sweepRequest(this.#host.baseState(),
        {axes, absorbers, size: this.#size, samples: this.#samples}) : null;
  }

  #changed() {
    clearTimeout(this.#counting);
    this.#counting = setTimeout(() => this.#showCount(), 200);
  }

  async #showCount() {
    const request = this.#request();
    this.#count.textContent = '';
    if (!request) return;
    try {
      const {points, traced_images: traced, camera_samples: samples} =
          await this.#service.post('/v1/sweeps?dry_run=true', request);
      this.#count.textContent = `${points} points from ${traced} traced images, ${(samples / 1e6).toFixed(1)} million camera samples`;
      clearProblem();
    } catch (error) {
      showProblem(error);
    }
  }

  async #start() {
    const request = this.#request();
    if (!request) return;
    clearProblem();
    try {
      this.#follow(await this.#service.post('/v1/sweeps', request));
    } catch (error) {
      showProblem(error);
    }
  }

  async #cancel() {
    try {
      await this.#service.json(`/v1/sweeps/${this.id}/cancel`, {method: 'POST'});
    } catch (error) {
      showProblem(error);
    }
  }

  async #saveSheet() {
    const fields = new URLSearchParams({format: 'png', ...displayQuery(this.#host.baseState())});
    try {
      const response = await this.#service.call(`/v1/sweeps/${this.id}/sheet?${fields}`);
      download(await response.blob(), 'translucube-sheet.png');
    } catch (error) {
      showProblem(error);
    }
  }

  /// Shows a sweep and fills it in until it has ended.
  async #follow(status) {
    this.#controller.abort();
    this.#controller = new AbortController();
    const {signal} = this.#controller;
    this.#status = status;
    this.id = status.id;
    this.#waiting = [];
    this.#lay(tablesOf(status.results));
    for (const result of status.results)
      if (result.state === 'succeeded') this.#waiting.push(result.point);
    this.#progress(status.state, status.counts);
    this.#host.changed();
    this.#fetchSome(signal);
    if (hasEnded(status.state)) return;
    try {
      await this.#service.follow(`/v1/sweeps/${status.id}/events`, {
        signal,
        onEvent: ({type, data}) => {
          if (type === 'points') this.#ended(data.points, data.state, signal);
          if (data.counts) this.#progress(type === 'state' ? data.state : 'running', data.counts);
        },
      });
    } catch (error) {
      if (!signal.aborted) showProblem(error);
    }
  }

  #progress(state, counts) {
    const total = this.#status.points, done = counts.succeeded;
    const bad = counts.failed + counts.canceled;
    byId('sweep-progress').value = total > 0 ? (done + bad) / total : 0;
    byId('sweep-status').textContent = `${done} of ${total} points` +
        (bad > 0 ? `, ${bad} not` : '') + (hasEnded(state) ? `, ${state}` : '');
    byId('sweep-cancel').hidden = hasEnded(state);
    byId('sweep-sheet').hidden = false;
  }

  #ended(points, state, signal) {
    for (const point of points) {
      if (state === 'succeeded') this.#waiting.push(point);
      else this.#cells.get(point)?.replaceChildren(state);
    }
    this.#fetchSome(signal);
  }

  async #fetchSome(signal) {
    while (this.#fetching < picturesAtOnce && this.#waiting.length > 0 && !signal.aborted) {
      const point = this.#waiting.shift();
      if (!this.#cells.has(point) || this.#cells.get(point).dataset.state === 'shown') continue;
      ++this.#fetching;
      this.#fetch(point, signal).finally(() => {
        --this.#fetching;
        this.#fetchSome(this.#controller.signal);
      });
    }
  }

  async #fetch(point, signal) {
    const cell = this.#cells.get(point);
    const fields = new URLSearchParams({format: 'png', ...displayQuery(this.#host.baseState())});
    try {
      const response = await this.#service.call(
          `/v1/sweeps/${this.id}/points/${point}/image?${fields}`, {signal});
      const url = URL.createObjectURL(await response.blob());
      const image = element('img', {src: url, alt: '', width: this.#status.request.base.image.width});
      image.addEventListener('load', () => URL.revokeObjectURL(url), {once: true});
      cell.replaceChildren(image);
      cell.dataset.state = 'shown';
      cell.disabled = false;
    } catch (error) {
      if (!signal.aborted) cell.replaceChildren('gone');
    }
  }

  #lay(tables) {
    this.#cells = new Map();
    const head = (axis, value) => axis.name === null ? '' : `${axis.name.charAt(0)} ${value}`;
    byId('sheet-tables').replaceChildren(...tables.map(({title, columns, rows, cells}) =>
      element('table', {},
          element('caption', {}, title || [rows.name, columns.name].filter(Boolean).join(' × ') || 'One point'),
          element('thead', {}, element('tr', {}, element('td', {}),
              columns.values.map(value => element('th', {scope: 'col'}, columns.name === 'absorber' ? value : head(columns, value))))),
          element('tbody', {}, cells.map((row, i) => element('tr', {},
              element('th', {scope: 'row'}, rows.name === 'absorber' ? rows.values[i] : head(rows, rows.values[i])),
              row.map(result => element('td', {}, this.#cell(result)))))))));
  }

  #cell(result) {
    const {absorption, roughness, scattering, absorber} = result;
    const cell = element('button', {
      type: 'button', class: 'cell', disabled: true,
      'aria-label': `Open absorption ${absorption}, roughness ${roughness}, scattering ${scattering}, ${absorber}`,
      onclick: () => this.#host.open(stateOfPoint(this.#host.baseState(), this.#status.request, result)),
    });
    const side = Math.min(this.#status.request.base.image.width, 160);
    cell.style.setProperty('--side', `${side}px`);
    this.#cells.set(result.point, cell);
    return cell;
  }
}
