// A model in three dimensions, turned and zoomed by pointer and keys; its parts are chosen by clicks, or by their names.
import { CSS2DObject, CSS2DRenderer, OrbitControls, THREE } from "nicegui-scene";

const CHOSEN = 0x3987e5;
const WRONG = 0xe03131;
const vector = (point) => new THREE.Vector3(...point);

// Lines without gaps, from points with gaps.
function strokes(points) {
  const found = [[]];
  for (const point of points) {
    if (point[0] === null) found.push([]);
    else found.at(-1).push(vector(point));
  }
  return found.filter((line) => line.length > 1);
}

function tube(line, radius) {
  const path = new THREE.CurvePath();
  for (let k = 1; k < line.length; k++)
    if (line[k].distanceTo(line[k - 1]) > 1e-9) path.add(new THREE.LineCurve3(line[k - 1], line[k]));
  return path.curves.map((curve) => new THREE.TubeGeometry(curve, 1, radius, 10));
}

function helix(first, second, radius) {
  const along = second.clone().sub(first);
  const side = Math.abs(along.z) < 0.9 * along.length() ? new THREE.Vector3(0, 0, 1) : new THREE.Vector3(1, 0, 0);
  const u = side.cross(along).normalize().multiplyScalar(radius);
  const v = along.clone().cross(u).normalize().multiplyScalar(radius);
  const points = [first];
  for (let k = 0; k <= 96; k++) {
    const turn = (k / 96) * 16 * Math.PI;
    points.push(first.clone().addScaledVector(along, 0.15 + (0.7 * k) / 96).addScaledVector(u, Math.cos(turn)).addScaledVector(v, Math.sin(turn)));
  }
  return [new THREE.TubeGeometry(new THREE.CatmullRomCurve3([...points, second]), 200, radius / 7, 6)];
}

export default {
  template: `<div class="model-space" style="position:relative" tabindex="0" role="group"
    aria-label="The model in space; arrow keys turn it" @keydown="key"><canvas style="display:block"></canvas></div>`,
  props: { scene: Object, chosen: Array, wrong: Array },
  watch: {
    scene() { this.build(); },
    chosen() { this.mark(); },
    wrong() { this.mark(); },
  },
  mounted() {
    const canvas = this.$el.firstElementChild;
    try {
      this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, canvas });
    } catch {
      this.$emit("unable");
      return;
    }
    this.world = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(35, 1, 0.001, 1000);
    this.camera.up.set(0, 0, 1);
    this.world.add(new THREE.HemisphereLight(0xffffff, 0x8899aa, 2.2));
    this.lamp = new THREE.DirectionalLight(0xffffff, 1.4);
    this.world.add(this.lamp);
    this.words = new CSS2DRenderer();
    Object.assign(this.words.domElement.style, { position: "absolute", inset: "0", pointerEvents: "none", overflow: "hidden" });
    this.$el.appendChild(this.words.domElement);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.render());
    canvas.addEventListener("pointerdown", (event) => (this.begun = [event.clientX, event.clientY]));
    canvas.addEventListener("click", (event) => this.click(event));
    this.sizes = new ResizeObserver(() => this.resize());
    this.sizes.observe(this.$el);
    this.build();
  },
  beforeUnmount() {
    this.sizes?.disconnect();
    this.controls?.dispose();
    this.renderer?.dispose();
  },
  methods: {
    build() {
      if (!this.renderer || !this.scene?.shapes) return;
      this.clear();
      this.group = new THREE.Group();
      this.world.add(this.group);
      this.low = vector(this.scene.low);
      this.high = vector(this.scene.high);
      this.size = Math.max(this.high.distanceTo(this.low), 1e-6);
      this.taken = new Map();
      for (const shape of this.scene.shapes) for (const object of this.objects(shape)) this.add(object, shape.part);
      for (const label of this.scene.labels) this.label(label);
      this.surround();
      if (!this.looked) this.fit();
      this.mark();
    },
    clear() {
      this.group?.traverse((object) => {
        object.geometry?.dispose();
        object.material?.dispose?.();
        object.element?.remove();
      });
      this.group?.removeFromParent();
    },
    add(object, part) {
      object.userData.part = part;
      this.group.add(object);
    },
    objects({ kind, part, points, colour, triangles, along }) {
      const solid = () => new THREE.MeshStandardMaterial({ color: colour, roughness: 0.7, metalness: 0.05, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }); // behind lines on it
      const unit = 0.009 * this.size;
      const solids = (geometries) => geometries.map((geometry) => new THREE.Mesh(geometry, solid()));
      const at = (geometry, point) => geometry.translate(...point);
      const first = points[0];
      switch (kind) {
        case "surface":
        case "mesh": {
          const geometry = new THREE.BufferGeometry();
          geometry.setAttribute("position", new THREE.Float32BufferAttribute(points.flat(), 3));
          geometry.setIndex(triangles);
          const flat = geometry.toNonIndexed();
          flat.computeVertexNormals();
          return solids([flat]);
        }
        case "line":
          return solids(points.length === 1 ? [at(new THREE.SphereGeometry(3 * unit, 24, 16), first)] : strokes(points).flatMap((line) => tube(line, unit)));
        case "dashes":
        case "edges": {
          const geometry = new THREE.BufferGeometry().setFromPoints(points.map(vector));
          const dashed = new THREE.LineDashedMaterial({ color: colour, dashSize: 2 * unit, gapSize: 1.5 * unit });
          const line = new THREE.LineSegments(geometry, kind === "dashes" ? dashed : new THREE.LineBasicMaterial({ color: colour }));
          return [line.computeLineDistances()];
        }
        case "crosses":
        case "points": {
          const geometry = new THREE.BufferGeometry().setFromPoints(points.map(vector));
          return [new THREE.Points(geometry, new THREE.PointsMaterial({ color: colour, size: unit }))];
        }
        case "spring":
          if (vector(first).distanceTo(vector(points[1])) < 1e-9 * this.size) return solids([at(new THREE.SphereGeometry(1.4 * unit, 20, 14), first)]);
          return solids(helix(vector(first), vector(points[1]), 2 * unit));
        case "turn":
        case "ring":
          return solids([at(new THREE.TorusGeometry(2.6 * unit, 0.4 * unit, 8, 32).rotateX(Math.PI / 2), first), at(new THREE.TorusGeometry(2.6 * unit, 0.4 * unit, 8, 32), first)]);
        case "ground":
          return solids([at(new THREE.SphereGeometry(1.4 * unit, 20, 14), first), at(new THREE.ConeGeometry(2.6 * unit, 4 * unit, 4).rotateX(Math.PI / 2).translate(0, 0, -2 * unit), first)]);
        case "arrow":
          return this.arrow(vector(first).addScaledVector(vector(along), part.startsWith("force ") ? 0 : -14 * unit), vector(along), 14 * unit, colour); // a force on a structure is above the face that it pulls
        default:
          return solids([at(new THREE.SphereGeometry((kind === "point" ? 0.8 : 1.4) * unit, 20, 14), first)]);
      }
    },
    arrow(tail, along, length, colour) {
      const arrow = new THREE.ArrowHelper(along.clone().normalize(), tail, length, colour, 0.3 * length, 0.15 * length);
      const shaft = new THREE.CylinderGeometry(0.03 * length, 0.03 * length, 0.75 * length).translate(0, 0.375 * length, 0);
      const thick = new THREE.Mesh(shaft, new THREE.MeshStandardMaterial({ color: colour }));
      thick.quaternion.copy(arrow.quaternion);
      thick.position.copy(tail);
      arrow.line.visible = false;
      arrow.cone.userData.part = undefined;
      return [arrow, thick];
    },
    // Move names down that would cover others.
    spread() {
      const names = [...this.words.domElement.children].filter((one) => one.style.display !== "none");
      for (const one of names) one.style.translate = "";
      const taken = [];
      const boxes = names.map((one) => [one, one.getBoundingClientRect()]).sort((a, b) => a[1].top - b[1].top);
      for (const [one, { left, right, top, height }] of boxes) {
        let at = top;
        for (const other of taken)
          if (left < other.right && other.left < right && at < other.bottom && other.top < at + height) at = other.bottom;
        if (at > top) one.style.translate = `0 ${at - top}px`;
        taken.push({ left, right, top: at, bottom: at + height });
      }
    },
    // The floor, the axes, and the direction of gravity.
    surround() {
      const span = Math.max(this.high.x - this.low.x, this.high.y - this.low.y, 0.3 * this.size);
      const step = 10 ** Math.floor(Math.log10(span / 2));
      const cell = span / step > 10 ? 2 * step : step;
      const count = 2 * Math.ceil((0.6 * span) / cell);
      const grid = new THREE.GridHelper(count * cell, count, 0x76818f, 0x76818f);
      grid.rotateX(Math.PI / 2);
      const middle = this.low.clone().add(this.high).multiplyScalar(0.5);
      grid.position.set(Math.round(middle.x / cell) * cell, Math.round(middle.y / cell) * cell, this.low.z - 0.04 * this.size);
      Object.assign(grid.material, { transparent: true, opacity: 0.3 });
      this.group.add(grid);
      const corner = new THREE.Vector3(this.low.x - 0.1 * this.size, this.low.y - 0.1 * this.size, grid.position.z);
      const colours = { x: "#d95926", y: "#199e70", z: "#3987e5" };
      for (const [k, axis] of ["x", "y", "z"].entries()) {
        const along = new THREE.Vector3().setComponent(k, 1);
        for (const object of this.arrow(corner, along, 0.12 * this.size, colours[axis])) this.group.add(object);
        this.label({ at: corner.clone().addScaledVector(along, 0.14 * this.size).toArray(), text: axis, colour: colours[axis] });
      }
      this.label({ at: [grid.position.x + 0.3 * count * cell, grid.position.y - (count * cell) / 2, corner.z], text: `grid ${+cell.toPrecision(3)} m`, colour: "#76818f" });
      if (this.scene.gravity) {
        const tail = new THREE.Vector3(this.high.x + 0.12 * this.size, middle.y, this.high.z);
        for (const object of this.arrow(tail, vector(this.scene.gravity), 0.12 * this.size, 0x76818f)) this.add(object, "gravity gravity");
        this.label({ at: tail.toArray(), text: "g", part: "gravity gravity", colour: "#76818f" });
      }
    },
    label({ at, text, part, colour }) {
      const element = document.createElement(part ? "button" : "span");
      element.textContent = text;
      Object.assign(element.style, { color: colour, font: "12px system-ui, sans-serif", pointerEvents: part ? "auto" : "none", padding: part ? "4px 6px" : "1px 4px", minWidth: "24px", minHeight: part ? "24px" : "" });
      if (part) {
        element.dataset.part = part;
        element.setAttribute("aria-label", part);
        element.addEventListener("click", () => this.$emit("choose", part));
      }
      const object = new CSS2DObject(element);
      object.position.copy(vector(at));
      const near = at.map((number) => Math.round((20 * number) / this.size)).join(); // names of one point stand in a column
      const row = this.taken.get(near) || 0;
      this.taken.set(near, row + 1);
      object.center.set(-0.05, 1.2 - row);
      this.group.add(object);
    },
    mark() {
      this.group?.traverse((object) => {
        if (object.element?.dataset.part) {
          const chosen = (this.chosen || []).includes(object.element.dataset.part);
          object.element.setAttribute("aria-pressed", chosen);
          object.element.classList.toggle("chosen", chosen);
          object.element.classList.toggle("wrong", (this.wrong || []).includes(object.element.dataset.part));
        }
        const material = object.material;
        if (!material?.color) return;
        const part = object.userData.part || object.parent?.userData.part;
        material.userData.colour ??= material.color.getHex();
        const marked = (this.wrong || []).includes(part) ? WRONG : (this.chosen || []).includes(part) ? CHOSEN : null;
        material.color.setHex(marked ?? material.userData.colour);
        material.emissive?.setHex(marked ?? 0);
        if (material.emissive) material.emissiveIntensity = 0.5;
      });
      this.render();
    },
    click(event) {
      if (this.begun && Math.hypot(event.clientX - this.begun[0], event.clientY - this.begun[1]) > 4) return;
      const box = this.renderer.domElement.getBoundingClientRect();
      const caster = new THREE.Raycaster();
      caster.params.Line.threshold = 0.015 * this.size;
      const place = [((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2];
      caster.setFromCamera(new THREE.Vector2(...place), this.camera);
      const part = ({ object }) => object.userData.part || object.parent?.userData.part;
      const hit = caster.intersectObjects(this.group.children, true).find(part);
      this.$emit("choose", hit ? part(hit) : null);
    },
    key(event) {
      const turn = { ArrowLeft: [-0.15, 0], ArrowRight: [0.15, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] }[event.key];
      if (turn && event.target === this.$el) {
        event.preventDefault();
        const around = new THREE.Spherical().setFromVector3(this.turned(this.offset(), 1));
        around.theta += turn[0];
        around.phi = Math.min(Math.max(around.phi + turn[1], 0.05), Math.PI - 0.05);
        this.camera.position.copy(this.controls.target).add(this.turned(new THREE.Vector3().setFromSpherical(around), -1));
        this.controls.update();
        this.render();
      }
      if (event.key === "+" || event.key === "-") this.scale(event.key === "+" ? 0.8 : 1.25);
      if (event.key === "0") this.fit();
    },
    offset() { return this.camera.position.clone().sub(this.controls.target); },
    turned(point, way) { return point.applyAxisAngle(new THREE.Vector3(1, 0, 0), (-way * Math.PI) / 2); }, // z up to y up
    scale(factor) {
      this.camera.position.copy(this.controls.target).add(this.offset().multiplyScalar(factor));
      this.render();
    },
    fit() {
      if (!this.low) return;
      const middle = this.low.clone().add(this.high).multiplyScalar(0.5);
      this.looked = true;
      this.controls.target.copy(middle);
      this.camera.position.copy(middle).add(new THREE.Vector3(1, -1.6, 0.75).normalize().multiplyScalar(2.1 * this.size));
      this.camera.near = 0.01 * this.size;
      this.camera.far = 50 * this.size;
      this.controls.update();
      this.resize();
    },
    resize() {
      const { clientWidth: width, clientHeight: height } = this.$el;
      if (!width || !height || !this.renderer) return;
      this.renderer.setPixelRatio(window.devicePixelRatio);
      this.renderer.setSize(width, height, false);
      Object.assign(this.renderer.domElement.style, { width: "100%", height: "100%" });
      this.words.setSize(width, height);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
      this.render();
    },
    render() {
      if (!this.renderer || this.waiting) return;
      this.waiting = requestAnimationFrame(() => {
        this.waiting = null;
        this.lamp.position.copy(this.camera.position);
        this.renderer.render(this.world, this.camera);
        this.words.render(this.world, this.camera);
        this.spread();
      });
    },
  },
};
