// Two scenes side by side whose cameras move together. Distances are in radii of each model, so that a small and a large
// one are seen alike; with `true size` one unit of length is as long on both sides.
import type { Model } from "../archive/protocol";
import type { Client } from "../archive/client";
import { colourBar, type Bar } from "../model/bars";
import type { Look } from "../model/material";
import { ModelScene } from "../model/scene";
import type { MapName } from "../ui/colours";
import { fill, h, sentenceOf } from "../ui/dom";
import { extent, quantile, sortedFinite } from "../ui/scale";

export interface CompareLook {
  wallBy: string;
  opacity: number;
  linesBy: string;
  map: MapName;
  trueSize: boolean;
}

interface Coloured {
  bar: Bar;
  values: Float32Array;
}

class Pane {
  readonly scene: ModelScene;
  constructor(readonly model: Model, root: HTMLElement) {
    this.scene = new ModelScene(model, `${model.id} in three dimensions`);
    fill(root, this.scene.stage.root);
  }
}

export class Panes {
  readonly roots = [h("div", { class: "pane-scene" }), h("div", { class: "pane-scene" })] as const;
  readonly bars = h("div", { class: "bars" });
  onMoved: () => void = () => {};
  /** Told what cannot be read of a pane's model, which is plain then. */
  onProblem: (side: number, sentence: string) => void = () => {};
  private readonly panes: (Pane | null)[] = [null, null];
  private following = false;
  private turn = 0;

  constructor(private readonly client: Client) {}

  dispose(): void {
    for (const pane of this.panes) pane?.scene.dispose();
  }

  get looking(): string {
    return this.panes.find((pane) => pane)?.scene.stage.looking ?? "";
  }

  set looking(text: string) {
    for (const pane of this.panes) if (pane) pane.scene.stage.looking = text;
  }

  put(side: 0 | 1, model: Model): void {
    this.panes[side]?.scene.dispose();
    const pane = new Pane(model, this.roots[side]);
    this.panes[side] = pane;
    pane.scene.stage.onMoved = () => this.follow(side);
  }

  drop(side: 0 | 1): void {
    this.panes[side]?.scene.dispose();
    this.panes[side] = null;
  }

  /** Both from the usual side of the first model. */
  frame(): void {
    const first = this.panes[0] ?? this.panes[1];
    first?.scene.stage.frame();
  }

  scale(trueSize: boolean): void {
    const sizes = this.panes.map((pane) => (pane ? pane.model.diagonal / 2 : 0));
    const largest = Math.max(...sizes);
    this.panes.forEach((pane, side) => pane && (pane.scene.stage.radius = trueSize ? largest : sizes[side]!));
    this.follow(0);
  }

  private follow(side: number): void {
    if (this.following) return;
    const [from, to] = [this.panes[side], this.panes[1 - side]];
    if (from && to) {
      this.following = true;
      to.scene.stage.looking = from.scene.stage.looking;
      this.following = false;
    }
    this.onMoved();
  }

  key(event: KeyboardEvent): void {
    (this.panes[0] ?? this.panes[1])?.scene.stage.key(event);
  }

  /** Colours both alike: one range, from what both have. */
  async show(look: CompareLook): Promise<void> {
    const turn = ++this.turn;
    const walls = await this.coloured("Walls", look, (model) => model.surface?.fields, look.wallBy);
    const lines = await this.coloured("Lines", look, (model) => model.lines?.fields, look.linesBy);
    if (turn !== this.turn) return;
    const lookOf = (coloured: Coloured | null, opacity: number): Look => ({
      mode: coloured ? coloured.bar.field.kind : "plain", map: look.map, range: coloured?.bar.range ?? [0, 1], opacity,
    });
    this.panes.forEach((pane, side) => {
      if (!pane) return;
      pane.scene.showWall(true, lookOf(walls[side]!, look.opacity), walls[side]?.values ?? null);
      pane.scene.showLines(true, lookOf(lines[side]!, 1), lines[side]?.values ?? null);
      pane.scene.stage.root.dataset.ready = String(turn);
    });
    const shown = [walls, lines].flatMap((pair) => pair.find((coloured) => coloured)?.bar ?? []);
    fill(this.bars, shown.map(colourBar));
  }

  private async coloured(
    what: string, look: CompareLook, fields: (model: Model) => Bar["field"][] | undefined, key: string,
  ): Promise<(Coloured | null)[]> {
    const found = await Promise.all(this.panes.map(async (pane, side) => {
      const field = pane && fields(pane.model)?.find((candidate) => candidate.key === key);
      if (!field) return null;
      try {
        return { field, values: await this.client.call("field", { id: pane.model.id, path: field.path, row: field.row }) };
      } catch (error) {
        this.onProblem(side, sentenceOf(error));
        return null;
      }
    }));
    const all = sortedFinite(Float32Array.from(found.flatMap((side) => (side ? Array.from(side.values) : []))));
    const whole = extent(all);
    const middle: [number, number] = [quantile(all, 0.01), quantile(all, 0.99)];
    const range = middle[1] > middle[0] ? middle : whole;
    const categories = [...new Set(all)].slice(0, 40);
    return found.map((side) => side && {
      values: side.values,
      bar: { what, field: side.field, map: look.map, range, categories: side.field.kind === "category" ? categories : [], empty: all.length === 0, cut: range !== whole },
    });
  }
}
