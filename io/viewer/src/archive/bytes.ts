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
  /** Null if there is no such file; throws with a sentence if it cannot be reached. */
  open(path: string): ByteSource | null;
}

/** Told of the bytes that were fetched so far. */
export type Fetched = (bytes: number) => void;

const kBlock = 1 << 18;
const kSmallFile = 1 << 22;

/** A source behind blocks, for sources where each read is slow. Small files are read whole, at once. */
export class CachedSource implements ByteSource {
  private readonly blocks = new Map<number, Uint8Array>();

  constructor(private readonly slow: ByteSource) {}

  get size(): number {
    return this.slow.size;
  }

  read(position: number, target: Uint8Array): void {
    if (target.length >= kBlock && this.size > kSmallFile) {
      this.slow.read(position, target);
      return;
    }
    const end = position + target.length;
    let at = position;
    while (at < end) {
      const block = this.block(Math.floor(at / this.blockSize()));
      const within = at % this.blockSize();
      const part = block.subarray(within, Math.min(block.length, within + end - at));
      target.set(part, at - position);
      at += part.length;
    }
  }

  private blockSize(): number {
    return this.size <= kSmallFile ? kSmallFile : kBlock;
  }

  private block(index: number): Uint8Array {
    const known = this.blocks.get(index);
    if (known) return known;
    const start = index * this.blockSize();
    const made = new Uint8Array(Math.min(this.blockSize(), this.size - start));
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

class ServedSource implements ByteSource {
  private constructor(
    private readonly url: string,
    private readonly name: string,
    readonly size: number,
    private readonly tag: string | null,
    private readonly fetched: Fetched,
  ) {}

  static open(url: string, name: string, fetched: Fetched): ServedSource | null {
    const request = ServedSource.request("HEAD", url, name, () => {});
    if (request.status === 404) return null;
    const size = Number(request.getResponseHeader("Content-Length"));
    if (request.status !== 200 || !Number.isSafeInteger(size))
      throw new Error(`the server does not give '${name}' (status ${request.status})`);
    return new ServedSource(url, name, size, request.getResponseHeader("ETag"), fetched);
  }

  read(position: number, target: Uint8Array): void {
    if (target.length === 0) return;
    const request = ServedSource.request("GET", this.url, this.name, (r) => {
      r.responseType = "arraybuffer";
      r.setRequestHeader("Range", `bytes=${position}-${position + target.length - 1}`);
    });
    const bytes = request.response instanceof ArrayBuffer ? new Uint8Array(request.response) : new Uint8Array(0);
    if (request.getResponseHeader("ETag") !== this.tag)
      throw new Error(`the file '${this.name}' was written anew while it was read: load the page again`);
    if (request.status !== 206 || bytes.length !== target.length)
      throw new Error(`the server does not give all of '${this.name}' (status ${request.status})`);
    target.set(bytes);
    this.fetched(bytes.length);
  }

  private static request(method: string, url: string, name: string, prepare: (r: XMLHttpRequest) => void) {
    const request = new XMLHttpRequest();
    request.open(method, url, false);
    prepare(request);
    try {
      request.send();
    } catch {
      throw new Error(`the server does not answer for '${name}': see whether 'lumenline browse ... serve' still runs`);
    }
    return request;
  }
}

const encoded = (path: string) => path.split("/").map(encodeURIComponent).join("/");

export function servedFiles(base: string, fetched: Fetched): FileSet {
  return {
    open(path) {
      const source = ServedSource.open(base + encoded(path), path, fetched);
      return source && new CachedSource(source);
    },
  };
}

export function localFiles(files: ReadonlyMap<string, Blob>, fetched: Fetched): FileSet {
  return {
    open(path) {
      const file = files.get(path);
      return file ? new CachedSource(new LocalSource(file, path, fetched)) : null;
    },
  };
}

export function embeddedFiles(files: ReadonlyMap<string, Uint8Array>): FileSet {
  return {
    open(path) {
      const bytes = files.get(path);
      return bytes ? new MemorySource(bytes) : null;
    },
  };
}
