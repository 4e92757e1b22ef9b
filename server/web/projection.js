// The cube on the screen: points of [0, 1]^3 (absorption right, scattering up, roughness back) to
// pixels and back. Orthographic: equal steps look equal wherever they are.

export const axes = ['absorption', 'scattering', 'roughness'];

export class Projection {
  /// Radians about the vertical, then about the horizontal; the size of the canvas in pixels.
  constructor(yaw, pitch, width, height) {
    const cy = Math.cos(yaw), sy = Math.sin(yaw), cp = Math.cos(pitch), sp = Math.sin(pitch);
    this.scale = 0.58 * Math.min(width, height);
    this.center = [width / 2, height / 2];
    /// What a unit step along each axis is on the screen (x right, y down, depth away).
    this.steps = [
      [cy, sy * sp, -sy * cp],
      [0, -cp, -sp],
      [sy, -cy * sp, cy * cp],
    ].map(([x, y, depth]) => [x * this.scale, y * this.scale, depth]);
  }

  /// [x, y, depth] of a point; larger depths are further away.
  at(point) {
    const out = [this.center[0], this.center[1], 0];
    for (let axis = 0; axis < 3; ++axis)
      for (let i = 0; i < 3; ++i) out[i] += (point[axis] - 0.5) * this.steps[axis][i];
    return out;
  }

  /// The axis that points most towards the viewer: a drag leaves it alone.
  get depthAxis() {
    return [0, 1, 2].reduce(
        (most, axis) => (Math.abs(this.steps[axis][2]) > Math.abs(this.steps[most][2]) ? axis : most), 0);
  }

  /// The point moved by pixels in the plane across `fixed`, kept in the cube.
  move(point, dx, dy, fixed) {
    const [a, b] = [0, 1, 2].filter(axis => axis !== fixed);
    const [ax, ay] = this.steps[a], [bx, by] = this.steps[b];
    const determinant = ax * by - ay * bx;
    const moved = [...point];
    if (Math.abs(determinant) < 1e-3 * this.scale * this.scale) return moved;
    moved[a] += (dx * by - dy * bx) / determinant;
    moved[b] += (dy * ax - dx * ay) / determinant;
    return moved.map(value => Math.min(1, Math.max(0, value)));
  }

  /// The side of the cube, 0 or 1, that is seen from inside: behind the point.
  backSide(axis) {
    return this.steps[axis][2] > 0 ? 1 : 0;
  }
}
