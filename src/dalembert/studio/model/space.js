// A model in space whose parts are chosen by clicks, or by their names.
import { Space } from "dalembert-player/space.js";
import { toRaw } from "vue";

export default {
  template: `<div class="model-space" style="position:relative" tabindex="0" role="group"
    aria-label="The model in space; arrow keys turn it"></div>`,
  props: { scene: Object, look: Object, chosen: Array, wrong: Array },
  watch: {
    scene() { this.show(); },
    chosen() { this.mark(); },
    wrong() { this.mark(); },
  },
  mounted() {
    this.space = Space.on(this.$el, this.look, { zooms: true, onChoose: (part) => this.$emit("choose", part) });
    if (!this.space) this.$emit("unable");
    this.mark();
    this.show();
  },
  beforeUnmount() { this.space?.close(); },
  methods: {
    show() { if (this.scene?.shapes) this.space?.take(toRaw(this.scene)); },
    mark() { this.space?.mark(this.chosen, this.wrong); },
    fit() { this.space?.fit(); },
    scale(factor) { this.space?.scale(factor); },
  },
};
