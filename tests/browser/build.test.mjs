// The committed page is what its sources and package-lock.json give, byte for byte.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { gunzipSync } from "node:zlib";
import { viewer } from "./support.mjs";

test("a build gives the committed page", () => {
  const folder = mkdtempSync(join(tmpdir(), "lumenline-page-"));
  try {
    const built = spawnSync("npm", ["run", "build"], {
      cwd: viewer, encoding: "utf8", env: { ...process.env, LUMENLINE_PAGE_FOLDER: folder },
    });
    assert.equal(built.status, 0, built.stdout + built.stderr);
    for (const name of ["page.html.gz", "hdf5.wasm.gz", "page.csp"])
      assert.ok(
        readFileSync(join(folder, name)).equals(readFileSync(join(viewer, "built", name))),
        `${name} differs from the committed one: run 'npm ci && npm run build' in io/viewer and commit io/viewer/built`,
      );
  } finally {
    rmSync(folder, { recursive: true });
  }
});

test("the page links to nothing, and its library is WebAssembly", () => {
  const html = gunzipSync(readFileSync(join(viewer, "built/page.html.gz"))).toString("utf8");
  const outside = html.replace(/<script[^]*?<\/script>/g, "").replace(/<style>[^]*?<\/style>/g, "");
  assert.doesNotMatch(outside, /(src|href)="(?!data:)/, "something is linked");
  assert.equal(html.split("<!--blocks-->").length, 2, "one place for blocks of data");
  assert.ok(html.indexOf("<!--blocks-->") < html.indexOf("<script"), "blocks stand before what looks for them");
  assert.match(outside, /Content-Security-Policy" content="default-src 'none'; script-src 'sha256-/);
  const policy = /Content-Security-Policy" content="([^"]*)"/.exec(outside)?.[1] ?? "";
  assert.doesNotMatch(policy, /'unsafe-inline'|'unsafe-eval'|\*|https?:/);
  const library = readFileSync(join(viewer, "built/hdf5.wasm.gz"));
  assert.ok(WebAssembly.validate(gunzipSync(library)));
  assert.ok(library.length < 2 * 1024 * 1024, "below 2 MiB");
});
