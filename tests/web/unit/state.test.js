import assert from 'node:assert/strict';
import test from 'node:test';

import {
  cameraPosition, curlCommand, defaults, developQuery, fromHash, pictureRequest, toHash, traceRequest,
} from '../../../server/web/state.js';

const odd = {
  ...defaults, absorption: 0.123, roughness: 1, scattering: 0, absorber: {rgb: [0.2, 1, 0.5]}, ior: 1.33,
  anisotropy: -0.4, pigment: 0.02, object: {type: 'box', width_mm: 3},
  oil_film: {normal: [1, 0, 0], offset_mm: 0}, backdrop: {type: 'print', pattern: 'stripes'}, environment: {constant: [1, 1, 1]},
  rotation: 90, azimuth: -30, elevation: 20, distance: 50, view: 'sRGB/plain', size: 256, samples: 16,
};

test('an address holds the whole state', () => {
  assert.deepEqual(fromHash('#' + toHash(odd)), odd);
  assert.deepEqual(fromHash(toHash(defaults)), defaults);
});

test('an address of the defaults names the point alone', () => {
  assert.equal(toHash(defaults), 'absorption=0.35&roughness=0.15&scattering=0.35');
});

test('what a link has wrong is left to the service, or is as by default', () => {
  const state = fromHash('#absorption=7&roughness=x&ior=nine&absorber={broken&unknown=1');
  assert.equal(state.absorption, defaults.absorption);
  assert.equal(state.roughness, defaults.roughness);
  assert.equal(state.ior, 'nine');
  assert.equal(state.absorber, defaults.absorber);
});

test('absorption and absorber do not change what is traced', () => {
  const other = {...defaults, absorption: 0.9, absorber: 'amber'};
  assert.deepEqual(traceRequest(defaults, 256, 16), traceRequest(other, 256, 16));
  assert.notDeepEqual(developQuery(defaults), developQuery(other));
  assert.notDeepEqual(traceRequest(defaults, 256, 16), traceRequest({...defaults, ior: 1.4}, 256, 16));
});

test('a request says all that is shown', () => {
  const request = pictureRequest(odd);
  assert.deepEqual(request.material.absorber, {rgb: [0.2, 1, 0.5]});
  assert.deepEqual(request.material.pigment, {absorption_per_scattering: 0.02});
  assert.deepEqual(request.scene.environment, {constant: [1, 1, 1], rotation_deg: 90});
  assert.equal(pictureRequest(defaults).material.pigment, false);
  assert.deepEqual(request.scene.backdrop, odd.backdrop);
  assert.ok(!('backdrop' in pictureRequest(defaults).scene));
});

test('the camera stands on a sphere', () => {
  assert.deepEqual(cameraPosition({azimuth: 0, elevation: 0, distance: 90}), [0, 0, 90]);
  assert.deepEqual(cameraPosition({azimuth: 90, elevation: 0, distance: 90}), [90, 0, 0]);
  assert.deepEqual(cameraPosition({azimuth: 10, elevation: 90, distance: 2}).map(Math.round), [0, 2, 0]);
});

test('a shell reads the command as one word', () => {
  const command = curlCommand({a: "it's"}, 'http://localhost:1', true);
  assert.match(command, /-d '\{"a":"it'\\''s"\}'$/);
  assert.match(command, /Bearer \$TOKEN"/);
});
