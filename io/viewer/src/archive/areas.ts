// The area of the sections along the lines, which the format keeps per branch.
import type { Hdf5, Numbers } from "./hdf5";
import { interpolated } from "./interpolate";

/** Where a model has it among the quantities of its lines, beside those that the file has there. */
export const kAreaPath = "/centerlines/area";

const kSections = ["branch_id", "abscissa", "area", "closed"].map((name) => `/sections/${name}`);
const kPoints = ["branch_id", "branch_abscissa"].map((name) => `/centerlines/${name}`);

export const hasAreas = (file: Hdf5, root: string): boolean => [...kSections, ...kPoints].every((path) => file.has(root + path));

/** At each point of the lines: between the sections of its branch in proportion, NaN beside one that is not closed. */
export function areasAlong(file: Hdf5, root: string, count: number): Float32Array {
  const [branch, abscissa, area, closed] = kSections.map((path) => file.numbers(root + path)) as [Numbers, Numbers, Numbers, Numbers];
  const [branchOf, at] = kPoints.map((path) => file.numbers(root + path, count)) as [Numbers, Numbers];
  const rows = new Map<number, number[]>();
  for (let row = 0; row < branch.length; ++row) rows.set(branch[row]!, [...(rows.get(branch[row]!) ?? []), row]);
  const curves = new Map([...rows].map(([id, own]) => {
    own.sort((a, b) => abscissa[a]! - abscissa[b]!);
    return [id, { x: own.map((row) => abscissa[row]!), y: own.map((row) => (closed[row] === 1 ? area[row]! : NaN)) }];
  }));
  return Float32Array.from(branchOf, (id, point) => {
    const curve = curves.get(id);
    if (!curve || !(at[point]! >= curve.x[0]! && at[point]! <= curve.x.at(-1)!)) return NaN;
    return interpolated(curve.x, curve.y, 0, curve.x.length, at[point]!);
  });
}
