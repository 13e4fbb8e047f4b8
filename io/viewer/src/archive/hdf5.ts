// HDF5 files of an archive behind checks: nothing in them is trusted, and each failure is one sentence with file and
// path. h5wasm's library reads through the file system of its WebAssembly module; a file appears there as a node whose
// `read` asks a ByteSource, so that nothing is copied before it is needed. Each file gets a folder of its own: the
// external links of an index lead nowhere there, since models are opened by their ids.
import { Dataset, File as H5File, Group, Module, ready, type Attribute } from "h5wasm";
import type { ByteSource } from "./bytes";

export type Numbers = Float64Array | Float32Array | Int32Array | Uint32Array | Int16Array | Uint16Array | Int8Array | Uint8Array;

/** A failure that one sentence tells. */
export class ArchiveError extends Error {}

interface Node {
  usedBytes: number;
  stream_ops: Record<string, unknown>;
}

interface EmscriptenFs {
  mkdir(path: string): void;
  rmdir(path: string): void;
  unlink(path: string): void;
  createFile(parent: string, name: string, properties: object, canRead: boolean, canWrite: boolean): Node;
}

const kFormatVersion = 1;
const kHdf5Class = { integer: 0, float: 1, string: 3 };
const kFarthest = 1e20;  // what the program reads itself
const kMostBytes = 1.5e9;  // of one dataset: the memory of a WebAssembly module ends at 2 GiB
let mounted = 0;

/** What is known of a dataset without reading it. */
export interface DatasetInfo {
  path: string;
  shape: number[];
  kind: "float" | "integer" | "text" | "other";
  units: string;
  description: string;
}

function mount(fs: EmscriptenFs, source: ByteSource, remember: (problem: unknown) => void): string {
  const folder = `/archive${mounted++}`;
  fs.mkdir(folder);
  const node = fs.createFile(folder, "file", {}, true, false);
  Object.defineProperty(node, "usedBytes", { get: () => source.size });
  node.stream_ops = {
    ...node.stream_ops,
    read(_: unknown, buffer: Int8Array, offset: number, length: number, position: number): number {
      const count = Math.max(0, Math.min(length, source.size - position));
      try {
        source.read(position, new Uint8Array(buffer.buffer, buffer.byteOffset + offset, count));
      } catch (problem) {
        remember(problem);  // through the C library it would come out as "read failed"
        return 0;
      }
      return count;
    },
  };
  return folder;
}

/** One open HDF5 file. */
export class Hdf5 {
  private problem: unknown = null;
  // Looked up once: each question is several calls into the library, and a table has hundreds of columns.
  private readonly objects = new Map<string, unknown>();
  private readonly infos = new Map<string, DatasetInfo>();
  private readonly described = new Map<string, { units: string; description: string }>();
  private constructor(readonly name: string) {}
  private file!: H5File;
  private fs!: EmscriptenFs;
  private folder = "";

  /** Throws ArchiveError if the bytes are no HDF5 file, or one of another program. */
  static async open(name: string, source: ByteSource): Promise<Hdf5> {
    const made = new Hdf5(name);
    made.fs = (await ready).FS as unknown as EmscriptenFs;
    made.folder = mount(made.fs, source, (problem) => (made.problem = problem));
    try {
      made.file = made.guarded(() => new H5File(`${made.folder}/file`, "r"), "is no HDF5 file, or is damaged");
      if (made.file.file_id === BigInt(-1) || Number(made.file.file_id) < 0)
        throw made.unusable("is no HDF5 file, or is damaged");
      const format = made.attribute("/", "format");
      if (format !== "lumenline-cohort" && format !== "lumenline-model")
        throw made.unusable("is an HDF5 file, but no archive of Lumenline");
      const version = made.attribute("/", "format_version");
      if (typeof version !== "number" || version > kFormatVersion)
        throw made.unusable(`has format version ${version}; this page reads ${kFormatVersion}`);
    } catch (error) {
      made.close();
      throw error;
    }
    return made;
  }

  close(): void {
    try {
      this.file?.close();
      this.fs.unlink(`${this.folder}/file`);
      this.fs.rmdir(this.folder);
    } catch {
      // A file that did not open has nothing to close.
    }
  }

  get format(): string {
    return String(this.attribute("/", "format"));
  }

  unusable(why: string): ArchiveError {
    return new ArchiveError(`cannot use '${this.name}': ${why}`);
  }

  /** Runs a call into HDF5; what the source had to say about a failure comes before what HDF5 says. */
  private guarded<T>(call: () => T, why: string): T {
    this.problem = null;
    let result: T;
    try {
      result = call();
    } catch (error) {
      if (error instanceof WebAssembly.RuntimeError) throw error;
      if (this.problem) throw this.problem;
      throw this.unusable(why);
    }
    if (this.problem) throw this.problem;
    return result;
  }

  private get(path: string): unknown {
    let found = this.objects.get(path);
    if (found === undefined) this.objects.set(path, (found = this.guarded(() => this.file.get(path), `${path} cannot be read`)));
    return found;
  }

  has(path: string): boolean {
    const found = this.get(path);
    return found instanceof Dataset || found instanceof Group;
  }

  isGroup(path: string): boolean {
    return this.get(path) instanceof Group;
  }

  /** Names within a group; none if there is no such group. */
  keys(path: string): string[] {
    const group = this.get(path);
    return group instanceof Group ? this.guarded(() => group.keys(), `${path} cannot be read`) : [];
  }

  attribute(path: string, name: string): string | number | null {
    const object = path === "/" ? this.file : this.get(path);
    if (!(object instanceof Group || object instanceof Dataset)) return null;
    return this.guarded(() => plain(object.attrs[name]), `the attribute ${path}@${name} cannot be read`);
  }

  attributes(path: string): Record<string, string | number> {
    const object = path === "/" ? this.file : this.get(path);
    const found: Record<string, string | number> = {};
    if (!(object instanceof Group || object instanceof Dataset)) return found;
    const all = this.guarded(() => object.attrs, `the attributes of ${path} cannot be read`);
    for (const name of Object.keys(all)) {
      const value = this.guarded(() => plain(all[name]), `the attribute ${path}@${name} cannot be read`);
      if (value !== null) found[name] = value;
    }
    return found;
  }

  /** Attributes of a dataset that the file also has elsewhere, in one piece with others; they are not looked up then. */
  describe(path: string, units: string, description: string): void {
    this.described.set(path, { units, description });
  }

  info(path: string): DatasetInfo | null {
    const known = this.infos.get(path);
    if (known) return known;
    const set = this.get(path);
    if (!(set instanceof Dataset)) return null;
    const { shape, type } = this.guarded(() => set.metadata, `${path} cannot be read`);
    const kind = type === kHdf5Class.float ? "float" : type === kHdf5Class.integer ? "integer" : type === kHdf5Class.string ? "text" : "other";
    const info: DatasetInfo = { path, shape: shape ?? [], kind, ...(this.described.get(path) ?? this.description(path, set)) };
    this.infos.set(path, info);
    return info;
  }

  private description(path: string, set: Dataset): { units: string; description: string } {
    const attributes = this.guarded(() => set.attrs, `${path} cannot be read`);
    const text = (name: string) => String(this.guarded(() => plain(attributes[name]), `${path} cannot be read`) ?? "");
    return { units: text("units"), description: text("description") };
  }

  /** Numbers of a dataset, row by row; of `expected` many values in all if that is given. */
  numbers(path: string, expected?: number): Numbers {
    const set = this.dataset(path);
    const { type, total_size } = set.metadata;
    if (type !== kHdf5Class.float && type !== kHdf5Class.integer) throw this.unusable(`${path} does not hold numbers`);
    this.expect(path, Number(total_size), expected);
    return this.guarded(() => numbersOf(set, raw(set)), `${path} cannot be read`);
  }

  /** Coordinates, all of which are finite. */
  points(path: string, count: number): Numbers {
    const values = this.numbers(path, 3 * count);
    for (const value of values)
      if (!(Math.abs(value) < kFarthest)) throw this.unusable(`${path} has a coordinate that is no number`);
    return values;
  }

  /** One row of a dataset of numbers whose first dimension counts rows. */
  row(path: string, index: number): Numbers {
    const set = this.dataset(path);
    const shape = set.metadata.shape ?? [];
    if (!(index >= 0 && index < (shape[0] ?? 0))) throw this.unusable(`${path} has no row ${index}`);
    return this.guarded(() => numbersOf(set, raw(set, index)), `${path} cannot be read`);
  }

  strings(path: string, expected?: number): string[] {
    const set = this.dataset(path);
    const { type, total_size } = set.metadata;
    if (type !== kHdf5Class.string) throw this.unusable(`${path} does not hold text`);
    this.expect(path, Number(total_size), expected);
    if (Number(total_size) === 0) return [];
    if (!set.metadata.vlen) return texts(this.guarded(() => raw(set), `${path} cannot be read`), set.metadata.size);
    const value = this.guarded(() => set.value, `${path} cannot be read`);
    return typeof value === "string" ? [value] : (value as string[]).map(String);
  }

  /** Indices of a dataset, each at least `least` and below `end`. */
  indices(path: string, least: number, end: number, expected?: number): Int32Array {
    const values = this.numbers(path, expected);
    for (const value of values)
      if (!(value >= least && value < end && Number.isInteger(value)))
        throw this.unusable(`${path} points beyond what there is`);
    return values instanceof Int32Array ? values : Int32Array.from(values);
  }

  /** Offsets of `items` items into `end` values: they ascend from 0 to `end`. */
  offsets(path: string, end: number): Int32Array {
    const values = this.indices(path, 0, end + 1);
    for (let i = 1; i < values.length; ++i)
      if (values[i]! < values[i - 1]!) throw this.unusable(`${path} does not ascend`);
    if (values.length === 0 || values[0] !== 0 || values[values.length - 1] !== end)
      throw this.unusable(`${path} does not cover its values`);
    return values;
  }

  private dataset(path: string): Dataset {
    const found = this.get(path);
    if (!(found instanceof Dataset)) throw this.unusable(`there is no dataset ${path}`);
    const { total_size, size } = this.guarded(() => found.metadata, `${path} cannot be read`);
    if (Number(total_size) * Number(size) > kMostBytes) throw this.unusable(`${path} is too large for a browser`);
    return found;
  }

  private expect(path: string, count: number, expected: number | undefined): void {
    if (expected !== undefined && count !== expected)
      throw this.unusable(`${path} has ${count} values where ${expected} belong`);
  }
}

/**
 * Bytes of a dataset, or of one row of it, little-endian. Not by h5wasm's `value`, which does not look at what HDF5
 * returns: of a block that cannot be unpacked it gives whatever was in the memory.
 */
function raw(set: Dataset, row?: number): Uint8Array<ArrayBuffer> {
  const { size, total_size } = set.metadata;
  const shape = set.metadata.shape ?? [];
  const count = row === undefined ? null : shape.map((n, axis) => BigInt(axis === 0 ? 1 : n));
  const from = count && count.map((_, axis) => BigInt(axis === 0 ? row! : 0));
  const bytes = size * (row === undefined ? Number(total_size) : Number(total_size) / shape[0]!);
  const at = Module._malloc(bytes);
  if (at === 0) throw new Error("no memory");
  try {
    const status = Module.get_dataset_data(set.file_id, set.path, count, from, count && count.map(() => 1n), BigInt(at));
    if (status < 0) throw new Error("HDF5 cannot read it");
    return Module.HEAPU8.slice(at, at + bytes) as Uint8Array<ArrayBuffer>;
  } finally {
    Module._free(at);
  }
}

const kIntegers = [[Uint8Array, Int8Array], [Uint16Array, Int16Array], [Uint32Array, Int32Array], [BigUint64Array, BigInt64Array]] as const;

function numbersOf(set: Dataset, { buffer }: Uint8Array<ArrayBuffer>): Numbers {
  const { type, size, signed } = set.metadata;
  if (type === kHdf5Class.float && size === 8) return new Float64Array(buffer);
  if (type === kHdf5Class.float && size === 4) return new Float32Array(buffer);
  const made = type === kHdf5Class.integer ? kIntegers[Math.log2(size)]?.[signed ? 1 : 0] : undefined;
  if (!made) throw new Error("numbers of a kind that is not known");
  const values = new made(buffer);
  return values instanceof BigInt64Array || values instanceof BigUint64Array ? Float64Array.from(values, Number) : values;
}

/** Texts of `size` bytes each, ended by a zero if shorter: decoded at once, where h5wasm takes them one by one. */
function texts(bytes: Uint8Array, size: number): string[] {
  const count = bytes.length / size;
  const utf8 = new TextDecoder();
  const all = utf8.decode(bytes);
  const cut = all.length === bytes.length // else some letters have several bytes
    ? (from: number) => all.slice(from, from + size)
    : (from: number) => utf8.decode(bytes.subarray(from, from + size));
  return Array.from({ length: count }, (_, i) => upToZero(cut(i * size)));
}

function upToZero(text: string): string {
  const end = text.indexOf("\0");
  return end < 0 ? text : text.slice(0, end);
}

function plain(attribute: Attribute | undefined): string | number | null {
  let value = attribute?.value ?? null;
  if (ArrayBuffer.isView(value)) value = (value as Int32Array)[0] ?? null;
  if (Array.isArray(value)) value = (value[0] as string) ?? null;
  if (typeof value === "bigint") return Number(value);
  return typeof value === "string" || typeof value === "number" ? value : null;
}
