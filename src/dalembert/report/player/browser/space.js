// A scene in space, drawn with WebGL: turned, moved and enlarged by pointer and keys, with labels above it.
import { BAR, barOf, boxOf, colourOf, decoded, svgElement } from "./shapes.js";
import { Solids, dot, plus, rgb } from "./solids.js";

const EYE = [0.5586, 0.3785], FIELD = (35 * Math.PI) / 360; // azimuth and height of the eye; half of the field of view
const REACH = 9; // pixels beside a thin part at which a click meets it
export const RADIAN = 150; // pixels of a turn by one radian
const MARKS = { chosen: [0.22, 0.53, 0.9], wrong: [0.88, 0.19, 0.19] };
export const BY_KEY = { ArrowLeft: [-0.15, 0], ArrowRight: [0.15, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
const VERTEX = `#version 300 es
uniform mat4 view; uniform float offset; in vec3 position; in vec3 colour; out vec3 at; out vec3 shade;
void main() { at = position; shade = colour; gl_Position = view * vec4(position, 1.0); gl_Position.z += offset * gl_Position.w; }`;
const FRAGMENT = `#version 300 es
precision highp float; uniform vec3 eye; uniform float lit; uniform float opacity; in vec3 at; in vec3 shade; out vec4 pixel;
void main() {
  float facing = abs(dot(normalize(cross(dFdx(at), dFdy(at))), normalize(eye - at))); // not a number on a line
  vec3 colour = lit > 0.0 ? shade * (0.62 + 0.5 * facing) : shade;
  pixel = vec4(min(colour, 1.0) * opacity, opacity);
}`;

function program(gl) {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.bindAttribLocation(made, 0, "position");
  gl.bindAttribLocation(made, 1, "colour");
  gl.linkProgram(made);
  return made;
}

export class Space {
  // root: holds canvas and labels; look: see colourOf; onChoose(part): called with the part that is clicked, or null;
  // complete: whether it is larger, with crosses and the name of the part below the pointer; scrolls: whether a finger
  // scrolls the page.
  static on(root, look, options = {}) {
    const canvas = document.createElement("canvas"), gl = canvas.getContext("webgl2", { antialias: true });
    return gl ? new Space(root, canvas, gl, look, options) : null;
  }

  constructor(root, canvas, gl, look, { onChoose = null, zooms = false, complete = false, scrolls = false }) {
    Object.assign(this, { root, canvas, gl, look, onChoose, complete, frame: 0, chosen: [], wrong: [], box: null, labels: [] });
    Object.assign(canvas.style, { display: "block", width: "100%", height: "100%", touchAction: scrolls ? "pan-y" : "none" });
    this.words = document.createElement("div");
    Object.assign(this.words.style, { position: "absolute", inset: "0", pointerEvents: "none", overflow: "hidden" });
    root.append(canvas, this.words);
    this.program = program(gl);
    this.buffers = [gl.createBuffer(), gl.createBuffer()];
    this.listen(zooms);
    if (complete) {
      canvas.addEventListener("pointermove", (event) => event.buttons || !this.triangles || this.say(event));
      canvas.addEventListener("pointerleave", () => this.hint?.remove());
    }
    this.sizes = new ResizeObserver(() => this.render());
    this.sizes.observe(root);
  }

  close() {
    this.sizes.disconnect();
    cancelAnimationFrame(this.waiting);
    this.gl.getExtension("WEBGL_lose_context")?.loseContext();
    this.canvas.remove();
    this.words.remove();
    this.overlay?.remove();
  }

  listen(zooms) {
    const { canvas, root } = this, held = new Map();
    const far = () => (held.size === 2 ? Math.hypot(...[0, 1].map((k) => [...held.values()][0][k] - [...held.values()][1][k])) : 0);
    canvas.addEventListener("pointerdown", (event) => {
      held.set(event.pointerId, [event.clientX, event.clientY]);
      this.begun = [event.clientX, event.clientY];
      canvas.setPointerCapture?.(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      const before = held.get(event.pointerId), apart = far();
      if (!before) return;
      held.set(event.pointerId, [event.clientX, event.clientY]);
      const [right, down] = [event.clientX - before[0], event.clientY - before[1]];
      if (held.size === 2) this.scale(apart / far());
      else if (event.shiftKey || event.buttons & 2) this.move(right, down);
      else this.turn(-right / RADIAN, -down / RADIAN);
    });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => held.delete(event.pointerId));
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("click", (event) => {
      if (this.onChoose && Math.hypot(event.clientX - this.begun[0], event.clientY - this.begun[1]) <= 4) this.onChoose(this.pick(event));
    });
    if (zooms)
      canvas.addEventListener("wheel", (event) => {
        event.preventDefault();
        this.scale(event.deltaY > 0 ? 1.12 : 1 / 1.12);
      });
    root.addEventListener("keydown", (event) => {
      if (BY_KEY[event.key] && event.target === root) {
        event.preventDefault();
        this.turn(...BY_KEY[event.key]);
      }
      if (zooms && (event.key === "+" || event.key === "-")) this.scale(event.key === "+" ? 0.8 : 1.25);
      if (zooms && event.key === "0") this.fit();
    });
  }

  // A newer scene is seen from where the older one was. A motion keeps the box of all motions so far.
  take(scene) {
    const moves = scene.times.length > 1;
    Object.assign(this, { film: scene, shapes: decoded(scene), frame: Math.min(this.frame, scene.times.length - 1) });
    const { low, high, grown } = (this.box = boxOf(this.shapes, 3, moves ? this.box : null));
    this.size = Math.max(Math.hypot(...plus(high, low, -1)), 1e-6);
    this.parts = [...new Set([...this.shapes.map((shape) => shape.part), "gravity gravity"])];
    this.name(moves);
    this.showBar();
    if (!this.target || (moves && grown)) this.fit();
    this.draw();
  }

  recolour(look) {
    this.look = look;
    this.name(this.film.times.length > 1);
    this.showBar();
    this.draw();
  }

  // The bar of the colours, beside the scene.
  showBar() {
    this.overlay?.remove();
    if (!this.film.bar) return;
    const height = Math.max(80, 0.66 * (this.root.clientHeight || 300));
    this.overlay = svgElement(this.root, "svg", { width: BAR, height: height + 20, viewBox: `0 -10 ${BAR} ${height + 20}`, "aria-hidden": true });
    Object.assign(this.overlay.style, { position: "absolute", right: 0, top: "12%", pointerEvents: "none" });
    this.overlay.append(barOf(this.film.bar, this.look, height));
  }

  // Name of the part below the pointer, or position and value there.
  say(event) {
    const part = this.pick(event), box = this.root.getBoundingClientRect(), { met } = this;
    const value = met ? met.weights.reduce((sum, weight, k) => sum + weight * this.solids.values[met.k + k], 0) : NaN;
    this.hint?.remove();
    this.canvas.title = Number.isNaN(value) ? (part ?? "") : "";
    if (Number.isNaN(value)) return;
    const place = [0, 1, 2].map((axis) => met.weights.reduce((sum, weight, k) => sum + weight * this.triangles[7 * (met.k + k) + axis], 0));
    const [x, y, z, size] = [...place, value].map((one) => +one.toPrecision(4));
    this.hint = this.element({ text: `x ${x}, y ${y}, z ${z} m: ${size}`, colour: this.look.ink });
    Object.assign(this.hint.style, { background: this.look.paper, border: `1px solid ${this.look.faint}`, borderRadius: "3px" });
    const left = Math.min(event.clientX - box.left + 14, box.width - this.hint.offsetWidth - 4);
    this.hint.style.transform = `translate(${left}px, ${Math.max(0, event.clientY - box.top - 24)}px)`;
  }

  // The picture as it is seen, with so many pixels a pixel.
  picture(ratio) {
    const { clientWidth: width, clientHeight: height } = this.root, svg = svgElement(null, "svg", { viewBox: `0 0 ${width} ${height}` });
    this.paint(ratio);
    svgElement(svg, "image", { width, height, href: this.canvas.toDataURL() });
    this.paint();
    if (this.film.bar) {
      const bar = svgElement(svg, "g", { transform: `translate(${width - BAR} ${0.15 * height})`, "font-family": "system-ui, sans-serif" });
      bar.append(barOf(this.film.bar, this.look, 0.66 * height));
    }
    const words = { "font-size": 12, "font-family": "system-ui, sans-serif" };
    for (const { element } of this.labels) {
      const [x, y] = element.style.transform.match(/-?[\d.]+/g) ?? [];
      if (element.style.display !== "none") svgElement(svg, "text", { ...words, x: +x + 4, y: +y + 13, fill: element.style.color }, element.textContent);
    }
    return svg;
  }

  fit() {
    if (!this.box) return;
    const [yaw, pitch] = this.target ? [this.yaw, this.pitch] : EYE;
    const [far, down] = this.complete ? [1.75, 0.1] : [2.1, 0], middle = plus(this.box.low, this.box.high).map((value) => value / 2);
    Object.assign(this, { target: plus(middle, [0, 0, -down * this.size]), far: far * this.size, yaw, pitch });
    this.render();
  }

  turn(right, down) {
    this.yaw += right;
    this.pitch = Math.max(-1.52, Math.min(1.52, this.pitch - down));
    this.render();
  }

  scale(factor) {
    if (Number.isFinite(factor)) this.far = Math.max(0.02 * this.size, Math.min(20 * this.size, this.far * factor));
    this.render();
  }

  move(right, down) {
    const { across, up } = this.axes(), pixel = (2 * this.far * Math.tan(FIELD)) / this.root.clientHeight;
    this.target = plus(plus(this.target, across, -right * pixel), up, down * pixel);
    this.render();
  }

  axes() {
    const [c, s, cp, sp] = [Math.cos(this.yaw), Math.sin(this.yaw), Math.cos(this.pitch), Math.sin(this.pitch)];
    return { across: [c, s, 0], up: [-sp * s, sp * c, cp], towards: [cp * s, -cp * c, sp] };
  }

  // Columns of the matrix from positions to the picture.
  matrix() {
    const { across, up, towards } = this.axes(), zoom = 1 / Math.tan(FIELD), aspect = this.root.clientWidth / this.root.clientHeight;
    const near = 0.01 * this.size, last = 50 * this.size, sum = (last + near) / (last - near);
    const rows = [across.map((one) => (one * zoom) / aspect), up.map((one) => one * zoom), towards.map((one) => -sum * one), towards.map((one) => -one)];
    const shift = rows.map((row) => -dot(row, this.target));
    shift[2] += sum * this.far - (2 * last * near) / (last - near);
    shift[3] += this.far;
    return [0, 1, 2, 3].flatMap((column) => rows.map((row, k) => (column < 3 ? row[column] : shift[k])));
  }

  // Pixels and depth of a position.
  pixel(view, point) {
    const [x, y, , w] = [0, 1, 2, 3].map((row) => view[row] * point[0] + view[4 + row] * point[1] + view[8 + row] * point[2] + view[12 + row]);
    return [(this.root.clientWidth * (1 + x / w)) / 2, (this.root.clientHeight * (1 - y / w)) / 2, w];
  }

  // Make triangles and lines of the frame.
  draw() {
    if (!this.shapes) return;
    const solids = new Solids(this.size, this.complete, this.film.bar), number = (part) => this.parts.indexOf(part);
    for (const shape of this.shapes) {
      const mark = this.wrong.includes(shape.part) ? "wrong" : this.chosen.includes(shape.part) ? "chosen" : null;
      solids.add(shape, this.frame, mark ? MARKS[mark] : rgb(colourOf(shape, this.look)), number(shape.part));
    }
    this.around = solids.surround(this.box.low, this.box.high, this.film.gravity, number);
    Object.assign(this, { solids, triangles: new Float32Array(solids.triangles), lines: new Float32Array(solids.lines), stale: true });
    this.render();
  }

  mark(chosen, wrong) {
    Object.assign(this, { chosen: chosen ?? [], wrong: wrong ?? [] });
    this.markLabels();
    this.draw();
  }

  markLabels() {
    for (const { element } of this.labels)
      if (element.dataset.part) {
        element.setAttribute("aria-pressed", this.chosen.includes(element.dataset.part));
        element.classList.toggle("chosen", this.chosen.includes(element.dataset.part));
        element.classList.toggle("wrong", this.wrong.includes(element.dataset.part));
      }
  }

  render() {
    if (this.waiting) return;
    this.waiting = requestAnimationFrame(() => {
      this.waiting = null;
      if (this.triangles && this.root.clientWidth && this.root.clientHeight) this.paint();
    });
  }

  paint(ratio = window.devicePixelRatio || 1) {
    const { gl, canvas, root } = this, view = this.matrix();
    const [width, height] = [Math.round(root.clientWidth * ratio), Math.round(root.clientHeight * ratio)];
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.useProgram(this.program);
    const uniform = (name) => gl.getUniformLocation(this.program, name);
    gl.uniformMatrix4fv(uniform("view"), false, view);
    gl.uniform3fv(uniform("eye"), plus(this.target, this.axes().towards, this.far));
    const { first, count } = this.solids.grid, all = this.lines.length / 7;
    for (const [k, numbers] of [this.triangles, this.lines].entries()) {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[k]);
      if (this.stale) gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.DYNAMIC_DRAW);
      for (const place of [0, 1]) {
        gl.enableVertexAttribArray(place);
        gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 28, 12 * place);
      }
      gl.uniform1f(uniform("lit"), k ? 0 : 1);
      gl.uniform1f(uniform("offset"), k ? -2e-5 : 0); // lines are in front of the faces that they lie on
      gl.uniform1f(uniform("opacity"), 1);
      if (!k) gl.drawArrays(gl.TRIANGLES, 0, numbers.length / 7);
      else {
        gl.drawArrays(gl.LINES, 0, first);
        gl.drawArrays(gl.LINES, first + count, all - first - count);
        gl.uniform1f(uniform("opacity"), 0.3);
        gl.drawArrays(gl.LINES, first, count);
      }
    }
    this.stale = false;
    this.place(view);
  }

  // Labels of a scene at rest, or names of bodies that move with them; and those of axes, floor and gravity.
  name(moves) {
    const ink = this.look.ink, colour = (number) => (number < 0 ? ink : this.look.series[number]);
    const bodies = this.shapes.filter((shape) => moves && shape.role === "body" && shape.name);
    const own = this.film.labels.map(({ role, name, at, text, colour: number }) => ({ part: `${role} ${name}`, at: () => at, text, colour: colour(number) }));
    const moving = bodies.map((shape) => ({ at: (frame) => this.middle(shape, frame), text: shape.name, colour: ink }));
    this.own = [...own, ...moving];
    this.words.replaceChildren();
    this.labels = [];
  }

  middle(shape, frame) {
    const numbers = shape.at(frame), k = 3 * (shape.count >> 1);
    return [...numbers.subarray(k, k + 3)];
  }

  element({ text, part, colour }) {
    const button = Boolean(part && this.onChoose), element = document.createElement(button ? "button" : "span");
    element.textContent = text;
    const shade = typeof colour === "string" ? colour : `rgb(${colour.map((one) => Math.round(255 * one)).join(" ")})`;
    Object.assign(element.style, { position: "absolute", left: 0, top: 0, color: shade, font: "12px system-ui, sans-serif", whiteSpace: "nowrap", pointerEvents: button ? "auto" : "none", padding: button ? "4px 6px" : "1px 4px", minWidth: "24px", minHeight: button ? "24px" : "" });
    if (button) {
      element.dataset.part = part;
      element.setAttribute("aria-label", part);
      element.addEventListener("click", () => this.onChoose(part));
    }
    this.words.append(element);
    return element;
  }

  // Move labels to their positions, and down where they would cover others.
  place(view) {
    if (!this.labels.length) {
      const around = this.around.map((label) => ({ ...label, at: () => label.at }));
      this.labels = [...this.own, ...around].map((label) => ({ ...label, element: this.element(label) }));
      for (const label of this.labels) Object.assign(label, { width: label.element.offsetWidth, height: label.element.offsetHeight });
      this.markLabels();
    }
    const boxes = this.labels.map((label) => {
      const [x, y, depth] = this.pixel(view, label.at(this.frame));
      return { ...label, left: x + 3, top: y - label.height, seen: depth > 0 && Number.isFinite(x) };
    });
    const taken = [];
    for (const { element, left, top, width, height, seen } of boxes.sort((a, b) => a.top - b.top)) {
      element.style.display = seen ? "" : "none";
      if (!seen) continue;
      let at = top;
      for (const other of taken) if (left < other.left + other.width && other.left < left + width && at < other.bottom && other.top < at + height) at = other.bottom;
      element.style.transform = `translate(${left.toFixed(1)}px, ${at.toFixed(1)}px)`;
      taken.push({ left, width, top: at, bottom: at + height });
    }
  }

  // The nearest part below the pointer, or a thin one beside it.
  pick(event) {
    const box = this.canvas.getBoundingClientRect(), [x, y] = [event.clientX - box.left, event.clientY - box.top], view = this.matrix();
    let nearest = Infinity, found = null;
    this.met = null; // the first corner of the nearest triangle, and shares of its corners at the pointer
    const corner = (list, k) => this.pixel(view, list.subarray(7 * k, 7 * k + 3));
    const side = (a, b) => (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
    for (let k = 0; k < this.triangles.length / 7; k += 3) {
      const [a, b, c] = [0, 1, 2].map((one) => corner(this.triangles, k + one)), signs = [side(a, b), side(b, c), side(c, a)];
      const depth = (a[2] + b[2] + c[2]) / 3, part = this.triangles[7 * k + 6];
      const inside = signs.some((one) => one) && (signs.every((one) => one >= 0) || signs.every((one) => one <= 0));
      if (part < 0 || depth >= nearest || !inside) continue;
      const sum = signs[0] + signs[1] + signs[2];
      [nearest, found, this.met] = [depth, part, { k, weights: [signs[1] / sum, signs[2] / sum, signs[0] / sum] }];
    }
    let closest = REACH;
    for (let k = 0; found === null && k < this.lines.length / 7; k += 2) {
      const [a, b] = [corner(this.lines, k), corner(this.lines, k + 1)], [u, v] = [b[0] - a[0], b[1] - a[1]];
      const share = Math.max(0, Math.min(1, ((x - a[0]) * u + (y - a[1]) * v) / (u * u + v * v || 1)));
      const distance = Math.hypot(a[0] + share * u - x, a[1] + share * v - y);
      if (this.lines[7 * k + 6] >= 0 && distance < closest) [closest, this.beside] = [distance, this.lines[7 * k + 6]];
    }
    if (found === null && closest < REACH) found = this.beside;
    return found === null ? null : this.parts[found];
  }
}
