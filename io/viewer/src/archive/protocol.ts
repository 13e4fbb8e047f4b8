// What the page and its worker say to each other. All coordinates of a model are relative to `centre`, so that 32-bit
// numbers hold them; units stand beside the values.

/** The HDF5 library, gzipped: from the server that has the archive too, or from the page itself. */
export type PackedLibrary = { server: string } | { base64: string };

export interface ServedArchive {
  kind: "served";
  base: string;
  root: string;
  name: string;
}

export type Opened =
  | ServedArchive
  | { kind: "local"; files: Map<string, Blob>; root: string; name: string }
  | { kind: "embedded"; files: Map<string, Uint8Array>; root: string; name: string };

export interface Column {
  name: string;
  label: string;
  units: string;
  description: string;
  numbers?: Float64Array; // exactly one of these two
  texts?: string[];
}

export interface Table {
  rows: number;
  columns: Column[];
}

export interface Failure {
  id: string;
  stage: string;
  code: string;
  sentence: string;
}

export interface Cohort {
  name: string;
  isModelFile: boolean;
  version: string;
  models: Table;
  tables: string[]; // further tables of the index, by name
  failures: Failure[];
  notes: string[]; // what of the index could not be read
}

export interface Field {
  key: string;
  path: string;
  row: number; // of a dataset with one row per source; -1 = the whole dataset
  label: string;
  symbol: string;
  units: string;
  description: string;
  kind: "scale" | "category";
}

export interface SurfacePart {
  points: Float32Array; // (N, 3)
  normals: Float32Array; // (N, 3)
  wall: Uint32Array; // corners of the triangles of the wall
  added: Uint32Array; // of extensions and caps
  fields: Field[];
}

export interface LinesPart {
  points: Float32Array; // (K, 3)
  offsets: Int32Array; // (L+1)
  abscissa: Float32Array; // (K)
  radius: Float32Array; // (K)
  source: Int32Array; // (L)
  target: Int32Array; // (L)
  fields: Field[];
}

export interface Ends {
  points: Float32Array; // (E, 3)
  radius: Float32Array;
  kind: string[];
  role: string[];
}

export interface MarkedTable {
  name: string;
  table: Table;
  points: Float32Array | null; // (rows, 3): where the rows are
  outlines: { points: Float32Array; offsets: Int32Array } | null; // closed curves of the rows
}

export interface Finding {
  code: string;
  severity: string;
  stage: string;
  message: string;
}

export interface Model {
  id: string;
  attributes: Record<string, string | number>;
  unit: string;
  centre: [number, number, number];
  diagonal: number; // of the box of the wall
  covariates: [string, string][];
  findings: Finding[];
  surface: SurfacePart | null;
  lines: LinesPart | null;
  ends: Ends | null;
  voronoi: { vertices: number; polygons: number; fields: Field[] } | null;
  notes: string[];
}

/** What has a place in a model beside its geometry: sections and the like. */
export interface Marks {
  tables: MarkedTable[];
  notes: string[];
}

export interface Voronoi {
  points: Float32Array;
  triangles: Uint32Array; // those of polygons between sites of the wall first
  ofWall: number; // how many corners of triangles these are
  edges: Uint32Array; // pairs: bare edges
}

export interface Site {
  index: number;
  point: [number, number, number]; // in the model's own coordinates
  values: { label: string; symbol: string; value: number; units: string; category: boolean }[];
  pole: { point: [number, number, number]; radius: number } | null; // relative to the centre, as all points
  way: Float32Array | null; // from the pole to centerline_point
  wayIsStraight: boolean; // else the descent over the diagram
  line: number; // -1 = none
  abscissa: number;
}

export interface Profile {
  id: string;
  x: Float32Array; // abscissa
  y: Float32Array;
  units: string;
}

export interface ProfileRequest {
  ids: string[];
  path: string; // dataset per centerline point
  line: number; // index; -1 = the longest
}

export interface Requests {
  served: { ask: null; answer: ServedArchive | null };
  open: { ask: Opened; answer: Cohort };
  table: { ask: string; answer: Table };
  model: { ask: string; answer: Model };
  marks: { ask: string; answer: Marks };
  field: { ask: { id: string; path: string; row: number }; answer: Float32Array };
  voronoi: { ask: string; answer: Voronoi };
  site: { ask: { id: string; index: number }; answer: Site };
  profiles: { ask: ProfileRequest; answer: { failed: string[] } };
}

export type Verb = keyof Requests;

export type Asked = { [V in Verb]: { number: number; verb: V; ask: Requests[V]["ask"] } }[Verb];
export type ToWorker = Asked | { cancel: number } | { library: PackedLibrary };

export type FromWorker =
  | { number: number; answer: unknown }
  | { number: number; sentence: string; fatal: boolean }
  | { number: number; part: unknown }
  | { fetched: number };
