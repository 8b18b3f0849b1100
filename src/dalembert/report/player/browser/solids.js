// Triangles and lines of the primitives of a scene in space. It needs no library.
const NEUTRAL = [0.46, 0.506, 0.56], AXES = [[0.85, 0.35, 0.15], [0.1, 0.62, 0.43], [0.22, 0.53, 0.9]];
const SIDES = [0.624, 0.765, 0.902]; // of finite elements, on their faces
const MOST_FACES = 10_000; // of a mesh whose sides are drawn
const FLOATS = 7; // of a corner: position, colour, number of the part

export const plus = (a, b, factor = 1) => [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = (a) => Math.hypot(...a);
const unit = (a) => a.map((value) => value / (length(a) || 1));

export function rgb(colour) {
  return [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16) / 255);
}

export class Solids {
  // size: of the scene in m; symbols are parts of it; crosses: whether measured positions are crosses, and not dots; bar:
  // colours of values. The corners of triangles have values then, which are not numbers where there are none.
  constructor(size, crosses = false, bar = null) {
    Object.assign(this, { size, crosses, bar, unit: 0.009 * size, triangles: [], lines: [], values: [] });
    Object.assign(this, { colour: NEUTRAL, part: -1, value: NaN, colours: bar?.colours.map(rgb) });
  }

  // Colour of a value, between those of the bar.
  shade(value) {
    const last = this.colours.length - 1, at = last * Math.max(0, Math.min(1, value / this.bar.highest)), k = Math.min(Math.floor(at), last - 1);
    return this.colours[k].map((one, place) => one + (at - k) * (this.colours[k + 1][place] - one));
  }

  corner(list, point) {
    list.push(point[0], point[1], point[2], ...this.colour, this.part);
    if (this.bar && list === this.triangles) this.values.push(this.value);
  }

  face(...points) {
    for (let k = 2; k < points.length; k++) for (const point of [points[0], points[k - 1], points[k]]) this.corner(this.triangles, point);
  }

  // A face whose corners have values and their colours.
  shadedFace(points, values, colours) {
    for (let k = 2; k < points.length; k++)
      for (const corner of [0, k - 1, k]) {
        Object.assign(this, { colour: colours[corner], value: values[corner] });
        this.corner(this.triangles, points[corner]);
      }
    this.value = NaN;
  }

  segment(a, b) {
    this.corner(this.lines, a);
    this.corner(this.lines, b);
  }

  // A tube with different radii at its ends: also a cone.
  tube(a, b, radius, end = radius, count = 12) {
    const along = unit(plus(b, a, -1)), side = Math.abs(along[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0];
    const u = unit(cross(side, along)), v = cross(along, u);
    const ring = (centre, r) => Array.from({ length: count }, (_, k) => plus(plus(centre, u, r * Math.cos((2 * Math.PI * k) / count)), v, r * Math.sin((2 * Math.PI * k) / count)));
    const first = ring(a, radius), last = ring(b, end);
    first.forEach((_, k) => this.face(first[k], first[(k + 1) % count], last[(k + 1) % count], last[k]));
    if (radius) this.face(...first);
    if (end) this.face(...last);
  }

  ball(centre, radius, count = 12) {
    const at = (k, l) => {
      const theta = (Math.PI * k) / count, phi = (2 * Math.PI * l) / count;
      return plus(centre, [Math.sin(theta) * Math.cos(phi), Math.sin(theta) * Math.sin(phi), Math.cos(theta)], radius);
    };
    for (let k = 0; k < count; k++) for (let l = 0; l < count; l++) this.face(at(k, l), at(k + 1, l), at(k + 1, l + 1), at(k, l + 1));
  }

  // Two rings about a point, one level and one upright.
  rings(centre, radius) {
    const count = 28;
    for (const turned of [(x, y) => [x, y, 0], (x, y) => [x, 0, y]]) {
      const at = (k) => plus(centre, turned(Math.cos((2 * Math.PI * k) / count), Math.sin((2 * Math.PI * k) / count)), radius);
      for (let k = 0; k < count; k++) this.tube(at(k), at(k + 1), 0.15 * radius, 0.15 * radius, 6);
    }
  }

  arrow(tail, along, size) {
    const neck = plus(tail, along, 0.7 * size);
    this.tube(tail, neck, 0.03 * size);
    this.tube(neck, plus(tail, along, size), 0.08 * size, 0);
  }

  spring(a, b) {
    const along = plus(b, a, -1);
    if (length(along) < 1e-9 * this.size) return this.ball(a, 1.4 * this.unit);
    const side = Math.abs(along[2]) < 0.9 * length(along) ? [0, 0, 1] : [1, 0, 0];
    const u = unit(cross(side, along)), v = cross(unit(along), u), radius = 2 * this.unit;
    const points = [a];
    for (let k = 0; k <= 96; k++) {
      const turn = (k / 96) * 16 * Math.PI, middle = plus(a, along, 0.15 + (0.7 * k) / 96);
      points.push(plus(plus(middle, u, radius * Math.cos(turn)), v, radius * Math.sin(turn)));
    }
    [...points, b].forEach((point, k, all) => k && this.tube(all[k - 1], point, radius / 7, radius / 7, 5));
  }

  dashes(a, b) {
    const along = plus(b, a, -1), count = Math.max(1, Math.round(length(along) / (3.5 * this.unit)));
    for (let k = 0; k < count; k++) this.segment(plus(a, along, k / count), plus(a, along, (k + 0.6) / count));
  }

  // A shape in a frame; number: of its part.
  add(shape, frame, colour, number) {
    Object.assign(this, { colour, part: number });
    const numbers = shape.at(frame), at = (k) => [numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]];
    const first = at(0), radius = this.unit, values = shape.valuesAt?.(frame), shades = values && Array.from(values, (value) => this.shade(value));
    switch (shape.kind) {
      case "surface":
      case "mesh":
        for (const face of shape.faces)
          if (values) this.shadedFace(face.map(at), face.map((k) => values[k]), face.map((k) => shades[k]));
          else this.face(...face.map(at));
        if (shape.kind === "mesh" && !values && shape.faces.length <= MOST_FACES) {
          this.colour = SIDES;
          for (const face of shape.faces) face.forEach((corner, k) => this.segment(at(corner), at(face[(k + 1) % face.length])));
        }
        break;
      case "line":
        if (shape.count === 1) this.ball(first, 3 * radius);
        for (let k = 1; k < shape.count; k++)
          if (length(plus(at(k), at(k - 1), -1)) > 1e-9 * this.size) {
            if (shape.role === "outline" || shape.role === "path") this.segment(at(k - 1), at(k));
            else if (shape.role === "axis") this.tube(at(k - 1), at(k), radius / 2, radius / 2, 6);
            else this.tube(at(k - 1), at(k), radius);
          }
        break;
      case "edges":
        for (let k = 0; k < shape.count; k += 2) this.segment(at(k), at(k + 1));
        break;
      case "dashes":
        this.dashes(first, at(1));
        break;
      case "crosses":
        if (this.crosses) {
          const arms = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
          for (let k = 0; k < shape.count; k++) for (const arm of arms) this.segment(plus(at(k), arm, -radius), plus(at(k), arm, radius));
          break;
        }
      // falls through
      case "points":
        for (let k = 0; k < shape.count; k++) {
          if (values) Object.assign(this, { colour: shades[k], value: values[k] });
          this.ball(at(k), (values ? 0.8 : 0.35) * radius, 5);
        }
        this.value = NaN;
        break;
      case "spring":
        this.spring(first, at(1));
        break;
      case "turn":
      case "ring":
        this.rings(first, 2.6 * radius);
        break;
      case "ground":
        this.ball(first, 1.4 * radius);
        this.tube(first, plus(first, [0, 0, -4 * radius]), 0, 2.6 * radius, 4);
        break;
      case "arrow": // a force on a structure is above the face that it pulls
        this.arrow(shape.role === "force" ? first : plus(first, shape.along, -14 * radius), shape.along, 14 * radius);
        break;
      default:
        this.ball(first, (shape.kind === "point" ? 0.8 : 1.4) * radius);
    }
  }

  // The floor, the axes and gravity around the corners low and high; returns labels.
  surround(low, high, gravity, numberOf) {
    const span = Math.max(high[0] - low[0], high[1] - low[1], 0.3 * this.size), step = 10 ** Math.floor(Math.log10(span / 2));
    const cell = span / step > 10 ? 2 * step : step, count = Math.ceil((0.6 * span) / cell), height = low[2] - 0.04 * this.size;
    const middle = plus(low, high).map((value) => value / 2), [x, y] = [0, 1].map((k) => Math.round(middle[k] / cell) * cell);
    Object.assign(this, { colour: NEUTRAL, part: -1 });
    const grid = this.lines.length;
    for (let k = -count; k <= count; k++) {
      this.segment([x + k * cell, y - count * cell, height], [x + k * cell, y + count * cell, height]);
      this.segment([x - count * cell, y + k * cell, height], [x + count * cell, y + k * cell, height]);
    }
    this.grid = { first: grid / FLOATS, count: (this.lines.length - grid) / FLOATS };
    const corner = [low[0] - 0.1 * this.size, low[1] - 0.1 * this.size, height], labels = [];
    for (const k of [0, 1, 2]) {
      const along = [0, 0, 0].map((_, at) => (at === k ? 1 : 0));
      this.colour = AXES[k];
      this.arrow(corner, along, 0.12 * this.size);
      labels.push({ at: plus(corner, along, 0.14 * this.size), text: "xyz"[k], colour: AXES[k] });
    }
    labels.push({ at: [x + 0.6 * count * cell, y - count * cell, height], text: `grid ${+cell.toPrecision(3)} m`, colour: NEUTRAL });
    if (gravity) {
      const tail = [high[0] + 0.12 * this.size, middle[1], high[2]];
      Object.assign(this, { colour: NEUTRAL, part: numberOf("gravity gravity") });
      this.arrow(tail, gravity, 0.12 * this.size);
      labels.push({ at: tail, text: "g", part: "gravity gravity", colour: NEUTRAL });
    }
    return labels;
  }
}
