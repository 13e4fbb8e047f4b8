// The side of the page that reads: one archive at a time, requests in their order, models kept open while they are
// looked at. Only one sentence leaves it for a failure; what breaks the WebAssembly module itself is told as fatal, and
// the page starts another worker.
import { embeddedFiles, localFiles, servedFiles, type ByteSource, type FileSet } from "./bytes";
import { cohortOfModel, kModelColumns, readCohort, readTable } from "./cohort";
import { ArchiveError, Hdf5 } from "./hdf5";
import { library, useLibrary } from "./library";
import { ModelReader } from "./model";
import type { Asked, Cohort, FromWorker, Opened, PackedLibrary, ProfileRequest, Requests, ServedArchive, Table, ToWorker, Verb } from "./protocol";

const kMostOpen = 4;

class Archive {
  private readonly readers = new Map<string, { file: Hdf5 | null; reader: ModelReader }>();

  private constructor(private readonly files: FileSet, private readonly root: Hdf5, readonly cohort: Cohort) {}

  static async open(opened: Opened): Promise<Archive> {
    const files = fileSet(opened);
    const source = await openIndex(opened, files);
    if (!source) throw new ArchiveError(`there is no file '${opened.root}' in '${opened.name}'`);
    const root = await Hdf5.open(opened.root, source);
    const cohort = root.format === "lumenline-model" ? cohortOfModel(root, opened.name) : readCohort(root, opened.name);
    return new Archive(files, root, cohort);
  }

  close(): void {
    for (const { file } of this.readers.values()) file?.close();
    this.root.close();
  }

  table(name: string): Table {
    const group = `/tables/${name}`;
    const lengths = this.root.keys(group).map((key) => this.root.info(`${group}/${key}`)?.shape[0] ?? 0);
    return readTable(this.root, group, lengths[0] ?? 0, kModelColumns, []);
  }

  async model(id: string): Promise<ModelReader> {
    const known = this.readers.get(id);
    if (known) {
      this.readers.delete(id);
      this.readers.set(id, known);
      return known.reader;
    }
    const opened = await this.openModel(id);
    this.readers.set(id, opened);
    for (const [oldest, entry] of this.readers) {
      if (this.readers.size <= kMostOpen) break;
      entry.file?.close();
      this.readers.delete(oldest);
    }
    return opened.reader;
  }

  private async openModel(id: string): Promise<{ file: Hdf5 | null; reader: ModelReader }> {
    if (this.cohort.isModelFile) {
      const own = this.cohort.models.columns.find((column) => column.name === "id")?.texts?.[0];
      if (id !== own) throw this.root.unusable(`it is the model '${own}', not '${id}'`);
      return { file: null, reader: new ModelReader(this.root, "", id) };
    }
    if (id === "" || id === "." || id === ".." || id.includes("/"))
      throw this.root.unusable(`it names a model '${id}', which is no file name`);
    // In a packed archive the model is a group of the index itself; a link into another file is none here.
    if (this.root.isGroup(`/models/${id}`)) return { file: null, reader: new ModelReader(this.root, `/models/${id}`, id) };
    const path = `models/${id}.hdf`;
    const source = await this.files.open(path);
    if (!source)
      throw new ArchiveError(`the file '${path}' of the model '${id}' is not there: open the whole archive, or run the cohort again`);
    const file = await Hdf5.open(path, source);
    return { file, reader: new ModelReader(file, "", id) };
  }
}

function fileSet(opened: Opened): FileSet {
  if (opened.kind === "served") return servedFiles(opened.base, fetched);
  if (opened.kind === "local") return localFiles(opened.files, fetched);
  return embeddedFiles(opened.files);
}

/** What the server has, whose index is read while the library is still being compiled. */
interface Ahead {
  archive: ServedArchive;
  index: Promise<ByteSource | null>;
}

let ahead: Promise<Ahead | null> = Promise.resolve(null);

async function readAhead(server: string): Promise<Ahead | null> {
  const answer = await fetch(new URL("archive.json", server));
  if (!answer.ok) return null;
  const { root, name } = (await answer.json()) as { root: string; name: string };
  const base = new URL("archive/", server).href;
  const index = servedFiles(base, fetched).open(root);
  index.catch(() => {}); // told to whoever opens it
  return { archive: { kind: "served", base, root, name }, index };
}

/** The index of the server's archive, once: it may be another one when it is opened again. */
async function openIndex(opened: Opened, files: FileSet): Promise<ByteSource | null> {
  const taken = opened.kind === "served" ? await ahead : null;
  ahead = Promise.resolve(null);
  return taken ? taken.index : files.open(opened.root);
}

let bytes = 0;
let toldAt = 0;
const tell = (message: FromWorker, transfer: Transferable[] = []) => postMessage(message, { transfer });

function fetched(count: number): void {
  bytes += count;
  if (performance.now() - toldAt < 50) return;
  toldAt = performance.now();
  tell({ fetched: bytes });
}

let archive: Archive | null = null;
const cancelled = new Set<number>();
const breath = () => new Promise((done) => setTimeout(done, 0));

function current(): Archive {
  if (!archive) throw new ArchiveError("no archive is open");
  return archive;
}

let queue: Promise<unknown> = Promise.resolve();

/** Does `work` when all that was asked for before is done. */
function next<T>(work: () => Promise<T>): Promise<T> {
  const done = queue.then(work);
  queue = done.catch(() => {});
  return done;
}

/** Waits anew for each model, so that a cohort of thousands holds up nothing else that is asked for. */
async function profiles(number: number, request: ProfileRequest): Promise<Requests["profiles"]["answer"]> {
  const failed: string[] = [];
  for (const id of request.ids) {
    await breath(); // lets other requests and a cancellation in
    if (cancelled.has(number)) break;
    try {
      const part = await next(async () => (await current().model(id)).profile(request.path, request.line));
      tell({ number, part: part ?? { id } });
    } catch (error) {
      if (error instanceof WebAssembly.RuntimeError) throw error;
      failed.push(id);
    }
  }
  cancelled.delete(number);
  return { failed };
}

const handlers: { [V in Verb]: (ask: Requests[V]["ask"], number: number) => Promise<Requests[V]["answer"]> } = {
  served: async () => (await ahead)?.archive ?? null,
  async open(opened) {
    archive?.close();
    archive = null;
    archive = await Archive.open(opened);
    return archive.cohort;
  },
  table: async (name) => current().table(name),
  model: async (id) => (await current().model(id)).read(),
  marks: async (id) => (await current().model(id)).marks(),
  field: async ({ id, path, row }) => (await current().model(id)).field(path, row),
  voronoi: async (id) => (await current().model(id)).voronoi(),
  site: async ({ id, index }) => (await current().model(id)).site(index),
  profiles: (request, number) => profiles(number, request),
};

async function answer(message: Asked): Promise<void> {
  const { number, verb, ask } = message;
  try {
    if (verb !== "served") await library();
    const handler = handlers[verb] as (ask: unknown, number: number) => Promise<unknown>;
    tell({ number, answer: await handler(ask, number) });
  } catch (error) {
    const broken = error instanceof WebAssembly.RuntimeError || error instanceof RangeError;
    const sentence = broken ? "the file is damaged in a way that stops the HDF5 library" : error instanceof Error ? error.message : String(error);
    tell({ number, sentence, fatal: broken });
  }
  tell({ fetched: bytes });
}

function begin(packed: PackedLibrary): void {
  useLibrary(packed);
  if ("server" in packed) ahead = readAhead(packed.server).catch(() => null);
}

onmessage = ({ data }: MessageEvent<ToWorker>) => {
  if ("library" in data) begin(data.library);
  else if ("cancel" in data) cancelled.add(data.cancel);
  else if (data.verb === "profiles") void next(async () => {}).then(() => answer(data));
  else void next(() => answer(data));
};

