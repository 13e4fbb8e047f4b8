// One model: controls on the left, facts on the right, the scene between them and the profile of a line below. All of
// it is told by one set of settings, which the address repeats.
import * as THREE from "three";
import type { App, View } from "../app";
import type { Field, LinesPart, MarkedTable, Model } from "../archive/protocol";
import { download, fill, h, number, problems, sentenceOf, withUnits } from "../ui/dom";
import { extent, quantile, sortedFinite } from "../ui/scale";
import { unitText } from "../archive/words";
import { barTitle, colourBar, paintBars, type Bar } from "./bars";
import { EndLabels } from "./labels";
import { Info } from "./info";
import type { Look } from "./material";
import { Panel } from "./panel";
import { ProfilePlot } from "./profile";
import { ModelScene } from "./scene";
import { fromAddress, initialSettings, toAddress, type Settings } from "./settings";

const kPlain: Look = { mode: "plain", map: "viridis", range: [0, 1], opacity: 1 };

interface Shown {
  field: Field;
  values: Float32Array;
  bar: Bar;
}

export class ModelView implements View {
  readonly root = h("main", { class: "model" });
  private loaded: Loaded | null = null;
  private gone = false;

  constructor(private readonly app: App, private readonly id: string, state: URLSearchParams) {
    fill(this.root, h("div", { class: "message" }, h("p", {}, `Reading ${id} …`)));
    void this.load(state);
  }

  private async load(state: URLSearchParams): Promise<void> {
    try {
      const model = await this.app.client.call("model", this.id);
      if (!this.gone) this.loaded = new Loaded(this.app, model, this.root, state);
    } catch (error) {
      if (!this.gone) this.app.fail(error);
    }
  }

  dispose(): void {
    this.gone = true;
    this.loaded?.dispose();
  }

  key(event: KeyboardEvent): void {
    if (event.key === "[" || event.key === "]") {
      const ids = this.app.ids();
      const next = ids[(ids.indexOf(this.id) + (event.key === "]" ? 1 : ids.length - 1)) % ids.length];
      if (next !== undefined) this.app.go(`#/model/${encodeURIComponent(next)}`);
      return;
    }
    this.loaded?.key(event);
  }
}

class Loaded {
  private settings: Settings;
  private readonly first: Settings;
  private readonly scene: ModelScene;
  private readonly panel: Panel;
  private readonly info: Info;
  private readonly labels: EndLabels;
  private readonly profile: ProfilePlot;
  private readonly bars = h("div", { class: "bars" });
  private readonly profileProblems = h("div", { class: "strip-problems" });
  private readonly readout = h("output", { class: "readout" });
  private readonly place = h("input", { type: "range", min: 0, max: 1, step: 0.001, "aria-label": "place along the line" });
  private readonly fields = new Map<string, Promise<Float32Array>>();
  private marks: MarkedTable[] = [];
  private drawing = 0;
  private drawingProfile = 0;
  private gone = false;
  private shownBars: Bar[] = [];
  private rememberAt = 0;

  constructor(private readonly app: App, private readonly model: Model, root: HTMLElement, state: URLSearchParams) {
    this.first = initialSettings(model);
    this.settings = fromAddress(state, this.first);
    if (model.lines && this.settings.line >= model.lines.offsets.length - 1) this.settings.line = this.first.line;
    this.scene = new ModelScene(model, `${model.id} in three dimensions; arrow keys turn it`);
    this.labels = new EndLabels(this.scene.stage, model);
    this.panel = new Panel(model, () => this.settings, (settings) => this.apply(settings));
    this.info = new Info(model, app.cohort, () => void this.pick(-1));
    this.profile = new ProfilePlot((abscissa, stays) => this.atAbscissa(abscissa, stays), () => this.moveTo(this.settings.at, false));
    this.place.addEventListener("input", () => this.moveTo(Number(this.place.value)));
    fill(root, this.panel.root,
      h("section", { class: "middle" },
        h("div", { class: "scene-frame" }, this.hasGeometry
          ? [this.scene.stage.root, this.labels.root, this.bars, this.tools()]
          : h("div", { class: "message" }, h("p", {}, "This file holds no geometry."))),
        model.lines && model.lines.offsets.length > 1 && this.strip(model.lines)),
      this.info.root);
    const looking = state.get("cam");
    requestAnimationFrame(() => {
      if (this.gone) return;
      if (looking) this.scene.stage.looking = looking;
      else this.scene.stage.frame();
    });
    this.scene.stage.onMoved = () => this.remember();
    this.scene.stage.onDrawn = () => this.labels.place();
    this.scene.stage.onClick((x, y) => this.clicked(x, y));
    void Promise.all([this.draw(), this.drawProfile()]).finally(() => this.readMarks());
    if (this.settings.site >= 0) void this.pick(this.settings.site);
  }

  dispose(): void {
    this.gone = true;
    ++this.drawing; // what is on its way comes too late
    clearTimeout(this.rememberAt);
    this.profile.dispose();
    this.labels.dispose();
    this.scene.dispose();
  }

  private get hasGeometry(): boolean {
    return Boolean(this.model.surface || this.model.lines);
  }

  private tools(): HTMLElement {
    const button = (text: string, title: string, act: () => void) =>
      h("button", { type: "button", title, on: { click: act } }, text);
    return h("div", { class: "tools" },
      button("Whole", "the whole model (0)", () => this.scene.stage.frame()),
      button("Picture", "save a picture as PNG (s)", () => this.picture()),
      button("Link", "copy a link to this view (c)", () => void this.copyLink()));
  }

  private strip(lines: LinesPart): HTMLElement {
    const count = lines.offsets.length - 1;
    const select = (label: string, options: [string, string][], value: string, act: (value: string) => void) => {
      const made = h("select", { "aria-label": label, on: { change: () => act(made.value) } }, options.map(([key, text]) => h("option", { value: key }, text)));
      made.value = value;
      return made;
    };
    this.lineChoice = select("line", Array.from({ length: count }, (_, l) => [String(l), this.lineName(lines, l)]), String(this.settings.line),
      (value) => this.apply({ ...this.settings, line: Number(value) }));
    return h("div", { class: "strip-plot" },
      h("div", { class: "strip-head" }, this.lineChoice,
        select("quantity", lines.fields.map((field) => [field.key, barTitleOf(field)]), this.settings.profile, (profile) => this.apply({ ...this.settings, profile })),
        this.place, this.readout),
      this.profileProblems,
      this.profile.root);
  }
  private lineChoice: HTMLSelectElement | null = null;

  private lineName(lines: LinesPart, line: number): string {
    const target = lines.target[line]!;
    return `Line ${line}: ${lines.source[line]} → ${target < 0 ? "loop" : target}`;
  }

  private apply(settings: Settings): void {
    const before = this.settings;
    this.settings = settings;
    void this.draw();
    if (before.line !== settings.line || before.profile !== settings.profile) {
      if (this.lineChoice) this.lineChoice.value = String(settings.line);
      void this.drawProfile();
    }
    this.remember();
  }

  /** The address follows, but not at each step of a drag: browsers refuse too many changes. */
  private remember(): void {
    clearTimeout(this.rememberAt);
    if (this.gone) return;
    this.rememberAt = window.setTimeout(() => this.app.remember(this.address()), 250);
  }

  private address(): string {
    return `#/model/${encodeURIComponent(this.model.id)}?${toAddress(this.settings, this.first, this.scene.stage.looking)}`;
  }

  private values(field: Field): Promise<Float32Array> {
    const key = `${field.path}#${field.row}`;
    const known = this.fields.get(key);
    if (known) return known;
    const asked = this.app.client.call("field", { id: this.model.id, path: field.path, row: field.row });
    this.fields.set(key, asked);
    return asked;
  }

  private async shown(what: string, fields: Field[] | undefined, key: string, on: boolean): Promise<Shown | null> {
    const field = on ? fields?.find((candidate) => candidate.key === key) : undefined;
    if (!field) return null;
    const values = await this.values(field);
    const counted = what === "Wall" ? this.onWall(values) : values;
    const sorted = sortedFinite(counted);
    const { whole, map } = this.settings;
    const whole_ = extent(sorted);
    let range: [number, number] = whole ? whole_ : [quantile(sorted, 0.01), quantile(sorted, 0.99)];
    if (!(range[1] > range[0])) range = whole_;
    const categories = field.kind === "category" ? [...new Set(sorted)] : [];
    return { field, values, bar: { what, field, map, range, categories, empty: sorted.length === 0, cut: range[0] > whole_[0] || range[1] < whole_[1] } };
  }

  /** Values of the sites that the wall has triangles at: extensions and caps have none to look at. */
  private onWall(values: Float32Array): Float32Array {
    const { wall } = this.model.surface!;
    const seen = new Uint8Array(values.length);
    for (const v of wall) seen[v] = 1;
    return values.filter((_, v) => seen[v] === 1);
  }

  private look(shown: Shown | null, opacity: number): Look {
    if (!shown) return { ...kPlain, opacity };
    return { mode: shown.field.kind, map: this.settings.map, range: shown.bar.range, opacity };
  }

  private async draw(): Promise<void> {
    const turn = ++this.drawing;
    const { settings, model, scene } = this;
    const said: string[] = []; // what cannot be read is plain, or left away
    try {
      const [wall, lines, balls, polygons, voronoi] = await Promise.all([
        tried(said, this.shown("Wall", model.surface?.fields, settings.wallBy, settings.wall)),
        tried(said, this.shown("Lines", model.lines?.fields, settings.linesBy, settings.lines)),
        settings.balls === "all" ? tried(said, this.shown("Balls", model.lines?.fields, settings.linesBy || "radius", true)) : null,
        tried(said, this.shown("Voronoi diagram", model.voronoi?.fields, settings.voronoiBy, settings.voronoi)),
        settings.voronoi && model.voronoi ? tried(said, this.app.client.call("voronoi", model.id)) : null,
      ]);
      if (turn !== this.drawing) return; // something newer is on its way
      scene.showWall(settings.wall, this.look(wall, settings.opacity), wall?.values ?? null);
      scene.showAdded(settings.added);
      scene.showLines(settings.lines, this.look(lines, 1), lines?.values ?? null);
      scene.chooseLine(settings.line, settings.lines && settings.balls !== "none");
      scene.showTrain(settings.balls === "all", settings.line, this.look(balls, 0.45), balls?.values ?? null);
      scene.showPolygons(settings.voronoi, settings.added, voronoi, this.look(polygons, 1), polygons?.values ?? null);
      for (const marked of this.marks) scene.showMarks(marked, settings.marks.includes(marked.name));
      this.labels.show(settings.ends);
      this.shownBars = [wall, polygons, lines].flatMap((shown) => (shown ? [shown.bar] : []));
      fill(this.bars, problems(said), this.shownBars.map(colourBar));
      this.moveTo(this.settings.at, false); // it may have been moved meanwhile
      this.scene.stage.root.dataset.ready = String(turn);
    } catch (error) {
      fill(this.bars, problems([sentenceOf(error)]));
    }
  }

  /** What can wait until there is something to look at. */
  private async readMarks(): Promise<void> {
    if (this.gone) return;
    let notes: string[];
    try {
      const found = await this.app.client.call("marks", this.model.id);
      this.marks = found.tables;
      notes = found.notes;
    } catch (error) {
      notes = [sentenceOf(error)];
    }
    if (this.gone) return;
    this.panel.offerMarks(this.marks);
    this.info.showMarks(this.marks, notes);
    if (this.settings.marks.length > 0) void this.draw();
  }

  private async drawProfile(): Promise<void> {
    const { lines } = this.model;
    const field = lines?.fields.find((candidate) => candidate.key === this.settings.profile);
    if (!lines || !field) return;
    const error = lines.fields.find((candidate) => candidate.key === `${field.key}_error`);
    const said: string[] = [];
    const turn = ++this.drawingProfile;
    const [values, errors] = await Promise.all([tried(said, this.values(field)), error ? tried(said, this.values(error)) : null]);
    if (turn !== this.drawingProfile || this.gone) return;
    fill(this.profileProblems, problems(said));
    const [first, end] = this.span();
    this.profile.show(values && {
      x: lines.abscissa.slice(first, end), y: values.slice(first, end), error: errors && errors.slice(first, end),
      xTitle: `Abscissa [${unitText(this.model.unit) || "length"}]`, yTitle: barTitleOf(field),
    });
    this.moveTo(this.settings.at, false);
  }

  private span(): [number, number] {
    const { offsets } = this.model.lines!;
    return [offsets[this.settings.line]!, offsets[this.settings.line + 1]!];
  }

  private atAbscissa(abscissa: number, stays: boolean): void {
    const { lines } = this.model;
    if (!lines) return;
    const [first, end] = this.span();
    const length = lines.abscissa[end - 1]! - lines.abscissa[first]!;
    this.moveTo(length > 0 ? (abscissa - lines.abscissa[first]!) / length : 0, stays);
  }

  /** Puts the mark at a share of the line: in the scene, in the plot, on the slider. */
  private moveTo(share: number, stays = true): void {
    const { lines, unit } = this.model;
    if (!lines || lines.offsets.length < 2) return;
    const [first, end] = this.span();
    if (end <= first) return;
    if (stays) {
      this.settings = { ...this.settings, at: Math.min(1, Math.max(0, share)) };
      this.remember();
    }
    const wanted = lines.abscissa[first]! + share * (lines.abscissa[end - 1]! - lines.abscissa[first]!);
    let k = first;
    while (k + 1 < end && Math.abs(lines.abscissa[k + 1]! - wanted) <= Math.abs(lines.abscissa[k]! - wanted)) ++k;
    const at = new THREE.Vector3().fromArray(lines.points, 3 * k);
    this.scene.showBall(at, this.settings.balls === "one" && this.settings.lines ? lines.radius[k]! : 0);
    this.profile.mark(lines.abscissa[k]!);
    this.place.value = String(share);
    fill(this.readout, `s = ${withUnits(lines.abscissa[k]!, unit)},  r = ${withUnits(lines.radius[k]!, unit)}`);
    this.readout.title = `point ${at.toArray().map((x, axis) => number(x + this.model.centre[axis]!)).join(", ")}`;
  }

  private clicked(x: number, y: number): void {
    const site = this.scene.siteAt(x, y);
    if (site >= 0) {
      void this.pick(site);
      return;
    }
    const point = this.scene.linePointAt(x, y, 12);
    if (point >= 0) this.toLinePoint(point);
    else void this.pick(-1);
  }

  private toLinePoint(point: number): void {
    const lines = this.model.lines!;
    let line = this.settings.line;
    if (point < lines.offsets[line]! || point >= lines.offsets[line + 1]!)
      line = lines.offsets.findIndex((offset, l) => point >= offset && point < (lines.offsets[l + 1] ?? 0));
    if (line !== this.settings.line) this.apply({ ...this.settings, line });
    this.atAbscissa(lines.abscissa[point]!, true);
  }

  private async pick(index: number): Promise<void> {
    this.settings = { ...this.settings, site: index };
    this.remember();
    try {
      const site = index < 0 ? null : await this.app.client.call("site", { id: this.model.id, index });
      if (this.gone || this.settings.site !== index) return;
      this.scene.showPicked(site);
      this.info.showSite(site);
      if (!site || site.line < 0 || !this.model.lines || site.line >= this.model.lines.offsets.length - 1) return;
      if (site.line !== this.settings.line) this.apply({ ...this.settings, line: site.line });
      if (Number.isFinite(site.abscissa)) this.atAbscissa(site.abscissa, true);
    } catch (error) {
      if (this.gone || this.settings.site !== index) return;
      this.settings = { ...this.settings, site: -1 };
      fill(this.bars, problems([sentenceOf(error)]));
    }
  }

  private picture(): void {
    const scale = 2;
    const canvas = this.scene.stage.picture(scale);
    const g = canvas.getContext("2d")!;
    const text = getComputedStyle(document.documentElement).getPropertyValue("--text");
    paintBars(g, this.shownBars, canvas.width, scale, text);
    this.labels.paint(g, scale, text);
    g.textAlign = "left";
    g.textBaseline = "bottom";
    g.fillStyle = text;
    g.fillText(this.model.id, 14 * scale, canvas.height - 12 * scale);
    canvas.toBlob((blob) => blob && download(blob, `${this.model.id.replaceAll(/[^\w.-]+/g, "_")}.png`));
  }

  private async copyLink(): Promise<void> {
    const link = location.href.split("#")[0] + this.address();
    this.app.remember(this.address());
    try {
      await navigator.clipboard.writeText(link);
      fill(this.readout, "link copied");
    } catch {
      fill(this.readout, "the link stands in the address bar");
    }
  }

  key(event: KeyboardEvent): void {
    const { lines } = this.model;
    if (this.scene.stage.key(event)) return;
    if (event.key === "v") this.panel.nextPreset();
    else if (event.key === "s" && this.hasGeometry) this.picture();
    else if (event.key === "c") void this.copyLink();
    else if (event.key === "Escape") void this.pick(-1);
    else if (event.key === "," || event.key === ".") this.moveTo(Math.min(1, Math.max(0, this.settings.at + (event.key === "." ? 0.01 : -0.01))));
    else if (event.key === "l" && lines) this.apply({ ...this.settings, line: (this.settings.line + 1) % (lines.offsets.length - 1) });
  }
}

/** What is read, or null after a failure, whose sentence goes to `said`. */
const tried = <T>(said: string[], read: Promise<T>): Promise<T | null> =>
  read.catch((error: unknown) => (said.push(sentenceOf(error)), null));

const barTitleOf = (field: Field): string =>
  barTitle({ what: "", field, map: "viridis", range: [0, 1], categories: [], empty: false, cut: false });
