import assert from 'node:assert/strict';
import test from 'node:test';

import {alpha, digits, meaning, percent, sigmaA, sigmaS} from '../../../server/web/optics.js';

test('absorption is the absorptance of 10 mm', () => {
  for (const a of [0, 0.1, 0.35, 0.9, 0.999])
    assert.ok(Math.abs(1 - Math.exp(-sigmaA(a) * 10) - a) < 1e-12);
  assert.equal(sigmaA(1), Infinity);
  assert.equal(sigmaA(0.5, 1), 10 * sigmaA(0.5));
});

test('scattering is the two-stream reflectance of 10 mm', () => {
  for (const g of [0, 0.5, -0.5])
    for (const s of [0, 0.2, 0.5, 0.99]) {
      const depth = 0.75 * sigmaS(s, g) * (1 - g) * 10;
      assert.ok(Math.abs(depth / (1 + depth) - s) < 1e-12);
    }
  assert.equal(sigmaS(1), Infinity);
});

test('roughness is the square root of alpha', () => {
  assert.equal(alpha(0.5), 0.25);
  assert.equal(alpha(1), 1);
});

test('numbers are short', () => {
  assert.equal(digits(0), '0');
  assert.equal(digits(0.043078291), '0.0431');
  assert.equal(digits(1234567), '1.2e6');
  assert.equal(digits(Infinity), '∞');
  assert.equal(percent(0.35), '35 %');
  assert.deepEqual(meaning('absorption', 1), {quantity: '100 % absorbed in 10 mm', coefficient: 'σₐ ∞ /mm'});
});
