// What is shown of a model and how, as the panel sets it and as an address carries it.
import type { Model } from "../archive/protocol";
import { kMapNames, type MapName } from "../ui/colours";

export type Balls = "none" | "one" | "all";

export interface Settings {
  wall: boolean;
  opacity: number;
  wallBy: string; // key of a field; empty = plain
  added: boolean;
  lines: boolean;
  linesBy: string;
  balls: Balls;
  voronoi: boolean;
  voronoiBy: string;
  ends: boolean;
  marks: string[];
  map: MapName;
  whole: boolean; // colours from the least to the largest value
  line: number;
  at: number; // abscissa of the ball, as a share of the line
  profile: string;
  site: number; // -1 = none picked
}

export interface Preset {
  name: string;
  title: string;
  available: (model: Model) => boolean;
  settings: Partial<Settings>;
}

const has = (fields: { key: string }[] | undefined, key: string) => fields?.some((field) => field.key === key) ?? false;

/** The first of `keys` that the model has among `fields`; else the first field of all. */
function firstOf(fields: { key: string }[] | undefined, keys: string[]): string {
  return keys.find((key) => has(fields, key)) ?? fields?.[0]?.key ?? "";
}

const arrival = (model: Model) => model.voronoi?.fields.find((field) => field.path.endsWith("/arrival_time"))?.key ?? "";

export const kPresets: Preset[] = [
  {
    name: "Lines", title: "centerlines in a transparent wall", available: (model) => model.lines !== null,
    settings: { wall: true, opacity: 0.22, wallBy: "", lines: true, linesBy: "radius", balls: "one", voronoi: false },
  },
  {
    name: "Surface", title: "the wall, coloured by a quantity", available: (model) => (model.surface?.fields.length ?? 0) > 0,
    settings: { wall: true, opacity: 1, wallBy: "?", lines: false, balls: "none", voronoi: false },
  },
  {
    name: "Balls", title: "maximal inscribed balls along a line", available: (model) => model.lines !== null,
    settings: { wall: true, opacity: 0.12, wallBy: "", lines: true, linesBy: "radius", balls: "all", voronoi: false },
  },
  {
    name: "Arrival time", title: "Voronoi diagram by the time of the front from the inlet", available: (model) => arrival(model) !== "",
    settings: { wall: true, opacity: 0.1, wallBy: "", lines: true, linesBy: "", balls: "none", voronoi: true, voronoiBy: "arrival_time" },
  },
  {
    name: "Distance", title: "Voronoi diagram by the distance to the centerlines",
    available: (model) => has(model.voronoi?.fields, "centerline_distance"),
    settings: { wall: true, opacity: 0.1, wallBy: "", lines: true, linesBy: "", balls: "none", voronoi: true, voronoiBy: "centerline_distance" },
  },
];

export function initialSettings(model: Model): Settings {
  const made: Settings = {
    wall: true, opacity: 1, wallBy: "", added: false, lines: false, linesBy: firstOf(model.lines?.fields, ["radius"]),
    balls: "none", voronoi: false, voronoiBy: firstOf(model.voronoi?.fields, ["ball_radius"]), ends: true, marks: [],
    map: "viridis", whole: false, line: longestLine(model), at: 0.5, profile: firstOf(model.lines?.fields, ["radius"]), site: -1,
  };
  const preset = kPresets.find((candidate) => candidate.available(model));
  return preset ? applyPreset(model, made, preset) : made;
}

export function applyPreset(model: Model, settings: Settings, preset: Preset): Settings {
  const made = { ...settings, ...preset.settings };
  if (made.wallBy === "?")
    made.wallBy = settings.wallBy || firstOf(model.surface?.fields, ["normalized_tangency_deviation", "geodesic_distance"]);
  if (preset.settings.voronoiBy === "arrival_time") made.voronoiBy = arrival(model);
  return made;
}

function longestLine(model: Model): number {
  const { lines } = model;
  if (!lines) return 0;
  let best = 0;
  const length = (l: number) => (lines.offsets[l + 1]! > lines.offsets[l]! ? lines.abscissa[lines.offsets[l + 1]! - 1]! : -1);
  for (let l = 1; l + 1 < lines.offsets.length; ++l) if (length(l) > length(best)) best = l;
  return best;
}

/** Settings as an address has them: what differs from what a model is first shown with. */
export function toAddress(settings: Settings, first: Settings, looking: string): string {
  const query = new URLSearchParams();
  for (const key of Object.keys(first) as (keyof Settings)[])
    if (String(settings[key]) !== String(first[key])) query.set(key, String(settings[key]));
  query.set("cam", looking);
  return query.toString();
}

/** Settings of an address; what it states wrongly is as the model is first shown. */
export function fromAddress(query: URLSearchParams, first: Settings): Settings {
  const made: Settings = { ...first };
  const target = made as unknown as Record<string, unknown>;
  for (const [key, initial] of Object.entries(first)) {
    const text = query.get(key);
    if (text === null) continue;
    if (Array.isArray(initial)) target[key] = text.split(",").filter(Boolean);
    else if (typeof initial === "boolean") target[key] = text === "true";
    else if (typeof initial === "number") target[key] = Number.isFinite(Number(text)) ? Number(text) : initial;
    else target[key] = text;
  }
  if (!kMapNames.includes(made.map)) made.map = first.map;
  if (!["none", "one", "all"].includes(made.balls)) made.balls = first.balls;
  made.opacity = Math.min(1, Math.max(0.05, made.opacity));
  made.at = Math.min(1, Math.max(0, made.at));
  made.line = Math.max(0, Math.round(made.line));
  return made;
}
