// Runs first, while the browser still reads the rest of the page: starts a worker, which begins with the HDF5 library and
// the archive that the server has. The page finds it in `reader`.
import type { PackedLibrary, ToWorker } from "./protocol";
import ArchiveWorker from "./worker?worker&inline";

// A page that is one file has the library in a block; else there is a server, which has it.
const block = document.getElementById("hdf5-library");
const library: PackedLibrary = block ? { base64: block.textContent! } : { server: new URL(".", location.href).href };
block?.remove();

function start(): Worker {
  const worker = new ArchiveWorker();
  worker.postMessage({ library } satisfies ToWorker);
  return worker;
}

/** The first one; null if there can be none, which whoever asks for it is told. */
function first(): Worker | null {
  try {
    return start();
  } catch {
    return null;
  }
}

let unused = first();

declare global {
  /** Gives a worker that has not been used. */
  var newReader: () => Worker;
}
globalThis.newReader = () => {
  const worker = unused ?? start();
  unused = null;
  return worker;
};
