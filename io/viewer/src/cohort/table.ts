// The table of models. Only the rows in sight are elements, so that thousands of models cost as much as thirty; widths
// come from the texts of the columns, since a table that is laid out by what is in sight would tremble.
import type { Column, Table } from "../archive/protocol";
import { unitText } from "../archive/words";
import { fill, h, number } from "../ui/dom";

const kRow = 29; // height in pixels, as the style sheet has it
const kOverscan = 8;

export interface TableEvents {
  sort(column: string): void;
  hover(row: number): void;
  choose(row: number): void;
  open(row: number): void;
}

function cellText(column: Column, row: number): string {
  return column.numbers ? number(column.numbers[row]) : (column.texts?.[row] ?? "");
}

function widthOf(column: Column, rows: number): number {
  let longest = Math.max(Math.min(column.label.length, 14), unitText(column.units).length + 2) + 2;
  const step = Math.max(1, Math.floor(rows / 200));
  for (let row = 0; row < rows; row += step) longest = Math.max(longest, cellText(column, row).length);
  return Math.round(Math.min(28, longest) * 7.6 + (column.name === "status" ? 38 : 26));
}

export class ModelTable {
  readonly root = h("div", { class: "table-scroll", tabindex: "0", role: "grid", "aria-label": "models" });
  private readonly head = h("thead");
  private readonly body = h("tbody");
  private readonly columnsElement = h("colgroup");
  private readonly table = h("table", { class: "models" }, this.columnsElement, this.head, this.body);
  private columns: Column[] = [];
  private rows: number[] = [];
  private chosen = -1;
  private hovered = -1;
  private scrolled = 0; // browsers forget it of what is not shown

  constructor(private readonly data: Table, private readonly events: TableEvents) {
    this.root.appendChild(this.table);
    this.root.addEventListener("scroll", () => {
      this.scrolled = this.root.scrollTop;
      this.draw();
    });
    this.root.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => {
      if (this.root.clientHeight > 0) this.root.scrollTop = this.scrolled;
      this.draw();
    }).observe(this.root);
    this.body.addEventListener("click", (event) => this.at(event, (row) => (this.events.choose(row), this.root.focus())));
    this.body.addEventListener("dblclick", (event) => this.at(event, (row) => this.events.open(row)));
    this.body.addEventListener("mouseover", (event) => this.at(event, (row) => this.events.hover(row)));
    this.body.addEventListener("mouseleave", () => this.events.hover(-1));
  }

  show(columns: Column[], rows: number[], sort: { column: string; descending: boolean }): void {
    this.columns = columns;
    this.rows = rows;
    const widths = columns.map((column) => widthOf(column, this.data.rows));
    fill(this.columnsElement, widths.map((width) => {
      const made = h("col");
      made.style.width = `${width}px`;
      return made;
    }));
    this.table.style.width = `${widths.reduce((a, b) => a + b, 0)}px`;
    fill(this.head, h("tr", {}, columns.map((column) => this.heading(column, sort))));
    this.root.setAttribute("aria-rowcount", String(rows.length));
    this.draw();
  }

  mark(chosen: number, hovered: number): void {
    if (chosen === this.chosen && hovered === this.hovered) return;
    const moved = chosen !== this.chosen;
    this.chosen = chosen;
    this.hovered = hovered;
    if (moved) this.reveal();
    this.draw();
  }

  private heading(column: Column, sort: { column: string; descending: boolean }): HTMLElement {
    const sorted = sort.column === column.name;
    const units = unitText(column.units);
    const button = h("button", { type: "button", title: column.description || column.label, on: { click: () => this.events.sort(column.name) } },
      h("span", { class: "label" }, column.label), sorted && h("span", { class: "arrow" }, sort.descending ? "▼" : "▲"),
      h("span", { class: "units" }, units));
    return h("th", {
      class: column.numbers ? "number" : "", scope: "col",
      "aria-sort": sorted ? (sort.descending ? "descending" : "ascending") : undefined,
    }, button);
  }

  private at(event: MouseEvent, act: (row: number) => void): void {
    const row = (event.target as Element).closest("tr")?.dataset.row;
    if (row !== undefined) act(Number(row));
  }

  private reveal(): void {
    const index = this.rows.indexOf(this.chosen);
    if (index < 0) return;
    const head = this.head.offsetHeight;
    const top = index * kRow;
    const shown = this.root.clientHeight - head;
    if (top < this.root.scrollTop) this.root.scrollTop = top;
    else if (top + kRow > this.root.scrollTop + shown) this.root.scrollTop = top + kRow - shown;
  }

  private key(event: KeyboardEvent): void {
    if (event.target !== this.root) return;
    const page = Math.max(1, Math.floor(this.root.clientHeight / kRow) - 2);
    const steps: Record<string, number> = {
      ArrowDown: 1, ArrowUp: -1, PageDown: page, PageUp: -page, Home: -this.rows.length, End: this.rows.length,
    };
    const step = steps[event.key];
    if (step !== undefined && this.rows.length > 0) {
      const now = this.rows.indexOf(this.chosen);
      const next = now < 0 ? 0 : Math.max(0, Math.min(this.rows.length - 1, now + step));
      this.events.choose(this.rows[next]!);
      event.preventDefault();
    }
    if (event.key === "Enter" && this.rows.includes(this.chosen)) this.events.open(this.chosen);
  }

  private draw(): void {
    const shown = Math.ceil(this.root.clientHeight / kRow);
    const first = Math.max(0, Math.min(Math.floor(this.root.scrollTop / kRow) - kOverscan, this.rows.length));
    const end = Math.min(this.rows.length, first + shown + 2 * kOverscan);
    const space = (rows: number) => {
      const made = h("tr", { class: "space", "aria-hidden": "true" }, h("td"));
      made.style.height = `${rows * kRow}px`;
      return made;
    };
    const made: HTMLElement[] = [];
    if (first > 0) made.push(space(first));
    for (let i = first; i < end; ++i) made.push(this.row(this.rows[i]!, i));
    if (end < this.rows.length) made.push(space(this.rows.length - end));
    fill(this.body, made);
  }

  private row(row: number, index: number): HTMLElement {
    const marks = [row === this.chosen ? "chosen" : "", row === this.hovered ? "hovered" : ""].join(" ").trim();
    return h("tr", { class: marks, "data-row": row, "aria-rowindex": index + 1, "aria-selected": row === this.chosen ? "true" : "false" },
      this.columns.map((column) => this.cell(column, row)));
  }

  private cell(column: Column, row: number): HTMLElement {
    const text = cellText(column, row);
    if (column.name === "id")
      return h("td", { class: "id", title: text }, h("a", { href: `#/model/${encodeURIComponent(text)}`, tabindex: "-1" }, text));
    if (column.name === "status") return h("td", {}, h("span", { class: `status ${statusClass(text)}` }, text));
    return h("td", { class: column.numbers ? "number" : "", title: column.numbers ? undefined : text }, text);
  }
}

export const statusClass = (status: string): string =>
  ["ok", "warning", "failed"].includes(status) ? `status-${status}` : "status-other";
