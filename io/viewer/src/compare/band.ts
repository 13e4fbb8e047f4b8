// The profile of one line over the whole cohort: per group the median and the band of its middle half, and the compared
// models on top. Lines differ in length, so they are laid over each other by share of length, or by abscissa.
import { DrawnCanvas, type Theme } from "../ui/canvas";
import { categoryColour } from "../ui/colours";
import { extent, padded, quantile, tickText, ticks } from "../ui/scale";
import { interpolated } from "../archive/interpolate";

export interface BandCurve {
  id: string;
  group: number;
  x: Float32Array; // abscissa
  share: Float32Array; // the same over the whole length
  y: Float32Array;
}

export interface BandData {
  curves: BandCurve[];
  groups: string[];
  chosen: string[]; // ids on top
  byShare: boolean;
  xTitle: string;
  yTitle: string;
}

const kSamples = 101;
const kLeast = 3; // curves that a band is made of
const kMargin = { left: 58, right: 160, top: 22, bottom: 34 };

interface Band {
  group: number;
  count: number;
  x: number[];
  low: number[];
  middle: number[];
  high: number[];
}

const alongOf = (curve: BandCurve, byShare: boolean): Float32Array => (byShare ? curve.share : curve.x);

function bandOf(curves: BandCurve[], group: number, byShare: boolean): Band | null {
  const members = curves.filter((curve) => curve.group === group && curve.x.length > 1);
  if (members.length < kLeast) return null;
  const end = byShare ? 1 : Math.max(...members.map((curve) => curve.x.at(-1)!));
  const band: Band = { group, count: members.length, x: [], low: [], middle: [], high: [] };
  for (let i = 0; i < kSamples; ++i) {
    const at = (i / (kSamples - 1)) * end;
    const values = members.flatMap((curve) => {
      const along = alongOf(curve, byShare);
      if (at < along[0]! - 1e-6 * end || at > along.at(-1)! + 1e-6 * end) return [];
      const value = interpolated(along, curve.y, 0, along.length, at);
      return Number.isFinite(value) ? [value] : [];
    });
    if (values.length < kLeast) values.length = 0; // a gap: its quantiles are NaN
    values.sort((a, b) => a - b);
    band.x.push(at);
    band.low.push(quantile(values, 0.25));
    band.middle.push(quantile(values, 0.5));
    band.high.push(quantile(values, 0.75));
  }
  return band;
}

export class BandPlot {
  readonly drawn = new DrawnCanvas("plot", (g, theme) => this.draw(g, theme));
  private data: BandData | null = null;
  private bands: Band[] = [];

  constructor() {
    this.drawn.canvas.setAttribute("role", "img");
    this.drawn.canvas.setAttribute("aria-label", "profile of one line over the cohort");
  }

  show(data: BandData): void {
    this.data = data;
    this.bands = data.groups.flatMap((_, group) => bandOf(data.curves, group, data.byShare) ?? []);
    this.drawn.redraw();
  }

  private draw(g: CanvasRenderingContext2D, theme: Theme): void {
    const data = this.data;
    if (!data) return;
    const top = data.chosen.flatMap((id) => data.curves.find((curve) => curve.id === id) ?? []);
    const others = data.curves.filter((curve) => !this.bands.some((band) => band.group === curve.group));
    const ys = [...this.bands.flatMap((band) => [...band.low, ...band.high]), ...[...top, ...others].flatMap((curve) => Array.from(curve.y))];
    const [low, high] = padded(extent(ys));
    const end = data.byShare ? 1 : Math.max(0, ...data.curves.map((curve) => curve.x.at(-1) ?? 0)) || 1;
    const [left, bottom] = [kMargin.left, this.drawn.height - kMargin.bottom];
    const right = this.drawn.width - kMargin.right;
    const toX = (x: number) => left + (x / end) * (right - left);
    const toY = (y: number) => bottom - ((y - low) / (high - low)) * (bottom - kMargin.top);
    axes(g, theme, data, [low, high], end, toX, toY, left, right, bottom);
    for (const band of this.bands) paintBand(g, band, toX, toY, data.groups.length > 1 ? categoryColour(band.group) : theme.accent);
    for (const curve of others) paintCurve(g, curve, data.byShare, toX, toY, theme.grid, 1, []);
    top.forEach((curve, i) => paintCurve(g, curve, data.byShare, toX, toY, theme.text, 2, i === 0 ? [] : [6, 4]));
    this.legend(g, theme, data, right + 14);
  }

  private legend(g: CanvasRenderingContext2D, theme: Theme, data: BandData, x: number): void {
    let y = kMargin.top + 6;
    g.textAlign = "left";
    g.textBaseline = "middle";
    const entry = (text: string, paint: () => void) => {
      paint();
      g.fillStyle = theme.text;
      let cut = text;
      while (cut.length > 3 && g.measureText(cut).width > kMargin.right - 44) cut = `${cut.slice(0, -2)}…`;
      g.fillText(cut, x + 26, y);
      y += 17;
    };
    data.chosen.forEach((id, i) => entry(id, () => {
      g.strokeStyle = theme.text;
      g.lineWidth = 2;
      g.setLineDash(i === 0 ? [] : [6, 4]);
      path(g, [[x, y], [x + 20, y]]);
      g.setLineDash([]);
    }));
    for (const band of this.bands)
      entry(`${data.groups[band.group]} (${band.count})`, () => {
        const colour = data.groups.length > 1 ? categoryColour(band.group) : theme.accent;
        g.fillStyle = `${colour}40`;
        g.fillRect(x, y - 5, 20, 10);
        g.strokeStyle = colour;
        g.lineWidth = 1.5;
        path(g, [[x, y], [x + 20, y]]);
      });
    if (this.bands.length > 0) {
      g.fillStyle = theme.faint;
      g.fillText("median, middle half", x, y);
    }
  }
}

function axes(
  g: CanvasRenderingContext2D, theme: Theme, data: BandData, [low, high]: [number, number], end: number,
  toX: (x: number) => number, toY: (y: number) => number, left: number, right: number, bottom: number,
): void {
  const rows = ticks(low, high, 5);
  const columns = ticks(0, end, 8);
  const step = (values: number[]) => (values.length > 1 ? values[1]! - values[0]! : 1);
  g.lineWidth = 1;
  g.strokeStyle = theme.grid;
  g.fillStyle = theme.faint;
  g.textAlign = "right";
  g.textBaseline = "middle";
  for (const y of rows) {
    path(g, [[left, toY(y)], [right, toY(y)]]);
    g.fillText(tickText(y, step(rows)), left - 6, toY(y));
  }
  g.textAlign = "center";
  g.textBaseline = "top";
  for (const x of columns) g.fillText(tickText(x, step(columns)), toX(x), bottom + 5);
  g.fillStyle = theme.text;
  g.textAlign = "right";
  g.fillText(data.xTitle, right, bottom + 19);
  g.textAlign = "left";
  g.fillText(data.yTitle, 6, 3);
}

function paintBand(g: CanvasRenderingContext2D, band: Band, toX: (x: number) => number, toY: (y: number) => number, colour: string): void {
  g.fillStyle = `${colour}33`;
  for (const [first, end] of runs(band.middle)) {
    g.beginPath();
    for (let i = first; i < end; ++i) g.lineTo(toX(band.x[i]!), toY(band.high[i]!));
    for (let i = end - 1; i >= first; --i) g.lineTo(toX(band.x[i]!), toY(band.low[i]!));
    g.closePath();
    g.fill();
  }
  g.strokeStyle = colour;
  g.lineWidth = 1.5;
  pieces(g, band.x, band.middle, toX, toY);
}

/** Where there are values: first and end of each run of finite ones. */
function runs(values: ArrayLike<number>): [number, number][] {
  const found: [number, number][] = [];
  for (let i = 0; i < values.length; ++i) {
    if (!Number.isFinite(values[i]!)) continue;
    if (found.at(-1)?.[1] === i) found.at(-1)![1] = i + 1;
    else found.push([i, i + 1]);
  }
  return found;
}

function pieces(g: CanvasRenderingContext2D, x: ArrayLike<number>, y: ArrayLike<number>, toX: (x: number) => number, toY: (y: number) => number): void {
  for (const [first, end] of runs(y))
    path(g, Array.from({ length: end - first }, (_, i) => [toX(x[first + i]!), toY(y[first + i]!)]));
}

function paintCurve(
  g: CanvasRenderingContext2D, curve: BandCurve, byShare: boolean, toX: (x: number) => number, toY: (y: number) => number,
  colour: string, width: number, dash: number[],
): void {
  g.strokeStyle = colour;
  g.lineWidth = width;
  g.setLineDash(dash);
  pieces(g, alongOf(curve, byShare), curve.y, toX, toY);
  g.setLineDash([]);
}

function path(g: CanvasRenderingContext2D, points: [number, number][]): void {
  g.beginPath();
  for (const [x, y] of points) g.lineTo(x, y);
  g.stroke();
}
