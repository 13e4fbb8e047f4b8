// The Voronoi diagram of one model: as triangles to be drawn, and as the ground of the way from a pole to the lines.
import type { Hdf5, Numbers } from "./hdf5";
import { centred, type Point } from "./points";
import type { Voronoi } from "./protocol";

/** Polygons of each vertex: those of vertex v are `polygons[starts[v]..starts[v + 1]]`. */
interface Around {
  starts: Int32Array;
  polygons: Int32Array;
}

export class Diagram {
  private shown: Voronoi | null = null;
  private around: Around | null = null;
  private distance: Numbers | null = null;
  private readonly count: number;
  private readonly points: Float32Array;
  private readonly corners: Int32Array;
  private readonly offsets: Int32Array;

  /** Throws ArchiveError where the arrays contradict each other. */
  constructor(private readonly file: Hdf5, private readonly root: string, centre: Point) {
    const vertices = `${root}/voronoi/vertices`;
    this.count = file.info(vertices)?.shape[0] ?? 0;
    this.points = centred(file.points(vertices, this.count), centre);
    this.corners = file.indices(`${root}/voronoi/polygon_vertices`, 0, this.count);
    this.offsets = file.offsets(`${root}/voronoi/polygon_offsets`, this.corners.length);
  }

  drawing(): Voronoi {
    if (this.shown) return this.shown;
    const { corners, offsets } = this;
    const added = this.addedPolygons(offsets.length - 1);
    const [wall, rest, edges]: [number[], number[], number[]] = [[], [], []];
    for (let p = 0; p + 1 < offsets.length; ++p) {
      const first = offsets[p]!;
      const end = offsets[p + 1]!;
      if (end - first === 2) edges.push(corners[first]!, corners[first + 1]!);
      // The polygons are convex, so a fan covers them.
      const fan = added?.[p] ? rest : wall;
      for (let i = first + 1; i + 1 < end; ++i) fan.push(corners[first]!, corners[i]!, corners[i + 1]!);
    }
    const triangles = new Uint32Array(wall.length + rest.length);
    triangles.set(wall);
    triangles.set(rest, wall.length);
    return (this.shown = { points: this.points, triangles, ofWall: wall.length, edges: Uint32Array.from(edges) });
  }

  /** Polygons that a site of an extension or cap takes part in; null if the file does not say. */
  private addedPolygons(count: number): Uint8Array | null {
    const [sites, origin] = [`${this.root}/voronoi/polygon_sites`, `${this.root}/surface/origin`];
    if (!this.file.has(sites) || !this.file.has(origin)) return null;
    const from = this.file.numbers(origin);
    const pairs = this.file.indices(sites, -1, from.length, 2 * count);
    const added = new Uint8Array(count);
    for (let i = 0; i < pairs.length; ++i) if (pairs[i]! >= 0 && from[pairs[i]!]! !== 0) added[i >> 1] = 1;
    return added;
  }

  private polygonsAround(): Around {
    if (this.around) return this.around;
    const starts = new Int32Array(this.count + 1);
    for (const v of this.corners) ++starts[v + 1]!;
    for (let v = 0; v < this.count; ++v) starts[v + 1]! += starts[v]!;
    const next = starts.slice();
    const polygons = new Int32Array(this.corners.length);
    for (let p = 0; p + 1 < this.offsets.length; ++p)
      for (let i = this.offsets[p]!; i < this.offsets[p + 1]!; ++i) polygons[next[this.corners[i]!]!++] = p;
    return (this.around = { starts, polygons });
  }

  /**
   * Points of the way down from a vertex towards `end`: always to the vertex of a shared polygon to which the distance
   * from the lines falls most per length. Vertices lead on past the end, which lies within a polygon: the way leaves them
   * where it is shortest with the straight piece that is left. Null where the file has no such distance there.
   */
  descent(from: number, end: Point): number[] | null {
    const path = `${this.root}/voronoi/centerline_distance`;
    if (!this.file.has(path) || !(from < this.count)) return null;
    const distance = (this.distance ??= this.file.numbers(path, this.count));
    if (!Number.isFinite(distance[from]!)) return null;
    const { starts, polygons } = this.polygonsAround();
    const way: number[] = [];
    let walked = 0;
    let [shortest, points] = [Infinity, 0];
    for (let at = from; at >= 0; ) {
      const here = this.points.subarray(3 * at, 3 * at + 3);
      if (way.length > 0) walked += distanceOf(here, way.slice(-3));
      way.push(...here);
      const whole = walked + distanceOf(here, end);
      if (whole <= shortest) [shortest, points] = [whole, way.length];
      let best = 0;
      let next = -1;
      for (let k = starts[at]!; k < starts[at + 1]!; ++k)
        for (let i = this.offsets[polygons[k]!]!; i < this.offsets[polygons[k]! + 1]!; ++i) {
          const other = this.corners[i]!;
          const fall = distance[at]! - distance[other]!;
          if (!(fall > 0)) continue;
          const slope = fall / (this.length(at, other) || Number.MIN_VALUE);
          if (slope > best) [best, next] = [slope, other];
        }
      at = next; // the distance falls with each step, so this ends
    }
    return way.slice(0, points);
  }

  private length(a: number, b: number): number {
    return distanceOf(this.points.subarray(3 * a, 3 * a + 3), this.points.subarray(3 * b, 3 * b + 3));
  }
}

const distanceOf = (a: ArrayLike<number>, b: ArrayLike<number>): number => Math.hypot(a[0]! - b[0]!, a[1]! - b[1]!, a[2]! - b[2]!);
