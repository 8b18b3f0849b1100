// Draws each figure of the page, in light or dark as the reader's system asks, and runs the animation.
(() => {
  "use strict";
  const look = JSON.parse(document.getElementById("look").textContent);
  const darkness = matchMedia("(prefers-color-scheme: dark)");
  const coarse = matchMedia("(pointer: coarse)").matches;
  const hovering = matchMedia("(hover: hover)").matches;
  let printing = false;

  async function plotly() { // packed, the library takes less than half the room
    if (!window.DecompressionStream) document.getElementById("old-browser").hidden = false;
    const packed = Uint8Array.from(atob(document.getElementById("plotly").textContent), (letter) => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    const script = document.createElement("script");
    script.textContent = await new Response(stream).text();
    document.head.append(script); // runs at once
  }

  function coloured(text) {
    if (printing || !darkness.matches) return JSON.parse(text);
    for (const [light, dark] of Object.entries(look.dark)) text = text.replaceAll(light, dark);
    return JSON.parse(text);
  }

  function draw(source) {
    const place = document.getElementById(source.dataset.for);
    const figure = coloured(source.textContent);
    const layout = figure.layout;
    const narrow = place.clientWidth < 520;
    layout.template = coloured(JSON.stringify(look.template));
    delete layout.height;
    layout.margin = { ...layout.template.layout.margin, ...layout.margin, t: 40 };
    if (narrow) {
      Object.assign(layout.margin, { l: 44, r: 8 });
      layout.template.layout.font.size = 11;
    }
    if (layout.meta?.labels) { // equal axes: no higher than the motion needs
      const [width, height] = ["xaxis", "yaxis"].map((name) => layout[name].range[1] - layout[name].range[0]);
      const needed = (place.clientWidth - 60) * height / width + 150;
      place.style.height = `${Math.round(Math.min(520, Math.max(300, needed)))}px`;
    }
    if (coarse) { // a finger on a figure scrolls the page
      layout.dragmode = false;
      for (const name of Object.keys(layout)) if (/^[xy]axis/.test(name)) layout[name].fixedrange = true;
    }
    const config = {
      responsive: true, displaylogo: false, displayModeBar: hovering ? "hover" : false,
      modeBarButtons: [["zoom2d", "pan2d", "resetScale2d"]],
    };
    // An animation changes its traces in place: frames stay with the player.
    return Plotly.newPlot(place, figure.data, layout, config).then(() => {
      place.frames = figure.frames || [];
      place.dataset.drawn = "yes";
      place.dispatchEvent(new Event("drawn"));
    });
  }

  function player(box) {
    const place = document.getElementById(box.dataset.for);
    const [button, slider, output] = ["button", "input", "output"].map((tag) => box.querySelector(tag));
    const { labels, seconds, name, unit, endless } = JSON.parse(document.querySelector(`[data-for="${place.id}"].figure`).textContent).layout.meta;
    let began = null;

    function show(number) {
      const frame = place.frames[number];
      slider.value = number;
      output.textContent = `${name} ${labels[number]} ${unit}`;
      slider.setAttribute("aria-valuetext", `${labels[number]} ${unit}`.trim());
      const still = { mode: "immediate", frame: { duration: 0, redraw: true }, transition: { duration: 0 } };
      return Plotly.animate(place, { data: frame.data, traces: frame.traces }, still).catch(() => {});
    }
    function turn(on) {
      began = on ? performance.now() - (slider.value % (labels.length - 1)) / (labels.length - 1) * seconds * 1000 : null;
      button.setAttribute("aria-pressed", String(on));
      button.querySelector("[aria-hidden]").textContent = on ? "❚❚" : "▶";
      button.querySelector(".word").textContent = on ? "Pause" : "Play";
      if (on) requestAnimationFrame(tick);
    }
    function tick(now) {
      if (began === null) return;
      const since = Math.max(0, Math.floor((now - began) / (1000 * seconds) * labels.length));
      const number = endless ? since % labels.length : Math.min(labels.length - 1, since);
      const shown = number === Number(slider.value) ? Promise.resolve() : show(number);
      if (!endless && number >= labels.length - 1) return turn(false);
      shown.then(() => requestAnimationFrame(tick));
    }
    button.addEventListener("click", () => turn(began === null));
    slider.addEventListener("input", () => { turn(false); show(Number(slider.value)); });
    place.addEventListener("drawn", () => Number(slider.value) && show(Number(slider.value)));
  }

  function seen(place) { // frames do not change a figure's own data
    const frame = place.frames[document.querySelector(`.player[data-for="${place.id}"] input`)?.value];
    const data = place.data.map((trace) => ({ ...trace }));
    frame?.traces.forEach((trace, number) => Object.assign(data[trace], frame.data[number]));
    return { data, layout: place.layout };
  }

  function offer(button) { // a picture of the figure as it is seen, with pixels fine enough to be printed
    const place = document.getElementById(button.dataset.figure);
    if (!place.dataset.drawn) return;
    const format = button.textContent.toLowerCase();
    button.addEventListener("click", () => {
      const { clientWidth: width, clientHeight: height } = place;
      const scale = format === "png" ? Math.max(2, 2000 / width) : 1;
      Plotly.downloadImage(seen(place), { format, width, height, scale, filename: place.id.replace("figure-", "") });
    });
  }

  const sources = [...document.querySelectorAll("script.figure")];
  const ready = plotly();
  const all = () => ready.then(() => Promise.all(sources.map(draw)));
  document.querySelectorAll(".player[data-for]").forEach(player);
  all().then(() => {
    document.querySelectorAll("[data-figure]").forEach(offer);
    document.documentElement.dataset.ready = "yes";
  });
  darkness.addEventListener("change", all);
  addEventListener("beforeprint", () => { printing = true; all(); });
  addEventListener("afterprint", () => { printing = false; all(); });
})();
