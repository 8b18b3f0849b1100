// Plays the motion of a mechanism in an SVG element. It needs no library: notebooks and pages share it.
const SVG = "http://www.w3.org/2000/svg";
const MARGIN = 24;
const TURN = 150; // pixels that turn a mechanism in space by one radian

export function svgElement(parent, tag, attributes, text = "") {
  const one = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) one.setAttribute(name, value);
  one.textContent = text;
  parent.append(one);
  return one;
}

export class Drawing {
  // look: { series: colours of bodies, ink }; onFrame(frame): called with each frame that is shown.
  constructor(scene, look, onFrame) {
    Object.assign(this, { scene, look, onFrame, frame: 0, playing: false, yaw: -0.56, pitch: 0.38, box: null });
    scene.addEventListener("pointerdown", (event) => this.grab(event));
    scene.addEventListener("pointermove", (event) => this.drag(event));
    scene.addEventListener("pointerup", () => (this.held = null));
    scene.addEventListener("keydown", (event) => this.turnByKey(event));
    this.resizing = new ResizeObserver(() => this.build());
    this.resizing.observe(scene);
  }

  close() {
    this.resizing.disconnect();
    this.playing = false;
    cancelAnimationFrame(this.waiting);
  }

  // A newer film continues where the older one was.
  show(film) {
    this.film = film;
    this.positions = new Float32Array(Uint8Array.from(atob(film.positions), (one) => one.charCodeAt(0)).buffer);
    this.frame = Math.min(this.frame, film.times.length - 1);
    this.scene.setAttribute("tabindex", film.across === 3 ? 0 : -1);
    this.widen();
    this.build();
  }

  // The box holds all motions so far, so that the picture does not jump while a value changes.
  widen() {
    const across = this.film.across;
    const kept = this.box?.low.length === across ? this.box : { low: Array(across).fill(Infinity), high: Array(across).fill(-Infinity) };
    this.positions.forEach((value, place) => {
      if (!Number.isFinite(value)) return;
      kept.low[place % across] = Math.min(kept.low[place % across], value);
      kept.high[place % across] = Math.max(kept.high[place % across], value);
    });
    this.box = kept;
  }

  // Coordinates of the picture: as they are in the plane, seen from a direction in space.
  flat(x, y, z) {
    if (this.film.across === 2) return [x, y];
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
    this.at = (...position) => {
      const [x, y] = this.flat(...position);
      return [this.width / 2 + factor * (x - across), this.height / 2 - factor * (y - up)];
    };
  }

  build() {
    const { scene, film, look } = this;
    if (!film || !scene.clientWidth) return;
    [this.width, this.height] = [scene.clientWidth, scene.clientHeight];
    scene.setAttribute("viewBox", `0 0 ${this.width} ${this.height}`);
    scene.replaceChildren();
    this.fit();
    const round = { fill: "none", "stroke-linecap": "round", "stroke-linejoin": "round" };
    this.lines = Object.keys(film.bodies).map((name, k) => {
      const one = svgElement(scene, "path", { ...round, stroke: look.series[k % look.series.length], "stroke-width": 5, "data-part": name });
      svgElement(one, "title", {}, name);
      return one;
    });
    this.joints = Object.entries(film.joints).map(([name, fixed]) => {
      const shape = fixed ? "M0 0L-8 13H8Z" : "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0";
      const one = svgElement(scene, "path", { d: shape, fill: "#fffffe", stroke: look.ink, "stroke-width": 2, "data-part": name });
      svgElement(one, "title", {}, name);
      return one;
    });
    this.draw();
  }

  draw() {
    const { across, times, bodies } = this.film;
    let next = (this.frame * this.positions.length) / times.length;
    const take = () => this.at(...this.positions.subarray(next, (next += across)));
    Object.values(bodies).forEach((count, k) => {
      let path = "", pen = "M";
      for (let point = 0; point < count; point++) {
        const [x, y] = take();
        if (Number.isNaN(x)) pen = "M";
        else {
          path += `${pen}${x.toFixed(1)} ${y.toFixed(1)}`;
          pen = "L";
        }
      }
      this.lines[k].setAttribute("d", path);
    });
    for (const joint of this.joints) joint.setAttribute("transform", `translate(${take().join(" ")})`);
    this.onFrame(this.frame);
  }

  seek(frame) {
    this.frame = Math.max(0, Math.min(frame, this.film.times.length - 1));
    this.draw();
  }

  play() {
    const last = this.film.times.length - 1;
    if (this.frame >= last) this.frame = 0;
    const began = performance.now() - (1000 * this.film.seconds * this.frame) / Math.max(last, 1);
    this.playing = true;
    const step = (now) => {
      if (!this.playing) return;
      const end = this.film.times.length - 1;
      this.seek(Math.floor(((now - began) / 1000 / this.film.seconds) * end));
      if (this.frame >= end) this.pause();
      else this.waiting = requestAnimationFrame(step);
    };
    this.waiting = requestAnimationFrame(step);
    this.onFrame(this.frame);
  }

  pause() {
    this.playing = false;
    this.onFrame(this.frame);
  }

  grab(event) {
    if (this.film?.across !== 3) return;
    this.held = [event.clientX, event.clientY];
    this.scene.setPointerCapture?.(event.pointerId);
  }

  drag(event) {
    if (!this.held) return;
    this.turn((event.clientX - this.held[0]) / TURN, (event.clientY - this.held[1]) / TURN);
    this.held = [event.clientX, event.clientY];
  }

  turnByKey(event) {
    const by = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] }[event.key];
    if (!by || this.film?.across !== 3) return;
    event.preventDefault();
    this.turn(...by);
  }

  turn(right, down) {
    this.yaw += right;
    this.pitch = Math.max(-1.57, Math.min(1.57, this.pitch + down));
    this.build();
  }
}
