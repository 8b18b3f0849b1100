// Plays the motion of a mechanism in SVG. A newer film continues where the older one was.
const SVG = "http://www.w3.org/2000/svg";
const MARGIN = 24, RADIUS = 5;

function numbersOf(text) {
  return new Float32Array(Uint8Array.from(atob(text), (one) => one.charCodeAt(0)).buffer);
}

// A length of 1, 2 or 5 times a power of ten that is at most a given one.
function round(length) {
  const decade = 10 ** Math.floor(Math.log10(length));
  return decade * [5, 2, 1].find((digit) => digit * decade <= length);
}

function made(parent, tag, attributes, text = "") {
  const one = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) one.setAttribute(name, value);
  one.textContent = text;
  parent.append(one);
  return one;
}

export default {
  template: `
    <div class="player">
      <svg ref="scene" class="player-scene" role="img" :aria-label="label" :tabindex="turns ? 0 : -1"
           @pointerdown="grab" @pointermove="drag" @pointerup="release" @keydown="turnByKey"></svg>
      <div class="player-controls">
        <q-btn flat round dense :icon="playing ? 'pause' : 'play_arrow'" :aria-label="playing ? 'Pause' : 'Play'"
               @click="toggle" />
        <input ref="time" type="range" min="0" value="0" step="1" aria-label="Time" @input="seek">
        <output ref="clock"></output>
      </div>
    </div>`,
  props: { film: Object, label: String },
  data: () => ({ playing: false, turns: false }),
  watch: {
    film() {
      this.take();
    },
  },
  created() {
    // not reactive: these change with each frame
    Object.assign(this, { frame: 0, phase: 0, yaw: -0.6, pitch: 0.35, box: null, began: 0, held: null });
  },
  mounted() {
    this.resizing = new ResizeObserver(() => this.build());
    this.resizing.observe(this.$refs.scene);
    this.take();
    this.present = true;
    this.announce();
  },
  unmounted() {
    this.present = false;
    this.resizing.disconnect();
    cancelAnimationFrame(this.waiting);
    this.$emit("hidden");
  },
  methods: {
    // Events before the handshake are lost.
    announce() {
      if (!this.present) return;
      if (window.did_handshake) this.$emit("shown");
      else setTimeout(() => this.announce(), 50);
    },
    take() {
      if (!this.film?.positions) return;
      const first = !this.positions, same = JSON.stringify(this.film.bodies) === this.built;
      this.positions = numbersOf(this.film.positions);
      this.turns = this.film.across === 3;
      this.widen();
      this.$refs.time.max = this.film.times.length - 1;
      if (first || !same || this.grown) this.build();
      const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
      if (!still && (first || !this.playing)) this.play();
      const taken = performance.timeOrigin + performance.now();
      requestAnimationFrame(() => {
        this.draw();
        Object.assign(this.$el.dataset, { taken, ...this.film.facts });
      });
    },
    // The box holds all motions so far, so that the picture does not jump while a value changes.
    widen() {
      const across = this.film.across, low = Array(across).fill(Infinity), high = Array(across).fill(-Infinity);
      const measure = (values) => values.forEach((value, place) => {
        if (!(Math.abs(value) < Infinity)) return;
        low[place % across] = Math.min(low[place % across], value);
        high[place % across] = Math.max(high[place % across], value);
      });
      measure(this.positions);
      Object.values(this.film.measured).forEach((points) => measure(points.flat()));
      const old = this.box?.low.length === across ? this.box : null;
      this.grown = !old || low.some((value, k) => value < old.low[k]) || high.some((value, k) => value > old.high[k]);
      if (this.grown && old) {
        low.forEach((value, k) => (low[k] = Math.min(value, old.low[k])));
        high.forEach((value, k) => (high[k] = Math.max(value, old.high[k])));
      }
      if (this.grown) this.box = { low, high };
    },
    // Coordinates of the picture from positions: as they are in the plane, seen from a direction in space.
    flat(x, y, z) {
      if (this.film.across === 2) return [x, y];
      const across = x * Math.cos(this.yaw) - y * Math.sin(this.yaw);
      const along = x * Math.sin(this.yaw) + y * Math.cos(this.yaw);
      return [across, z * Math.cos(this.pitch) + along * Math.sin(this.pitch)];
    },
    scale() {
      const { low, high } = this.box, space = this.film.across === 3;
      const corners = [];
      for (let corner = 0; corner < (space ? 8 : 4); corner++) {
        corners.push(this.flat(...low.map((value, k) => ((corner >> k) & 1 ? high[k] : value))));
      }
      const x = corners.map((one) => one[0]), y = corners.map((one) => one[1]);
      const [left, right, bottom, top] = [Math.min(...x), Math.max(...x), Math.min(...y), Math.max(...y)];
      const size = Math.max(right - left, top - bottom, 1e-9);
      const room = [this.width - 2 * MARGIN, this.height - 2 * MARGIN];
      const factor = Math.min(room[0] / Math.max(right - left, 0.2 * size), room[1] / Math.max(top - bottom, 0.2 * size));
      const middle = [(left + right) / 2, (bottom + top) / 2];
      this.factor = factor;
      this.place = (x, y, z) => {
        const [across, up] = this.flat(x, y, z);
        return [this.width / 2 + factor * (across - middle[0]), this.height / 2 - factor * (up - middle[1])];
      };
    },
    build() {
      const scene = this.$refs.scene;
      if (!this.positions || !scene.clientWidth) return;
      [this.width, this.height] = [scene.clientWidth, scene.clientHeight];
      scene.setAttribute("viewBox", `0 0 ${this.width} ${this.height}`);
      scene.replaceChildren();
      this.scale();
      this.crosses = made(scene, "path", { class: "player-measured" });
      this.lines = Object.keys(this.film.bodies).map((name, k) => {
        const one = made(scene, "path", { class: `player-body series-${k % 7}` });
        made(one, "title", {}, name);
        return one;
      });
      this.joints = Object.entries(this.film.joints).map(([name, fixed]) => {
        const one = made(scene, "path", { class: fixed ? "player-joint player-fixed" : "player-joint" });
        one.setAttribute("d", fixed ? "M0 0L-8 12H8Z" : `M${-RADIUS} 0a${RADIUS} ${RADIUS} 0 1 0 ${2 * RADIUS} 0a${RADIUS} ${RADIUS} 0 1 0 ${-2 * RADIUS} 0`);
        made(one, "title", {}, name);
        return one;
      });
      this.names = Object.keys(this.film.bodies).map((name) => made(scene, "text", { class: "player-name" }, name));
      const length = round((this.width / 4) / this.factor), end = this.width - 12, at = this.height - 10;
      const ruler = `M${end - length * this.factor} ${at - 5}v5h${length * this.factor}v-5`;
      made(scene, "path", { class: "player-ruler", d: ruler });
      const label = made(scene, "text", { class: "player-length", x: end, y: at - 9, "text-anchor": "end" });
      label.textContent = `${+length.toPrecision(1)} m`;
      this.built = JSON.stringify(this.film.bodies);
      this.draw();
    },
    draw() {
      if (!this.lines) return;
      const { across, times, bodies, measured } = this.film, frame = Math.min(this.frame, times.length - 1);
      const points = this.positions.length / across / times.length;
      let next = frame * points * across;
      const take = () => {
        const found = this.place(...this.positions.subarray(next, next + across));
        next += across;
        return found;
      };
      Object.values(bodies).forEach((count, k) => {
        let path = "", pen = "M", middle = null;
        for (let point = 0; point < count; point++) {
          const [x, y] = take();
          if (Number.isNaN(x)) pen = "M";
          else {
            path += `${pen}${x.toFixed(1)} ${y.toFixed(1)}`;
            pen = "L";
            if (point === count >> 1) middle = [x, y];
          }
        }
        this.lines[k].setAttribute("d", path);
        if (middle) this.names[k].setAttribute("transform", `translate(${middle[0] + 9} ${middle[1] - 9})`);
      });
      for (const joint of this.joints) joint.setAttribute("transform", `translate(${take().join(" ")})`);
      const marks = Object.values(measured).flat().map((one) => this.place(...one));
      this.crosses.setAttribute("d", marks.map(([x, y]) => `M${x - 3} ${y - 3}l6 6m0 -6l-6 6`).join(""));
      this.$refs.time.value = frame;
      const decimals = Math.max(0, 2 - Math.floor(Math.log10(Math.max(times.at(-1), 1e-12))));
      const time = `${times[frame].toFixed(decimals)} s`;
      this.$refs.clock.textContent = `t = ${time}`;
      this.$refs.time.setAttribute("aria-valuetext", time);
    },
    play() {
      if (this.frame >= this.film.times.length - 1) this.frame = 0;
      this.began = performance.now() - 1000 * this.share() * this.film.seconds;
      if (this.playing) return;
      this.playing = true;
      this.waiting = requestAnimationFrame(this.step);
    },
    share() {
      return this.frame / Math.max(this.film.times.length - 1, 1);
    },
    step(now) {
      if (!this.playing) return;
      const last = this.film.times.length - 1;
      const frame = Math.min(last, Math.floor(((now - this.began) / 1000 / this.film.seconds) * last));
      if (frame !== this.frame) {
        this.frame = Math.max(frame, 0);
        this.draw();
      }
      if (this.frame >= last) this.playing = false;
      else this.waiting = requestAnimationFrame(this.step);
    },
    toggle() {
      if (this.playing) this.playing = false;
      else if (this.positions) this.play();
    },
    seek(event) {
      this.playing = false;
      this.frame = Number(event.target.value);
      if (this.positions) this.draw();
    },
    grab(event) {
      if (!this.turns) return;
      this.held = [event.clientX, event.clientY];
      event.target.setPointerCapture?.(event.pointerId);
    },
    drag(event) {
      if (!this.held) return;
      this.turn((event.clientX - this.held[0]) / 150, (event.clientY - this.held[1]) / 150);
      this.held = [event.clientX, event.clientY];
    },
    release() {
      this.held = null;
    },
    turnByKey(event) {
      const by = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] }[event.key];
      if (!by || !this.turns) return;
      event.preventDefault();
      this.turn(...by);
    },
    turn(right, down) {
      this.yaw += right;
      this.pitch = Math.max(-1.57, Math.min(1.57, this.pitch + down));
      this.build();
    },
  },
};
