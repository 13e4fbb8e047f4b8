// A quantity along the abscissa of one line: hovering moves the ball, a click leaves it there.
import uPlot from "uplot";
import { theme } from "../ui/canvas";
import { h } from "../ui/dom";

export interface Curve {
  x: Float32Array;
  y: Float32Array;
  error: Float32Array | null; // drawn as a band
  xTitle: string;
  yTitle: string;
}

const kAxis = 44;

export class ProfilePlot {
  readonly root = h("div", { class: "profile", role: "img" });
  private plot: uPlot | null = null;
  private curve: Curve | null = null;
  private at = NaN;
  private readonly observer = new ResizeObserver(() => this.resize());
  private readonly themed = () => this.make();

  /** `moved` is told the abscissa under the pointer, and whether it is to stay; `left` that the pointer went away. */
  constructor(private readonly moved: (abscissa: number, stays: boolean) => void, left: () => void) {
    this.root.addEventListener("mouseleave", left);
    this.observer.observe(this.root);
    addEventListener("themechange", this.themed);
  }

  dispose(): void {
    this.observer.disconnect();
    removeEventListener("themechange", this.themed);
    this.plot?.destroy();
  }

  show(curve: Curve | null): void {
    this.curve = curve;
    this.root.setAttribute("aria-label", curve ? `${curve.yTitle} over ${curve.xTitle}` : "nothing to plot");
    this.make();
  }

  /** Marks an abscissa. */
  mark(abscissa: number): void {
    this.at = abscissa;
    this.plot?.redraw(false, false);
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.root;
    if (!this.plot) this.make();
    else if (width > 0 && height > 0) this.plot.setSize({ width, height });
  }

  private make(): void {
    this.plot?.destroy();
    this.plot = null;
    const { clientWidth: width, clientHeight: height } = this.root;
    const curve = this.curve;
    if (!curve || curve.x.length === 0 || !(width > 0 && height > 0)) return;
    const colours = theme();
    const axis = (label: string, size: number): uPlot.Axis => ({
      label, size, labelSize: 18, labelFont: colours.font, font: colours.font, stroke: colours.faint, gap: 3, labelGap: 0,
      grid: { stroke: colours.grid, width: 1 }, ticks: { show: false },
    });
    const gaps = (values: Float32Array) => Array.from(values, (x) => (Number.isFinite(x) ? x : null));
    const y = gaps(curve.y);
    const data: uPlot.AlignedData = curve.error
      ? [curve.x, y, y.map((v, i) => shifted(v, curve.error![i]!, -1)), y.map((v, i) => shifted(v, curve.error![i]!, 1))]
      : [curve.x, y];
    const quiet: uPlot.Series = { stroke: "transparent", points: { show: false } };
    this.plot = new uPlot({
      width, height,
      legend: { show: false },
      padding: [10, 14, 0, 0],
      scales: { x: { time: false } },
      axes: [axis(curve.xTitle, 22), axis(curve.yTitle, kAxis + 14)],
      series: [{}, { stroke: colours.accent, width: 1.6, points: { show: false } }, ...(curve.error ? [quiet, quiet] : [])],
      bands: curve.error ? [{ series: [3, 2], fill: `${colours.accent}33` }] : [],
      cursor: { y: false, points: { size: 7 }, drag: { x: true, y: false } },
      hooks: {
        setCursor: [(plot) => {
          const { idx } = plot.cursor;
          if (typeof idx === "number") this.moved(curve.x[idx]!, false);
        }],
        draw: [(plot) => this.drawMark(plot, colours.text)],
      },
    }, data, this.root);
    this.plot.over.addEventListener("click", () => {
      const idx = this.plot?.cursor.idx;
      if (typeof idx === "number") this.moved(curve.x[idx]!, true);
    });
  }

  private drawMark(plot: uPlot, colour: string): void {
    if (!Number.isFinite(this.at)) return;
    const x = plot.valToPos(this.at, "x", true);
    const { top, height } = plot.bbox;
    plot.ctx.save();
    plot.ctx.strokeStyle = colour;
    plot.ctx.lineWidth = devicePixelRatio || 1;
    plot.ctx.setLineDash([4, 3]);
    plot.ctx.beginPath();
    plot.ctx.moveTo(x, top);
    plot.ctx.lineTo(x, top + height);
    plot.ctx.stroke();
    plot.ctx.restore();
  }
}

const shifted = (value: number | null, error: number, sign: number): number | null =>
  value === null ? null : Number.isFinite(error) ? value + sign * error : value;
