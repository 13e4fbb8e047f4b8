// The controls of a model, on the left: one block per layer, only for layers that the model has.
import type { Field, MarkedTable, Model } from "../archive/protocol";
import { unitText } from "../archive/words";
import { kMapNames, type MapName } from "../ui/colours";
import { checkbox, choice, fill, h, slider } from "../ui/dom";
import { applyPreset, kPresets, type Balls, type Settings } from "./settings";

const fieldText = (field: Field): string => {
  const symbol = field.symbol.length > 1 ? `${field.symbol}: ` : "";
  const units = unitText(field.units);
  return `${symbol}${field.label}${units ? ` [${units}]` : ""}`;
};

const options = (fields: Field[], none: string) =>
  [["", none] as const, ...fields.map((field) => [field.key, fieldText(field)] as const)];

const kMarkNames: Record<string, string> = {
  branches: "Branches", bifurcations: "Bifurcations", sections: "Sections", stenoses: "Stenoses", dilations: "Dilations", loops: "Loops",
};
export const markName = (name: string): string => kMarkNames[name] ?? name;

export class Panel {
  readonly root = h("aside", { class: "panel", "aria-label": "what is shown" });
  private readonly marksPart = h("section", {});

  constructor(
    private readonly model: Model, private readonly get: () => Settings, private readonly set: (settings: Settings) => void,
  ) {
    this.draw();
  }

  private change(part: Partial<Settings>, redraw = false): void {
    this.set({ ...this.get(), ...part });
    if (redraw) this.draw();
  }

  /** The next of the ready-made looks. */
  nextPreset(): void {
    const ready = kPresets.filter((preset) => preset.available(this.model));
    const now = ready.findIndex((preset) => this.shows(preset.settings));
    const next = ready[(now + 1) % ready.length];
    if (next) this.change(applyPreset(this.model, this.get(), next), true);
  }

  private shows(part: Partial<Settings>): boolean {
    const settings = this.get();
    return (["lines", "balls", "voronoi"] as const).every((key) => part[key] === undefined || part[key] === settings[key]) &&
      (part.voronoi ? settings.voronoiBy.startsWith(part.voronoiBy ?? "") : true) && (part.wallBy === "?") === (settings.wallBy !== "");
  }

  draw(): void {
    const { model } = this;
    const settings = this.get();
    const presets = kPresets.filter((preset) => preset.available(model)).map((preset) =>
      h("button", {
        type: "button", role: "radio", title: preset.title, "aria-checked": String(this.shows(preset.settings)),
        on: { click: () => this.change(applyPreset(model, this.get(), preset), true) },
      }, preset.name));
    fill(this.root,
      presets.length > 1 && h("div", { class: "segment", role: "radiogroup", "aria-label": "look" }, presets),
      model.surface && this.wall(settings),
      model.lines && this.lines(settings),
      model.voronoi && this.block("Voronoi diagram", settings.voronoi, (voronoi) => this.change({ voronoi }, true),
        choice("Colour", options(model.voronoi.fields, "plain"), settings.voronoiBy, (voronoiBy) => this.change({ voronoiBy })).root),
      this.others(settings),
      this.marksPart,
      h("section", {},
        choice("Colour map", kMapNames.map((name) => [name, name] as const), settings.map, (map) => this.change({ map: map as MapName })).root,
        checkbox("Colours span all values", settings.whole, (whole) => this.change({ whole }))));
  }

  private block(title: string, on: boolean, changed: (on: boolean) => void, ...body: HTMLElement[]): HTMLElement {
    return h("section", { class: on ? "" : "off" }, h("h2", {}, checkbox(title, on, changed)), on && body);
  }

  private wall(settings: Settings): HTMLElement {
    return this.block("Wall", settings.wall, (wall) => this.change({ wall }, true),
      choice("Colour", options(this.model.surface!.fields, "plain"), settings.wallBy, (wallBy) => this.change({ wallBy })).root,
      slider("Opacity", 0.05, 1, 0.01, settings.opacity, (opacity) => this.change({ opacity })).root);
  }

  private lines(settings: Settings): HTMLElement {
    const balls = [["none", "none"], ["one", "one, at the mark"], ["all", "along the line"]] as const;
    return this.block("Centerlines", settings.lines, (lines) => this.change({ lines }, true),
      choice("Colour", options(this.model.lines!.fields, "plain"), settings.linesBy, (linesBy) => this.change({ linesBy })).root,
      choice("Balls", balls, settings.balls, (chosen) => this.change({ balls: chosen as Balls })).root);
  }

  private others(settings: Settings): HTMLElement | false {
    const { model } = this;
    const boxes: HTMLElement[] = [];
    if (model.ends) boxes.push(checkbox("Ends", settings.ends, (ends) => this.change({ ends })));
    if ((model.surface?.added.length ?? 0) > 0)
      boxes.push(checkbox("Extensions and caps", settings.added, (added) => this.change({ added })));
    return boxes.length > 0 && h("section", {}, boxes);
  }

  /** A box for each of them that has a place. */
  offerMarks(marks: MarkedTable[]): void {
    fill(this.marksPart, marks.filter((marked) => marked.points || marked.outlines).map((marked) =>
      checkbox(`${markName(marked.name)} (${marked.table.rows})`, this.get().marks.includes(marked.name), (on) => {
        const others = this.get().marks.filter((name) => name !== marked.name);
        this.change({ marks: on ? [...others, marked.name] : others });
      })));
  }
}
