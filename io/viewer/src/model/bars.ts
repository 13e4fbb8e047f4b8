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
  cut: boolean; // whether values lie beyond the range
}

export const barTitle = (bar: Bar): string => {
  const units = unitText(bar.field.units);
  const symbol = bar.field.symbol && bar.field.symbol.length > 1 ? ` ${bar.field.symbol}` : "";
  return `${bar.field.label}${symbol}${units ? ` [${units}]` : ""}`;
};

export function colourBar(bar: Bar): HTMLElement {
  const title = h("div", { class: "bar-title" }, h("span", { class: "quiet-text" }, `${bar.what}: `), barTitle(bar));
  if (bar.field.kind === "category") {
    const shown = bar.categories.slice(0, 12).map((id) => {
      const patch = h("i");
      patch.style.background = categoryColour(id);
      return h("span", { class: "patch" }, patch, String(id));
    });
    return h("div", { class: "bar" }, title, h("div", { class: "patches" }, shown, bar.categories.length > 12 && "…"));
  }
  const strip = h("div", { class: "strip" });
  strip.style.background = gradient(bar.map, "right");
  const [low, high] = bar.range;
  const values = ticks(low, high, 4);
  const step = values.length > 1 ? values[1]! - values[0]! : 1;
  const scale = h("div", { class: "bar-ticks" }, values.map((value) => {
    const tick = h("span", {}, tickText(value, step));
    tick.style.left = `${((value - low) / (high - low || 1)) * 100}%`;
    return tick;
  }));
  const hint = bar.cut ? "from the 1st to the 99th percentile; what lies beyond has the colours of the ends" : "all values";
  return h("div", { class: "bar", title: `${number(low)} to ${number(high)}: ${hint}` }, title, strip, scale);
}

/** The same bars on a picture, from the top right corner down. */
export function paintBars(g: CanvasRenderingContext2D, bars: Bar[], width: number, scale: number, text: string): void {
  const [w, strip] = [220 * scale, 10 * scale];
  let y = 14 * scale;
  const x = width - w - 16 * scale;
  g.font = `${11 * scale}px sans-serif`;
  for (const bar of bars.filter((candidate) => candidate.field.kind === "scale")) {
    g.fillStyle = text;
    g.textAlign = "left";
    g.textBaseline = "top";
    g.fillText(barTitle(bar), x, y);
    y += 16 * scale;
    const colours = g.createLinearGradient(x, 0, x + w, 0);
    const stops = gradient(bar.map, "right").match(/rgb\([^)]*\)|#[0-9a-f]{6}/gi) ?? [];
    stops.forEach((colour, i) => colours.addColorStop(i / (stops.length - 1), colour));
    g.fillStyle = colours;
    g.fillRect(x, y, w, strip);
    y += strip + 3 * scale;
    g.fillStyle = text;
    const [low, high] = bar.range;
    const values = ticks(low, high, 4);
    const step = values.length > 1 ? values[1]! - values[0]! : 1;
    g.textAlign = "center";
    for (const value of values) g.fillText(tickText(value, step), x + ((value - low) / (high - low || 1)) * w, y);
    y += 22 * scale;
  }
}
