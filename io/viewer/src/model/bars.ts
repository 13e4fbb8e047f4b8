// Colour bars over a scene: what is coloured by what, from where to where, in which unit.
import type { Field } from "../archive/protocol";
import { unitText } from "../archive/words";
import { categoryColour, gradient, type MapName } from "../ui/colours";
import { h, number } from "../ui/dom";
import { tickText, ticks } from "../ui/scale";

export interface Bar {
  what: string; // "Wall", "Lines", "Voronoi diagram"
  field: Field;
  map: MapName;
  range: [number, number];
  categories: number[]; // ids that occur, for fields of ids
  empty: boolean; // no point has a value
  cut: boolean; // whether values lie beyond the range
}

export const barTitle = (bar: Bar): string => {
  const units = unitText(bar.field.units);
  const symbol = bar.field.symbol && bar.field.symbol.length > 1 ? ` ${bar.field.symbol}` : "";
  return `${bar.field.label}${symbol}${units ? ` [${units}]` : ""}`;
};

const kMostPatches = 12;

/** Numbers below a bar, at shares of its length: both ends, and round values between them. */
function marksOf([low, high]: [number, number]): { share: number; text: string }[] {
  if (!(high > low)) return [{ share: 0, text: number(low) }];
  const values = ticks(low, high, 4);
  const step = values.length > 1 ? values[1]! - values[0]! : 1;
  const inner = values.map((value) => ({ share: (value - low) / (high - low), text: tickText(value, step) }));
  return [{ share: 0, text: number(low) }, ...inner.filter(({ share }) => share > 0.33 && share < 0.67), { share: 1, text: number(high) }];
}

export function colourBar(bar: Bar): HTMLElement {
  const title = h("div", { class: "bar-title" }, h("span", { class: "quiet-text" }, `${bar.what}: `), barTitle(bar));
  if (bar.empty) return h("div", { class: "bar" }, title, h("div", { class: "quiet-text" }, "no values"));
  if (bar.field.kind === "category") {
    const shown = bar.categories.slice(0, kMostPatches).map((id) => {
      const patch = h("i");
      patch.style.background = categoryColour(id);
      return h("span", { class: "patch" }, patch, String(id));
    });
    return h("div", { class: "bar" }, title, h("div", { class: "patches" }, shown, bar.categories.length > kMostPatches && "…"));
  }
  const strip = h("div", { class: "strip" });
  strip.style.background = gradient(bar.map, "right");
  const [low, high] = bar.range;
  const scale = h("div", { class: "bar-ticks" }, marksOf(bar.range).map(({ share, text }) => {
    const tick = h("span", {}, text);
    tick.style.left = `${share * 100}%`;
    return tick;
  }));
  const hint = bar.cut ? "from the 1st to the 99th percentile; what lies beyond has the colours of the ends" : "all values";
  return h("div", { class: "bar", title: `${number(low)} to ${number(high)}: ${hint}` }, title, strip, scale);
}

/** The same bars on a picture, from the top right corner down. */
export function paintBars(g: CanvasRenderingContext2D, bars: Bar[], width: number, scale: number, text: string): void {
  const w = 220 * scale;
  let y = 14 * scale;
  const x = width - w - 16 * scale;
  g.font = `${11 * scale}px sans-serif`;
  g.textBaseline = "top";
  for (const bar of bars) {
    g.fillStyle = text;
    g.textAlign = "left";
    g.fillText(bar.empty ? `${barTitle(bar)}: no values` : barTitle(bar), x, y);
    y += 16 * scale;
    if (bar.empty) continue;
    y = bar.field.kind === "category" ? paintPatches(g, bar, x, y, w, scale, text) : paintStrip(g, bar, x, y, w, scale, text);
  }
}

function paintStrip(g: CanvasRenderingContext2D, bar: Bar, x: number, y: number, w: number, scale: number, text: string): number {
  const strip = 10 * scale;
  const colours = g.createLinearGradient(x, 0, x + w, 0);
  const stops = gradient(bar.map, "right").match(/rgb\([^)]*\)|#[0-9a-f]{6}/gi) ?? [];
  stops.forEach((colour, i) => colours.addColorStop(i / (stops.length - 1), colour));
  g.fillStyle = colours;
  g.fillRect(x, y, w, strip);
  g.fillStyle = text;
  for (const mark of marksOf(bar.range)) {
    g.textAlign = mark.share === 0 ? "left" : mark.share === 1 ? "right" : "center";
    g.fillText(mark.text, x + mark.share * w, y + strip + 3 * scale);
  }
  return y + strip + 25 * scale;
}

function paintPatches(g: CanvasRenderingContext2D, bar: Bar, left: number, top: number, w: number, scale: number, text: string): number {
  let [x, y] = [left, top];
  for (const id of bar.categories.slice(0, kMostPatches)) {
    const needed = g.measureText(String(id)).width + 20 * scale;
    if (x + needed > left + w) [x, y] = [left, y + 15 * scale];
    g.fillStyle = categoryColour(id);
    g.fillRect(x, y + scale, 9 * scale, 9 * scale);
    g.fillStyle = text;
    g.fillText(String(id), x + 12 * scale, y);
    x += needed;
  }
  return y + 22 * scale;
}
