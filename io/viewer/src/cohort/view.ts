// The cohort: its table on the left, what the numbers look like on the right. One row may be chosen and one hovered,
// in the table and in both plots alike.
import type { App } from "../app";
import type { Cohort, Column, Table } from "../archive/protocol";
import { checkbox, choice, fill, h } from "../ui/dom";
import { columnOf, groupings, groupsOf, measures, parseQuery, sortRows } from "./rows";
import { measureText, measureTitle, PointPlot } from "./points";
import { ModelTable, statusClass } from "./table";

interface State {
  query: string;
  status: Set<string>; // shown; empty = all
  sort: { column: string; descending: boolean };
  columns: Set<string>;
  measure: string;
  by: string;
  x: string;
  y: string;
}

/** Text columns that are provenance rather than something to read. */
const kQuiet = new Set([
  "source_file", "source_sha256", "inputs_sha256", "length_unit", "coordinate_system", "failure_stage", "failure_code",
  "size_note", "voronoi_vertices", "polygons", "triangles", "unreached_sites", "diagonal", "edge_over_radius",
]);

const isStatistic = (name: string) => /_(sd|median|p95)$/.test(name) && !name.startsWith("normalized_tangency_deviation_p95");

function shownAtFirst(table: Table): Set<string> {
  const kept = table.columns.filter((column) => {
    if (column.name === "id" || column.name === "status") return true;
    if (kQuiet.has(column.name) || isStatistic(column.name)) return false;
    return column.numbers ? column.numbers.some((x) => Number.isFinite(x)) : column.texts!.some((text) => text !== "");
  });
  return new Set(kept.map((column) => column.name));
}

export class CohortView {
  readonly root: HTMLElement;
  private readonly table: Table;
  private readonly models: ModelTable;
  private readonly distribution: PointPlot;
  private readonly scatter: PointPlot;
  private readonly count = h("span", { class: "count", role: "status" });
  private readonly problem = h("span", { class: "problem" });
  private readonly state: State;
  private rows: number[] = [];
  private chosen = -1;
  private hovered = -1;

  constructor(private readonly app: App, private readonly cohort: Cohort) {
    this.table = cohort.models;
    this.state = this.initialState();
    this.models = new ModelTable(this.table, {
      sort: (column) => this.sortBy(column),
      hover: (row) => this.mark(this.chosen, row),
      choose: (row) => this.mark(row, this.hovered),
      open: (row) => this.open(row),
    });
    const events = {
      hover: (row: number) => this.mark(this.chosen, row),
      open: (row: number) => this.open(row),
    };
    this.distribution = new PointPlot("distribution of a measure by group", {
      ...events, describe: (row) => this.describe(row, [this.state.measure, this.state.by]),
    });
    this.scatter = new PointPlot("one measure against another", {
      ...events, describe: (row) => this.describe(row, [this.state.x, this.state.y]),
    });
    this.root = h("main", { class: "cohort" }, this.left(), this.right());
    this.update();
  }

  private initialState(): State {
    const numeric = measures(this.table).map((column) => column.name);
    const first = (...wanted: string[]) => wanted.find((name) => numeric.includes(name)) ?? numeric[0] ?? "";
    const groups = groupings(this.table).map((column) => column.name);
    const by = ["group", "structure", "side", ...groups].find((name) => groups.includes(name)) ?? "";
    return {
      query: "", status: new Set(), sort: { column: "", descending: false }, columns: shownAtFirst(this.table),
      measure: first("radius_mean"), by, x: first("length", "sites"), y: first("normalized_tangency_deviation_mean", "radius_mean"),
    };
  }

  focusSearch(): void {
    this.root.querySelector<HTMLInputElement>("input[type=search]")?.focus();
  }

  private idOf(row: number): string {
    return columnOf(this.table, "id")?.texts?.[row] ?? "";
  }

  private open(row: number): void {
    this.app.go(`#/model/${encodeURIComponent(this.idOf(row))}`);
  }

  private describe(row: number, names: string[]): string[] {
    const texts = names.flatMap((name) => {
      const column = columnOf(this.table, name);
      if (!column) return [];
      return [column.numbers ? measureText(column.label, column.numbers[row]!, column.units) : `${column.label}: ${column.texts![row] || "(none)"}`];
    });
    return [this.idOf(row), ...texts];
  }

  private left(): HTMLElement {
    const search = h("input", {
      type: "search", placeholder: "Search, or radius_min<2, group=patient …", "aria-label": "search and filter models",
      title: "Words are looked for in all texts. Comparisons (<, >, <=, >=, =, !=, and : for 'contains') filter by a column.",
      on: { input: () => ((this.state.query = search.value), this.update()) },
    });
    search.value = this.state.query;
    return h("section", { class: "models-pane" },
      h("div", { class: "toolbar" }, search, this.statusChips(), h("span", { class: "grow" }), this.problem, this.count, this.columnMenu()),
      this.models.root,
      this.cohort.notes.length > 0 && h("ul", { class: "notes" }, this.cohort.notes.map((note) => h("li", {}, note))),
      this.failures());
  }

  private statusChips(): HTMLElement {
    const status = columnOf(this.table, "status")?.texts ?? [];
    const chips = [...new Set(status)].sort().map((name) => {
      const chip = h("button", {
        type: "button", class: `chip ${statusClass(name)}`, "aria-pressed": "false",
        on: {
          click: () => {
            if (!this.state.status.delete(name)) this.state.status.add(name);
            chip.setAttribute("aria-pressed", String(this.state.status.has(name)));
            this.update();
          },
        },
      }, `${name} ${status.filter((text) => text === name).length}`);
      return chip;
    });
    return h("div", { class: "chips", role: "group", "aria-label": "filter by status" }, chips);
  }

  private columnMenu(): HTMLElement {
    const boxes = this.table.columns.filter((column) => column.name !== "id").map((column) => {
      const box = checkbox(column.label, this.state.columns.has(column.name), (on) => {
        if (on) this.state.columns.add(column.name);
        else this.state.columns.delete(column.name);
        this.update();
      });
      box.title = column.description;
      return box;
    });
    return h("details", { class: "menu" }, h("summary", {}, "Columns"), h("div", { class: "menu-body" }, boxes));
  }

  private failures(): HTMLElement | false {
    if (this.cohort.failures.length === 0) return false;
    const rows = this.cohort.failures.map((failure) => h("li", {},
      h("a", { href: `#/model/${encodeURIComponent(failure.id)}` }, failure.id), " ",
      h("span", { class: "code" }, [failure.stage, failure.code].filter(Boolean).join(" · ")), h("p", {}, failure.sentence)));
    return h("details", { class: "failures", open: true },
      h("summary", {}, `${rows.length} ${rows.length === 1 ? "model" : "models"} failed`), h("ul", {}, rows));
  }

  private right(): HTMLElement {
    const options = (columns: Column[]) => columns.map((column) => [column.name, measureTitle(column.label, column.units)] as const);
    const numeric = options(measures(this.table));
    const groups = [["", "all together"] as const, ...options(groupings(this.table))];
    const pick = (label: string, key: "measure" | "by" | "x" | "y") =>
      choice(label, key === "by" ? groups : numeric, this.state[key], (value) => ((this.state[key] = value), this.update())).root;
    if (numeric.length === 0)
      return h("section", { class: "plots-pane" }, h("p", { class: "quiet" }, "No measures to plot."));
    return h("section", { class: "plots-pane" },
      h("figure", {}, h("figcaption", {}, h("h2", {}, "Distribution"), pick("Measure", "measure"), pick("By", "by")), this.distribution.drawn.root),
      h("figure", {}, h("figcaption", {}, h("h2", {}, "Scatter"), pick("x", "x"), pick("y", "y")), this.scatter.drawn.root));
  }

  private sortBy(name: string): void {
    const { sort } = this.state;
    // Once up, once down, then as the configuration has it.
    if (sort.column !== name) this.state.sort = { column: name, descending: false };
    else if (!sort.descending) this.state.sort = { column: name, descending: true };
    else this.state.sort = { column: "", descending: false };
    this.update();
  }

  private mark(chosen: number, hovered: number): void {
    if (chosen === this.chosen && hovered === this.hovered) return;
    this.chosen = chosen;
    this.hovered = hovered;
    this.models.mark(chosen, hovered);
    this.distribution.mark(chosen, hovered);
    this.scatter.mark(chosen, hovered);
  }

  private update(): void {
    const { state, table } = this;
    const query = parseQuery(table, state.query);
    const status = columnOf(table, "status")?.texts;
    const all = Array.from({ length: table.rows }, (_, row) => row);
    this.rows = all.filter((row) => query.test(row) && (state.status.size === 0 || state.status.has(status?.[row] ?? "")));
    fill(this.problem, query.unclear.length > 0 && `not understood: ${query.unclear.join(", ")}`);
    fill(this.count, this.rows.length === table.rows ? `${table.rows} models` : `${this.rows.length} of ${table.rows} models`);
    const columns = table.columns.filter((column) => column.name === "id" || state.columns.has(column.name));
    this.models.show(columns, sortRows(this.rows, columnOf(table, state.sort.column), state.sort.descending), state.sort);
    this.plot();
  }

  private plot(): void {
    const { state, table, rows } = this;
    const groups = groupsOf(table, columnOf(table, state.by));
    const title = (column: Column) => measureTitle(column.label, column.units);
    const measure = columnOf(table, state.measure);
    if (measure?.numbers)
      this.distribution.show({
        rows, x: null, y: measure.numbers, group: groups.of, groups: groups.names, xTitle: "", yTitle: title(measure),
      });
    const [x, y] = [columnOf(table, state.x), columnOf(table, state.y)];
    if (x?.numbers && y?.numbers)
      this.scatter.show({
        rows, x: x.numbers, y: y.numbers, group: groups.of, groups: groups.names, xTitle: title(x), yTitle: title(y),
      });
  }
}
