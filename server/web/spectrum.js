// Absorption spectra: what they look like as a swatch, and as text of a user's.

/// CIE 1931 colour matching, the fit of Wyman, Sloan and Shirley 2013 (JCGT 2 (2), equation 4):
/// good enough to tell absorbers apart. The pictures are the service's.
function lobe(x, mean, below, above) {
  const t = (x - mean) * (x < mean ? below : above);
  return Math.exp(-0.5 * t * t);
}
function matching(nm) {
  return [
    0.362 * lobe(nm, 442.0, 0.0624, 0.0374) + 1.056 * lobe(nm, 599.8, 0.0264, 0.0323) -
        0.065 * lobe(nm, 501.1, 0.0490, 0.0382),
    0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322),
    1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725),
  ];
}

const toRgb = [
  [3.2404542, -1.5371385, -0.4985314],
  [-0.9692660, 1.8760108, 0.0415560],
  [0.0556434, -0.2040259, 1.0572252],
];

/// Linear RGB of an even light through exp(-density x k); `k` of a wavelength, 1 at its peak.
function through(k, density) {
  const sum = [0, 0, 0], white = [0, 0, 0];
  for (let nm = 390; nm <= 710; nm += 5) {
    const xyz = matching(nm), passed = Math.exp(-density * k(nm));
    for (let row = 0; row < 3; ++row) {
      const part = toRgb[row][0] * xyz[0] + toRgb[row][1] * xyz[1] + toRgb[row][2] * xyz[2];
      sum[row] += part * passed;
      white[row] += part;
    }
  }
  return sum.map((value, row) => value / white[row]);
}

/// Linear between the samples, constant beyond them; relative to the peak.
export function relativeSpectrum({wavelengths_nm: w, values: v}) {
  const peak = Math.max(...v);
  return nm => {
    if (nm <= w[0]) return v[0] / peak;
    for (let i = 1; i < w.length; ++i)
      if (nm <= w[i]) {
        const t = (nm - w[i - 1]) / (w[i] - w[i - 1]);
        return (v[i - 1] + t * (v[i] - v[i - 1])) / peak;
      }
    return v.at(-1) / peak;
  };
}

function encoded(linear) {
  const clipped = Math.min(1, Math.max(0, linear));
  const value = clipped <= 0.0031308 ? 12.92 * clipped : 1.055 * clipped ** (1 / 2.4) - 0.055;
  return Math.round(255 * value);
}

/// CSS colour of light through an absorber of this peak density (sigma_a times the length).
export function swatch(absorber, density = 1.4) {
  let rgb;
  if (absorber.rgb) rgb = absorber.rgb.map(k => Math.exp(-density * k));
  else rgb = through(relativeSpectrum(absorber), density);
  return `rgb(${rgb.map(encoded).join(' ')})`;
}

/// The {"rgb"} absorber through which this CSS colour (#rrggbb) is what is left of white: the
/// channels' densities, the largest 1. Neutral for white, which no absorber gives.
export function absorberOfColor(css) {
  const linear = [1, 3, 5].map(i => {
    const value = parseInt(css.slice(i, i + 2), 16) / 255;
    return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  });
  const densities = linear.map(value => -Math.log(Math.max(value, 1e-4)));
  const peak = Math.max(...densities);
  if (!(peak > 0)) return {rgb: [1, 1, 1]};
  return {rgb: densities.map(density => Number((density / peak).toFixed(4)))};
}

/// The colour that absorberOfColor would take back to these channels.
export function colorOfAbsorber({rgb}, density = 1.4) {
  const peak = Math.max(...rgb) || 1;
  return '#' + rgb.map(k => encoded(Math.exp(-density * k / peak)).toString(16).padStart(2, '0')).join('');
}

/// Lines of "wavelength value", separated by space, tab, comma or semicolon; what has no number is
/// taken for a heading. Throws what to say to the user.
export function parseSpectrum(text) {
  const rows = [];
  for (const [i, line] of text.split(/\r?\n/).entries()) {
    const parts = line.trim().split(/[\s,;]+/).filter(part => part !== '');
    if (parts.length === 0 || Number.isNaN(Number(parts[0]))) continue;
    const [wavelength, value] = parts.map(Number);
    if (parts.length < 2 || !Number.isFinite(wavelength) || !Number.isFinite(value))
      throw new Error(`Line ${i + 1} is not a wavelength and a value.`);
    rows.push([wavelength, value]);
  }
  if (rows.length < 2) throw new Error('Two lines or more, each a wavelength in nm and a value.');
  rows.sort((a, b) => a[0] - b[0]);
  return {wavelengths_nm: rows.map(row => row[0]), values: rows.map(row => row[1])};
}

export function spectrumText({wavelengths_nm, values}) {
  return wavelengths_nm.map((nm, i) => `${nm} ${values[i]}`).join('\n');
}
