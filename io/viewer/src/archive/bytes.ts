// Where the bytes of an archive come from: ranges over HTTP, files the user chose, or bytes within the page. HDF5 reads
// synchronously, so these do too, which browsers allow in workers only. HDF5's own reads are small and scattered
// (headers, B-trees) or large (a dataset): the small ones are served from cached blocks, the large ones pass through.

/** A file of known size that can be read at any place. */
export interface ByteSource {
  readonly size: number;
  /** Fills `target` from `position` on; the caller stays within `size`. */
  read(position: number, target: Uint8Array): void;
}

/** The files of one archive, by their path within it ("cohort.h5", "models/a.hdf"). */
export interface FileSet {
  /** Null if there is no such file; throws with a sentence if it cannot be reached. Small files are read at once. */
  open(path: string): Promise<ByteSource | null>;
}

/** Told of the bytes that were fetched so far. */
export type Fetched = (bytes: number) => void;

const kBlock = 1 << 18;
const kSmallFile = 1 << 22;

/** A source behind blocks, for sources where each read is slow. */
class CachedSource implements ByteSource {
  private readonly blocks = new Map<number, Uint8Array>();

  constructor(private readonly slow: ByteSource) {}

  get size(): number {
    return this.slow.size;
  }

  read(position: number, target: Uint8Array): void {
    if (target.length >= kBlock) {
      this.slow.read(position, target);
      return;
    }
    const end = position + target.length;
    let at = position;
    while (at < end) {
      const block = this.block(Math.floor(at / kBlock));
      const within = at % kBlock;
      const part = block.subarray(within, Math.min(block.length, within + end - at));
      target.set(part, at - position);
      at += part.length;
    }
  }

  private block(index: number): Uint8Array {
    const known = this.blocks.get(index);
    if (known) return known;
    const start = index * kBlock;
    const made = new Uint8Array(Math.min(kBlock, this.size - start));
    this.slow.read(start, made);
    this.blocks.set(index, made);
    return made;
  }
}

class MemorySource implements ByteSource {
  constructor(private readonly bytes: Uint8Array) {}

  get size(): number {
    return this.bytes.length;
  }

  read(position: number, target: Uint8Array): void {
    target.set(this.bytes.subarray(position, position + target.length));
  }
}

class LocalSource implements ByteSource {
  private readonly reader = new FileReaderSync();

  constructor(private readonly file: Blob, private readonly name: string, private readonly fetched: Fetched) {}

  get size(): number {
    return this.file.size;
  }

  read(position: number, target: Uint8Array): void {
    try {
      const part = this.file.slice(position, position + target.length);
      target.set(new Uint8Array(this.reader.readAsArrayBuffer(part)));
    } catch {
      throw new Error(`the file '${this.name}' can no longer be read; it may have been moved or changed: open it again`);
    }
    this.fetched(target.length);
  }
}

/** A file of the server, by ranges of it. */
class ServedSource implements ByteSource {
  constructor(
    private readonly url: string,
    private readonly name: string,
    readonly size: number,
    private readonly tag: string | null,
    private readonly fetched: Fetched,
  ) {}

  read(position: number, target: Uint8Array): void {
    if (target.length === 0) return;
    const request = new XMLHttpRequest();
    request.open("GET", this.url, false);
    request.responseType = "arraybuffer";
    request.setRequestHeader("Range", `bytes=${position}-${position + target.length - 1}`);
    try {
      request.send();
    } catch {
      throw silent(this.name);
    }
    const bytes = request.response instanceof ArrayBuffer ? new Uint8Array(request.response) : new Uint8Array(0);
    if (request.getResponseHeader("ETag") !== this.tag)
      throw new Error(`the file '${this.name}' was written anew while it was read: load the page again`);
    if (request.status !== 206 || bytes.length !== target.length) throw refused(this.name, request.status);
    target.set(bytes);
    this.fetched(bytes.length);
  }
}

const silent = (name: string) =>
  new Error(`the server does not answer for '${name}': see whether 'lumenline browse ... serve' still runs`);
const refused = (name: string, status: number) => new Error(`the server does not give all of '${name}' (status ${status})`);

async function openServed(url: string, name: string, fetched: Fetched): Promise<ByteSource | null> {
  const ask = (method: string) => fetch(url, { method }).catch(() => Promise.reject(silent(name)));
  const head = await ask("HEAD");
  if (head.status === 404) return null;
  const size = Number(head.headers.get("Content-Length"));
  if (head.status !== 200 || !Number.isSafeInteger(size)) throw refused(name, head.status);
  if (size > kSmallFile) return new CachedSource(new ServedSource(url, name, size, head.headers.get("ETag"), fetched));
  if (size === 0) return new MemorySource(new Uint8Array(0));
  const whole = await ask("GET");
  if (whole.status !== 200) throw refused(name, whole.status);
  const bytes = await whole.arrayBuffer().catch(() => Promise.reject(silent(name)));
  fetched(bytes.byteLength);
  return new MemorySource(new Uint8Array(bytes));
}

const encoded = (path: string) => path.split("/").map(encodeURIComponent).join("/");

export function servedFiles(base: string, fetched: Fetched): FileSet {
  return { open: (path) => openServed(base + encoded(path), path, fetched) };
}

export function localFiles(files: ReadonlyMap<string, Blob>, fetched: Fetched): FileSet {
  return {
    async open(path) {
      const file = files.get(path);
      if (!file) return null;
      const source = new LocalSource(file, path, fetched);
      if (file.size > kSmallFile) return new CachedSource(source);
      const bytes = new Uint8Array(file.size);
      source.read(0, bytes);
      return new MemorySource(bytes);
    },
  };
}

export function embeddedFiles(files: ReadonlyMap<string, Uint8Array>): FileSet {
  return {
    async open(path) {
      const bytes = files.get(path);
      return bytes ? new MemorySource(bytes) : null;
    },
  };
}
