// The player of motions as an element of a page.
import { Player } from "dalembert-player";
import { toRaw } from "vue";

export default {
  template: `<div class="player"></div>`,
  props: { film: Object, look: Object, label: String },
  watch: {
    film() {
      this.take();
    },
  },
  mounted() {
    this.player = new Player(this.$el, this.look, this.label);
    this.take();
    this.present = true;
    this.announce();
  },
  unmounted() {
    this.present = false;
    this.player.close();
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
      const taken = performance.timeOrigin + performance.now(), { facts } = this.film;
      this.player.show(toRaw(this.film));
      requestAnimationFrame(() => Object.assign(this.$el.dataset, { taken, ...facts }));
    },
  },
};
