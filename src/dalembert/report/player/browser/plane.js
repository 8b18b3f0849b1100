// A scene in the plane as SVG, and a scene in space where there is no WebGL. It needs no library.
import { boxOf, colourOf, decoded, svgElement } from "./shapes.js";

const MARGIN = 24, BESIDE = 56, BELOW = 34; // pixels; beside and below the picture with the values of axes
const RADIUS = 5; // of a joint, in pixels
const CIRCLE = `M${-RADIUS} 0a${RADIUS} ${RADIUS} 0 1 0 ${2 * RADIUS} 0a${RADIUS} ${RADIUS} 0 1 0 ${-2 * RADIUS} 0`;

// A length of 1, 2 or 5 times a power of ten that is at most a given one.
function round(length) {
  const decade = 10 ** Math.floor(Math.log10(length));
  return decade * [5, 2, 1].find((digit) => digit * decade <= length);
}

export class Plane {
  // look: see colourOf; complete: whether the axes have values, in place of the length of a bar
  constructor(root, look, { complete = false } = {}) {
    const svg = svgElement(root, "svg", { class: "player-plane" });
    Object.assign(this, { svg, look, complete, frame: 0, yaw: -0.6, pitch: 0.35, box: null });
    this.sizes = new ResizeObserver(() => this.build());
    this.sizes.observe(svg);
  }

  close() {
    this.sizes.disconnect();
    this.svg.remove();
  }

  // A newer film continues where the older one was.
  take(film) {
    const shapes = decoded(film), parts = shapes.map(({ kind, part }) => kind + part).join(), same = parts === this.parts;
    Object.assign(this, { film, shapes, parts, turns: film.dimensions === 3 });
    this.frame = Math.min(this.frame, film.times.length - 1);
    const old = this.box?.low.length === film.dimensions ? this.box : null;
    this.box = boxOf(shapes, film.dimensions, old); // of all motions so far: the picture does not jump while a value changes
    if (this.box.grown || !same) this.build();
    else this.draw(true);
  }

  recolour(look) {
    this.look = look;
    this.build();
  }

  // The picture as it is seen.
  picture() {
    const copy = this.svg.cloneNode(true);
    copy.setAttribute("font-family", "system-ui, sans-serif");
    return copy;
  }

  // Coordinates of the picture: as they are in the plane, seen from a direction in space.
  flat(x, y, z) {
    if (!this.turns) return [x, y];
    const along = x * Math.sin(this.yaw) + y * Math.cos(this.yaw);
    return [x * Math.cos(this.yaw) - y * Math.sin(this.yaw), z * Math.cos(this.pitch) + along * Math.sin(this.pitch)];
  }

  fit() {
    const { low, high } = this.box;
    const corners = Array.from({ length: 2 ** low.length }, (_, corner) => this.flat(...low.map((value, k) => ((corner >> k) & 1 ? high[k] : value))));
    const ends = [0, 1].map((k) => corners.map((one) => one[k])).map((all) => [Math.min(...all), Math.max(...all)]);
    const size = Math.max(...ends.map(([first, last]) => last - first), 1e-9);
    const hasAxes = this.complete && !this.turns, [beside, below] = hasAxes ? [BESIDE, BELOW] : [MARGIN, MARGIN];
    const rooms = [this.width - beside - MARGIN, this.height - below - MARGIN];
    const factor = Math.min(...ends.map(([first, last], k) => rooms[k] / Math.max(last - first, 0.2 * size)));
    const [across, up] = ends.map(([first, last]) => (first + last) / 2);
    const centre = [beside + rooms[0] / 2, MARGIN + rooms[1] / 2];
    Object.assign(this, { factor, hasAxes });
    this.at = (...position) => {
      const [x, y] = this.flat(...position);
      return [centre[0] + factor * (x - across), centre[1] - factor * (y - up)];
    };
  }

  build() {
    const { svg, film, look } = this;
    this.drawn = null;
    if (!film || !svg.clientWidth) return;
    [this.width, this.height] = [svg.clientWidth, svg.clientHeight];
    svg.setAttribute("viewBox", `0 0 ${this.width} ${this.height}`);
    svg.replaceChildren();
    this.fit();
    const ink = { fill: "none", stroke: look.ink, "stroke-width": 1.25 };
    const words = { class: "player-name", fill: look.ink, "font-size": 13 };
    const ring = { class: "player-joint", fill: look.paper, stroke: look.ink, "stroke-width": 2 };
    this.drawn = this.shapes.map((shape) => {
      const { role } = shape, stroke = colourOf(shape, look), line = { fill: "none", stroke, class: `player-${role}` };
      if (shape.kind === "crosses") return this.part(`${shape.name} measured`, { ...ink, class: "player-measured" });
      if (role === "outline") return svgElement(svg, "path", { ...line, "stroke-width": 3 });
      if (role === "path") return this.part(`path of ${shape.name}`, { ...line, "stroke-width": 1.5, "stroke-dasharray": "1.5 4" });
      if (role === "axis") return this.part(`${shape.name} axis`, { ...line, "stroke-width": 2 });
      if (role === "joint") return this.part(shape.name, { ...ring, d: shape.kind === "ground" ? "M0 0L-8 12H8Z" : CIRCLE });
      return this.part(shape.name, { ...line, "stroke-width": shape.faces ? 0.5 : 5 });
    });
    this.names = this.shapes.map((shape) => (shape.role === "body" ? svgElement(svg, "text", words, shape.name) : null));
    if (this.hasAxes) this.scales();
    else this.bar(ink, words);
    this.draw(true);
  }

  // Values at the lower and the left edge.
  scales() {
    const style = { fill: this.look.muted, "font-size": 12 }, tick = { stroke: this.look.muted, fill: "none" };
    const bottom = this.height - BELOW, step = round((Math.min(this.width, 1.4 * this.height) / 4) / this.factor);
    const [zero, high] = [this.at(0, 0), this.at(step, step)], size = high[0] - zero[0];
    const value = (k) => String(+(k * step).toPrecision(6)).replace("-", "−");
    for (let k = Math.ceil((BESIDE - zero[0]) / size); zero[0] + k * size <= this.width - 12; k++) {
      const x = zero[0] + k * size;
      svgElement(this.svg, "path", { ...tick, d: `M${x} ${bottom}v4` });
      svgElement(this.svg, "text", { ...style, x, y: bottom + 16, "text-anchor": "middle" }, value(k));
    }
    for (let k = Math.ceil((zero[1] - bottom) / size); zero[1] - k * size >= 12; k++) {
      const y = zero[1] - k * size;
      svgElement(this.svg, "path", { ...tick, d: `M${BESIDE} ${y}h-4` });
      svgElement(this.svg, "text", { ...style, x: BESIDE - 7, y: y + 4, "text-anchor": "end" }, value(k));
    }
    svgElement(this.svg, "path", { ...tick, d: `M${BESIDE} 4V${bottom}H${this.width - 4}` });
    svgElement(this.svg, "text", { ...style, x: this.width - 6, y: this.height - 3, "text-anchor": "end" }, "x (m)");
    svgElement(this.svg, "text", { ...style, x: 4, y: 14 }, "y (m)");
  }

  // The length of a bar, as a scale.
  bar(ink, words) {
    const { svg } = this, length = round(this.width / 4 / this.factor), end = this.width - 12, bottom = this.height - 10;
    svgElement(svg, "path", { ...ink, d: `M${end - length * this.factor} ${bottom - 5}v5h${length * this.factor}v-5` });
    svgElement(svg, "text", { ...words, x: end, y: bottom - 9, "text-anchor": "end" }, `${+length.toPrecision(1)} m`);
  }

  part(name, style) {
    const one = svgElement(this.svg, "path", { ...style, "data-part": name, "stroke-linecap": "round", "stroke-linejoin": "round" });
    svgElement(one, "title", {}, name);
    return one;
  }

  // Moves what moves in the frame; all: what is at rest too.
  draw(all = false) {
    if (!this.drawn) return;
    this.shapes.forEach((shape, k) => {
      if (!all && shape.frames === 1) return;
      const numbers = shape.at(this.frame), across = this.film.dimensions;
      const points = Array.from({ length: shape.count }, (_, one) => this.at(...numbers.subarray(one * across, (one + 1) * across)));
      if (shape.role === "joint") this.drawn[k].setAttribute("transform", `translate(${points[0].join(" ")})`);
      else this.drawn[k].setAttribute("d", this.path(shape, points));
      const [x, y] = points[shape.count >> 1] ?? [], name = this.names[k];
      if (!name || Number.isNaN(x)) return;
      const isLast = x + 9 + 7 * shape.name.length > this.width;
      name.setAttribute("transform", `translate(${isLast ? x - 9 : x + 9} ${y - 9})`);
      name.setAttribute("text-anchor", isLast ? "end" : "start");
    });
  }

  // Commands of a path through pixels, with gaps where they are not known.
  path({ kind, faces }, points) {
    if (kind === "crosses") return points.map(([x, y]) => `M${x - 3} ${y - 3}l6 6m0 -6l-6 6`).join("");
    const at = points.map(([x, y]) => (Number.isNaN(x) ? "" : `${x.toFixed(1)} ${y.toFixed(1)}`));
    if (kind === "edges") return at.map((one, k) => `${k % 2 ? "L" : "M"}${one}`).join("");
    if (faces) return faces.map((face) => `M${face.map((corner) => at[corner]).join("L")}Z`).join("");
    return at.map((one, k) => one && (k && at[k - 1] ? "L" : "M") + one).join("");
  }

  turn(right, down) {
    this.yaw += right;
    this.pitch = Math.max(-1.57, Math.min(1.57, this.pitch + down));
    this.build();
  }
}
