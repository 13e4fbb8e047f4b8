// A model in three dimensions, in layers that are made when they are first shown: wall, lines, balls, Voronoi diagram,
// marks, and what was picked. It draws what it is told and knows nothing of panels and addresses.
import * as THREE from "three";
import type { MarkedTable, Model, Site, Voronoi } from "../archive/protocol";
import { FieldMaterial, forMaterial, type Look } from "./material";
import { setValues, tubes, valued, type Tubes } from "./shapes";
import { Stage } from "./stage";

const kWall = 0xd9c8b8;
const kAdded = 0x8d9aa3;
const kBall = 0x4f86c6;
const kPicked = 0xd55e00;
const kMark = 0xcc79a7;
const kMostBalls = 400;

interface Wall {
  geometry: THREE.BufferGeometry;
  back: THREE.Mesh;
  front: THREE.Mesh;
  material: FieldMaterial[];
}

/** A median that needs no order: good enough for the thickness of a tube. */
function median(values: Float32Array): number {
  const sorted = values.filter((x) => x > 0).sort();
  return sorted[sorted.length >> 1] ?? 0;
}

export class ModelScene {
  readonly stage: Stage;
  private wall: Wall | null = null;
  private added: THREE.Mesh | null = null;
  private lines: { tubes: Tubes; mesh: THREE.Mesh; material: FieldMaterial } | null = null;
  private chosenLine: THREE.Mesh | null = null;
  private polygons: { mesh: THREE.Mesh; edges: THREE.LineSegments; material: FieldMaterial; bare: FieldMaterial } | null = null;
  private ball: THREE.Mesh | null = null;
  private train: THREE.InstancedMesh | null = null;
  private picked: THREE.Group | null = null;
  private readonly marks = new Map<string, THREE.Group>();
  private readonly thickness: number;

  constructor(readonly model: Model, label: string) {
    this.stage = new Stage(label);
    this.stage.radius = model.diagonal / 2;
    const typical = model.lines ? median(model.lines.radius) : 0;
    const size = model.diagonal;
    this.thickness = Math.min(Math.max(typical * 0.09, size * 0.0012), size * 0.006);
    this.stage.outline = this.outline();
    this.stage.usual = this.bestView();
    this.stage.frame();
  }

  /** Some of the wall's points, else of the lines'. */
  private outline(): Float32Array {
    const { surface, lines } = this.model;
    const points = surface?.points ?? lines?.points ?? new Float32Array();
    const chosen = surface && surface.wall.length > 0 ? surface.wall : null;
    const count = chosen ? chosen.length : points.length / 3;
    const step = Math.max(1, Math.floor(count / 4000));
    const made: number[] = [];
    for (let i = 0; i < count; i += step) made.push(...points.subarray(3 * (chosen ? chosen[i]! : i), 3 * (chosen ? chosen[i]! : i) + 3));
    return Float32Array.from(made);
  }

  dispose(): void {
    this.stage.dispose();
  }

  /** Looks across the broad side of the model, with the z axis up. */
  private bestView(): THREE.Vector3 {
    const points = this.stage.outline;
    let [xx, xy, yy] = [0, 0, 0];
    for (let i = 0; i < points.length; i += 3) {
      xx += points[i]! ** 2;
      xy += points[i]! * points[i + 1]!;
      yy += points[i + 1]! ** 2;
    }
    const angle = 0.5 * Math.atan2(2 * xy, xx - yy);
    return new THREE.Vector3(Math.sin(angle), -Math.cos(angle), 0.25);
  }

  private add<T extends THREE.Object3D>(object: T, order = 0): T {
    object.renderOrder = order;
    this.stage.scene.add(object);
    return object;
  }

  showWall(on: boolean, look: Look, values: Float32Array | null): void {
    const { surface } = this.model;
    if (!surface) return;
    if (!this.wall && on) {
      const geometry = valued(surface.points, surface.normals, surface.wall);
      // Of a transparent wall, what lies behind is drawn before what lies in front.
      const material = [new FieldMaterial(kWall, { side: THREE.BackSide, rim: 0.75 }), new FieldMaterial(kWall, { side: THREE.FrontSide, rim: 0.75 })];
      const back = this.add(new THREE.Mesh(geometry, material[0]), 10);
      const front = this.add(new THREE.Mesh(geometry, material[1]), 11);
      this.wall = { geometry, back, front, material };
    }
    if (!this.wall) return;
    this.wall.back.visible = this.wall.front.visible = on;
    if (values) setValues(this.wall.geometry, forMaterial(values));
    for (const material of this.wall.material) material.show(look);
    this.stage.redraw();
  }

  showAdded(on: boolean): void {
    const { surface } = this.model;
    if (!surface || surface.added.length === 0) return;
    if (!this.added && on) {
      const material = new FieldMaterial(kAdded, { rim: 0.5 });
      material.show({ mode: "plain", map: "viridis", range: [0, 1], opacity: 0.3 });
      this.added = this.add(new THREE.Mesh(valued(surface.points, surface.normals, surface.added), material), 12);
    }
    if (this.added) this.added.visible = on;
    this.stage.redraw();
  }

  showLines(on: boolean, look: Look, values: Float32Array | null): void {
    const { lines } = this.model;
    if (!lines) return;
    if (!this.lines && on) {
      const made = tubes(lines.points, lines.offsets, this.thickness);
      const material = new FieldMaterial(0x30424d);
      this.lines = { tubes: made, material, mesh: this.add(new THREE.Mesh(made.geometry, material), 1) };
    }
    if (!this.lines) return;
    this.lines.mesh.visible = on;
    this.lines.tubes.setValues(values && forMaterial(values));
    this.lines.material.show(look);
    this.stage.redraw();
  }

  /** Puts a dark sleeve around one line of several, so that it can be told from the others. */
  chooseLine(line: number, on: boolean): void {
    if (this.chosenLine && on && this.chosenLine.userData.line === line) return;
    if (this.chosenLine) this.remove(this.chosenLine);
    this.chosenLine = null;
    const { lines } = this.model;
    if (!lines || !on || lines.offsets.length <= 2) return;
    const [first, end] = [lines.offsets[line] ?? 0, lines.offsets[line + 1] ?? 0];
    const made = tubes(lines.points.slice(3 * first, 3 * end), [0, end - first], this.thickness * 1.9);
    const material = new FieldMaterial(0x0b6e8a, { rim: 0.4 });
    material.show({ mode: "plain", map: "viridis", range: [0, 1], opacity: 0.35 });
    this.chosenLine = this.add(new THREE.Mesh(made.geometry, material), 2);
    this.chosenLine.userData.line = line;
  }

  showPolygons(on: boolean, added: boolean, voronoi: Voronoi | null, look: Look, values: Float32Array | null): void {
    if (!this.polygons && on && voronoi) {
      const material = new FieldMaterial(0xb4bfc6, { flat: true });
      const mesh = this.add(new THREE.Mesh(valued(voronoi.points, null, voronoi.triangles), material), 1);
      // Bare edges have no face whose light could be computed: they are shown as if they faced the eye.
      const bare = new FieldMaterial(0xb4bfc6, { flat: true });
      const edges = this.add(new THREE.LineSegments(valued(voronoi.points, null, voronoi.edges), bare), 1);
      this.polygons = { mesh, edges, material, bare };
    }
    if (!this.polygons) return;
    this.polygons.mesh.visible = this.polygons.edges.visible = on;
    if (voronoi) this.polygons.mesh.geometry.setDrawRange(0, added ? Infinity : voronoi.ofWall);
    if (values) {
      const shown = forMaterial(values);
      setValues(this.polygons.mesh.geometry, shown);
      setValues(this.polygons.edges.geometry, shown);
    }
    this.polygons.material.show(look);
    this.polygons.bare.show(look);
    this.stage.redraw();
  }

  /** The maximal inscribed ball at a point; none for a radius of 0. */
  showBall(at: THREE.Vector3, radius: number): void {
    if (!this.ball) {
      const material = new FieldMaterial(kBall, { rim: 0.9 });
      material.show({ mode: "plain", map: "viridis", range: [0, 1], opacity: 0.3 });
      this.ball = this.add(new THREE.Mesh(withValues(new THREE.SphereGeometry(1, 48, 32)), material), 5);
    }
    this.ball.visible = radius > 0;
    this.ball.position.copy(at);
    this.ball.scale.setScalar(radius || 1);
    this.stage.redraw();
  }

  /** Balls one radius apart along a line, coloured like the lines. */
  showTrain(on: boolean, line: number, look: Look, values: Float32Array | null): void {
    if (this.train) this.remove(this.train);
    this.train = null;
    const { lines } = this.model;
    if (!on || !lines) return;
    const places: number[] = [];
    const [first, end] = [lines.offsets[line] ?? 0, lines.offsets[line + 1] ?? 0];
    let next = -Infinity;
    for (let k = first; k < end && places.length < kMostBalls; ++k) {
      if (lines.abscissa[k]! < next || !(lines.radius[k]! > 0)) continue;
      places.push(k);
      next = lines.abscissa[k]! + lines.radius[k]! * 0.5;
    }
    const geometry = new THREE.SphereGeometry(1, 32, 20);
    const material = new FieldMaterial(kBall, { rim: 0.6 });
    material.show({ ...look, opacity: 0.45 });
    const train = new THREE.InstancedMesh(geometry, material, places.length);
    const perBall = new Float32Array(places.length);
    const shown = values && forMaterial(values);
    const matrix = new THREE.Matrix4();
    places.forEach((k, i) => {
      const r = lines.radius[k]!;
      matrix.makeScale(r, r, r).setPosition(lines.points[3 * k]!, lines.points[3 * k + 1]!, lines.points[3 * k + 2]!);
      train.setMatrixAt(i, matrix);
      perBall[i] = shown ? shown[k]! : 0;
    });
    geometry.setAttribute("value", new THREE.InstancedBufferAttribute(perBall, 1));
    train.frustumCulled = false;
    this.train = this.add(train, 4);
    this.stage.redraw();
  }

  /** A site, the ball at its pole, and the way from there to the centerline. */
  showPicked(site: Site | null): void {
    if (this.picked) this.remove(this.picked);
    this.picked = null;
    this.stage.redraw();
    if (!site) return;
    const group = new THREE.Group();
    const at = site.point.map((x, axis) => x - this.model.centre[axis]!) as [number, number, number];
    group.add(this.dot(at, 2.2, kPicked));
    if (site.pole) {
      group.add(this.dot(site.pole.point, 1.8, 0x0072b2));
      const ball = new FieldMaterial(kPicked, { rim: 0.9 });
      ball.show({ mode: "plain", map: "viridis", range: [0, 1], opacity: 0.12 });
      const mesh = new THREE.Mesh(withValues(new THREE.SphereGeometry(site.pole.radius, 48, 32)), ball);
      mesh.position.fromArray(site.pole.point);
      mesh.renderOrder = 6;
      group.add(mesh);
      group.add(this.thread([...at, ...site.pole.point], kPicked));
    }
    if (site.way) {
      group.add(this.thread(site.way, 0x0072b2));
      group.add(this.dot([...site.way.slice(-3)] as [number, number, number], 1.8, 0x009e73));
    }
    this.picked = this.add(group, 7);
  }

  private dot(at: [number, number, number], size: number, colour: number): THREE.Mesh {
    const dot = new THREE.Mesh(withValues(new THREE.SphereGeometry(this.thickness * size, 20, 14)), new FieldMaterial(colour));
    dot.position.fromArray(at);
    return dot;
  }

  private thread(points: ArrayLike<number>, colour: number): THREE.Mesh {
    const made = tubes(Float32Array.from(points), [0, points.length / 3], this.thickness * 0.7);
    return new THREE.Mesh(made.geometry, new FieldMaterial(colour));
  }

  showMarks(marked: MarkedTable, on: boolean): void {
    const known = this.marks.get(marked.name);
    if (known) this.remove(known);
    this.marks.delete(marked.name);
    if (!on) return;
    const group = new THREE.Group();
    if (marked.outlines) {
      const made = tubes(marked.outlines.points, marked.outlines.offsets, this.thickness * 0.45);
      group.add(new THREE.Mesh(made.geometry, new FieldMaterial(kMark)));
    } else if (marked.points)
      for (let i = 0; i < marked.points.length; i += 3)
        if (Number.isFinite(marked.points[i]!))
          group.add(this.dot([...marked.points.slice(i, i + 3)] as [number, number, number], 2.6, kMark));
    this.marks.set(marked.name, this.add(group, 3));
    this.stage.redraw();
  }

  /** The site of the wall nearest to where a click met it; -1 beside the model. */
  siteAt(x: number, y: number): number {
    const { surface } = this.model;
    if (!surface || !this.wall?.front.visible) return -1;
    const caster = this.stage.ray(x, y);
    const probe = new THREE.Mesh(this.wall.geometry, new THREE.MeshBasicMaterial({ side: THREE.DoubleSide }));
    const hit = caster.intersectObject(probe, false)[0];
    if (!hit?.face) return -1;
    const corners = [hit.face.a, hit.face.b, hit.face.c];
    const distance = (v: number) => new THREE.Vector3().fromArray(surface.points, 3 * v).distanceToSquared(hit.point);
    return corners.reduce((best, v) => (distance(v) < distance(best) ? v : best));
  }

  /** The point of a line nearest to a place on the canvas, within `reach` pixels; -1 for none. */
  linePointAt(x: number, y: number, reach: number): number {
    const { lines } = this.model;
    if (!lines) return -1;
    let best = -1;
    let least = reach * reach;
    const at = new THREE.Vector3();
    for (let k = 0; k < lines.points.length / 3; ++k) {
      const place = this.stage.project(at.fromArray(lines.points, 3 * k));
      if (!place) continue;
      const d = (place.x - x) ** 2 + (place.y - y) ** 2;
      if (d < least) [least, best] = [d, k];
    }
    return best;
  }

  private remove(object: THREE.Object3D): void {
    this.stage.scene.remove(object);
    object.traverse((part) => {
      if (!(part instanceof THREE.Mesh)) return;
      (part.geometry as THREE.BufferGeometry).dispose();
      (part.material as THREE.Material).dispose();
    });
    this.stage.redraw();
  }
}

function withValues(geometry: THREE.BufferGeometry): THREE.BufferGeometry {
  const count = geometry.getAttribute("position").count;
  geometry.setAttribute("value", new THREE.BufferAttribute(new Float32Array(count), 1));
  return geometry;
}
