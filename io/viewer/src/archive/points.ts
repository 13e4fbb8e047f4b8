// Points in space as flat arrays, relative to a middle: the graphics card counts in 32 bits.
import type { Numbers } from "./hdf5";

export type Point = [number, number, number];

export function centred(points: Numbers, centre: Point): Float32Array {
  const out = new Float32Array(points.length);
  for (let i = 0; i < points.length; i += 3) {
    out[i] = points[i]! - centre[0];
    out[i + 1] = points[i + 1]! - centre[1];
    out[i + 2] = points[i + 2]! - centre[2];
  }
  return out;
}

export function boxOf(points: Numbers, corners: ArrayLike<number> | null): { centre: Point; diagonal: number } {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  const count = corners ? corners.length : points.length / 3;
  for (let i = 0; i < count; ++i) {
    const at = 3 * (corners ? corners[i]! : i);
    for (let axis = 0; axis < 3; ++axis) {
      const x = points[at + axis]!;
      if (x < low[axis]!) low[axis] = x;
      if (x > high[axis]!) high[axis] = x;
    }
  }
  if (!low.every(Number.isFinite) || !high.every(Number.isFinite)) return { centre: [0, 0, 0], diagonal: 1 };
  const centre = low.map((x, axis) => (x + high[axis]!) / 2) as Point;
  return { centre, diagonal: Math.hypot(...high.map((x, axis) => x - low[axis]!)) || 1 };
}

/** Two unit vectors across a unit vector and each other. */
export function across([x, y, z]: Point): [Point, Point] {
  const a: Point = Math.abs(x) < 0.6 ? [0, z, -y] : [-z, 0, x];
  const length = Math.hypot(...a) || 1;
  const u = a.map((part) => part / length) as Point;
  return [u, [y * u[2] - z * u[1], z * u[0] - x * u[2], x * u[1] - y * u[0]]];
}
