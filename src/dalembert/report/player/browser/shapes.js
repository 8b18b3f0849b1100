// The shapes of a scene: their positions, box and colours, and elements of SVG. It needs no library.
const SVG = "http://www.w3.org/2000/svg";

export function svgElement(parent, tag, attributes, text = "") {
  const one = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) one.setAttribute(name, value);
  one.textContent = text;
  parent?.append(one);
  return one;
}

// Colour of a shape; look: colours of bodies, series, and ink, muted, faint and paper, which are read on the page.
export function colourOf({ role, colour }, look) {
  const quiet = { outline: look.faint, path: look.muted, ground: look.muted }[role];
  return quiet ?? (colour < 0 ? look.ink : look.series[colour % look.series.length]);
}

// Shapes with their part, and with their positions in a frame: (count, dimensions) in one array.
export function decoded(scene) {
  const numbers = new Float32Array(Uint8Array.from(atob(scene.positions), (one) => one.charCodeAt(0)).buffer), count = scene.times.length;
  let next = 0;
  const taken = (size) => numbers.subarray(next, (next += size));
  return scene.shapes.map((shape) => {
    const size = shape.count * scene.dimensions, all = taken(shape.moves ? count * size : size), poses = shape.posed ? taken(12 * count) : null;
    const values = shape.values ? taken(shape.values * shape.count) : null;
    const valuesAt = values && ((frame) => (shape.values > 1 ? values.subarray(frame * shape.count, (frame + 1) * shape.count) : values));
    const at = (frame) => (poses ? posed(all, poses.subarray(12 * frame, 12 * frame + 12)) : shape.moves ? all.subarray(frame * size, (frame + 1) * size) : all);
    return { ...shape, part: `${shape.role} ${shape.name}`.trim(), at, valuesAt, frames: poses || shape.moves ? count : 1 };
  });
}

// Points in the axes of a body, in the fixed axes.
function posed(points, [x, y, z, ...axes]) {
  const found = new Float32Array(points.length);
  for (let k = 0; k < points.length; k += 3)
    for (let axis = 0; axis < 3; axis++)
      found[k + axis] = [x, y, z][axis] + points[k] * axes[axis] + points[k + 1] * axes[3 + axis] + points[k + 2] * axes[6 + axis];
  return found;
}

// Lowest and highest corner of shapes over all their frames, together with an older box.
export function boxOf(shapes, dimensions, old) {
  const low = Array(dimensions).fill(Infinity), high = Array(dimensions).fill(-Infinity);
  const measure = (numbers) => numbers.forEach((value, place) => {
    if (!Number.isFinite(value)) return;
    low[place % dimensions] = Math.min(low[place % dimensions], value);
    high[place % dimensions] = Math.max(high[place % dimensions], value);
  });
  for (const shape of shapes) for (let frame = 0; frame < shape.frames; frame++) measure(shape.at(frame));
  if (old) [old.low, old.high].forEach(measure);
  const grown = !old || low.some((value, k) => value < old.low[k]) || high.some((value, k) => value > old.high[k]);
  return { low, high, grown };
}

// The bar of a scene's colours, as a group of SVG that is BAR wide and so high.
export const BAR = 76;
export function barOf({ title, colours, ticks }, look, height) {
  const group = svgElement(null, "g", { class: "player-bar" }), words = { fill: look.ink, "font-size": 12 }, step = height / colours.length;
  colours.forEach((colour, k) => svgElement(group, "rect", { y: height - (k + 1) * step, width: 12, height: step + 0.5, fill: colour }));
  for (const [share, text] of ticks) svgElement(group, "text", { ...words, x: 17, y: 4 + (1 - share) * height }, text);
  svgElement(group, "text", { ...words, "text-anchor": "middle", transform: `translate(${BAR - 14} ${height / 2}) rotate(90)` }, title);
  return group;
}
