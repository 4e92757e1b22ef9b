import assert from 'node:assert/strict';
import test from 'node:test';

import {defaults} from '../../../server/web/state.js';
import {parseAxis, stateOfPoint, sweepRequest, tablesOf} from '../../../server/web/sweep-plan.js';

test('an axis is a list or a range', () => {
  assert.deepEqual(parseAxis('0, 0.5 1'), [0, 0.5, 1]);
  assert.deepEqual(parseAxis('0 to 1 in 5'), {from: 0, to: 1, count: 5});
  assert.deepEqual(parseAxis('0.1..0.9/3'), {from: 0.1, to: 0.9, count: 3});
  assert.throws(() => parseAxis('some'), /A list/);
  assert.throws(() => parseAxis(''), /A list/);
});

test('axes and absorbers that are not swept stay out', () => {
  const request = sweepRequest(defaults, {axes: {roughness: [0, 1]}, absorbers: [], size: 64, samples: 16});
  assert.deepEqual(request.axes, {roughness: [0, 1]});
  assert.equal(request.absorbers, undefined);
  assert.deepEqual(request.base.image, {width: 64, height: 64});
  assert.deepEqual(request.base.quality, {samples: 16});
});

function grid(absorptions, roughnesses, absorbers) {
  const results = [];
  for (const absorber of absorbers)
    for (const roughness of roughnesses)
      for (const absorption of absorptions)
        results.push({point: results.length, absorption, roughness, scattering: 0.5, absorber});
  return results;
}

test('points come to lie in tables: the third axis has one for each value', () => {
  const [one] = tablesOf(grid([0, 0.5, 1], [0, 0.3], ['amber']));
  assert.equal(one.columns.name, 'absorption');
  assert.equal(one.rows.name, 'roughness');
  assert.deepEqual(one.cells.map(row => row.map(({point}) => point)), [[0, 1, 2], [3, 4, 5]]);
  const two = tablesOf(grid([0, 1], [0, 1], ['amber', 'tea']));
  assert.deepEqual(two.map(({title}) => title), ['absorber amber', 'absorber tea']);
  assert.deepEqual(two[1].cells.map(row => row.map(({point}) => point)), [[4, 5], [6, 7]]);
});

test('a sweep of one axis, and of none, is a table too', () => {
  const [line] = tablesOf(grid([0, 0.5], [0], ['amber']));
  assert.deepEqual(line.cells.map(row => row.map(({point}) => point)), [[0, 1]]);
  assert.equal(tablesOf(grid([0], [0], ['amber']))[0].cells[0][0].point, 0);
});

test('a point opens as the state that it was rendered in', () => {
  const request = {base: {material: {absorber: {rgb: [1, 0, 0]}}}};
  const state = stateOfPoint(defaults, request,
      {absorption: 0.5, roughness: 0, scattering: 1, absorber: 'absorber 1'});
  assert.deepEqual(state, {...defaults, absorption: 0.5, roughness: 0, scattering: 1, absorber: {rgb: [1, 0, 0]}});
  assert.equal(stateOfPoint(defaults, request, {absorber: 'tea'}).absorber, 'tea');
});
