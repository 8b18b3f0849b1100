// Puts a player in the place of each picture of a motion in a page, and saves what it shows.
import { element, Player } from "./index.js";
import { svgElement } from "./shapes.js";

const darkness = matchMedia("(prefers-color-scheme: dark)");
const LAYOUT = `
.dalembert-film .player-scene { height: auto; aspect-ratio: var(--shape); min-height: 240px; max-height: 520px }
@media screen { .dalembert-film[data-plays] > .film-still { display: none } }
@media print { .dalembert-film > .player { display: none !important } }
`;

function play(box) {
  const film = JSON.parse(box.querySelector("script").textContent), { looks } = film;
  const look = () => looks[darkness.matches ? looks.length - 1 : 0];
  const options = { complete: true, zooms: true, scrolls: matchMedia("(pointer: coarse)").matches };
  element(box, "style", { textContent: LAYOUT });
  const player = new Player(element(box, "div"), look(), box.dataset.label, undefined, options);
  player.show(film, { plays: false });
  darkness.addEventListener("change", () => player.recolour(look()));
  box.dataset.plays = "yes";
  for (const button of box.id ? document.querySelectorAll(`[data-figure="${box.id}"]`) : [])
    button.addEventListener("click", () => save(player, button.textContent.toLowerCase(), look().paper, box.id.replace("figure-", "")));
}

// Offers a picture as it is seen, with pixels fine enough to be printed.
async function save(player, format, paper, name) {
  const { clientWidth: width, clientHeight: height } = player.view, scale = Math.max(2, 2000 / width);
  const picture = player.scene.picture(scale);
  for (const [key, value] of Object.entries({ width, height })) picture.setAttribute(key, value);
  picture.prepend(svgElement(picture, "rect", { width, height, fill: paper }));
  let blob = new Blob([new XMLSerializer().serializeToString(picture)], { type: "image/svg+xml" });
  if (format === "png") {
    const image = new Image(), canvas = Object.assign(document.createElement("canvas"), { width: scale * width, height: scale * height });
    image.src = URL.createObjectURL(blob);
    await image.decode();
    canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
    blob = await new Promise((done) => canvas.toBlob(done));
  }
  Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: `${name}.${format}` }).click();
}

document.querySelectorAll(".dalembert-film:not([data-plays])").forEach(play);
