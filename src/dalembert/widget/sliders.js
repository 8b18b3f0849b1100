// A mechanism with sliders for its parameters: the front end of an anywidget.
import { element, Player } from "./index.js";
import { svgElement } from "./shapes.js";

const STEPS = 400; // of a slider
const WIDTH = 420, HEIGHT = 90; // of a curve, in pixels
const LAYOUT = `
.dalembert-sliders { display: flex; flex-wrap: wrap; gap: 8px 24px; font: 14px system-ui, sans-serif; max-width: 960px }
.dalembert-sliders > .motion { flex: 3 1 360px; min-width: 0 }
.dalembert-sliders > .values { flex: 2 1 240px; min-width: 0 }
.dalembert-sliders .curve { display: block; width: 100%; height: ${HEIGHT}px }
.dalembert-sliders label { display: block; margin: 6px 0 }
.dalembert-sliders label input { width: 100%; margin: 0 }
.dalembert-sliders .head { display: flex; justify-content: space-between; gap: 8px }
.dalembert-sliders .head output { font-variant-numeric: tabular-nums }
.dalembert-sliders :focus-visible { outline: 2px solid currentColor; outline-offset: 2px }
.dalembert-sliders .name { font-size: 13px; margin-top: 6px }
.dalembert-sliders [role=alert] { flex: 1 1 100% }
`;

// Of a number as a person reads it: four digits.
function read(value) {
  return String(Number(value.toPrecision(4)));
}

// A channel over time with measured points; returns the line that marks a time.
function curve(parent, name, points, measured, colour, ink) {
  const box = { class: "curve", viewBox: `0 0 ${WIDTH} ${HEIGHT}`, preserveAspectRatio: "none", role: "img", "aria-label": name };
  element(parent, "div", { className: "name", textContent: name });
  const chart = svgElement(parent, "svg", box);
  const all = [...points, ...measured.map((one) => one[1])];
  const low = Math.min(...all), size = Math.max(...all) - low || 1;
  const at = (share, value) => `${(WIDTH * share).toFixed(1)} ${(HEIGHT - 6 - ((HEIGHT - 12) * (value - low)) / size).toFixed(1)}`;
  const line = points.map((value, place) => `${place ? "L" : "M"}${at(place / (points.length - 1), value)}`);
  const same = { fill: "none", "vector-effect": "non-scaling-stroke", "stroke-linecap": "round" };
  const dots = measured.map(([share, value]) => `M${at(share, value)}h0`);
  svgElement(chart, "path", { ...same, class: "measured", d: dots.join(""), stroke: ink, "stroke-width": 4 });
  svgElement(chart, "path", { ...same, class: "computed", d: line.join(""), stroke: colour, "stroke-width": 2 });
  return svgElement(chart, "line", { y1: 0, y2: HEIGHT, stroke: ink, "vector-effect": "non-scaling-stroke" });
}

function render({ model, el }) {
  element(el, "style", { textContent: LAYOUT });
  const root = element(el, "div", { className: "dalembert-sliders" });
  const left = element(root, "div", { className: "motion" }), right = element(root, "div", { className: "values" });
  const motion = element(left, "div");
  const curves = element(left, "div");
  const alert = element(root, "div");
  alert.setAttribute("role", "alert");
  let cursors = [];

  const look = model.get("look");
  const player = new Player(motion, look, "The mechanism in motion", (share) => {
    for (const cursor of cursors) cursor.setAttribute("transform", `translate(${WIDTH * share} 0)`);
  });

  // One request at a time: what changes meanwhile is asked for once, when the answer is there.
  const values = Object.fromEntries(model.get("parameters").map((one) => [one.name, one.value]));
  Object.assign(values, model.get("asked").values);
  let waiting = false, changed = false;
  const ask = () => {
    if (waiting) {
      changed = true;
      return;
    }
    waiting = true;
    model.set("asked", { number: model.get("asked").number + 1, values: { ...values } });
    model.save_changes();
  };

  for (const { name, unit, lower, upper } of model.get("parameters")) {
    const label = element(right, "label");
    const head = element(label, "span", { className: "head" });
    element(head, "span", { textContent: unit ? `${name} (${unit})` : name });
    const output = element(head, "output", { textContent: read(values[name]) });
    const slider = element(label, "input", { type: "range", min: lower, max: upper, step: (upper - lower) / STEPS || 1 });
    slider.setAttribute("aria-label", unit ? `${name} in ${unit}` : name);
    slider.value = values[name];
    slider.oninput = () => {
      values[name] = Number(slider.value);
      output.textContent = read(values[name]);
      ask();
    };
  }

  const draw = () => {
    const film = model.get("film");
    alert.textContent = model.get("message");
    const { series = {}, ranges = {}, measured = {} } = model.get("curves");
    curves.replaceChildren();
    cursors = Object.entries(series).map(([name, points], k) => {
      const colour = look.series[k % look.series.length];
      return curve(curves, `${name}: ${ranges[name].join(" to ")}`, points, measured[name] ?? [], colour, look.ink);
    });
    if (film.positions) player.show(film, { plays: model.get("answered") > 0 });
    el.dataset.answered = model.get("answered");
  };
  const answer = () => {
    draw();
    waiting = false;
    if (changed) {
      changed = false;
      ask();
    }
  };
  model.on("change:answered", answer);
  draw();
  return () => {
    model.off("change:answered", answer);
    player.close();
  };
}

export default { render };
