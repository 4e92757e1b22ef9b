// The page: one state, the controls that change it, the picture that follows it.

import {AbsorberPicker} from './absorber.js';
import {AxisSliders, BodyControls, ObjectControls, PartControls, SceneControls} from './controls.js';
import {CubeView} from './cube.js';
import {byId, copyText, download} from './dom.js';
import {digits, sigmaA} from './optics.js';
import {clearProblem, showProblem} from './problems.js';
import {Service} from './service.js';
import {swatch} from './spectrum.js';
import {errorText, pointText, Stage} from './stage.js';
import {curlCommand, fromHash, pictureRequest, toHash} from './state.js';
import {SweepView} from './sweep.js';
import {Tracer} from './tracer.js';

const service = new Service(askToken);
let state = fromHash(location.hash);
let asked = performance.now(), pending = true;   // since when a changed picture is waited for

const tracer = new Tracer(service, {
  picture(blob, film, shown, samples) {
    stage.show({state: shown, blob, error: film.error, samples});
    if (pending && JSON.stringify(shown) === JSON.stringify(state)) {
      pending = false;
      performance.measure('picture', {start: asked, end: performance.now()});
    }
  },
  progress: showProgress,
  material: report => sliders.setReport(report, state),
  problem(error) {
    byId('status').textContent = 'Not this: what is shown is from before.';
    showProblem(error);
  },
});

const stage = new Stage({goTo: next => change(next, true), onChange: drawCube});
const cube = new CubeView(byId('cube'), change);
const sliders = new AxisSliders(byId('axes'), change);
const absorber = new AbsorberPicker(byId('absorber'), change);
const body = new BodyControls(byId('body'), change);
const object = new ObjectControls(byId('object'), change);
const oilFilm = new PartControls(byId('oil-film'), change, 'oil_film', '/material/oil_film');
const backdrop = new PartControls(byId('backdrop'), change, 'backdrop', '/scene/backdrop');
const scene = new SceneControls(byId('scene'), change);
const sweep = new SweepView(service, {
  baseState: () => state,
  absorberNames: () => absorberNames,
  open(next) {
    showTab('explorer');
    change(next, true);
    byId('cube').focus();
  },
  changed: writeHash,
});
let absorberNames = [];

/// A part of the state is another one; `last`: the user has let go.
function change(part, last) {
  const before = JSON.stringify(state);
  state = {...state, ...part};
  if (JSON.stringify(state) !== before) {
    asked = performance.now();
    pending = true;
    clearProblem();
    tracer.show(state);
  }
  reflect(last);
  if (last) {
    writeHash();
    byId('announce').textContent = `Point ${pointText(state)}`;
  }
}

/// Brings the controls to the state: all, or those that follow a movement.
function reflect(all = true) {
  sliders.set(state);
  drawCube();
  if (!all) return;
  absorber.set(state);
  body.set(state);
  object.set(state);
  oilFilm.set(state);
  backdrop.set(state);
  scene.set(state);
}

function drawCube() {
  const spectrum = absorber.spectrumOf(state.absorber);
  const density = Math.min(sigmaA(state.absorption) * 10, 20);
  cube.set(state, swatch(spectrum, density), stage.pinnedPoints);
  byId('cube').setAttribute('aria-label',
      `The cube with its point at absorption ${digits(state.absorption)}, roughness ` +
      `${digits(state.roughness)}, scattering ${digits(state.scattering)}. Arrow keys move it along ` +
      'absorption and scattering, page up and down along roughness.');
}

function showProgress(film, done) {
  byId('progress').value = film.samples / film.total;
  const parts = [`${film.size} px`, `${film.samples} of ${film.total} samples`, errorText(film.error)];
  byId('status').textContent = parts.filter(Boolean).join(' · ');
  if (done) byId('announce').textContent = `Finished, ${errorText(film.error)}`;
}

// ---- address, tabs

function writeHash() {
  const fields = new URLSearchParams(toHash(state));
  if (!byId('sweep').hidden) {
    fields.set('tab', 'sweep');
    if (sweep.id) fields.set('sweep', sweep.id);
  }
  history.replaceState(null, '', `#${fields}`);
}

function readHash() {
  const fields = new URLSearchParams(location.hash.slice(1));
  change(fromHash(location.hash), true);
  showTab(fields.get('tab') === 'sweep' ? 'sweep' : 'explorer');
  if (fields.get('sweep')) sweep.restore(fields.get('sweep'));
}

function showTab(name) {
  for (const tab of ['explorer', 'sweep']) {
    byId(tab).hidden = tab !== name;
    byId(`tab-${tab}`).setAttribute('aria-selected', String(tab === name));
    byId(`tab-${tab}`).tabIndex = tab === name ? 0 : -1;
  }
  byId('skip').hidden = name !== 'explorer';
  if (name === 'sweep') sweep.refresh();
  writeHash();
}

for (const [name, other] of [['explorer', 'sweep'], ['sweep', 'explorer']]) {
  byId(`tab-${name}`).addEventListener('click', () => showTab(name));
  byId(`tab-${name}`).addEventListener('keydown', event => {
    if (event.key !== 'ArrowLeft' && event.key !== 'ArrowRight') return;
    showTab(other);
    byId(`tab-${other}`).focus();
  });
}
window.addEventListener('hashchange', readHash);

// ---- what leaves the page

async function save(format) {
  const film = tracer.film;
  if (!film) return;
  try {
    const at = ['absorption', 'roughness', 'scattering'].map(axis => state[axis]).join('-');
    download(await tracer.picture(film, state, format), `translucube-${at}.${format}`);
  } catch (error) {
    showProblem(error);
  }
}
byId('download-png').addEventListener('click', () => save('png'));
byId('download-exr').addEventListener('click', () => save('exr'));

byId('show-request').addEventListener('click', () => {
  const request = pictureRequest(state);
  byId('request-json').value = JSON.stringify(request, null, 2);
  byId('request-curl').value = curlCommand(request, location.origin, service.hasToken);
  byId('copied').textContent = '';
  byId('request-dialog').showModal();
});
for (const form of ['json', 'curl'])
  byId(`copy-${form}`).addEventListener('click', async () => {
    const text = byId(`request-${form}`);
    const copied = await copyText(text.value, text);
    byId('copied').textContent = copied ? 'Copied.' : 'Selected: copy it with the keyboard.';
  });
byId('request-close').addEventListener('click', () => byId('request-dialog').close());
byId('copy-link').addEventListener('click', async () => {
  writeHash();
  const copied = await copyText(location.href);
  byId('announce').textContent = copied ? 'Link copied.' : 'The address of this page is the link.';
  byId('copy-link').textContent = copied ? 'Copied' : 'See address';
  setTimeout(() => (byId('copy-link').textContent = 'Link'), 2000);
});

/// What the user gives, '' where they close the dialog.
function askToken() {
  const dialog = byId('token-dialog');
  return new Promise(resolve => {
    dialog.addEventListener('close', () => {
      resolve(byId('token').value.trim());
      byId('token').value = '';
    }, {once: true});
    dialog.showModal();
  });
}

// ---- begin

async function loadLists() {
  const [{absorbers}, {environments}, {displays}, parts] = await Promise.all(
      ['absorbers', 'environments', 'displays', 'objects'].map(name => service.json(`/v1/${name}`)));
  absorber.setList(absorbers);
  absorberNames = absorbers.map(({name}) => name);
  scene.setLists(environments, displays);
  object.setList(parts.objects);
  oilFilm.setPart(parts.oil_film);
  backdrop.setPart(parts.backdrop);
  reflect();
}

tracer.show(state);
reflect();
readHash();
loadLists().catch(showProblem);
