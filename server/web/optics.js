// The cube's coordinates as optics of the reference thickness. Lengths in mm, coefficients in 1/mm.

export const referenceThickness = 10;

/// Peak absorption coefficient: the absorptance of d is a. Infinite at a = 1.
export function sigmaA(a, d = referenceThickness) {
  return a >= 1 ? Infinity : -Math.log1p(-a) / d;
}

/// GGX slope roughness: r is its square root.
export function alpha(r) {
  return r * r;
}

/// Scattering coefficient: the two-stream diffuse reflectance of d without absorption is s.
/// Infinite at s = 1; g: mean cosine of scattering.
export function sigmaS(s, g = 0, d = referenceThickness) {
  if (s >= 1) return Infinity;
  return (4 / 3) * s / (1 - s) / d / (1 - g);
}

/// A number for people: three digits, no more zeros than it needs.
export function digits(value) {
  if (!Number.isFinite(value)) return value > 0 ? '∞' : '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) return value.toExponential(1).replace('e+', 'e');
  return String(Number(value.toPrecision(3)));
}

export function percent(value) {
  return `${Number((100 * value).toPrecision(3))} %`;
}

/// What the three coordinates mean, as text.
export function meaning(axis, value, g = 0) {
  switch (axis) {
    case 'absorption':
      return {
        quantity: `${percent(value)} absorbed in 10 mm`,
        coefficient: `σₐ ${digits(sigmaA(value))} /mm`,
      };
    case 'roughness':
      return {quantity: `slope roughness α`, coefficient: `α ${digits(alpha(value))}`};
    default:
      return {
        quantity: `${percent(value)} reflected by 10 mm`,
        coefficient: `σₛ ${digits(sigmaS(value, g))} /mm`,
      };
  }
}
