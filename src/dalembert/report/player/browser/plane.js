// The drawing of a mechanism in motion as SVG. It needs no library: notebooks and pages share it.
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

export class Scene {
  // look: { series: colours of bodies, ink, paper }, which are read on a light and on a dark page
  constructor(svg, look) {
    Object.assign(this, { svg, look, frame: 0, yaw: -0.6, pitch: 0.35, box: null });
  }

  get turns() {
    return this.film?.across === 3;
  }

  // A newer film continues where the older one was.
  take(film) {
    const parts = JSON.stringify([film.bodies, film.joints]), same = parts === this.parts;
    Object.assign(this, { film, parts });
    this.positions = new Float32Array(Uint8Array.from(atob(film.positions), (one) => one.charCodeAt(0)).buffer);
    this.frame = Math.min(this.frame, film.times.length - 1);
    this.svg.setAttribute("tabindex", this.turns ? 0 : -1);
    if (this.widen() || !same) this.build();
  }

  // The box holds all motions so far, so that the picture does not jump while a value changes.
  widen() {
    const across = this.film.across, low = Array(across).fill(Infinity), high = Array(across).fill(-Infinity);
    const measure = (values) => values.forEach((value, place) => {
      if (!Number.isFinite(value)) return;
      low[place % across] = Math.min(low[place % across], value);
      high[place % across] = Math.max(high[place % across], value);
    });
    measure(this.positions);
    Object.values(this.film.measured).forEach((points) => measure(points.flat()));
    const old = this.box?.low.length === across ? this.box : { low, high };
    const grown = old.low === low || low.some((value, k) => value < old.low[k]) || high.some((value, k) => value > old.high[k]);
    this.box = { low: low.map((value, k) => Math.min(value, old.low[k])), high: high.map((value, k) => Math.max(value, old.high[k])) };
    return grown;
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
    this.lines = null;
    if (!film || !svg.clientWidth) return;
    [this.width, this.height] = [svg.clientWidth, svg.clientHeight];
    svg.setAttribute("viewBox", `0 0 ${this.width} ${this.height}`);
    svg.replaceChildren();
    this.fit();
    const ink = { fill: "none", stroke: look.ink, "stroke-width": 1.25 }, words = { class: "player-name", fill: look.ink };
    this.crosses = svgElement(svg, "path", { ...ink, class: "player-measured" });
    const bodies = Object.keys(film.bodies);
    this.lines = bodies.map((name, k) => this.part(name, { class: "player-body", fill: "none", stroke: look.series[k % look.series.length], "stroke-width": 5 }));
    this.joints = Object.entries(film.joints).map(([name, fixed]) => {
      return this.part(name, { class: "player-joint", d: fixed ? "M0 0L-8 12H8Z" : CIRCLE, fill: look.paper, stroke: look.ink, "stroke-width": 2 });
    });
    this.names = bodies.map((name) => svgElement(svg, "text", words, name));
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
    if (!this.lines) return;
    const { across, times, bodies, measured } = this.film;
    let next = (this.frame * this.positions.length) / times.length;
    const take = () => this.at(...this.positions.subarray(next, (next += across)));
    Object.values(bodies).forEach((count, k) => {
      let path = "", pen = "M", middle = null;
      for (let point = 0; point < count; point++) {
        const [x, y] = take();
        if (Number.isNaN(x)) pen = "M";
        else {
          path += `${pen}${x.toFixed(1)} ${y.toFixed(1)}`;
          pen = "L";
          if (point === count >> 1) middle = [x + 9, y - 9];
        }
      }
      this.lines[k].setAttribute("d", path);
      if (middle) this.names[k].setAttribute("transform", `translate(${middle.join(" ")})`);
    });
    for (const joint of this.joints) joint.setAttribute("transform", `translate(${take().join(" ")})`);
    const marks = Object.values(measured).flat().map((one) => this.at(...one));
    this.crosses.setAttribute("d", marks.map(([x, y]) => `M${x - 3} ${y - 3}l6 6m0 -6l-6 6`).join(""));
  }

  turn(right, down) {
    this.yaw += right;
    this.pitch = Math.max(-1.57, Math.min(1.57, this.pitch + down));
    this.build();
  }
}
