// A canvas that knows the theme, the device's pixels and its size, and is drawn again when any of them changes.
import { h } from "./dom";

export interface Theme {
  text: string;
  faint: string;
  grid: string;
  accent: string;
  back: string;
  font: string;
}

export function theme(element: Element = document.documentElement): Theme {
  const style = getComputedStyle(element);
  const value = (name: string) => style.getPropertyValue(name).trim();
  return {
    text: value("--text"),
    faint: value("--text-2"),
    grid: value("--grid"),
    accent: value("--accent"),
    back: value("--surface"),
    font: `11px ${value("--font")}`,
  };
}

export class DrawnCanvas {
  readonly canvas = h("canvas", {});
  readonly root: HTMLElement;
  width = 0;
  height = 0;
  private asked = false;
  private readonly observer: ResizeObserver;
  private readonly themed = () => this.redraw();

  constructor(className: string, private readonly draw: (g: CanvasRenderingContext2D, theme: Theme) => void) {
    this.root = h("div", { class: className }, this.canvas);
    this.observer = new ResizeObserver(() => this.redraw());
    this.observer.observe(this.root);
    addEventListener("themechange", this.themed);
  }

  dispose(): void {
    this.observer.disconnect();
    removeEventListener("themechange", this.themed);
  }

  redraw(): void {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.now();
    });
  }

  private now(): void {
    const box = this.root.getBoundingClientRect();
    this.width = box.width;
    this.height = box.height;
    if (!(this.width > 0 && this.height > 0)) return;
    const ratio = devicePixelRatio || 1;
    this.canvas.width = Math.round(this.width * ratio);
    this.canvas.height = Math.round(this.height * ratio);
    const g = this.canvas.getContext("2d");
    if (!g) return;
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    g.clearRect(0, 0, this.width, this.height);
    const colours = theme(this.root);
    g.font = colours.font;
    this.draw(g, colours);
  }
}
