// A slider whose position is the browser's: an older one from the studio does not move it back while it is dragged.
const BUSY = 500; // ms after the user's last move

export default {
  template: `<input type="range" min="0" step="1" @input="move">`,
  props: { position: Number },
  watch: {
    position: "place",
  },
  mounted() {
    this.place();
  },
  methods: {
    place() {
      if (performance.now() - (this.moved ?? -BUSY) >= BUSY) this.$el.value = this.position;
    },
    move() {
      this.moved = performance.now();
      this.$emit("moved", this.$el.valueAsNumber);
    },
  },
};
