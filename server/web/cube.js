// The cube as a picture: the current point, its shadows on the faces behind it, the lattice. The
// point, or one of its shadows, can be dragged; the background turns the cube.

import {Projection, axes} from './projection.js';

const reach = 14;          // px around a handle that count as it
const keyStep = 0.02;
const names = {absorption: 'absorption a', scattering: 'scattering s', roughness: 'roughness r'};
const keys = {
  ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowUp: [1, 1], ArrowDown: [1, -1],
  PageUp: [2, 1], PageDown: [2, -1],
};

export class CubeView {
  #canvas;
  #onMove;
  #point = [0.3, 0.3, 0.3];   // in the order of `axes`
  #marks = [];                // points of pinned views
  #yaw = -0.62;
  #pitch = 0.42;
  #color = '#999';
  #drag = null;
  #projection;

  /// `onMove({absorption, ...}, last)`: the point was moved; `last` where the drag is over.
  constructor(canvas, onMove) {
    this.#canvas = canvas;
    this.#onMove = onMove;
    canvas.addEventListener('pointerdown', event => this.#down(event));
    canvas.addEventListener('pointermove', event => this.#moved(event));
    for (const name of ['pointerup', 'pointercancel'])
      canvas.addEventListener(name, event => this.#up(event));
    canvas.addEventListener('keydown', event => this.#key(event));
    new ResizeObserver(() => this.draw()).observe(canvas);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.draw());
  }

  set({absorption, roughness, scattering}, color, marks) {
    this.#point = [absorption, scattering, roughness];
    this.#color = color;
    this.#marks = marks.map(mark => axes.map(axis => mark[axis]));
    this.draw();
  }

  /// Where the point is, in CSS pixels of the canvas.
  get pointOnCanvas() {
    const [x, y] = this.#projection.at(this.#point);
    return {x, y};
  }

  draw() {
    const canvas = this.#canvas, {clientWidth: width, clientHeight: height} = canvas;
    if (!width || !height) return;
    const dots = window.devicePixelRatio || 1;
    canvas.width = Math.round(width * dots);
    canvas.height = Math.round(height * dots);
    this.#projection = new Projection(this.#yaw, this.#pitch, width, height);
    const paint = canvas.getContext('2d');
    paint.scale(dots, dots);
    const style = getComputedStyle(canvas);
    paint.font = `12px ${style.fontFamily}`;
    paint.lineJoin = 'round';
    const ink = style.getPropertyValue('--ink').trim(), faint = style.getPropertyValue('--faint').trim();
    this.#drawFaces(paint, faint);
    this.#drawLattice(paint, faint);
    this.#drawShadows(paint, ink, faint);
    this.#drawPoint(paint, ink);
    this.#drawFront(paint, faint);
    this.#drawLabels(paint, ink);
  }

  #line(paint, from, to) {
    const [x, y] = this.#projection.at(from), [u, v] = this.#projection.at(to);
    paint.beginPath();
    paint.moveTo(x, y);
    paint.lineTo(u, v);
    paint.stroke();
  }

  #disk(paint, point, radius) {
    const [x, y] = this.#projection.at(point);
    paint.beginPath();
    paint.arc(x, y, radius, 0, 2 * Math.PI);
  }

  /// The twelve edges, those at the back or those in front.
  #edges(front) {
    const edges = [];
    for (let axis = 0; axis < 3; ++axis) {
      const [a, b] = [0, 1, 2].filter(other => other !== axis);
      for (const u of [0, 1])
        for (const v of [0, 1]) {
          const isFront = u !== this.#projection.backSide(a) && v !== this.#projection.backSide(b);
          if (isFront !== front) continue;
          const from = [0, 0, 0];
          from[a] = u;
          from[b] = v;
          const to = [...from];
          to[axis] = 1;
          edges.push([from, to]);
        }
    }
    return edges;
  }

  #drawFaces(paint, faint) {
    paint.strokeStyle = faint;
    paint.lineWidth = 1;
    for (const [from, to] of this.#edges(false)) this.#line(paint, from, to);
    paint.globalAlpha = 0.25;
    for (let axis = 0; axis < 3; ++axis) {
      const [a, b] = [0, 1, 2].filter(other => other !== axis);
      for (const t of [0.25, 0.5, 0.75])
        for (const [along, across] of [[a, b], [b, a]]) {
          const from = [0, 0, 0];
          from[axis] = this.#projection.backSide(axis);
          from[across] = t;
          const to = [...from];
          to[along] = 1;
          this.#line(paint, from, to);
        }
    }
    paint.globalAlpha = 1;
  }

  #drawFront(paint, faint) {
    paint.strokeStyle = faint;
    paint.globalAlpha = 0.45;
    for (const [from, to] of this.#edges(true)) this.#line(paint, from, to);
    paint.globalAlpha = 1;
  }

  #drawLattice(paint, faint) {
    paint.fillStyle = faint;
    const steps = [0, 0.25, 0.5, 0.75, 1];
    for (const a of steps)
      for (const s of steps)
        for (const r of steps) {
          const depth = this.#projection.at([a, s, r])[2];
          paint.globalAlpha = 0.35 - 0.25 * Math.max(-1, Math.min(1, depth));
          this.#disk(paint, [a, s, r], 1.2);
          paint.fill();
        }
    paint.globalAlpha = 1;
  }

  #shadow(axis) {
    const shadow = [...this.#point];
    shadow[axis] = this.#projection.backSide(axis);
    return shadow;
  }

  #drawShadows(paint, ink, faint) {
    paint.lineWidth = 1;
    for (let axis = 0; axis < 3; ++axis) {
      const shadow = this.#shadow(axis);
      paint.strokeStyle = ink;
      paint.globalAlpha = 0.55;
      paint.setLineDash([3, 3]);
      this.#line(paint, this.#point, shadow);
      paint.setLineDash([]);
      // On the face, to the edges that carry the numbers.
      paint.strokeStyle = faint;
      for (let other = 0; other < 3; ++other) {
        if (other === axis) continue;
        const edge = [...shadow];
        edge[other] = this.#projection.backSide(other);
        this.#line(paint, shadow, edge);
      }
      paint.globalAlpha = 0.5;
      paint.fillStyle = ink;
      this.#disk(paint, shadow, 4);
      paint.fill();
    }
    paint.globalAlpha = 1;
  }

  #drawPoint(paint, ink) {
    paint.strokeStyle = ink;
    for (const mark of this.#marks) {
      this.#disk(paint, mark, 4.5);
      paint.lineWidth = 1.5;
      paint.stroke();
    }
    this.#disk(paint, this.#point, 8);
    paint.fillStyle = this.#color;
    paint.fill();
    paint.lineWidth = 2;
    paint.stroke();
  }

  /// Each axis is named at its edge that is lowest or leftmost on the screen, outside of the cube.
  #drawLabels(paint, ink) {
    const {center} = this.#projection;
    paint.fillStyle = ink;
    paint.textBaseline = 'middle';
    for (let axis = 0; axis < 3; ++axis) {
      const edge = this.#labelEdge(axis);
      const place = (t, away) => {
        const point = [...edge];
        point[axis] = t;
        const [x, y] = this.#projection.at(point);
        const middle = [...edge];
        middle[axis] = 0.5;
        const [mx, my] = this.#projection.at(middle);
        const length = Math.hypot(mx - center[0], my - center[1]) || 1;
        const out = [(mx - center[0]) / length, (my - center[1]) / length];
        return {x: x + away * out[0], y: y + away * out[1], right: out[0]};
      };
      // Text begins where it is furthest out, so that it never crosses its edge.
      const write = (text, {x, y, right}) => {
        const {width} = paint.measureText(text);
        const left = x - width * (right > 0.25 ? 0 : right < -0.25 ? 1 : 0.5);
        paint.fillText(text, Math.min(Math.max(left, 2), 2 * center[0] - width - 2),
            Math.min(Math.max(y, 8), 2 * center[1] - 8));
      };
      write(names[axes[axis]], place(0.5, 12));
      write('0', place(0.04, 7));
      write('1', place(0.96, 7));
    }
  }

  #labelEdge(axis) {
    const [a, b] = [0, 1, 2].filter(other => other !== axis);
    let best = null, bestScore = -Infinity;
    for (const u of [0, 1])
      for (const v of [0, 1]) {
        const middle = [0.5, 0.5, 0.5];
        middle[a] = u;
        middle[b] = v;
        const [x, y] = this.#projection.at(middle);
        const vertical = axis === 1;
        // An edge of the outline: neither in front of the cube nor behind it.
        const outline = (u === this.#projection.backSide(a)) !== (v === this.#projection.backSide(b));
        const score = (outline ? 1e4 : 0) + (vertical ? -x : y);
        if (score > bestScore) {
          bestScore = score;
          best = [0, 0, 0];
          best[a] = u;
          best[b] = v;
        }
      }
    return best;
  }

  // ---- input

  #tell(last) {
    const [absorption, scattering, roughness] = this.#point;
    const round = value => Number(value.toFixed(3));
    this.#onMove({
      absorption: round(absorption), scattering: round(scattering), roughness: round(roughness),
    }, last);
  }

  #down(event) {
    const x = event.offsetX, y = event.offsetY;
    const near = point => {
      const [px, py] = this.#projection.at(point);
      return Math.hypot(px - x, py - y) <= reach;
    };
    // A shadow moves along its face, the point across the line of sight.
    let fixed = near(this.#point) ? this.#projection.depthAxis : null;
    for (let axis = 0; fixed === null && axis < 3; ++axis)
      if (near(this.#shadow(axis))) fixed = axis;
    this.#drag = {x, y, fixed, point: [...this.#point], yaw: this.#yaw, pitch: this.#pitch};
    this.#canvas.setPointerCapture(event.pointerId);
  }

  #moved(event) {
    const drag = this.#drag;
    if (!drag) return;
    const dx = event.offsetX - drag.x, dy = event.offsetY - drag.y;
    if (drag.fixed === null) {
      this.#yaw = drag.yaw + dx * 0.01;
      this.#pitch = Math.min(1.4, Math.max(-1.4, drag.pitch + dy * 0.01));
      this.draw();
      return;
    }
    this.#point = this.#projection.move(drag.point, dx, dy, drag.fixed);
    this.draw();
    this.#tell(false);
  }

  #up(event) {
    const drag = this.#drag;
    this.#drag = null;
    if (drag && drag.fixed !== null && event.type === 'pointerup') this.#tell(true);
  }

  #key(event) {
    const move = keys[event.key];
    if (!move || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    const [axis, direction] = move;
    const step = event.shiftKey ? 5 * keyStep : keyStep;
    this.#point[axis] = Math.min(1, Math.max(0, this.#point[axis] + direction * step));
    this.#tell(true);
  }
}
