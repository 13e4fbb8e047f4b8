// Names of the ends over the scene. Where two would cover each other, the later one gives way; inlets come first in an
// archive, so they stay.
import * as THREE from "three";
import type { Model } from "../archive/protocol";
import { h } from "../ui/dom";
import type { Stage } from "./stage";

const kHeight = 18;

export class EndLabels {
  readonly root = h("div", { class: "labels", "aria-hidden": "true" });
  private readonly labels: { at: THREE.Vector3; element: HTMLElement; width: number }[] = [];
  private on = true;

  constructor(private readonly stage: Stage, model: Model) {
    const { ends } = model;
    if (!ends) return;
    for (let e = 0; e < ends.role.length; ++e) {
      const text = `${ends.role[e]} ${e}`;
      const element = h("span", { class: ends.role[e] === "inlet" ? "end inlet" : "end", title: ends.kind[e] }, text);
      this.labels.push({ at: new THREE.Vector3().fromArray(ends.points, 3 * e), element, width: 7 * text.length + 14 });
      this.root.appendChild(element);
    }
  }

  dispose(): void {
    this.root.remove();
  }

  show(on: boolean): void {
    this.on = on;
    this.root.hidden = !on;
    this.place();
  }

  /** The same on a picture that is `scale` times as large. */
  paint(g: CanvasRenderingContext2D, scale: number, text: string): void {
    g.textAlign = "center";
    g.textBaseline = "bottom";
    g.fillStyle = text;
    for (const { at, element } of this.labels) {
      const place = this.on && !element.hidden && this.stage.project(at);
      if (place) g.fillText(element.textContent!, place.x * scale, (place.y - 6) * scale);
    }
  }

  place(): void {
    if (!this.on) return;
    const taken: [number, number, number][] = [];
    for (const { at, element, width } of this.labels) {
      const place = this.stage.project(at);
      const free = place && !taken.some(([x, y, w]) => Math.abs(y - place.y) < kHeight && Math.abs(x - place.x) < (w + width) / 2);
      element.hidden = !free;
      if (!free) continue;
      taken.push([place.x, place.y, width]);
      element.style.transform = `translate(${Math.round(place.x)}px, ${Math.round(place.y)}px) translate(-50%, -130%)`;
    }
  }
}
