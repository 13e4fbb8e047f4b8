// Colours that tell values apart, also for colour-blind readers and in grey: perceptually uniform maps for measures,
// the palette of Okabe and Ito for categories.
import { interpolateCividis, interpolateInferno, interpolateMagma, interpolateViridis } from "d3-scale-chromatic";

export const kMaps = {
  viridis: interpolateViridis,
  cividis: interpolateCividis,
  magma: interpolateMagma,
  inferno: interpolateInferno,
} as const;

export type MapName = keyof typeof kMaps;
export const kMapNames = Object.keys(kMaps) as MapName[];

const kPalette = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c6d31", "#7f7f7f"];

type Rgb = [number, number, number];

function rgb(text: string): Rgb {
  if (text.startsWith("#")) return [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16)) as Rgb;
  return (text.match(/\d+/g) ?? ["0", "0", "0"]).slice(0, 3).map(Number) as Rgb;
}

/** `colour` on the way to another, as "#rrggbb". */
function mixed(colour: string, to: Rgb, share: number): string {
  const parts = rgb(colour).map((part, i) => Math.round(part + share * (to[i]! - part)));
  return `#${parts.map((part) => part.toString(16).padStart(2, "0")).join("")}`;
}

/** The palette, and for the ninth and what follows the same in light and in dark. */
export const kCategories = [
  ...kPalette, ...kPalette.map((colour) => mixed(colour, [255, 255, 255], 0.55)), ...kPalette.map((colour) => mixed(colour, [0, 0, 0], 0.5)),
];

/** `count` colours along a map, as RGBA bytes. */
export function mapBytes(name: MapName, count: number): Uint8Array {
  const bytes = new Uint8Array(4 * count);
  for (let i = 0; i < count; ++i) bytes.set([...rgb(kMaps[name](i / (count - 1))), 255], 4 * i);
  return bytes;
}

export function categoryBytes(): Uint8Array {
  const bytes = new Uint8Array(4 * kCategories.length);
  kCategories.forEach((colour, i) => bytes.set([...rgb(colour), 255], 4 * i));
  return bytes;
}

/** A CSS gradient along a map, from left to right or from below to above. */
export function gradient(name: MapName, to: "right" | "top"): string {
  const stops = Array.from({ length: 17 }, (_, i) => kMaps[name](i / 16));
  return `linear-gradient(to ${to}, ${stops.join(", ")})`;
}

export const categoryColour = (index: number): string =>
  index < 0 ? "#999999" : kCategories[index % kCategories.length]!;
