// The index of an archive, or one model file told as a cohort of one. Columns are taken as they come: a column that
// cannot be read is left away with a note, and only an index without ids is refused.
import type { Cohort, Column, Failure, Table } from "./protocol";
import { ArchiveError, type Hdf5 } from "./hdf5";
import { columnLabel } from "./words";

const kCovariate = "covariate, as the cohort's table states it";

function readColumn(file: Hdf5, path: string, name: string, rows: number): Column | null {
  const info = file.info(path);
  if (!info || info.shape.length !== 1) return null;
  const given = info.description === kCovariate ? file.attribute(path, "column") : null; // its name need not do as a dataset's
  const column: Column = {
    name,
    label: typeof given === "string" && given !== "" ? given : columnLabel(name),
    units: info.units,
    description: info.description,
  };
  if (info.kind === "text") column.texts = file.strings(path, rows);
  else if (info.kind === "float" || info.kind === "integer") column.numbers = Float64Array.from(file.numbers(path, rows));
  else return null;
  return column;
}

/** The columns of equal length that a group holds; `first` come first, in this order. */
export function readTable(file: Hdf5, group: string, rows: number, first: string[], notes: string[]): Table {
  const names = file.keys(group).sort((a, b) => {
    const rank = (name: string) => (first.includes(name) ? first.indexOf(name) : first.length);
    return rank(a) - rank(b);
  });
  const columns: Column[] = [];
  for (const name of names) {
    try {
      const column = readColumn(file, `${group}/${name}`, name, rows);
      if (column) columns.push(column);
    } catch (error) {
      if (!(error instanceof ArchiveError)) throw error;
      notes.push(error.message);
    }
  }
  return { rows, columns };
}

export const kModelColumns = [
  "id", "status", "group", "subject", "session", "side", "structure",
  "centerlines", "length", "radius_min", "radius_mean", "radius_max",
  "normalized_tangency_deviation_mean", "normalized_tangency_deviation_p95",
  "geodesic_distance_mean", "euclidean_distance_mean", "sites", "triangles", "inlets", "outlets", "warnings",
];

function readFailures(file: Hdf5, notes: string[]): Failure[] {
  if (!file.isGroup("/tables/failures")) return [];
  try {
    const id = file.strings("/tables/failures/id");
    const [stage, code, sentence] = ["stage", "code", "sentence"].map((name) =>
      file.strings(`/tables/failures/${name}`, id.length),
    ) as [string[], string[], string[]];
    return id.map((name, i) => ({ id: name, stage: stage[i]!, code: code[i]!, sentence: sentence[i]! }));
  } catch (error) {
    if (!(error instanceof ArchiveError)) throw error;
    notes.push(error.message);
    return [];
  }
}

/** Units and descriptions of all columns, which the dictionary has in a few datasets. */
function useDictionary(file: Hdf5): void {
  if (!file.isGroup("/dictionary")) return; // an index of an earlier version
  try {
    const tables = file.strings("/dictionary/table");
    const [columns, units, definitions] = ["column", "unit", "definition"].map((name) =>
      file.strings(`/dictionary/${name}`, tables.length),
    ) as [string[], string[], string[]];
    tables.forEach((table, k) => file.describe(`/tables/${table}/${columns[k]}`, units[k]!, definitions[k]!));
  } catch (error) {
    if (!(error instanceof ArchiveError)) throw error; // the columns have them too
  }
}

export function readCohort(file: Hdf5, name: string): Cohort {
  const notes: string[] = [];
  useDictionary(file);
  const ids = file.strings("/tables/models/id");
  const models = readTable(file, "/tables/models", ids.length, kModelColumns, notes);
  const seconds = file.has("/timing/seconds") ? readTimes(file, ids) : null;
  if (seconds) models.columns.push(seconds);
  return {
    name,
    isModelFile: false,
    version: String(file.attribute("/", "lumenline_version") ?? ""),
    models,
    tables: file.keys("/tables").filter((table) => table !== "models" && table !== "failures"),
    failures: readFailures(file, notes),
    notes,
  };
}

function readTimes(file: Hdf5, ids: string[]): Column | null {
  try {
    const timed = file.strings("/timing/id");
    const seconds = file.numbers("/timing/seconds", timed.length);
    const of = new Map(timed.map((id, i) => [id, seconds[i]!]));
    const numbers = Float64Array.from(ids, (id) => of.get(id) ?? NaN);
    return { name: "seconds", label: "seconds", units: "s", description: "time of work on the model", numbers };
  } catch (error) {
    if (error instanceof ArchiveError) return null;
    throw error;
  }
}

/** A model file by itself: a cohort of one row, made of its attributes. */
export function cohortOfModel(file: Hdf5, name: string): Cohort {
  const attributes = file.attributes("/");
  const text = (key: string): Column => ({
    name: key, label: columnLabel(key), units: "1", description: "", texts: [String(attributes[key] ?? "")],
  });
  const failed = attributes["status"] === "failed";
  return {
    name,
    isModelFile: true,
    version: String(attributes["lumenline_version"] ?? ""),
    models: { rows: 1, columns: ["id", "status", "group", "subject", "session", "side", "structure"].map(text) },
    tables: [],
    failures: failed
      ? [{
          id: String(attributes["id"] ?? ""), stage: String(attributes["failure_stage"] ?? ""),
          code: String(attributes["failure_code"] ?? ""), sentence: String(attributes["failure_sentence"] ?? ""),
        }]
      : [],
    notes: [],
  };
}
