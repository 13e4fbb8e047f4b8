// One page: script, style and worker go into index.html, which states a content-security policy with the hashes of just
// these; the WebAssembly of the HDF5 library stands beside it. Both are compressed by a library of fixed version, so that
// the bytes depend on package-lock.json and the sources alone.
import { createHash } from "node:crypto";
import { mkdirSync, writeFileSync } from "node:fs";
import { resolve } from "node:path";
import { gzipSync } from "fflate";
import { defineConfig, type Plugin } from "vite";

const hash = (text: string) => `'sha256-${createHash("sha256").update(text, "utf8").digest("base64")}'`;

/** The policy of the page. WebAssembly runs in the worker, which starts from a blob. */
function policy(scripts: string[], style: string): string {
  return [
    "default-src 'none'",
    `script-src ${scripts.map(hash).join(" ")} 'wasm-unsafe-eval'`,
    `style-src ${hash(style)}`,
    "worker-src blob:",
    "img-src data: blob:",
    "connect-src 'self'",
    "base-uri 'none'",
    "form-action 'none'",
  ].join("; ");
}

let library: Uint8Array<ArrayBuffer> | undefined;

/** Takes the WebAssembly out of h5wasm's script, and lets src/archive/library.ts make the instance. */
function libraryApart(): Plugin {
  const once = (code: string, what: string | RegExp, by: string): string => {
    const parts = code.split(what);
    if (parts.length !== 2) throw new Error(`h5wasm is not as it was: ${what} is there ${parts.length - 1} times`);
    return parts.join(by);
  };
  return {
    name: "library-apart",
    enforce: "pre",
    transform(code, id) {
      if (id.endsWith("h5wasm/dist/esm/hdf5_hl.js")) {
        const hook = `import { instantiateWasm } from ${JSON.stringify(resolve("src/archive/library.ts"))};\n`;
        return hook + once(code, "ModuleFactory({ noInitialRun: true })", "ModuleFactory({ noInitialRun: true, instantiateWasm })");
      }
      if (!id.endsWith("h5wasm/dist/esm/hdf5_util.js")) return null;
      const decode = /function binaryDecode\(bin\)\{.*?return o\}/s.exec(code)?.[0];
      const find = /function findWasmBinary\(\)\{.*?\}(?=function getBinarySync)/s.exec(code)?.[0];
      if (!decode || !find) throw new Error("h5wasm is not as it was: its WebAssembly is not found");
      library = new Function(`${decode};${find};return findWasmBinary()`)() as Uint8Array<ArrayBuffer>;
      if (!WebAssembly.validate(library)) throw new Error("h5wasm is not as it was: its WebAssembly is none");
      return once(code, find, "function findWasmBinary(){}");
    },
  };
}

function onePage(): Plugin {
  return {
    name: "one-page",
    apply: "build",
    enforce: "post",
    generateBundle(_, bundle) {
      let [first, script] = ["", ""];
      let style = "";
      for (const [name, item] of Object.entries(bundle)) {
        if (item.type === "chunk" && item.isEntry && item.imports.length === 0) {
          // What ends a script element or begins a comment in it can stand in strings and patterns only.
          const code = item.code.replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--").trim();
          if (item.name === "start") first = `(()=>{${code}})()`;
          else script = code;
        } else if (item.type === "asset" && name.endsWith(".css")) style = String(item.source);
        else if (name !== "index.html") this.error(`the page is to be one file, and ${name} stands beside it`);
      }
      const page = bundle["index.html"];
      if (page?.type !== "asset" || !first || !script || !style) return this.error("script, style or page is missing");
      if (!library) return this.error("the HDF5 library is missing");
      style = style.trim();
      const rules = policy([first, script], style);
      const head = `<meta http-equiv="Content-Security-Policy" content="${rules}" />\n    <!--blocks-->\n    <script>${first}</script>\n    <style>${style}</style>`;
      const html = String(page.source)
        .replace(/\s*<script type="module"[^>]*><\/script>/, "")
        .replace(/\s*<link rel="stylesheet"[^>]*>/, "")
        .replace("<meta charset=\"utf-8\" />", () => `<meta charset="utf-8" />\n    ${head}`)
        .replace(/\s*<\/body>/, () => `\n    <script type="module">${script}</script>\n  </body>`);
      for (const name of Object.keys(bundle)) delete bundle[name];
      const folder = resolve(process.env.LUMENLINE_PAGE_FOLDER ?? "built");
      mkdirSync(folder, { recursive: true });
      const packed = (bytes: Uint8Array) => gzipSync(bytes, { level: 9, mtime: 0 });
      writeFileSync(resolve(folder, "page.html.gz"), packed(new TextEncoder().encode(html)));
      writeFileSync(resolve(folder, "hdf5.wasm.gz"), packed(library));
      writeFileSync(resolve(folder, "page.csp"), rules + "; frame-ancestors 'none'\n");
    },
  };
}

export default defineConfig({
  base: "./",
  plugins: [libraryApart(), onePage()],
  esbuild: { charset: "utf8", legalComments: "none" },
  build: {
    target: "es2022",
    modulePreload: false,
    cssCodeSplit: false,
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 10000,
    reportCompressedSize: false,
    write: false,
    rollupOptions: { input: { page: "index.html", start: "src/archive/start.ts" } },
  },
  worker: { format: "iife", plugins: () => [libraryApart()] }, // a page opened as a file may not start module workers
});
