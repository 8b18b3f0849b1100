// Plays the motion of a mechanism: its drawing, a button and the time. Notebooks and pages share it.
import { Plane } from "./plane.js";
import { svgElement } from "./shapes.js";
import { BY_KEY, RADIAN, Space } from "./space.js";

const STYLE = `
.player-scene { position: relative; width: 100%; height: clamp(180px, 27vh, 380px); touch-action: pan-y }
.player-plane { display: block; width: 100%; height: 100% }
.player-scene[tabindex="0"] { cursor: grab; touch-action: none }
.player-scene:focus-visible, .player-controls :focus-visible { outline: 2px solid currentColor; outline-offset: 2px }
.player-controls { display: flex; align-items: center; gap: 8px }
.player-controls button { width: 32px; height: 32px; flex: none; padding: 0; border: none; border-radius: 50%;
  background: none; color: inherit; cursor: pointer }
.player-controls button:hover { background: rgba(118, 129, 143, 0.25) }
.player-controls svg { display: block; width: 16px; height: 16px; margin: auto; fill: currentColor }
.player-controls input { flex: 1; min-width: 0; accent-color: var(--q-primary, auto) }
.player-controls output { min-width: 6.5em; font-variant-numeric: tabular-nums; text-align: right }
.player-name { font-size: 13px; user-select: none }
`;

export function element(parent, tag, properties = {}) {
  const one = Object.assign(document.createElement(tag), properties);
  parent.append(one);
  return one;
}

export class Player {
  // look: colours of the scene; label: for screen readers; onFrame(share): called with each frame that is shown;
  // options: of the scene.
  constructor(root, look, label, onFrame = () => {}, options = {}) {
    Object.assign(this, { root, onFrame, options, playing: false });
    root.classList.add("player");
    element(root, "style", { textContent: STYLE });
    this.view = element(root, "div", { className: "player-scene", role: "img", ariaLabel: label });
    const controls = element(root, "div", { className: "player-controls" });
    this.button = element(controls, "button", { type: "button", onclick: () => this.toggle() });
    this.sign = svgElement(svgElement(this.button, "svg", { viewBox: "0 0 16 16", "aria-hidden": true }), "path", {});
    this.time = element(controls, "input", { type: "range", min: 0, step: 1, value: 0, ariaLabel: "Time" });
    this.time.oninput = () => {
      const frame = Number(this.time.value); // before the pause, which shows the frame of the motion
      this.pause();
      this.seek(frame);
    };
    this.clock = element(controls, "output");
    this.look = look;
    this.tell();
  }

  // What draws a film: in space with WebGL where the browser has it.
  sceneOf(film) {
    const inSpace = film.dimensions === 3;
    if (this.scene && this.inSpace === inSpace) return this.scene;
    this.scene?.close();
    this.inSpace = inSpace;
    this.view.tabIndex = inSpace ? 0 : -1;
    const space = inSpace ? Space.on(this.view, this.look, this.options) : null;
    if (space) return space;
    const plane = new Plane(this.view, this.look, this.options);
    if (inSpace) this.makeTurnable(plane);
    return plane;
  }

  makeTurnable(plane) {
    plane.svg.addEventListener("pointermove", (event) => {
      if (event.buttons & 1) plane.turn(event.movementX / RADIAN, event.movementY / RADIAN);
    });
    this.view.addEventListener("keydown", (event) => {
      if (!BY_KEY[event.key]) return;
      event.preventDefault();
      plane.turn(...BY_KEY[event.key]);
    });
  }

  // Shows a newer film, which continues where the older one was, and plays it to its end.
  show(film, { plays = true } = {}) {
    this.scene = this.sceneOf(film);
    this.scene.take(film);
    this.time.max = film.times.length - 1;
    if (plays && !this.playing && !matchMedia("(prefers-reduced-motion: reduce)").matches) this.play();
    else this.seek(this.scene.frame);
  }

  recolour(look) {
    this.look = look;
    this.scene?.recolour(look);
  }

  close() {
    this.scene?.close();
    this.playing = false;
    cancelAnimationFrame(this.waiting);
  }

  get last() {
    return this.scene.film.times.length - 1;
  }

  // Steps of one pass: of a period one more, to its first frame.
  get steps() {
    return this.last + (this.scene.film.endless ? 1 : 0);
  }

  seek(frame) {
    this.scene.frame = Math.max(0, Math.min(frame, this.last));
    this.scene.draw();
    this.tell();
  }

  play() {
    if (!this.scene?.film) return;
    if (this.scene.frame >= this.last && !this.scene.film.endless) this.scene.frame = 0;
    const steps = this.steps, passed = this.scene.frame / Math.max(steps, 1), began = performance.now() - 1000 * passed * this.scene.film.seconds;
    this.playing = true;
    const step = (now) => {
      if (!this.playing) return;
      const { endless, seconds, times } = this.scene.film, since = Math.max(0, Math.floor(((now - began) / 1000 / seconds) * this.steps));
      const frame = endless ? since % times.length : since;
      if (!endless && frame >= this.last) this.playing = false;
      if (frame !== this.scene.frame || !this.playing) this.seek(frame);
      if (this.playing) this.waiting = requestAnimationFrame(step);
    };
    this.waiting = requestAnimationFrame(step);
    this.seek(this.scene.frame);
  }

  pause() {
    this.playing = false;
    this.tell();
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  // Shows the time, and what the button does.
  tell() {
    const name = this.playing ? "Pause" : "Play";
    if (this.button.ariaLabel !== name) {
      Object.assign(this.button, { ariaLabel: name, title: name });
      this.sign.setAttribute("d", this.playing ? "M3 2h4v12h-4zM9 2h4v12h-4z" : "M4 2l10 6l-10 6z");
    }
    if (!this.scene?.film) return;
    const { times, frames, quantity = "Time" } = this.scene.film, frame = this.scene.frame;
    const decimals = Math.max(0, 2 - Math.floor(Math.log10(Math.max(times.at(-1), 1e-12))));
    const time = times[frame].toFixed(decimals);
    Object.assign(this.time, { value: frame, ariaLabel: quantity });
    this.time.setAttribute("aria-valuetext", frames?.[frame] ?? `${time} seconds`);
    this.clock.textContent = frames?.[frame] ?? `t = ${time} s`;
    this.onFrame(frame / Math.max(this.last, 1));
  }
}
