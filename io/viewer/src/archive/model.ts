// One model: geometry first, fields when they are asked for. Parts that the file has not are left away; a part that is
// damaged is left away with a note, so that the rest can still be looked at. Indices are checked against what they
// point into before anything is drawn with them.
import { areasAlong, hasAreas, kAreaPath } from "./areas";
import { Diagram } from "./diagram";
import { ArchiveError, type Hdf5, type DatasetInfo, type Numbers } from "./hdf5";
import { interpolated } from "./interpolate";
import { Places } from "./places";
import { boxOf, centred, type Point } from "./points";
import type { Ends, Field, Finding, LinesPart, Marks, Model, Profile, Site, SurfacePart, Voronoi } from "./protocol";
import { labelOf, symbolOf } from "./words";

/** Categories are ids; of integers, these are measures or pointers instead. */
const kNoField = new Set(["points", "normals", "triangles", "input_vertex", "pole", "cap", "polygon_vertices"]);

/** What the page says first of a surface, line or complex. */
const kOrder = [
  "geodesic_distance", "euclidean_distance", "normalized_tangency_deviation", "abscissa", "branch_id", "centerline_id",
  "radius", "area", "clearance", "ball_radius", "curvature", "arrival_time", "centerline_distance",
];

function byRank(a: Field, b: Field): number {
  const rank = ({ path }: Field) => (kOrder.includes(path.split("/").at(-1)!) ? kOrder.indexOf(path.split("/").at(-1)!) : kOrder.length);
  return rank(a) - rank(b);
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

/** An open model within a file: the file's root, or a group of a packed archive. */
export class ModelReader {
  private centre: Point = [0, 0, 0];
  private placed = false; // whether `centre` is known
  private diagram: Diagram | null = null;

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
      if (info.shape.length === 2 && info.shape[1] === count && info.shape[0]! < count) {
        const sources = this.at("/voronoi/sources");
        const source = info.shape[0]! > 1 && this.file.has(sources) ? this.file.numbers(sources, info.shape[0]) : null;
        for (let row = 0; row < info.shape[0]!; ++row)
          found.push(fieldOf(info, key, row, info.shape[0] === 1 ? labelOf(key) : `${labelOf(key)} from endpoint ${source?.[row] ?? row}`));
      }
    }
    return found.sort(byRank);
  }

  /** A worker that takes over from one that broke is asked for parts before the whole. */
  private place(): void {
    if (!this.placed) this.read();
  }

  read(): Model {
    this.placed = true;
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
      voronoi: null,
      notes,
    };
    // Of a surface that was not to be archived the group has the sizes alone.
    if (attributes["fields"] !== "lines") model.surface = this.part("/surface", notes, () => this.surface(model));
    model.lines = this.part("/centerlines", notes, () => this.lines(model));
    model.ends = this.part("/endpoints", notes, () => this.ends());
    model.voronoi = this.part("/voronoi", notes, () => {
      const vertices = this.rows("/voronoi/vertices", 3);
      return { vertices, polygons: this.rows("/voronoi/polygon_offsets") - 1, fields: this.fields("/voronoi", vertices) };
    });
    if (model.surface && model.lines) this.derive(model.surface, model.lines);
    return model;
  }

  /** Apart from the geometry, which is looked at first. */
  marks(): Marks {
    this.place();
    const notes: string[] = [];
    const tables = ["branches", "bifurcations", "sections", "stenoses", "dilations", "loops"].flatMap((name) => {
      const marked = this.part(`/${name}`, notes, () => new Places(this.file, this.root, this.centre).read(name));
      return marked && marked.table.rows > 0 ? [marked] : [];
    });
    return { tables, notes };
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
      fields: [...this.fields("/centerlines", count), ...this.area()].sort(byRank),
    };
  }

  private area(): Field[] {
    const info = hasAreas(this.file, this.root) ? this.file.info(this.at("/sections/area")) : null;
    return info ? [{ ...fieldOf(info, "area", -1, labelOf("area")), path: this.at(kAreaPath) }] : [];
  }

  /** A quantity of the lines' points, which need not be a dataset. */
  private along(path: string, count?: number): Numbers {
    if (path !== this.at(kAreaPath) || this.file.has(path)) return this.file.numbers(path, count);
    return areasAlong(this.file, this.root, this.rows("/centerlines/points", 3));
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
    const values = row < 0 ? this.along(path) : this.file.row(path, row);
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

  private complex(): Diagram {
    this.place();
    return (this.diagram ??= new Diagram(this.file, this.root, this.centre));
  }

  voronoi(): Voronoi {
    return this.complex().drawing();
  }

  site(index: number): Site {
    this.place();
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
    const last = end.map((x, axis) => x - this.centre[axis]!);
    const descent = this.part("/voronoi", [], () => this.complex().descent(pole, last as Point));
    site.wayIsStraight = descent === null;
    site.way = Float32Array.from([...(descent ?? point), ...last]);
  }

  /** One quantity along one line; null if the model has no such line. */
  profile(path: string, line: number): Profile | null {
    const areas = path === kAreaPath && hasAreas(this.file, this.root);
    if (!this.file.isGroup(this.at("/centerlines")) || !(areas || this.file.has(this.at(path)))) return null;
    const abscissa = this.file.numbers(this.at("/centerlines/abscissa"));
    const offsets = this.file.offsets(this.at("/centerlines/offsets"), abscissa.length);
    const length = (l: number) => abscissa[offsets[l + 1]! - 1]! - abscissa[offsets[l]!]!;
    let chosen = line;
    if (line < 0)
      for (let l = 0; l + 1 < offsets.length; ++l)
        if (offsets[l + 1]! > offsets[l]! && (chosen < 0 || length(l) > length(chosen))) chosen = l;
    if (!(chosen >= 0 && chosen + 1 < offsets.length)) return null;
    const [first, end] = [offsets[chosen]!, offsets[chosen + 1]!];
    const values = this.along(this.at(path), abscissa.length);
    return {
      id: this.id,
      x: Float32Array.from(abscissa.subarray(first, end)),
      y: Float32Array.from(values.subarray(first, end)),
      units: this.file.info(this.at(areas ? "/sections/area" : path))?.units ?? "",
    };
  }
}
