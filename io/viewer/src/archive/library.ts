// The HDF5 library's WebAssembly, in the worker: the page compiles it once and hands it over. As h5wasm ships it, each
// worker would parse four megabytes of script and decode them to bytes before it compiled them. The build puts
// `instantiateWasm` into h5wasm's call of its factory, and the bytes, compressed, into the page (vite.config.ts).

let take: (module: WebAssembly.Module) => void;
let refuse: (reason: Error) => void;
const module = new Promise<WebAssembly.Module>((done, failed) => ([take, refuse] = [done, failed]));
module.catch(() => {}); // told to whoever waits for it

/** Waits for the library; throws where the page has none that can be compiled. */
export async function library(): Promise<void> {
  await module;
}

export function useLibrary(compiled: WebAssembly.Module | Error): void {
  if (compiled instanceof WebAssembly.Module) take(compiled);
  else refuse(compiled);
}

/** Emscripten's hook, instead of its own way to the bytes. */
export function instantiateWasm(
  imports: WebAssembly.Imports,
  receive: (instance: WebAssembly.Instance, module: WebAssembly.Module) => void,
): void {
  module.then(async (compiled) => receive(await WebAssembly.instantiate(compiled, imports), compiled), () => {});
}
