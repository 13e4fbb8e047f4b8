// What the keys do.
import { h } from "./dom";

const kKeys: [string, string][] = [
  ["g", "the cohort"],
  ["/", "search the models"],
  ["↑ ↓  Enter", "walk through the table, open a model"],
  ["[  ]", "the model before, the next one"],
  ["← → ↑ ↓", "turn the model (with Shift: move it)"],
  ["+  −", "nearer, farther"],
  ["0", "the whole model"],
  ["1 … 6", "look along an axis"],
  ["v", "next look: lines, surface, balls, arrival time, distance"],
  [",  .", "ball back and forth along the line"],
  ["l", "next line"],
  ["s", "picture as a PNG file"],
  ["c", "copy a link to this view"],
  ["?", "this list"],
];

export function showHelp(): void {
  const close = h("button", { type: "button", on: { click: () => dialog.close() } }, "Close");
  const dialog = h("dialog", { class: "help", "aria-label": "keys", on: { close: () => dialog.remove() } },
    h("h1", {}, "Keys"),
    h("dl", {}, kKeys.map(([key, text]) => [h("dt", {}, h("kbd", {}, key)), h("dd", {}, text)])),
    h("p", {}, "In the model, drag turns, right drag moves, the wheel zooms; a click on the wall shows its values, its pole and its way to the centerline."),
    close);
  document.body.appendChild(dialog);
  dialog.showModal();
}
