// One model: geometry first, fields when they are asked for. Parts that the file has not are left away; a part that is
// damaged is left away with a note, so that the rest can still be looked at. Indices are checked against what they
// point into before anything is drawn with them.
import { ArchiveError, type Hdf5, type DatasetInfo, type Numbers } from "./hdf5";
import type { Ends, Field, Finding, LinesPart, MarkedTable, Model, Profile, Site, SurfacePart, Voronoi } from "./protocol";
import { readTable } from "./cohort";
import { interpolated } from "./interpolate";
import { labelOf, symbolOf } from "./words";

type Point = [number, number, number];

/** Categories are ids; of integers, these are measures or pointers instead. */
const kNoField = new Set(["points", "normals", "triangles", "input_vertex", "pole", "cap", "polygon_vertices"]);

/** What the page says first of a surface, line or complex. */
const kOrder = [
  "geodesic_distance", "euclidean_distance", "normalized_tangency_deviation", "abscissa", "branch_id", "centerline_id",
  "radius", "clearance", "ball_radius", "curvature", "arrival_time", "centerline_distance",
];

const rank = (key: string) => (kOrder.includes(key) ? kOrder.indexOf(key) : kOrder.length);

function centred(points: Numbers, centre: Point): Float32Array {
  const out = new Float32Array(points.length);
  for (let i = 0; i < points.length; i += 3) {
    out[i] = points[i]! - centre[0];
    out[i + 1] = points[i + 1]! - centre[1];
    out[i + 2] = points[i + 2]! - centre[2];
  }
  return out;
}

function boxOf(points: Numbers, corners: ArrayLike<number> | null): { centre: Point; diagonal: number } {
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

function fieldOf(info: DatasetInfo, key: string, row: number, label: string): Field {
  return {
    key: row < 0 ? key : `${key}_${row}`,
    path: info.path,
    row,
    label,
    symbol: symbolOf(key),
    units: info.units,
    description: info.description,
    kind: info.kind === "integer" ? "category" : "scale",
  };
}

const kCircle = 48; // corners of a drawn circle

/** Two unit vectors across a unit vector and each other. */
function across([x, y, z]: Point): [Point, Point] {
  const a: Point = Math.abs(x) < 0.6 ? [0, z, -y] : [-z, 0, x];
  const length = Math.hypot(...a) || 1;
  const u = a.map((part) => part / length) as Point;
  return [u, [y * u[2] - z * u[1], z * u[0] - x * u[2], x * u[1] - y * u[0]]];
}

/** An open model within a file: the file's root, or a group of a packed archive. */
export class ModelReader {
  private centre: Point = [0, 0, 0];
  private polygons: Voronoi | null = null;

  constructor(private readonly file: Hdf5, private readonly root: string, readonly id: string) {}

  private at(path: string): string {
    return this.root + path;
  }

  /** Runs `read` for a part that may be missing or damaged. */
  private part<T>(group: string, notes: string[], read: () => T): T | null {
    try {
      return this.file.isGroup(this.at(group)) ? read() : null;
    } catch (error) {
      if (!(error instanceof ArchiveError)) throw error;
      notes.push(error.message);
      return null;
    }
  }

  private rows(path: string, columns = 1): number {
    const info = this.file.info(this.at(path));
    const shape = info?.shape ?? [];
    if (!info) throw this.file.unusable(`there is no dataset ${this.at(path)}`);
    if (columns > 1 ? shape.length !== 2 || shape[1] !== columns : shape.length !== 1)
      throw this.file.unusable(`${this.at(path)} has an unexpected shape`);
    return shape[0]!;
  }

  /** Datasets of a group with one number for each of `count` points. */
  private fields(group: string, count: number): Field[] {
    const found: Field[] = [];
    for (const key of this.file.keys(this.at(group))) {
      if (kNoField.has(key)) continue;
      const info = this.file.info(this.at(`${group}/${key}`));
      if (!info || (info.kind !== "float" && info.kind !== "integer")) continue;
      if (info.shape.length === 1 && info.shape[0] === count) found.push(fieldOf(info, key, -1, labelOf(key)));
      if (info.shape.length === 2 && info.shape[1] === count && info.shape[0]! < count)
        for (let row = 0; row < info.shape[0]!; ++row)
          found.push(fieldOf(info, key, row, info.shape[0] === 1 ? labelOf(key) : `${labelOf(key)} from source ${row}`));
    }
    return found.sort((a, b) => rank(a.path.split("/").at(-1)!) - rank(b.path.split("/").at(-1)!));
  }

  read(): Model {
    const notes: string[] = [];
    const attributes = this.file.attributes(this.root || "/");
    const model: Model = {
      id: this.id,
      attributes,
      unit: String(attributes["length_unit"] ?? ""),
      centre: this.centre,
      diagonal: 1,
      covariates: this.part("/covariates", notes, () => this.covariates()) ?? [],
      findings: this.part("/diagnostics", notes, () => this.findings()) ?? [],
      surface: null,
      lines: null,
      ends: null,
      marks: [],
      voronoi: null,
      notes,
    };
    model.surface = this.part("/surface", notes, () => this.surface(model));
    model.lines = this.part("/centerlines", notes, () => this.lines(model));
    model.ends = this.part("/endpoints", notes, () => this.ends());
    for (const name of ["branches", "bifurcations", "sections", "stenoses", "dilations", "loops"]) {
      const marked = this.part(`/${name}`, notes, () => this.marked(name));
      if (marked && marked.table.rows > 0) model.marks.push(marked);
    }
    model.voronoi = this.part("/voronoi", notes, () => {
      const vertices = this.rows("/voronoi/vertices", 3);
      return { vertices, polygons: this.rows("/voronoi/polygon_offsets") - 1, fields: this.fields("/voronoi", vertices) };
    });
    if (model.surface && model.lines) this.derive(model.surface, model.lines);
    return model;
  }

  private surface(model: Model): SurfacePart {
    const points = this.file.points(this.at("/surface/points"), this.rows("/surface/points", 3));
    const count = points.length / 3;
    const triangles = this.file.indices(this.at("/surface/triangles"), 0, count, 3 * this.rows("/surface/triangles", 3));
    const cap = this.file.has(this.at("/surface/cap"))
      ? this.file.numbers(this.at("/surface/cap"), triangles.length / 3)
      : new Int32Array(triangles.length / 3).fill(-1);
    const wall = new Uint32Array(triangles.length);
    const added = new Uint32Array(triangles.length);
    let ofWall = 0;
    let ofAdded = 0;
    for (let t = 0; t < cap.length; ++t)
      for (let c = 0; c < 3; ++c)
        if (cap[t] === -1) wall[ofWall++] = triangles[3 * t + c]!;
        else added[ofAdded++] = triangles[3 * t + c]!;
    const box = boxOf(points, ofWall > 0 ? wall.subarray(0, ofWall) : null);
    this.centre = model.centre = box.centre;
    model.diagonal = box.diagonal;
    return {
      points: centred(points, box.centre),
      normals: Float32Array.from(this.file.numbers(this.at("/surface/normals"), points.length)),
      wall: wall.slice(0, ofWall),
      added: added.slice(0, ofAdded),
      fields: this.fields("/surface", count),
    };
  }

  private lines(model: Model): LinesPart {
    const count = this.rows("/centerlines/points", 3);
    const points = this.file.points(this.at("/centerlines/points"), count);
    const offsets = this.file.offsets(this.at("/centerlines/offsets"), count);
    const float = (path: string) => Float32Array.from(this.file.numbers(this.at(path), count));
    const ids = (path: string) => Int32Array.from(this.file.numbers(this.at(path), offsets.length - 1));
    if (!model.surface) {
      const box = boxOf(points, null);
      this.centre = model.centre = box.centre;
      model.diagonal = box.diagonal;
    }
    return {
      points: centred(points, this.centre),
      offsets,
      abscissa: float("/centerlines/abscissa"),
      radius: float("/centerlines/radius"),
      source: ids("/centerlines/source"),
      target: ids("/centerlines/target"),
      fields: this.fields("/centerlines", count),
    };
  }

  private ends(): Ends {
    const count = this.rows("/endpoints/point", 3);
    return {
      points: centred(this.file.points(this.at("/endpoints/point"), count), this.centre),
      radius: Float32Array.from(this.file.numbers(this.at("/endpoints/radius"), count)),
      kind: this.file.strings(this.at("/endpoints/kind"), count),
      role: this.file.strings(this.at("/endpoints/role"), count),
    };
  }

  private covariates(): [string, string][] {
    const names = this.file.strings(this.at("/covariates/name"));
    const values = this.file.strings(this.at("/covariates/value"), names.length);
    return names.map((name, i) => [name, values[i]!]);
  }

  private findings(): Finding[] {
    const code = this.file.strings(this.at("/diagnostics/code"));
    const [severity, stage, message] = ["severity", "stage", "message"].map((name) =>
      this.file.strings(this.at(`/diagnostics/${name}`), code.length),
    ) as [string[], string[], string[]];
    return code.map((name, i) => ({ code: name, severity: severity[i]!, stage: stage[i]!, message: message[i]! }));
  }

  /** A table of things with a place: its columns, and where its rows are, under whatever of these names it has. */
  private marked(name: string): MarkedTable {
    const group = this.at(`/${name}`);
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
    const axis = this.at("/graph/axis");
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

  /** Quantities of the lines that the wall can be coloured by: those at the abscissa a site belongs to. */
  private derive(surface: SurfacePart, lines: LinesPart): void {
    const has = (key: string) => surface.fields.some((field) => field.key === key);
    if (!has("centerline_id") || !has("abscissa")) return;
    for (const key of ["radius", "clearance"]) {
      const field = lines.fields.find((candidate) => candidate.key === key);
      if (field)
        surface.fields.push({
          ...field, key: `line_${key}`, path: `derived:${key}`, label: labelOf(`line_${key}`), symbol: "",
          description: `${field.description}, at the abscissa that the site belongs to`,
        });
    }
  }

  /** Values per point, for the graphics card: what is missing or unreached is NaN. */
  field(path: string, row: number): Float32Array {
    if (path.startsWith("derived:")) return this.derived(path.slice("derived:".length));
    const values = row < 0 ? this.file.numbers(path) : this.file.row(path, row);
    const categories = this.file.info(path)?.kind === "integer";
    return Float32Array.from(values, (x) => (!Number.isFinite(x) || (categories && x < 0) ? NaN : x));
  }

  private derived(key: string): Float32Array {
    const id = this.file.numbers(this.at("/surface/centerline_id"));
    const at = this.file.numbers(this.at("/surface/abscissa"), id.length);
    const abscissa = this.file.numbers(this.at("/centerlines/abscissa"));
    const values = this.file.numbers(this.at(`/centerlines/${key}`), abscissa.length);
    const offsets = this.file.offsets(this.at("/centerlines/offsets"), abscissa.length);
    return Float32Array.from(id, (line, site) => {
      if (!(line >= 0 && line + 1 < offsets.length)) return NaN;
      return interpolated(abscissa, values, offsets[line]!, offsets[line + 1]!, at[site]!);
    });
  }

  voronoi(): Voronoi {
    if (this.polygons) return this.polygons;
    const count = this.rows("/voronoi/vertices", 3);
    const points = centred(this.file.points(this.at("/voronoi/vertices"), count), this.centre);
    const corners = this.file.indices(this.at("/voronoi/polygon_vertices"), 0, count);
    const offsets = this.file.offsets(this.at("/voronoi/polygon_offsets"), corners.length);
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
    return (this.polygons = { points, triangles, ofWall: wall.length, edges: Uint32Array.from(edges) });
  }

  /** Polygons that a site of an extension or cap takes part in; null if the file does not say. */
  private addedPolygons(count: number): Uint8Array | null {
    const [sites, origin] = [this.at("/voronoi/polygon_sites"), this.at("/surface/origin")];
    if (!this.file.has(sites) || !this.file.has(origin)) return null;
    const from = this.file.numbers(origin);
    const pairs = this.file.indices(sites, -1, from.length, 2 * count);
    const added = new Uint8Array(count);
    for (let i = 0; i < pairs.length; ++i) if (pairs[i]! >= 0 && from[pairs[i]!]! !== 0) added[i >> 1] = 1;
    return added;
  }

  site(index: number): Site {
    const count = this.rows("/surface/points", 3);
    const point = Array.from(this.file.row(this.at("/surface/points"), index)) as Point;
    const site: Site = {
      index, point, values: [], pole: null, way: null, wayIsStraight: true, line: -1, abscissa: NaN,
    };
    for (const field of this.fields("/surface", count)) {
      const value = this.file.row(field.path, index)[0]!;
      site.values.push({
        label: field.label, symbol: field.symbol, value, units: field.units, category: field.kind === "category",
      });
      if (field.key === "centerline_id") site.line = value;
      if (field.key === "abscissa") site.abscissa = value;
    }
    this.addPole(site);
    return site;
  }

  private addPole(site: Site): void {
    if (!this.file.has(this.at("/surface/pole")) || !this.file.has(this.at("/voronoi/vertices"))) return;
    const pole = this.file.row(this.at("/surface/pole"), site.index)[0]!;
    if (pole < 0) return;
    const at = Array.from(this.file.row(this.at("/voronoi/vertices"), pole));
    const point = at.map((x, axis) => x - this.centre[axis]!) as Point;
    site.pole = { point, radius: this.file.row(this.at("/voronoi/ball_radius"), pole)[0]! };
    if (!this.file.has(this.at("/surface/centerline_point"))) return;
    const end = Array.from(this.file.row(this.at("/surface/centerline_point"), site.index));
    if (!end.every(Number.isFinite)) return;
    site.way = Float32Array.from([...point, ...end.map((x, axis) => x - this.centre[axis]!)]);
  }

  /** One quantity along one line; null if the model has no such line. */
  profile(path: string, line: number): Profile | null {
    if (!this.file.isGroup(this.at("/centerlines")) || !this.file.has(this.at(path))) return null;
    const abscissa = this.file.numbers(this.at("/centerlines/abscissa"));
    const offsets = this.file.offsets(this.at("/centerlines/offsets"), abscissa.length);
    const length = (l: number) => abscissa[offsets[l + 1]! - 1]! - abscissa[offsets[l]!]!;
    let chosen = line;
    if (line < 0)
      for (let l = 0; l + 1 < offsets.length; ++l)
        if (offsets[l + 1]! > offsets[l]! && (chosen < 0 || length(l) > length(chosen))) chosen = l;
    if (!(chosen >= 0 && chosen + 1 < offsets.length)) return null;
    const [first, end] = [offsets[chosen]!, offsets[chosen + 1]!];
    const values = this.file.numbers(this.at(path), abscissa.length);
    return {
      id: this.id,
      x: Float32Array.from(abscissa.subarray(first, end)),
      y: Float32Array.from(values.subarray(first, end)),
      units: this.file.info(this.at(path))?.units ?? "",
    };
  }
}
