// Geometries made of lines: tubes around polylines, whose frames are carried along without twist.
import * as THREE from "three";

const kSides = 8;
const kSpacing = 2; // of rings, in radii of the tube

export interface Tubes {
  geometry: THREE.BufferGeometry;
  /** Gives each point's value to its ring. */
  setValues(values: Float32Array | null): void;
}

/** The first of the points that stand where each point stands: lines of a tree share their way to its root. */
function firstThere(points: Float32Array): Int32Array {
  const bits = new Uint32Array(points.buffer, points.byteOffset, points.length);
  const buckets = new Map<number, number[]>();
  return Int32Array.from({ length: points.length / 3 }, (_, k) => {
    const [x, y, z] = [bits[3 * k]!, bits[3 * k + 1]!, bits[3 * k + 2]!];
    const hash = Math.imul(x, 73856093) ^ Math.imul(y, 19349663) ^ Math.imul(z, 83492791);
    const bucket = buckets.get(hash);
    const known = bucket?.find((i) => bits[3 * i] === x && bits[3 * i + 1] === y && bits[3 * i + 2] === z);
    if (known !== undefined) return known;
    if (bucket) bucket.push(k);
    else buckets.set(hash, [k]);
    return k;
  });
}

/**
 * Points of the polylines that get a ring, tube by tube: each as far from the one before it as the tube is thick, or at
 * an end. What an earlier line has is not drawn again.
 */
function ringed(points: Float32Array, offsets: ArrayLike<number>, radius: number): { at: number[]; starts: number[] } {
  const [at, starts]: [number[], number[]] = [[], []];
  const [here, last] = [new THREE.Vector3(), new THREE.Vector3()];
  const there = firstThere(points);
  const drawn = (k: number) => there[k]! < k && Math.abs(there[k + 1]! - there[k]!) === 1;  // the piece from point k on
  for (let line = 0; line + 1 < offsets.length; ++line) {
    const [first, end] = [offsets[line]!, offsets[line + 1]!];
    for (let k = first; k < end; ++k) {
      const [before, after] = [k > first && !drawn(k - 1), k + 1 < end && !drawn(k)];
      if (!before && !after && end - first > 1) continue;
      here.fromArray(points, 3 * k);
      if (!before) starts.push(at.length);
      else if (after && here.distanceTo(last) < kSpacing * radius) continue;
      at.push(k);
      last.copy(here);
    }
  }
  starts.push(at.length);
  return { at, starts };
}

/** Tubes of one radius around the polylines [offsets[i], offsets[i+1]) of `points`. */
export function tubes(points: Float32Array, offsets: ArrayLike<number>, radius: number): Tubes {
  const { at: source, starts } = ringed(points, offsets, radius);
  const count = source.length;
  const position = new Float32Array(count * kSides * 3);
  const normal = new Float32Array(count * kSides * 3);
  const index: number[] = [];
  const [at, before, after, tangent, side, up] = Array.from({ length: 6 }, () => new THREE.Vector3()) as [
    THREE.Vector3, THREE.Vector3, THREE.Vector3, THREE.Vector3, THREE.Vector3, THREE.Vector3];
  for (let line = 0; line + 1 < starts.length; ++line) {
    const [first, end] = [starts[line]!, starts[line + 1]!];
    side.set(0, 0, 0);
    for (let k = first; k < end; ++k) {
      at.fromArray(points, 3 * source[k]!);
      before.fromArray(points, 3 * source[Math.max(first, k - 1)]!);
      after.fromArray(points, 3 * source[Math.min(end - 1, k + 1)]!);
      tangent.subVectors(after, before);
      if (tangent.lengthSq() > 0) tangent.normalize();
      else tangent.set(0, 0, 1);
      carry(side, tangent);
      up.crossVectors(tangent, side);
      for (let s = 0; s < kSides; ++s) {
        const angle = (2 * Math.PI * s) / kSides;
        const [c, d] = [Math.cos(angle), Math.sin(angle)];
        const v = 3 * (k * kSides + s);
        for (let axis = 0; axis < 3; ++axis) {
          const n = c * side.getComponent(axis) + d * up.getComponent(axis);
          normal[v + axis] = n;
          position[v + axis] = at.getComponent(axis) + radius * n;
        }
      }
      if (k + 1 < end) ring(index, k);
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
  geometry.setAttribute("normal", new THREE.BufferAttribute(normal, 3));
  const value = new THREE.BufferAttribute(new Float32Array(count * kSides), 1);
  geometry.setAttribute("value", value);
  geometry.setIndex(index);
  return {
    geometry,
    setValues(values) {
      const ring = value.array as Float32Array;
      for (let k = 0; k < count; ++k) ring.fill(values ? values[source[k]!]! : 0, k * kSides, (k + 1) * kSides);
      value.needsUpdate = true;
    },
  };
}

/** Turns `side` to stand across `tangent`, as little as possible. */
function carry(side: THREE.Vector3, tangent: THREE.Vector3): void {
  side.addScaledVector(tangent, -side.dot(tangent));
  if (side.lengthSq() < 1e-12) {
    const axis = Math.abs(tangent.x) < 0.6 ? new THREE.Vector3(1, 0, 0) : new THREE.Vector3(0, 1, 0);
    side.crossVectors(tangent, axis);
  }
  side.normalize();
}

function ring(index: number[], k: number): void {
  for (let s = 0; s < kSides; ++s) {
    const [a, b] = [k * kSides + s, k * kSides + ((s + 1) % kSides)];
    index.push(a, a + kSides, b, b, a + kSides, b + kSides);
  }
}

/** A geometry of vertices with one value each. */
export function valued(points: Float32Array, normals: Float32Array | null, index: Uint32Array): THREE.BufferGeometry {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(points, 3));
  if (normals) geometry.setAttribute("normal", new THREE.BufferAttribute(normals, 3));
  geometry.setAttribute("value", new THREE.BufferAttribute(new Float32Array(points.length / 3), 1));
  geometry.setIndex(new THREE.BufferAttribute(index, 1));
  return geometry;
}

export function setValues(geometry: THREE.BufferGeometry, values: Float32Array): void {
  const attribute = geometry.getAttribute("value") as THREE.BufferAttribute;
  attribute.copyArray(values);
  attribute.needsUpdate = true;
}
