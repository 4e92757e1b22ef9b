// What the explorer shows, as one plain value; to and from the address, and as requests.

export const defaults = Object.freeze({
  absorption: 0.35, roughness: 0.15, scattering: 0.35,
  absorber: 'red-glass',            // a name, {rgb} or {wavelengths_nm, values}
  ior: 1.5, anisotropy: 0, pigment: 0,  // pigment: absorption per scattering, 0: none
  object: {type: 'sphere', radius_mm: 20},
  oil_film: false, backdrop: false,  // or what GET /v1/objects says of them
  environment: 'forest',            // a name, or {constant: [r, g, b]}
  rotation: 0, azimuth: 0, elevation: 0, distance: 90,  // degrees, degrees, degrees, mm
  view: '',                         // 'display/view' of /v1/displays, '': the first
  size: 512, samples: 64,
});

/// The keys whose values go through the address as JSON where they are no text.
const structured = new Set(['absorber', 'object', 'environment', 'oil_film', 'backdrop']);
const texts = new Set(['view']);

function same(a, b) {
  return JSON.stringify(a) === JSON.stringify(b);
}

/// The address's fragment, without '#'. What is as by default stays out, but for the point.
export function toHash(state) {
  const fields = new URLSearchParams();
  for (const key of Object.keys(defaults)) {
    const always = key === 'absorption' || key === 'roughness' || key === 'scattering';
    if (!always && same(state[key], defaults[key])) continue;
    const value = state[key];
    fields.set(key, typeof value === 'object' ? JSON.stringify(value) : String(value));
  }
  return fields.toString();
}

/// A number, or what stands there where it is none: the service says what is wrong with that.
function number(text) {
  const value = Number(text);
  return text.trim() !== '' && Number.isFinite(value) ? value : text;
}

/// The state that a fragment describes; what it does not say is as by default.
export function fromHash(hash) {
  const state = structuredClone(defaults);
  for (const [key, text] of new URLSearchParams(hash.replace(/^#/, ''))) {
    if (!(key in defaults)) continue;
    if (structured.has(key) && text.startsWith('{')) {
      try {
        state[key] = JSON.parse(text);
      } catch {
        // A broken link shows the default.
      }
    } else {
      state[key] = text === 'false' ? false : structured.has(key) || texts.has(key) ? text : number(text);
    }
  }
  for (const axis of ['absorption', 'roughness', 'scattering'])
    if (!(state[axis] >= 0 && state[axis] <= 1)) state[axis] = defaults[axis];
  return state;
}

/// Where the camera is: on a sphere about the origin, from +z towards +x, then up.
export function cameraPosition({azimuth, elevation, distance}) {
  const a = azimuth * Math.PI / 180, e = elevation * Math.PI / 180;
  const clean = value => Number(value.toFixed(6)) + 0;
  return [
    clean(distance * Math.cos(e) * Math.sin(a)),
    clean(distance * Math.sin(e)),
    clean(distance * Math.cos(e) * Math.cos(a)),
  ];
}

function environmentOf(state) {
  const source = typeof state.environment === 'string' ? {image: state.environment}
                                                       : state.environment;
  return {...source, rotation_deg: state.rotation};
}

/// The request of the picture as it is shown.
export function pictureRequest(state, samples = state.samples) {
  const request = {
    material: {
      cube: {
        absorption: state.absorption, roughness: state.roughness, scattering: state.scattering,
      },
      absorber: state.absorber,
      ior: state.ior,
      anisotropy: state.anisotropy,
      pigment: state.pigment ? {absorption_per_scattering: state.pigment} : false,
    },
    scene: {
      object: state.object,
      environment: environmentOf(state),
      camera: {position_mm: cameraPosition(state)},
    },
    image: {width: state.size, height: state.size},
    quality: {samples},
  };
  // Older services know neither.
  if (state.oil_film) request.material.oil_film = state.oil_film;
  if (state.backdrop) request.scene.backdrop = state.backdrop;
  return request;
}

/// Whether other absorptions and absorbers can be developed from one tracing: not of pigments.
export function isExplorable(state) {
  return !state.pigment;
}

/// The request behind it, where it can be explorable: then it is the same for every absorption and
/// absorber, which are developed from its one tracing.
export function traceRequest(state, size, samples) {
  const request = pictureRequest(state, samples);
  request.image = {width: size, height: size};
  if (!isExplorable(state)) return request;
  request.material.cube.absorption = 0;
  delete request.material.absorber;
  request.explorable = true;
  return request;
}

/// The query that develops the state from its traced render.
export function developQuery(state) {
  const absorber = typeof state.absorber === 'string' ? state.absorber
                                                      : JSON.stringify(state.absorber);
  return {absorption: String(state.absorption), absorber, ...displayQuery(state)};
}

export function displayQuery({view}) {
  const slash = view.indexOf('/');
  return slash > 0 ? {display: view.slice(0, slash), view: view.slice(slash + 1)} : {};
}

/// The request as a command for a shell.
export function curlCommand(request, origin, withToken) {
  const body = JSON.stringify(request).replaceAll("'", `'\\''`);
  const token = withToken ? ` -H "Authorization: Bearer $TOKEN"` : '';
  return `curl -sS ${origin}/v1/renders -H 'Prefer: wait=60' ` +
      `-H 'Content-Type: application/json'${token} -d '${body}'`;
}
