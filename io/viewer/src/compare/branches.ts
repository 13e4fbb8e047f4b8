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

/** The closed sections of the branch of that label, along its abscissa, NaN at the others; models without it have no curve. */
export function branchCurves(sections: Table, label: string, quantity: string): { curves: BandCurve[]; units: string } {
  const [ids, labels] = ["id", "branch_label"].map((name) => column(sections, name)?.texts ?? []) as [string[], string[]];
  const [at, share, closed] = ["abscissa", "abscissa_relative", "closed"].map((name) => column(sections, name)?.numbers);
  const values = column(sections, quantity);
  if (!at || !share || !values?.numbers) return { curves: [], units: "" };
  const rows = new Map<string, number[]>();
  for (let row = 0; row < sections.rows; ++row) {
    if (labels[row] !== label) continue;
    const own = rows.get(ids[row]!) ?? [];
    own.push(row);
    rows.set(ids[row]!, own);
  }
  const measured = (row: number) => (closed?.[row] === 0 ? NaN : values.numbers![row]!);
  const curves = [...rows].map(([id, own]) => {
    own.sort((a, b) => at[a]! - at[b]!);
    const of = (value: (row: number) => number) => Float32Array.from(own, value);
    return { id, group: 0, x: of((row) => at[row]!), share: of((row) => share[row]!), y: of(measured) };
  });
  return { curves, units: values.units };
}
