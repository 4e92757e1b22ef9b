// Sweeps as values: from the form to a request, from results to tables.

import {pictureRequest} from './state.js';

export const sweepAxes = ['absorption', 'roughness', 'scattering'];

/// A list of numbers, "0, 0.5, 1", or a range "0 to 1 in 5", "0..1/5", as the service takes it.
/// Throws what to say to the user.
export function parseAxis(text) {
  const range = text.match(/^\s*(\S+?)\s*(?:to|\.\.|–|-)\s*(\S+?)\s*(?:in|\/|x)\s*(\d+)\s*$/);
  if (range) {
    const [from, to, count] = range.slice(1).map(Number);
    if ([from, to].every(Number.isFinite)) return {from, to, count};
  }
  const parts = text.split(/[\s,;]+/).filter(part => part !== '');
  const values = parts.map(Number);
  if (values.length === 0 || !values.every(Number.isFinite))
    throw new Error('A list such as 0, 0.5, 1, or a range such as 0 to 1 in 5.');
  return values;
}

/// `axes`: {absorption: [...] or {from, to, count}} of those that are swept.
export function sweepRequest(state, {axes, absorbers, size, samples}) {
  const base = pictureRequest(state, samples);
  base.image = {width: size, height: size};
  const request = {base, axes};
  if (absorbers.length > 0) request.absorbers = absorbers;
  return request;
}

const unique = values => [...new Set(values)];

/// Tables of the points of a sweep: absorption (or the first axis that varies) runs along the
/// rows, the next one down; whatever else varies makes a table for each of its values.
/// `results`: of a sweep's status.
export function tablesOf(results) {
  const dimensions = [...sweepAxes, 'absorber']
      .map(name => ({name, values: unique(results.map(result => result[name]))}));
  const varying = dimensions.filter(({values}) => values.length > 1);
  const fixed = {name: null, values: [null]};
  const [columns = fixed, rows = fixed, ...rest] = varying;
  const tables = [];
  const split = (left, chosen) => {
    if (left.length > 0) {
      for (const value of left[0].values) split(left.slice(1), [...chosen, [left[0].name, value]]);
      return;
    }
    const cells = rows.values.map(row => columns.values.map(column => results.find(result =>
      chosen.every(([name, value]) => result[name] === value) &&
      (rows.name === null || result[rows.name] === row) &&
      (columns.name === null || result[columns.name] === column))));
    tables.push({
      title: chosen.map(([name, value]) => `${name} ${value}`).join(', '),
      columns, rows, cells,
    });
  };
  split(rest, []);
  return tables;
}

/// The state that shows a point of a sweep.
export function stateOfPoint(state, request, {absorption, roughness, scattering, absorber}) {
  const named = request.absorbers ?? [request.base.material.absorber];
  const own = /^absorber (\d+)$/.exec(absorber);
  return {
    ...state, absorption, roughness, scattering,
    absorber: own ? named[Number(own[1]) - 1] : absorber,
  };
}
