// Tables of things that have a place in the model: branches, bifurcations, sections, stenoses, loops.
import { readTable } from "./cohort";
import type { Hdf5 } from "./hdf5";
import { across, centred, type Point } from "./points";
import type { MarkedTable } from "./protocol";

const kCircle = 48; // corners of a drawn circle

/** The tables of one model below `root`, with places relative to `centre`. */
export class Places {
  constructor(private readonly file: Hdf5, private readonly root: string, private readonly centre: Point) {}

  /** Its columns, and where its rows are, under whatever of these names it has. */
  read(name: string): MarkedTable {
    const group = `${this.root}/${name}`;
    const infos = this.file.keys(group).map((key) => this.file.info(`${group}/${key}`));
    const lengths = infos.flatMap((info) => (info && info.shape.length === 1 ? [info.shape[0]!] : []));
    const places = ["point", "origin", "position", "centre", "center", "throat_point"];
    const placed = places.map((key) => `${group}/${key}`).find((path) => this.file.info(path)?.shape[1] === 3);
    const idPath = `${group}/id`;
    const rows =
      this.file.info(idPath)?.shape[0] ?? (placed ? this.file.info(placed)!.shape[0]! : Math.min(...lengths, Infinity));
    if (!Number.isFinite(rows)) return { name, table: { rows: 0, columns: [] }, points: null, outlines: null };
    const fitting = new Set(infos.flatMap((info) => (info?.shape.length === 1 && info.shape[0] === rows ? [info.path] : [])));
    const other: string[] = []; // columns of another length are parts of outlines and the like
    const table = readTable(this.file, group, rows, ["id"], other);
    table.columns = table.columns.filter((column) => fitting.has(`${group}/${column.name}`));
    const points = placed
      ? centred(this.file.numbers(placed, 3 * rows), this.centre)
      : (this.vectors(group, ["origin", "point", "position"], rows, this.centre) ?? this.onAxes(group, rows));
    return { name, table, points, outlines: this.outlines(group) ?? this.circles(group, points, rows) };
  }

  /** Rows of three columns "<name>_x", "_y", "_z", relative to `from`; null if there are none. */
  private vectors(group: string, names: string[], rows: number, from: Point): Float32Array | null {
    for (const name of names) {
      const paths = ["x", "y", "z"].map((axis) => `${group}/${name}_${axis}`);
      if (!paths.every((path) => this.file.has(path))) continue;
      const columns = paths.map((path) => this.file.numbers(path, rows));
      return Float32Array.from({ length: 3 * rows }, (_, i) => columns[i % 3]![Math.floor(i / 3)]! - from[i % 3]!);
    }
    return null;
  }

  /** Places of rows that name a branch and an abscissa: the nearest point of the branch's axis. */
  private onAxes(group: string, rows: number): Float32Array | null {
    const axis = `${this.root}/graph/axis`;
    const needed = [`${group}/branch_id`, `${group}/abscissa`, `${axis}/offsets`, `${axis}/points`, `${axis}/abscissa`];
    if (!needed.every((path) => this.file.has(path))) return null;
    const [branch, wanted] = [this.file.numbers(needed[0]!, rows), this.file.numbers(needed[1]!, rows)];
    const along = this.file.numbers(needed[4]!);
    const offsets = this.file.offsets(needed[2]!, along.length);
    const points = this.file.points(needed[3]!, along.length);
    const places = new Float32Array(3 * rows).fill(NaN);
    for (let row = 0; row < rows; ++row) {
      const b = branch[row]!;
      if (!(b >= 0 && b + 1 < offsets.length) || !Number.isFinite(wanted[row]!)) continue;
      let nearest = offsets[b]!;
      for (let k = nearest; k < offsets[b + 1]!; ++k)
        if (Math.abs(along[k]! - wanted[row]!) < Math.abs(along[nearest]! - wanted[row]!)) nearest = k;
      for (let x = 0; x < 3; ++x) places[3 * row + x] = points[3 * nearest + x]! - this.centre[x]!;
    }
    return places;
  }

  /** Circles of a section's area in its plane, for sections whose outlines are not in the file. */
  private circles(group: string, points: Float32Array | null, rows: number): MarkedTable["outlines"] {
    const diameter = `${group}/equivalent_diameter`;
    const normals = points && this.file.has(diameter) ? this.vectors(group, ["normal"], rows, [0, 0, 0]) : null;
    if (!points || !normals) return null;
    const diameters = this.file.numbers(diameter, rows);
    const curve: number[] = [];
    const offsets = [0];
    for (let row = 0; row < rows; ++row) {
      const [n, at] = [[...normals.slice(3 * row, 3 * row + 3)], [...points.slice(3 * row, 3 * row + 3)]];
      const radius = diameters[row]! / 2;
      if (![...n, ...at, radius].every(Number.isFinite)) continue;
      const [a, b] = across(n as Point);
      for (let i = 0; i <= kCircle; ++i) {
        const [c, s] = [Math.cos((2 * Math.PI * i) / kCircle), Math.sin((2 * Math.PI * i) / kCircle)];
        for (let x = 0; x < 3; ++x) curve.push(at[x]! + radius * (c * a[x]! + s * b[x]!));
      }
      offsets.push(curve.length / 3);
    }
    return { points: Float32Array.from(curve), offsets: Int32Array.from(offsets) };
  }

  /** Closed curves of a group, as offsets and points, or in a group of their own. */
  private outlines(group: string): MarkedTable["outlines"] {
    for (const base of [`${group}/outline`, `${group}/contour`, `${group}/polygon`, `${group}/curve`, group]) {
      const [points, offsets] = [`${base}/points`, `${base}/offsets`];
      const info = this.file.isGroup(base) ? this.file.info(points) : null;
      if (!info || info.shape[1] !== 3 || !this.file.info(offsets)) continue;
      const count = info.shape[0]!;
      return {
        points: centred(this.file.points(points, count), this.centre),
        offsets: this.file.offsets(offsets, count),
      };
    }
    return null;
  }
}
