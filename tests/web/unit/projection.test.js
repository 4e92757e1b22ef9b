import assert from 'node:assert/strict';
import test from 'node:test';

import {Projection} from '../../../server/web/projection.js';

test('a drag moves the point under the pointer, in one plane, and not out of the cube', () => {
  for (const [yaw, pitch] of [[-0.6, 0.4], [0.3, -0.5], [2, 0.2], [0.1, 1.3]]) {
    const projection = new Projection(yaw, pitch, 300, 200);
    const from = [0.4, 0.5, 0.6];
    for (let fixed = 0; fixed < 3; ++fixed) {
      const to = projection.move(from, 6, -4, fixed);
      assert.equal(to[fixed], from[fixed]);
      const [x, y] = projection.at(from), [u, v] = projection.at(to);
      if (to.every(value => value > 0 && value < 1) && to.some((value, i) => value !== from[i])) {
        assert.ok(Math.abs(u - x - 6) < 1e-6);
        assert.ok(Math.abs(v - y + 4) < 1e-6);
      }
    }
    assert.ok(projection.move(from, 1e4, 1e4, projection.depthAxis).every(value => value >= 0 && value <= 1));
  }
});

test('seen from the front, absorption goes right, scattering up, roughness away', () => {
  const projection = new Projection(0, 0, 100, 100);
  const [x, y, depth] = projection.at([0.5, 0.5, 0.5]);
  assert.ok(projection.at([1, 0.5, 0.5])[0] > x);
  assert.ok(projection.at([0.5, 1, 0.5])[1] < y);
  assert.ok(projection.at([0.5, 0.5, 1])[2] > depth);
  assert.equal(projection.depthAxis, 2);
  assert.equal(projection.backSide(2), 1);
});
