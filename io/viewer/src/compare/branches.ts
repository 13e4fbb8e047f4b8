// The sections of one branch over the whole cohort, from the tables of the index: branches of different models that bear
// one label are the same vessel (population.labels).
import type { Column, Table } from "../archive/protocol";
import type { BandCurve } from "./band";

const column = (table: Table, name: string): Column | undefined => table.columns.find((each) => each.name === name);

/** What a section has that makes a profile, in the order of the menu. */
const kQuantities = ["equivalent_diameter", "inscribed_diameter", "area", "perimeter", "min_diameter", "max_diameter",
  "min_projection", "hydraulic_diameter", "circularity", "centroid_offset"];

/** Labels of the table of branches, those of most models first. */
export function branchLabels(branches: Table): string[] {
  const counts = new Map<string, number>();
  for (const label of column(branches, "branch_label")?.texts ?? []) if (label) counts.set(label, (counts.get(label) ?? 0) + 1);
  return [...counts.keys()].sort((a, b) => counts.get(b)! - counts.get(a)! || a.localeCompare(b, "en", { numeric: true }));
}

export const sectionColumns = (sections: Table): Column[] =>
  kQuantities.flatMap((name) => column(sections, name) ?? []).filter((each) => each.numbers);

/** The closed sections of the branch of that label, along its abscissa; models without it have no curve. */
export function branchCurves(sections: Table, label: string, quantity: string): { curves: BandCurve[]; units: string } {
  const [ids, labels] = ["id", "branch_label"].map((name) => column(sections, name)?.texts ?? []) as [string[], string[]];
  const [at, closed] = ["abscissa", "closed"].map((name) => column(sections, name)?.numbers) as [Float64Array?, Float64Array?];
  const values = column(sections, quantity);
  if (!at || !values?.numbers) return { curves: [], units: "" };
  const points = new Map<string, [number, number][]>();
  for (let row = 0; row < sections.rows; ++row) {
    if (labels[row] !== label || closed?.[row] === 0) continue;
    const own = points.get(ids[row]!) ?? [];
    own.push([at[row]!, values.numbers[row]!]);
    points.set(ids[row]!, own);
  }
  const curves = [...points].map(([id, own]) => {
    own.sort((a, b) => a[0] - b[0]);
    return { id, group: 0, x: Float32Array.from(own, (p) => p[0]), y: Float32Array.from(own, (p) => p[1]) };
  });
  return { curves, units: values.units };
}
