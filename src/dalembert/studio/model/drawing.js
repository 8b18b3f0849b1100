// An SVG drawing whose parts are chosen by pointer and keys, zoomed by the wheel and moved by dragging.
const REACH = 9; // pixels beside a thin part at which a click still meets it

export default {
  template: `<div class="model-drawing" @click="click" @keydown="key" @dblclick="fit" @wheel.prevent="wheel"
    @pointerdown="down" @pointermove="move" @pointerup="up" @pointercancel="up"></div>`,
  props: { svg: String, chosen: Array, wrong: Array },
  watch: {
    svg() { this.show(); },
    chosen() { this.mark(); },
    wrong() { this.mark(); },
  },
  mounted() { this.show(); },
  methods: {
    show() {
      const focused = this.$el.contains(document.activeElement) ? this.part(document.activeElement) : null;
      this.$el.innerHTML = this.svg || "";
      const svg = this.$el.firstElementChild;
      if (!svg) return;
      svg.removeAttribute("width");
      svg.removeAttribute("height");
      this.whole = svg.getAttribute("viewBox").split(" ").map(Number);
      this.zoom(this.view || this.whole);
      this.mark();
      if (focused) this.groups().find((group) => this.part(group) === focused)?.focus({ preventScroll: true });
    },
    groups() { return [...this.$el.querySelectorAll("g[data-part]")]; },
    part(element) {
      const group = element?.closest?.("g[data-part]");
      return group ? `${group.classList[0]} ${group.dataset.part}` : null;
    },
    mark() {
      for (const group of this.groups()) {
        const name = this.part(group);
        group.classList.toggle("chosen", (this.chosen || []).includes(name));
        group.classList.toggle("wrong", (this.wrong || []).includes(name));
        group.setAttribute("aria-pressed", (this.chosen || []).includes(name));
      }
    },
    near(event) {
      const around = [[0, 0]];
      for (const radius of [REACH / 2, REACH])
        for (let k = 0; k < 8; k++) around.push([radius * Math.cos(k * 0.785), radius * Math.sin(k * 0.785)]);
      for (const [x, y] of around) {
        const found = this.part(document.elementFromPoint(event.clientX + x, event.clientY + y));
        if (found) return found;
      }
      return null;
    },
    click(event) {
      if (!this.dragged) this.$emit("choose", this.near(event));
      this.dragged = false;
    },
    key(event) {
      const name = this.part(event.target);
      if ((event.key === "Enter" || event.key === " ") && name) {
        event.preventDefault();
        this.$emit("choose", name);
      }
      if (event.key === "+" || event.key === "-") this.scale(event.key === "+" ? 0.8 : 1.25);
      if (event.key === "0") this.fit();
    },
    zoom(view) {
      this.view = view;
      this.$el.firstElementChild?.setAttribute("viewBox", view.join(" "));
    },
    fit() { if (this.whole) this.zoom(this.whole); },
    scale(factor, at) {
      if (!this.view) return;
      const [x, y, width, height] = this.view;
      const [px, py] = at || [x + width / 2, y + height / 2];
      const bounded = Math.min(Math.max(factor, (0.05 * this.whole[2]) / width), (2 * this.whole[2]) / width);
      this.zoom([px - (px - x) * bounded, py - (py - y) * bounded, width * bounded, height * bounded]);
    },
    at(event) {
      const matrix = this.$el.firstElementChild?.getScreenCTM?.();
      if (!matrix) return null;
      const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse());
      return [point.x, point.y];
    },
    wheel(event) { this.scale(event.deltaY > 0 ? 1.12 : 1 / 1.12, this.at(event)); },
    down(event) {
      this.held = event.button === 0 ? this.at(event) : null;
      this.begun = [event.clientX, event.clientY];
      this.dragged = false;
    },
    move(event) {
      if (!this.held || !event.buttons) return;
      const far = Math.hypot(event.clientX - this.begun[0], event.clientY - this.begun[1]) > 4;
      if (!far && !this.dragged) return;
      this.dragged = true;
      const [x, y] = this.at(event);
      this.zoom([this.view[0] + this.held[0] - x, this.view[1] + this.held[1] - y, this.view[2], this.view[3]]);
    },
    up() { this.held = null; },
  },
};
