import assert from 'node:assert/strict';
import test from 'node:test';

import {
  absorberOfColor, colorOfAbsorber, parseSpectrum, relativeSpectrum, spectrumText, swatch,
} from '../../../server/web/spectrum.js';

const blueAbsorber = {wavelengths_nm: [400, 500, 520, 700], values: [2, 2, 0, 0]};

test('a spectrum is relative to its peak, linear between samples, constant beyond them', () => {
  const k = relativeSpectrum(blueAbsorber);
  assert.equal(k(300), 1);
  assert.equal(k(510), 0.5);
  assert.equal(k(900), 0);
});

test('what absorbs blue looks yellow, nothing looks white', () => {
  const [r, g, b] = swatch(blueAbsorber).match(/\d+/g).map(Number);
  assert.ok(b < 170 && r > 230 && g > 200, `${r} ${g} ${b}`);
  assert.equal(swatch(blueAbsorber, 0), 'rgb(255 255 255)');
});

test('a colour becomes the absorber that lets it through', () => {
  const {rgb} = absorberOfColor('#ff0000');
  assert.equal(rgb[0], 0);
  assert.equal(Math.max(...rgb), 1);
  assert.deepEqual(absorberOfColor('#ffffff'), {rgb: [1, 1, 1]});
  const again = absorberOfColor(colorOfAbsorber({rgb: [0.2, 1, 0.5]}));
  [0.2, 1, 0.5].forEach((k, i) => assert.ok(Math.abs(again.rgb[i] - k) < 0.02));
});

test('a pasted table is a spectrum', () => {
  const text = 'nm\tabsorbance\n500, 0.5\n400 1\n\n600;0\n';
  const spectrum = parseSpectrum(text);
  assert.deepEqual(spectrum, {wavelengths_nm: [400, 500, 600], values: [1, 0.5, 0]});
  assert.deepEqual(parseSpectrum(spectrumText(spectrum)), spectrum);
  assert.throws(() => parseSpectrum('400 1'), /Two lines/);
  assert.throws(() => parseSpectrum('400 1\n500 x'), /Line 2/);
});
