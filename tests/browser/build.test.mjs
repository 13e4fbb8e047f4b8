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
    for (const name of ["page.html.gz", "page.csp"])
      assert.ok(
        readFileSync(join(folder, name)).equals(readFileSync(join(viewer, "built", name))),
        `${name} differs from the committed one: run 'npm ci && npm run build' in io/viewer and commit io/viewer/built`,
      );
  } finally {
    rmSync(folder, { recursive: true });
  }
});

test("the page is one file that asks for nothing else", () => {
  const html = gunzipSync(readFileSync(join(viewer, "built/page.html.gz"))).toString("utf8");
  const outside = html.replace(/<script[^]*?<\/script>/g, "").replace(/<style>[^]*?<\/style>/g, "");
  assert.doesNotMatch(outside, /(src|href)="(?!data:)/, "something is linked");
  assert.equal(html.split("<!--archive-->").length, 2, "one place for an archive");
  assert.match(outside, /Content-Security-Policy" content="default-src 'none'; script-src 'sha256-/);
  const policy = /Content-Security-Policy" content="([^"]*)"/.exec(outside)?.[1] ?? "";
  assert.doesNotMatch(policy, /'unsafe-inline'|'unsafe-eval'|\*|https?:/);
  assert.ok(readFileSync(join(viewer, "built/page.html.gz")).length < 2 * 1024 * 1024, "below 2 MiB");
});
