// What is known of a model and of the site that was picked, on the right.
import type { Cohort, MarkedTable, Model, Site } from "../archive/protocol";
import { columnOf } from "../cohort/rows";
import { measureTitle } from "../cohort/points";
import { statusClass } from "../cohort/table";
import { fill, h, number, problems, withUnits } from "../ui/dom";
import { markName } from "./panel";

const kLabels = ["group", "subject", "session", "side", "structure"];
const kMeasures = [
  "length", "radius_min", "radius_mean", "radius_max", "normalized_tangency_deviation_mean", "geodesic_distance_mean",
  "euclidean_distance_mean", "sites", "centerlines",
];

type Pair = [name: string, value: string, title?: string];

const list = (pairs: Pair[]) =>
  pairs.length > 0 && h("dl", { class: "facts" }, pairs.map(([name, value, title]) => [h("dt", { title }, name), h("dd", { title: value }, value)]));

function wayWords(site: Site): string {
  if (!site.way) return "No way leads on to a centerline.";
  return site.wayIsStraight
    ? "Blue: on to the centerline, drawn straight, since the file has no Voronoi diagram with distances."
    : "Blue: on to the centerline, by steepest descent over the vertices of the Voronoi diagram.";
}

export class Info {
  readonly root = h("aside", { class: "info", "aria-label": "facts" });
  private readonly notes = h("div");
  private readonly tables = h("div");
  private readonly pickedPart = h("section", { class: "picked", role: "status" });

  constructor(private readonly model: Model, cohort: Cohort | null, private readonly unpick: () => void) {
    const status = String(model.attributes["status"] ?? "");
    const sentence = model.attributes["failure_sentence"];
    fill(this.root,
      h("section", {},
        h("h1", { title: model.id }, model.id), h("p", {}, h("span", { class: `status ${statusClass(status)}` }, status)),
        sentence !== undefined && h("p", { class: "problem" }, String(sentence)),
        this.notes,
        list([...this.labels(), ...model.covariates.filter(([, value]) => value !== "")])),
      this.pickedPart,
      cohort && !cohort.isModelFile && this.measures(cohort),
      this.findings(),
      this.tables,
      this.provenance());
    this.notes.append(...problems(model.notes));
    this.showSite(null);
  }

  /** What has a place in the model, and what could not be read of it. */
  showMarks(marks: MarkedTable[], notes: string[]): void {
    this.notes.append(...problems(notes));
    fill(this.tables, marks.map((marked) => this.marked(marked)));
    this.tables.dataset.ready = "1";
  }

  private labels(): Pair[] {
    return kLabels.flatMap((key): Pair[] => {
      const value = this.model.attributes[key];
      return value === undefined || value === "" ? [] : [[key, String(value)]];
    });
  }

  private measures(cohort: Cohort): HTMLElement | false {
    const row = columnOf(cohort.models, "id")?.texts?.indexOf(this.model.id) ?? -1;
    if (row < 0) return false;
    const pairs = kMeasures.flatMap((name): Pair[] => {
      const column = columnOf(cohort.models, name);
      return column?.numbers && Number.isFinite(column.numbers[row]!)
        ? [[column.label, withUnits(column.numbers[row]!, column.units), column.description]] : [];
    });
    return pairs.length > 0 && h("section", {}, h("h2", {}, "Measures"), list(pairs));
  }

  private findings(): HTMLElement | false {
    const { findings } = this.model;
    if (findings.length === 0) return false;
    const grave = findings.filter((finding) => finding.severity !== "note");
    return h("details", { open: grave.length > 0 && grave.length < 3 }, h("summary", {}, `Findings (${findings.length})`),
      h("ul", { class: "findings" }, findings.map((finding) =>
        h("li", { class: `severity-${finding.severity === "note" ? "note" : "grave"}` }, h("span", { class: "code" }, finding.code), h("p", {}, finding.message)))));
  }

  private marked({ name, table }: MarkedTable): HTMLElement {
    const shown = Math.min(table.rows, 200);
    const columns = table.columns.slice(0, 40);
    const rows = Array.from({ length: shown }, (_, row) =>
      h("tr", {}, columns.map((column) => h("td", {}, column.numbers ? number(column.numbers[row]!) : column.texts![row]!))));
    return h("details", {}, h("summary", {}, `${markName(name)} (${table.rows})`),
      h("div", { class: "small-table", tabindex: "0" }, h("table", {},
        h("thead", {}, h("tr", {}, columns.map((column) => h("th", { title: column.description }, measureTitle(column.label, column.units))))),
        h("tbody", {}, rows))),
      shown < table.rows && h("p", { class: "quiet" }, `and ${table.rows - shown} more`));
  }

  private provenance(): HTMLElement {
    const keys = ["source_file", "length_unit", "coordinate_system", "lumenline_version", "source_sha256", "inputs_sha256"];
    return h("details", {}, h("summary", {}, "Provenance"),
      list(keys.flatMap((key): Pair[] => (this.model.attributes[key] === undefined ? [] : [[key.replaceAll("_", " "), String(this.model.attributes[key])]]))));
  }

  showSite(site: Site | null): void {
    if (!site) {
      fill(this.pickedPart, this.model.surface && h("p", { class: "quiet" }, "Click the wall: values there, its pole and its way to the centerline."));
      return;
    }
    const values = site.values.map((value): Pair => [
      value.symbol.length > 1 ? value.symbol : value.label,
      value.category ? (value.value < 0 ? "–" : String(value.value)) : withUnits(value.value, value.units), value.label,
    ]);
    fill(this.pickedPart,
      h("h2", {}, `Site ${site.index} `, h("button", { type: "button", class: "quiet", title: "forget the site", on: { click: () => this.unpick() } }, "×")),
      list([["point", site.point.map((x) => number(x)).join(", ")], ...values,
        ...(site.pole ? [["ball at the pole", withUnits(site.pole.radius, this.model.unit), "radius of the Voronoi ball at the site's pole"] as Pair] : [])]),
      h("p", { class: "quiet" }, site.pole
        ? `Orange: from the site to its pole, and the ball there. ${wayWords(site)}`
        : "The site has no pole in this file."));
  }
}
