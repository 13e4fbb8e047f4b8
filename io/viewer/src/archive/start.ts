// Runs first, while the browser still reads the rest of the page: the HDF5 library is compiled, a worker starts and the
// server is asked what it serves, all at the same time. The page finds them in `reader`.
import { bytesOfBlock } from "./blocks";
import ArchiveWorker from "./worker?worker&inline";

/** The HDF5 library that the page carries compressed in a block of data; an Error tells why there is none. */
async function compiledLibrary(): Promise<WebAssembly.Module | Error> {
  try {
    const packed = new Blob([bytesOfBlock(document.getElementById("hdf5-library")!)]);
    const bytes = new Response(packed.stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
    return await WebAssembly.compile(await bytes);
  } catch (error) {
    return new Error(`the browser cannot start the HDF5 library of this page: ${error instanceof Error ? error.message : error}`);
  }
}

let first: Worker | null = new ArchiveWorker();

const started = {
  library: compiledLibrary(),
  /** A worker that has not been used. */
  worker(): Worker {
    const worker = first ?? new ArchiveWorker();
    first = null;
    return worker;
  },
  /** What the server says it serves; null where there is none. */
  served: location.protocol.startsWith("http") ? fetch("archive.json").catch(() => null) : Promise.resolve(null),
  bytesOfBlock,
};

declare global {
  var reader: typeof started;
}
globalThis.reader = started;
