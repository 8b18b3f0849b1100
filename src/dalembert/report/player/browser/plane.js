// A scene in the plane as SVG, and a scene in space where there is no WebGL. It needs no library.
import { boxOf, decoded } from "./solids.js";

const SVG = "http://www.w3.org/2000/svg";
const MARGIN = 24; // pixels
const RADIUS = 5; // of a joint, in pixels
const CIRCLE = `M${-RADIUS} 0a${RADIUS} ${RADIUS} 0 1 0 ${2 * RADIUS} 0a${RADIUS} ${RADIUS} 0 1 0 ${-2 * RADIUS} 0`;

export function svgElement(parent, tag, attributes, text = "") {
  const one = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) one.setAttribute(name, value);
  one.textContent = text;
  parent.append(one);
  return one;
}

// A length of 1, 2 or 5 times a power of ten that is at most a given one.
function round(length) {
  const decade = 10 ** Math.floor(Math.log10(length));
  return decade * [5, 2, 1].find((digit) => digit * decade <= length);
}

export class Plane {
  // look: { series: colours of bodies, ink, paper }, which are read on a light and on a dark page
  constructor(root, look) {
    const svg = svgElement(root, "svg", { class: "player-plane" });
    Object.assign(this, { svg, look, frame: 0, yaw: -0.6, pitch: 0.35, box: null });
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
    else this.draw();
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
    const rooms = [this.width - 2 * MARGIN, this.height - 2 * MARGIN];
    const factor = Math.min(...ends.map(([first, last], k) => rooms[k] / Math.max(last - first, 0.2 * size)));
    const [across, up] = ends.map(([first, last]) => (first + last) / 2);
    this.factor = factor;
    this.at = (...position) => {
      const [x, y] = this.flat(...position);
      return [this.width / 2 + factor * (x - across), this.height / 2 - factor * (y - up)];
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
    const ink = { fill: "none", stroke: look.ink, "stroke-width": 1.25 }, words = { class: "player-name", fill: look.ink };
    const ring = { class: "player-joint", fill: look.paper, stroke: look.ink, "stroke-width": 2 };
    this.drawn = this.shapes.map((shape) => {
      const stroke = shape.colour < 0 ? look.ink : look.series[shape.colour % look.series.length];
      if (shape.kind === "crosses") return svgElement(svg, "path", { ...ink, class: "player-measured" });
      if (shape.role === "joint") return this.part(shape.name, { ...ring, d: shape.kind === "ground" ? "M0 0L-8 12H8Z" : CIRCLE });
      return this.part(shape.name, { class: "player-body", fill: "none", stroke, "stroke-width": shape.faces ? 0.5 : 5 });
    });
    this.names = this.shapes.map((shape) => (shape.role === "body" ? svgElement(svg, "text", words, shape.name) : null));
    const length = round(this.width / 4 / this.factor), end = this.width - 12, bottom = this.height - 10;
    svgElement(svg, "path", { ...ink, d: `M${end - length * this.factor} ${bottom - 5}v5h${length * this.factor}v-5` });
    svgElement(svg, "text", { ...words, x: end, y: bottom - 9, "text-anchor": "end" }, `${+length.toPrecision(1)} m`);
    this.draw();
  }

  part(name, style) {
    const one = svgElement(this.svg, "path", { ...style, "data-part": name, "stroke-linecap": "round", "stroke-linejoin": "round" });
    svgElement(one, "title", {}, name);
    return one;
  }

  draw() {
    if (!this.drawn) return;
    this.shapes.forEach((shape, k) => {
      const numbers = shape.at(this.frame), across = this.film.dimensions;
      const points = Array.from({ length: shape.count }, (_, one) => this.at(...numbers.subarray(one * across, (one + 1) * across)));
      if (shape.role === "joint") this.drawn[k].setAttribute("transform", `translate(${points[0].join(" ")})`);
      else this.drawn[k].setAttribute("d", this.path(shape, points));
      const [x, y] = points[shape.count >> 1] ?? [];
      if (x >= 0 || x < 0) this.names[k]?.setAttribute("transform", `translate(${x + 9} ${y - 9})`);
    });
  }

  // Commands of a path through pixels, with gaps where they are not known.
  path({ kind, faces }, points) {
    if (kind === "crosses") return points.map(([x, y]) => `M${x - 3} ${y - 3}l6 6m0 -6l-6 6`).join("");
    const at = points.map(([x, y]) => (Number.isNaN(x) ? "" : `${x.toFixed(1)} ${y.toFixed(1)}`));
    if (faces) return faces.map((face) => `M${face.map((corner) => at[corner]).join("L")}Z`).join("");
    return at.map((one, k) => one && (k && at[k - 1] ? "L" : "M") + one).join("");
  }

  turn(right, down) {
    this.yaw += right;
    this.pitch = Math.max(-1.57, Math.min(1.57, this.pitch + down));
    this.build();
  }
}
