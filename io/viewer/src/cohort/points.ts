// One drawing of models as points, for both plots of the cohort: measure by group (with a box per group) and measure by
// measure. Points can be hovered, clicked, and walked through with the arrow keys from left to right.
import { DrawnCanvas, type Theme } from "../ui/canvas";
import { unitText } from "../archive/words";
import { h, withUnits } from "../ui/dom";
import { extent, padded, quantile, sortedFinite, tickText, ticks } from "../ui/scale";
import { categoryColour } from "../ui/colours";

export interface PointEvents {
  hover(row: number): void;
  open(row: number): void;
  describe(row: number): string[];
}

export interface PointData {
  rows: number[];
  x: Float64Array | null; // by row; null = by group
  y: Float64Array;
  group: Int32Array; // by row
  groups: string[];
  xTitle: string;
  yTitle: string;
}

const kMargin = { left: 58, right: 12, top: 22, bottom: 36 };
const kHit = 9;

interface Placed {
  row: number;
  x: number;
  y: number;
}

export class PointPlot {
  readonly drawn: DrawnCanvas;
  private readonly tip = h("div", { class: "tip", role: "status" });
  private data: PointData | null = null;
  private placed: Placed[] = [];
  private hovered = -1;
  private chosen = -1;

  constructor(label: string, private readonly events: PointEvents) {
    this.drawn = new DrawnCanvas("plot", (g, theme) => this.draw(g, theme));
    this.drawn.root.appendChild(this.tip);
    const canvas = this.drawn.canvas;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `${label}; arrow keys walk through the models, Enter opens one`);
    canvas.addEventListener("mousemove", (event) => this.events.hover(this.nearest(event.offsetX, event.offsetY)));
    canvas.addEventListener("mouseleave", () => this.events.hover(-1));
    canvas.addEventListener("click", (event) => {
      const row = this.nearest(event.offsetX, event.offsetY);
      if (row >= 0) this.events.open(row);
    });
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  show(data: PointData): void {
    this.data = data;
    this.drawn.redraw();
  }

  mark(chosen: number, hovered: number): void {
    this.chosen = chosen;
    this.hovered = hovered;
    this.drawn.redraw();
  }

  /** Where a model's point is on the canvas. */
  private position(row: number): Placed | undefined {
    return this.placed.find((point) => point.row === row);
  }

  private nearest(x: number, y: number): number {
    let best = -1;
    let least = kHit * kHit;
    for (const point of this.placed) {
      const d = (point.x - x) ** 2 + (point.y - y) ** 2;
      if (d < least) [least, best] = [d, point.row];
    }
    return best;
  }

  private key(event: KeyboardEvent): void {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (step !== undefined && this.placed.length > 0) {
      const order = [...this.placed].sort((a, b) => a.x - b.x || a.y - b.y);
      const now = order.findIndex((point) => point.row === this.hovered);
      const next = now < 0 ? 0 : (now + step + order.length) % order.length;
      this.events.hover(order[next]!.row);
      event.preventDefault();
    }
    if (event.key === "Enter" && this.hovered >= 0) this.events.open(this.hovered);
  }

  private draw(g: CanvasRenderingContext2D, theme: Theme): void {
    const data = this.data;
    this.placed = [];
    if (!data) return;
    const rows = data.rows.filter((row) => Number.isFinite(data.y[row]!) && (!data.x || Number.isFinite(data.x[row]!)));
    const [left, top] = [kMargin.left, kMargin.top];
    const right = this.drawn.width - kMargin.right;
    const bottom = this.drawn.height - kMargin.bottom;
    const [low, high] = padded(extent(rows.map((row) => data.y[row]!)));
    const toY = (value: number) => bottom - ((value - low) / (high - low)) * (bottom - top);
    this.verticalAxis(g, theme, data.yTitle, low, high, toY, left, right);
    if (rows.length === 0) {
      g.fillStyle = theme.faint;
      g.textAlign = "center";
      g.fillText("no model has this measure", (left + right) / 2, (top + bottom) / 2);
    }
    if (data.x) this.placeScatter(g, theme, data, rows, toY, left, right, bottom);
    else this.placeGroups(g, theme, data, rows, toY, left, right, bottom);
    this.drawPoints(g, theme, data);
    this.showTip();
  }

  private verticalAxis(
    g: CanvasRenderingContext2D, theme: Theme, title: string, low: number, high: number,
    toY: (value: number) => number, left: number, right: number,
  ): void {
    const values = ticks(low, high, Math.max(2, this.drawn.height / 45));
    const step = values.length > 1 ? values[1]! - values[0]! : 1;
    g.textBaseline = "middle";
    g.textAlign = "right";
    for (const value of values) {
      g.strokeStyle = theme.grid;
      line(g, left, toY(value), right, toY(value));
      g.fillStyle = theme.faint;
      g.fillText(tickText(value, step), left - 6, toY(value));
    }
    g.textAlign = "left";
    g.fillStyle = theme.text;
    g.fillText(title, 6, 9);
  }

  private placeScatter(
    g: CanvasRenderingContext2D, theme: Theme, data: PointData, rows: number[], toY: (value: number) => number,
    left: number, right: number, bottom: number,
  ): void {
    const x = data.x!;
    const [low, high] = padded(extent(rows.map((row) => x[row]!)));
    const toX = (value: number) => left + ((value - low) / (high - low)) * (right - left);
    const values = ticks(low, high, Math.max(2, (right - left) / 70));
    const step = values.length > 1 ? values[1]! - values[0]! : 1;
    g.textBaseline = "top";
    g.textAlign = "center";
    for (const value of values) {
      g.strokeStyle = theme.grid;
      line(g, toX(value), kMargin.top, toX(value), bottom);
      g.fillStyle = theme.faint;
      g.fillText(tickText(value, step), toX(value), bottom + 5);
    }
    g.textAlign = "right";
    g.fillStyle = theme.text;
    g.fillText(data.xTitle, right, bottom + 20);
    for (const row of rows) this.placed.push({ row, x: toX(x[row]!), y: toY(data.y[row]!) });
  }

  private placeGroups(
    g: CanvasRenderingContext2D, theme: Theme, data: PointData, rows: number[], toY: (value: number) => number,
    left: number, right: number, bottom: number,
  ): void {
    const width = (right - left) / data.groups.length;
    data.groups.forEach((name, index) => {
      const members = rows.filter((row) => data.group[row] === index);
      const middle = left + (index + 0.5) * width;
      g.textAlign = "center";
      g.textBaseline = "top";
      g.fillStyle = theme.text;
      g.fillText(fitted(g, name, width - 4), middle, bottom + 5);
      g.fillStyle = theme.faint;
      g.fillText(`n = ${members.length}`, middle, bottom + 19);
      const box = Math.min(46, width * 0.3);
      if (members.length >= 3)
        this.box(g, theme, sortedFinite(members.map((row) => data.y[row]!)), toY, middle - Math.min(width * 0.28, 60), box / 2);
      swarm(members.map((row) => ({ row, x: middle + Math.min(width * 0.12, 26), y: toY(data.y[row]!) })), width * 0.36, this.placed);
    });
  }

  private box(
    g: CanvasRenderingContext2D, theme: Theme, sorted: Float64Array, toY: (value: number) => number, x: number, half: number,
  ): void {
    const [q1, q2, q3] = [0.25, 0.5, 0.75].map((share) => quantile(sorted, share)) as [number, number, number];
    const reach = 1.5 * (q3 - q1);
    const low = Math.min(q1, sorted.find((value) => value >= q1 - reach) ?? q1);
    const high = Math.max(q3, sorted.findLast((value) => value <= q3 + reach) ?? q3);
    g.strokeStyle = theme.faint;
    g.lineWidth = 1;
    line(g, x, toY(low), x, toY(q1));
    line(g, x, toY(q3), x, toY(high));
    g.strokeRect(x - half / 2, toY(q3), half, Math.max(1, toY(q1) - toY(q3)));
    g.lineWidth = 2;
    g.strokeStyle = theme.text;
    line(g, x - half / 2, toY(q2), x + half / 2, toY(q2));
    g.lineWidth = 1;
  }

  private drawPoints(g: CanvasRenderingContext2D, theme: Theme, data: PointData): void {
    const radius = this.placed.length > 400 ? 2.5 : 4;
    const several = data.groups.length > 1;
    for (const point of this.placed) {
      g.globalAlpha = this.placed.length > 400 ? 0.65 : 0.85;
      g.fillStyle = several ? categoryColour(data.group[point.row]!) : theme.accent;
      disc(g, point, radius);
    }
    g.globalAlpha = 1;
    for (const row of [this.chosen, this.hovered]) {
      const point = this.position(row);
      if (!point) continue;
      g.strokeStyle = theme.text;
      g.lineWidth = 2;
      g.beginPath();
      g.arc(point.x, point.y, radius + 3, 0, 2 * Math.PI);
      g.stroke();
      g.lineWidth = 1;
    }
  }

  private showTip(): void {
    const point = this.position(this.hovered);
    this.tip.hidden = !point;
    if (!point) return;
    Object.assign(this.tip.dataset, { x: Math.round(point.x), y: Math.round(point.y) });
    this.tip.replaceChildren(...this.events.describe(point.row).map((text, i) => h(i === 0 ? "strong" : "span", {}, text)));
    const right = point.x > this.drawn.width / 2;
    this.tip.style.left = right ? "" : `${point.x + 12}px`;
    this.tip.style.right = right ? `${this.drawn.width - point.x + 12}px` : "";
    this.tip.style.top = `${Math.min(point.y, this.drawn.height - 72)}px`;
  }
}

/** Moves points of nearly the same height aside, in turns to the right and to the left, within `width`. */
function swarm(points: Placed[], width: number, placed: Placed[]): void {
  const step = points.length > 400 ? 4 : 8;
  const rows = new Map<number, number>();
  for (const point of points.sort((a, b) => a.y - b.y)) {
    const level = Math.round(point.y / step);
    const used = rows.get(level) ?? 0;
    rows.set(level, used + 1);
    const side = used % 2 === 0 ? 1 : -1;
    const aside = Math.ceil(used / 2) * step * 0.9;
    placed.push({ ...point, x: point.x + side * (aside % Math.max(step, width)) });
  }
}

function line(g: CanvasRenderingContext2D, x1: number, y1: number, x2: number, y2: number): void {
  g.beginPath();
  g.moveTo(x1, y1);
  g.lineTo(x2, y2);
  g.stroke();
}

function disc(g: CanvasRenderingContext2D, point: Placed, radius: number): void {
  g.beginPath();
  g.arc(point.x, point.y, radius, 0, 2 * Math.PI);
  g.fill();
}

function fitted(g: CanvasRenderingContext2D, text: string, width: number): string {
  if (g.measureText(text).width <= width) return text;
  let cut = text;
  while (cut.length > 1 && g.measureText(`${cut}…`).width > width) cut = cut.slice(0, -1);
  return `${cut}…`;
}

export const measureTitle = (label: string, units: string): string => (unitText(units) ? `${label} [${unitText(units)}]` : label);
export const measureText = (label: string, value: number, units: string): string =>
  `${label}: ${withUnits(value, units)}`;
