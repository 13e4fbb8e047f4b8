// The HDF5 library's WebAssembly, in the worker. As h5wasm ships it, each worker would parse four megabytes of script and
// decode them to bytes before it compiled them. The build puts `instantiateWasm` into h5wasm's call of its factory and the
// bytes, compressed, into a file of their own (vite.config.ts), which the server gives and pages without one carry.
import { bytesOfBase64 } from "./base64";
import type { PackedLibrary } from "./protocol";

let take: (packed: PackedLibrary) => void;
const packed = new Promise<PackedLibrary>((done) => (take = done));
let started: () => void;
let failed: (reason: Error) => void;
const running = new Promise<void>((done, refused) => ([started, failed] = [done, refused]));
running.catch(() => {}); // told to whoever waits for it

export const useLibrary = (given: PackedLibrary): void => take(given);

/** Waits for the library; throws a sentence where the browser cannot start it. */
export const library = (): Promise<void> => running;

async function compiled(given: PackedLibrary): Promise<WebAssembly.Module> {
  if ("server" in given) return WebAssembly.compileStreaming(fetch(new URL("hdf5.wasm", given.server)));
  const bytes = new Blob([bytesOfBase64(given.base64)]).stream().pipeThrough(new DecompressionStream("gzip"));
  return WebAssembly.compileStreaming(new Response(bytes, { headers: { "Content-Type": "application/wasm" } }));
}

/** Emscripten's hook, instead of its own way to the bytes. */
export async function instantiateWasm(
  imports: WebAssembly.Imports,
  receive: (instance: WebAssembly.Instance, module: WebAssembly.Module) => void,
): Promise<void> {
  try {
    const module = await compiled(await packed);
    receive(await WebAssembly.instantiate(module, imports), module);
    started();
  } catch (error) {
    const why = error instanceof Error ? error.message : String(error);
    failed(new Error(`the browser cannot start the HDF5 library of this page: ${why}`));
  }
}
