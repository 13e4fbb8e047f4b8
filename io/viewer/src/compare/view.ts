// Two models side by side, and below them the profile of one line or one branch over the whole cohort with these two on
// top. Profiles of lines come in model by model, and the plot grows with them; those of branches stand in the index.
import type { App, View } from "../app";
import type { Field, Model, Table } from "../archive/protocol";
import { columnOf, groupings, groupsOf } from "../cohort/rows";
import { measureTitle } from "../cohort/points";
import { unitText, labelOf } from "../archive/words";
import { kMapNames, type MapName } from "../ui/colours";
import { checkbox, choice, fill, h, sentenceOf, slider } from "../ui/dom";
import { BandPlot, type BandCurve } from "./band";
import { branchCurves, branchLabels, sectionColumns } from "./branches";
import { Panes, type CompareLook } from "./panes";

interface Profiled {
  key: string;
  of: string; // "line" or "branch"
  curves: BandCurve[];
  units: string;
  read: number;
  failed: number;
  done: boolean;
}

const kLines = "/centerlines/";
const kBranch = "branch:"; // before a label, among the choices of lines

export class CompareView implements View {
  readonly root = h("main", { class: "compare" });
  private readonly models: (Model | null)[] = [null, null];
  private readonly panes: Panes;
  private readonly plot = new BandPlot();
  private readonly toolbar = h("div", { class: "toolbar" });
  private readonly band = h("div", { class: "strip-head" });
  private readonly said = h("span", { class: "count", role: "status" });
  private readonly problems = [h("p", { class: "problem" }), h("p", { class: "problem" })] as const;
  private readonly look: CompareLook;
  private quantity: string;
  private line: number;
  private branch: string; // label; empty = a line
  private labels: string[] = [];
  private sections: Table | null = null;
  private by: string;
  private byShare: boolean;
  private profiled: Profiled | null = null;
  private cancel: () => void = () => {};
  private gone = false;
  private rememberAt = 0;
  private redrawAt = 0;
  private looking: string;

  constructor(private readonly app: App, private a: string, private b: string, state: URLSearchParams) {
    this.panes = new Panes(app.client);
    const map = state.get("map") as MapName;
    this.look = {
      wallBy: state.get("wallBy") ?? "", linesBy: state.get("linesBy") ?? "radius", map: kMapNames.includes(map) ? map : "viridis",
      opacity: Math.min(1, Math.max(0.05, Number(state.get("opacity") ?? 0.25) || 0.25)), trueSize: state.get("trueSize") === "true",
    };
    this.quantity = state.get("quantity") ?? "radius";
    this.line = Number(state.get("line") ?? -1);
    this.branch = state.get("branch") ?? "";
    this.byShare = state.get("share") !== "false";
    const groups = groupings(app.cohort!.models).map((column) => column.name);
    this.by = state.get("by") ?? ["group", ...groups].find((name) => groups.includes(name)) ?? "";
    this.looking = state.get("cam") ?? "";
    this.panes.onMoved = () => this.remember();
    this.panes.onProblem = (side, sentence) => fill(this.problems[side as 0 | 1], sentence);
    fill(this.root, this.toolbar,
      h("div", { class: "panes" }, this.pane(0), this.pane(1), this.panes.bars),
      h("div", { class: "strip-plot band" }, this.band, this.plot.drawn.root));
    this.fillToolbar();
    this.fillBand();
    void this.load();
  }

  dispose(): void {
    this.gone = true;
    clearTimeout(this.rememberAt);
    this.cancel();
    this.plot.drawn.dispose();
    this.panes.dispose();
  }

  key(event: KeyboardEvent): void {
    this.panes.key(event);
  }

  private pane(side: 0 | 1): HTMLElement {
    const ids = this.app.ids();
    const select = h("select", {
      "aria-label": side === 0 ? "left model" : "right model",
      on: { change: () => this.go(side === 0 ? select.value : this.a, side === 1 ? select.value : this.b) },
    }, ids.map((id) => h("option", { value: id }, id)));
    select.value = side === 0 ? this.a : this.b;
    return h("section", { class: "pane" }, this.panes.roots[side], h("div", { class: "pane-head" }, select), this.problems[side]);
  }

  private go(a: string, b: string): void {
    this.app.go(this.address(a, b));
  }

  private async load(): Promise<void> {
    // An archive without branches, or one model's file, has no such table.
    this.labels = await this.app.client.call("table", "branches").then(branchLabels, () => []);
    await Promise.all(([0, 1] as const).map(async (side) => {
      try {
        const model = await this.app.client.call("model", side === 0 ? this.a : this.b);
        if (this.gone) return;
        this.models[side] = model;
        this.panes.put(side, model);
      } catch (error) {
        fill(this.problems[side], sentenceOf(error));
      }
    }));
    if (this.gone) return;
    this.fillToolbar();
    this.fillBand();
    requestAnimationFrame(() => {
      if (this.gone) return;
      this.panes.scale(this.look.trueSize);
      if (this.looking) this.panes.looking = this.looking;
      else this.panes.frame();
    });
    await this.show(); // before the cohort, which may be large
    if (!this.gone) void this.profile();
  }

  private show(): Promise<void> {
    this.remember();
    for (const side of [0, 1] as const) if (this.models[side]) fill(this.problems[side]);
    return this.panes.show(this.look).catch((error: unknown) => fill(this.problems[0], sentenceOf(error)));
  }

  /** Fields that either model has. */
  private fields(of: (model: Model) => Field[] | undefined): Field[] {
    const found = new Map<string, Field>();
    for (const model of this.models) for (const field of (model && of(model)) ?? []) if (!found.has(field.key)) found.set(field.key, field);
    return [...found.values()];
  }

  private fillToolbar(): void {
    const options = (fields: Field[]) => [["", "plain"] as const, ...fields.map((field) => [field.key, measureTitle(field.label, field.units)] as const)];
    const { look } = this;
    fill(this.toolbar,
      choice("Walls", options(this.fields((model) => model.surface?.fields)), look.wallBy, (wallBy) => {
        look.wallBy = wallBy;
        if (wallBy && look.opacity < 0.5) look.opacity = 1;
        this.fillToolbar();
        void this.show();
      }).root,
      slider("Opacity", 0.05, 1, 0.01, look.opacity, (opacity) => ((look.opacity = opacity), void this.show())).root,
      choice("Lines", options(this.fields((model) => model.lines?.fields)), look.linesBy, (linesBy) => ((look.linesBy = linesBy), void this.show())).root,
      choice("Colour map", kMapNames.map((name) => [name, name] as const), look.map, (map) => ((look.map = map as MapName), void this.show())).root,
      checkbox("True size", look.trueSize, (on) => {
        look.trueSize = on;
        this.panes.scale(on);
        this.remember();
      }));
  }

  private fillBand(): void {
    const { app } = this;
    const fields = this.fields((model) => model.lines?.fields.filter((field) => field.kind === "scale"));
    const sectional = this.sections ? sectionColumns(this.sections).map((each) => [each.name, measureTitle(each.label, each.units)] as const) : [];
    const linear = fields.map((field) => [field.key, measureTitle(field.label, field.units)] as const);
    const known = this.branch ? sectional : linear;
    const quantities = known.length > 0 ? known : [[this.quantity, labelOf(this.quantity)] as const];
    const most = Math.max(1, ...this.models.map((model) => (model?.lines ? model.lines.offsets.length - 1 : 0)));
    const lines = [
      ["-1", "the longest line"] as const,
      ...Array.from({ length: Math.min(most, 200) }, (_, l) => [String(l), `line ${l}`] as const),
      ...this.labels.slice(0, 500).map((label) => [kBranch + label, `branch ${label}`] as const),
    ];
    const groups = [["", "all together"] as const, ...groupings(app.cohort!.models).map((column) => [column.name, column.label] as const)];
    fill(this.band,
      h("h2", {}, "Over the cohort"),
      choice("Quantity", quantities, this.quantity, (value) => ((this.quantity = value), void this.profile())).root,
      choice("Of", lines, this.branch ? kBranch + this.branch : String(this.line), (value) => this.choose(value)).root,
      choice("By", groups, this.by, (value) => ((this.by = value), this.drawBand())).root,
      checkbox("By share of length", this.byShare, (on) => ((this.byShare = on), this.drawBand())),
      h("span", { class: "grow" }), this.said);
  }

  private choose(value: string): void {
    const branch = value.startsWith(kBranch) ? value.slice(kBranch.length) : "";
    const otherKind = Boolean(branch) !== Boolean(this.branch);
    if (otherKind) this.quantity = branch ? "equivalent_diameter" : "radius";
    this.branch = branch;
    if (!branch) this.line = Number(value);
    if (otherKind) this.fillBand();
    void this.profile();
  }

  private async profileOfBranch(): Promise<void> {
    const profiled: Profiled = { key: this.quantity, of: "branch", curves: [], units: "", read: 0, failed: 0, done: true };
    this.profiled = profiled;
    const first = !this.sections;
    try {
      this.sections ??= await this.app.client.call("table", "sections");
    } catch (error) {
      fill(this.said, sentenceOf(error));
      return;
    }
    if (this.profiled !== profiled || this.gone) return;
    Object.assign(profiled, branchCurves(this.sections, this.branch, this.quantity));
    if (first) this.fillBand();
    this.drawBand();
  }

  private async profile(): Promise<void> {
    this.cancel();
    this.cancel = () => {};
    this.remember();
    if (this.branch) return this.profileOfBranch();
    const ids = this.app.ids();
    const order = [...new Set([this.a, this.b, ...ids])].filter((id) => ids.includes(id));
    const profiled: Profiled = { key: this.quantity, of: "line", curves: [], units: "", read: 0, failed: 0, done: false };
    this.profiled = profiled;
    const { answer, cancel } = this.app.client.stream("profiles", { ids: order, path: kLines + this.quantity, line: this.line }, (part) => {
      const curve = part as { id: string; x?: Float32Array; y?: Float32Array; units?: string };
      profiled.read += 1;
      if (curve.x && curve.y && curve.x.length > 0) {
        const length = curve.x.at(-1)!;
        profiled.curves.push({ id: curve.id, group: 0, x: curve.x, share: curve.x.map((x) => x / length), y: curve.y });
        profiled.units ||= curve.units ?? "";
      }
      this.drawSoon(profiled);
    });
    this.cancel = cancel;
    try {
      profiled.failed = (await answer).failed.length;
    } catch (error) {
      fill(this.said, sentenceOf(error));
      return;
    }
    profiled.done = true;
    if (this.profiled === profiled && !this.gone) this.drawBand();
  }

  private drawSoon(profiled: Profiled): void {
    if (this.redrawAt || this.profiled !== profiled || this.gone) return;
    this.redrawAt = window.setTimeout(() => {
      this.redrawAt = 0;
      if (!this.gone) this.drawBand();
    }, 200);
  }

  private drawBand(): void {
    const { profiled, app } = this;
    if (!profiled) return;
    this.remember();
    const table = app.cohort!.models;
    const ids = app.ids();
    const groups = groupsOf(table, columnOf(table, this.by));
    const row = new Map(ids.map((id, index) => [id, index]));
    for (const curve of profiled.curves) curve.group = groups.of[row.get(curve.id) ?? 0] ?? 0;
    const unit = this.models.find((model) => model)?.unit ?? "";
    this.plot.show({
      curves: profiled.curves, groups: groups.names, chosen: [...new Set([this.a, this.b])], byShare: this.byShare,
      xTitle: this.byShare ? `Share of the ${profiled.of}'s length` : `Abscissa${unitText(unit) ? ` [${unit}]` : ""}`,
      yTitle: measureTitle(labelOf(profiled.key), profiled.units),
    });
    const missing = profiled.failed > 0 ? `, ${profiled.failed} cannot be read` : "";
    fill(this.said, profiled.done ? `${profiled.curves.length} of ${ids.length} models have this ${profiled.of}${missing}` : `${profiled.read} of ${ids.length} models read …`);
    this.plot.drawn.root.dataset.ready = String(profiled.done);
  }

  private address(a: string, b: string): string {
    const { look } = this;
    const query = new URLSearchParams({
      wallBy: look.wallBy, linesBy: look.linesBy, opacity: String(look.opacity), map: look.map, trueSize: String(look.trueSize),
      quantity: this.quantity, line: String(this.line), branch: this.branch, by: this.by, share: String(this.byShare), cam: this.panes.looking,
    });
    return `#/compare/${encodeURIComponent(a)}/${encodeURIComponent(b)}?${query.toString()}`;
  }

  private remember(): void {
    clearTimeout(this.rememberAt);
    if (this.models.every((model) => !model)) return;
    this.rememberAt = window.setTimeout(() => this.app.remember(this.address(this.a, this.b)), 250);
  }
}
