// Plays the motion of a mechanism: its drawing, a button and the time. Notebooks and pages share it.
import { Scene, svgElement } from "./scene.js";

const TURN = 150; // pixels that turn a mechanism in space by one radian
const BY_KEY = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
const STYLE = `
.player-scene { display: block; width: 100%; height: clamp(180px, 27vh, 380px); touch-action: pan-y }
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
  // look: colours of the scene; label: for screen readers; onFrame(share): called with each frame that is shown.
  constructor(root, look, label, onFrame = () => {}) {
    Object.assign(this, { root, onFrame, playing: false });
    root.classList.add("player");
    element(root, "style", { textContent: STYLE });
    const svg = svgElement(root, "svg", { class: "player-scene", role: "img", "aria-label": label });
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
    this.scene = new Scene(svg, look);
    this.makeTurnable(svg);
    this.resizing = new ResizeObserver(() => this.scene.build());
    this.resizing.observe(svg);
    this.tell();
  }

  makeTurnable(svg) {
    let held = null;
    svg.addEventListener("pointerdown", (event) => {
      if (!this.scene.turns) return;
      held = [event.clientX, event.clientY];
      svg.setPointerCapture?.(event.pointerId);
    });
    svg.addEventListener("pointermove", (event) => {
      if (!held) return;
      this.scene.turn((event.clientX - held[0]) / TURN, (event.clientY - held[1]) / TURN);
      held = [event.clientX, event.clientY];
    });
    for (const end of ["pointerup", "pointercancel"]) svg.addEventListener(end, () => (held = null));
    svg.addEventListener("keydown", (event) => {
      if (!BY_KEY[event.key] || !this.scene.turns) return;
      event.preventDefault();
      this.scene.turn(...BY_KEY[event.key]);
    });
  }

  // Shows a newer film, which continues where the older one was, and plays it to its end.
  show(film, { plays = true } = {}) {
    this.scene.take(film);
    this.time.max = film.times.length - 1;
    if (plays && !this.playing && !matchMedia("(prefers-reduced-motion: reduce)").matches) this.play();
    else this.seek(this.scene.frame);
  }

  close() {
    this.resizing.disconnect();
    this.playing = false;
    cancelAnimationFrame(this.waiting);
  }

  get last() {
    return this.scene.film.times.length - 1;
  }

  seek(frame) {
    this.scene.frame = Math.max(0, Math.min(frame, this.last));
    this.scene.draw();
    this.tell();
  }

  play() {
    if (!this.scene.film) return;
    if (this.scene.frame >= this.last) this.scene.frame = 0;
    const passed = this.scene.frame / Math.max(this.last, 1), began = performance.now() - 1000 * passed * this.scene.film.seconds;
    this.playing = true;
    const step = (now) => {
      if (!this.playing) return;
      const frame = Math.floor(((now - began) / 1000 / this.scene.film.seconds) * this.last);
      if (frame >= this.last) this.playing = false;
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
    if (!this.scene.film) return;
    const { times } = this.scene.film, frame = this.scene.frame;
    const decimals = Math.max(0, 2 - Math.floor(Math.log10(Math.max(times.at(-1), 1e-12))));
    const time = `${times[frame].toFixed(decimals)} s`;
    this.time.value = frame;
    this.time.setAttribute("aria-valuetext", time);
    this.clock.textContent = `t = ${time}`;
    this.onFrame(frame / Math.max(this.last, 1));
  }
}
