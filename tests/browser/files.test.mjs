// Where archives come from: folders and files that are chosen, packed archives, pages with an archive in them; and what
// is said when files are missing or damaged.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { after, before, test } from "node:test";
import { archives, binary, chromium, content, drawn, openPage, picture, serve, viewer } from "./support.mjs";

let browser;
before(async () => (browser = await chromium()));
after(() => browser?.close());

const written = (name) => join(archives, name);

function writePage(name, ...options) {
  return writePageOf("good", name, ...options);
}

function writePageOf(archive, name, ...options) {
  const done = spawnSync(binary, ["browse", join(archives, archive), "page", "-o", written(name), ...options], { encoding: "utf8" });
  assert.equal(done.status, 0, done.stderr);
  return pathToFileURL(written(name)).href;
}

async function choose(selector, files) {
  const { page, problems } = await openPage(browser);
  await page.goto(writePage("empty.html", "--empty"));
  await page.waitForSelector(".start");
  await page.locator(selector).setInputFiles(files);
  return { page, problems };
}

const shownModel = async (page, id) => {
  await page.locator("table.models td.id a", { hasText: id }).click();
  await drawn(page);
  return content(await picture(page.locator(".scene"), `files-${id}`));
};

test("a page with an archive in it shows it without a server", async () => {
  const { page, problems } = await openPage(browser);
  await page.goto(writePage("whole.html"));
  await page.waitForSelector("table.models tbody tr");
  assert.ok((await shownModel(page, "stenosis")).share > 0.03);
  assert.deepEqual(problems, []);
  await page.close();
});

test("a page with some of the models says of the others that they are not there", async () => {
  const { page } = await openPage(browser);
  await page.goto(writePage("part.html", "--model", "torus"));
  await page.waitForSelector("table.models tbody tr");
  assert.ok((await shownModel(page, "torus")).share > 0.03);
  await page.goto(`${page.url().split("#")[0]}#/model/stenosis`);
  await page.waitForSelector(".error");
  assert.match(await page.locator(".error").innerText(), /models\/stenosis\.hdf.*is not there/);
  await page.close();
});

test("a model whose surface was not archived shows its lines, and finds nothing wrong", async () => {
  const { page, problems } = await openPage(browser);
  await page.goto(writePageOf("lean", "lean.html"));
  await page.waitForSelector("table.models tbody tr");
  assert.ok((await shownModel(page, "helix")).share > 0.001);
  assert.doesNotMatch(await page.locator("body").innerText(), /cannot|there is no dataset/);
  assert.deepEqual(problems, []);
  await page.close();
});

test("a folder can be chosen", async () => {
  const { page, problems } = await choose("#open-folder", join(archives, "good"));
  await page.waitForSelector("table.models tbody tr");
  assert.equal(await page.locator(".archive-name").innerText(), "good");
  assert.ok((await shownModel(page, "helix")).share > 0.03);
  assert.deepEqual(problems, []);
  await page.close();
});

test("a model file can be chosen", async () => {
  const { page, problems } = await choose("#open-file", join(archives, "good/models/torus.hdf"));
  await drawn(page);
  assert.equal(await page.locator(".info h1").innerText(), "torus");
  assert.ok(content(await picture(page.locator(".scene"), "files-model")).share > 0.03);
  assert.deepEqual(problems, []);
  await page.close();
});

test("a model file is that model, by whatever name it is asked for, and whatever was open before", async () => {
  const { page, problems } = await choose("#open-folder", join(archives, "good"));
  await page.waitForSelector("table.models tbody tr");
  await shownModel(page, "stenosis");
  await page.getByRole("button", { name: "Open…" }).click();
  await page.locator("#open-file").setInputFiles(join(archives, "good/models/torus.hdf"));
  await page.waitForFunction(() => document.querySelector(".info h1")?.innerText === "torus");
  await page.evaluate(() => (location.hash = "#/model/stenosis"));
  await page.waitForSelector(".error");
  assert.match(await page.locator(".error").innerText(), /it is the model 'torus', not 'stenosis'/);
  await page.getByRole("link", { name: "Show the model" }).click();
  await page.waitForFunction(() => document.querySelector(".info h1")?.innerText === "torus");
  assert.deepEqual(problems, []);
  await page.close();
});

test("a page that was damaged, and a browser without workers, are said", async () => {
  writePage("harmed.html");
  const html = readFileSync(written("harmed.html"), "utf8");
  const at = html.indexOf(">", html.indexOf("data-lumenline-file=")) + 400;
  writeFileSync(written("harmed.html"), `${html.slice(0, at)}*${html.slice(at + 1)}`);
  const { page } = await openPage(browser);
  await page.goto(pathToFileURL(written("harmed.html")).href);
  await page.waitForSelector(".error p");
  await page.addInitScript(() => {
    globalThis.Worker = class {
      constructor() {
        throw new Error("no workers here");
      }
    };
  });
  await page.goto(writePage("whole.html"));
  await page.waitForSelector(".error p");
  assert.match(await page.locator(".error").innerText(), /no workers here/);
  await page.close();
});

/** Copies a group of one HDF5 file into another, as packing an archive does. */
function copyGroup(from, to) {
  for (const name of from.keys()) {
    const item = from.get(name);
    if (item.type === "Group") copyGroup(item, to.create_group(name));
    else if (item.type === "Dataset") {
      const shape = item.shape ?? [];
      if (shape.some((n) => n === 0)) continue;
      const value = item.value;
      to.create_dataset({ name, data: Array.isArray(value) || ArrayBuffer.isView(value) ? value : [value], shape: shape.length > 0 ? shape : [1], dtype: item.dtype });
      for (const key of ["units", "description"]) to.get(name).create_attribute(key, item.attrs[key]?.value ?? "");
    }
  }
  for (const [key, attribute] of Object.entries(from.attrs)) to.create_attribute(key, attribute.value, attribute.shape, attribute.dtype);
}

test("a packed archive can be chosen", async () => {
  const h5 = (await import(pathToFileURL(join(viewer, "node_modules/h5wasm/dist/node/hdf5_hl.js")).href)).default;
  await h5.ready;
  const packed = new h5.File(written("packed.h5"), "w");
  const index = new h5.File(join(archives, "good/cohort.h5"), "r");
  packed.create_attribute("format", "lumenline-cohort");
  packed.create_attribute("format_version", 1, null, "<i4");
  copyGroup(index.get("tables"), packed.create_group("tables"));
  const models = packed.create_group("models");
  for (const id of ["torus", "stenosis"]) {
    const model = new h5.File(join(archives, `good/models/${id}.hdf`), "r");
    copyGroup(model, models.create_group(id));
    model.close();
  }
  index.close();
  packed.close();
  const { page, problems } = await choose("#open-file", written("packed.h5"));
  await page.waitForSelector("table.models tbody tr");
  assert.ok((await shownModel(page, "torus")).share > 0.03);
  assert.deepEqual(problems, []);
  await page.close();
});

test("files that are no archive are refused in one sentence", async () => {
  const { page } = await choose("#open-file", join(archives, "no-index/cohort.h5"));
  await page.waitForSelector(".error");
  assert.match(await page.locator(".error p").first().innerText(), /^cannot use 'cohort\.h5': is no HDF5 file, or is damaged/);
  await page.close();
  const second = await choose("#open-folder", join(archives, "missing/models"));
  assert.match(await second.page.locator(".start .problem").innerText(), /no cohort\.h5/);
  await second.page.close();
});

test("a missing and a truncated model file are said, and the cohort stays usable", async () => {
  for (const [name, id, sentence] of [
    ["missing", "torus", /'models\/torus\.hdf'.*is not there/],
    ["truncated", "torus", /'models\/torus\.hdf': is no HDF5 file, or is damaged/],
    ["truncated", "helix", /'models\/helix\.hdf': is no HDF5 file, or is damaged/],
  ]) {
    const server = await serve(join(archives, name), "--port", "0");
    const { page } = await openPage(browser);
    await page.goto(`${server.address}#/model/${id}`);
    await page.waitForSelector(".error");
    assert.match(await page.locator(".error p").first().innerText(), sentence);
    await page.getByRole("link", { name: "Back to the cohort" }).click();
    await page.waitForSelector("table.models tbody tr");
    assert.ok((await shownModel(page, "stenosis")).share > 0.03);
    await page.goto(`${server.address}#/compare/${id}/stenosis`);
    await page.waitForSelector(".plot[data-ready=true]");
    assert.match(await page.locator(".pane .problem").first().innerText(), sentence);
    assert.match(await page.locator(".band .count").innerText(), /cannot be read/);
    await page.close();
    await server.stop();
  }
});

test("a scrambled model is shown in part or refused, and the page goes on", async () => {
  const server = await serve(join(archives, "scrambled"), "--port", "0");
  const { page, problems } = await openPage(browser);
  await page.goto(`${server.address}#/model/torus`);
  await page.waitForSelector(".error, .info h1");
  await page.goto(`${server.address}#/`);
  await page.waitForSelector("table.models tbody tr");
  assert.ok((await shownModel(page, "stenosis")).share > 0.03);
  // The HDF5 library tells the console what it met, in indented lines.
  assert.deepEqual(problems.filter((text) => !/^(HDF5-DIAG| )/.test(text)), []);
  await page.close();
  await server.stop();
});

test("an archive that is written anew while it is looked at is noticed", async () => {
  const folder = join(archives, "rewritten");
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(join(folder, "models"), { recursive: true });
  for (const name of ["cohort.h5", "models/torus.hdf", "models/stenosis.hdf"]) copyFileSync(join(archives, "good", name), join(folder, name));
  const server = await serve(folder, "--port", "0");
  const { page } = await openPage(browser);
  await page.goto(`${server.address}#/model/torus`);
  await drawn(page);
  copyFileSync(join(archives, "good/models/stenosis.hdf"), join(folder, "models/torus.hdf"));
  await page.getByRole("radio", { name: "Distance" }).click();
  // A file this small was read whole at the start: either it is noticed, or what was read first is shown to the end.
  await page.waitForFunction(() => /written anew/.test(document.querySelector(".bars").textContent) || document.querySelector(".scene").dataset.ready !== "1");
  await page.close();
  await server.stop();
});

test("a browser that cannot start the HDF5 library is told in one sentence", async () => {
  const said = /^the browser cannot start the HDF5 library of this page: \S/;
  const { page } = await openPage(browser);
  writePage("whole.html");
  const html = readFileSync(written("whole.html"), "utf8");
  const libraries = { "of other bytes": "AAAA", "of no base64": "<>", "cut short": /id="hdf5-library">([^<]*)/.exec(html)[1].slice(0, 4000) };
  for (const [what, bytes] of Object.entries(libraries)) {
    writeFileSync(written("broken.html"), html.replace(/(id="hdf5-library">)[^<]*/, (_, tag) => tag + bytes));
    await page.goto(pathToFileURL(written("broken.html")).href);
    await page.waitForSelector(".error");
    assert.match(await page.locator(".error p").first().innerText(), said, what);
  }
  const server = await serve(join(archives, "good"), "--port", "0");
  await page.context().route("**/hdf5.wasm", (route) => route.abort());
  await page.goto(server.address);
  await page.waitForSelector(".error");
  assert.match(await page.locator(".error p").first().innerText(), said);
  await page.close();
  await server.stop();
});

test("a server that ended is said", async () => {
  const server = await serve(join(archives, "good"), "--port", "0");
  const { page } = await openPage(browser);
  await page.goto(server.address);
  await page.waitForSelector("table.models tbody tr");
  await server.stop();
  await page.locator("table.models td.id a", { hasText: "torus" }).click();
  await page.waitForSelector(".error");
  assert.match(await page.locator(".error").innerText(), /does not answer/);
  await page.close();
});

test("a page is one file, and says what it cannot hold", () => {
  const whole = readFileSync(written("whole.html"), "latin1");
  assert.equal(whole.split("data-lumenline-file=").length - 1, whole.match(/<script type="application\/octet-stream" data-/g).length);
  const wrong = spawnSync(binary, ["browse", join(archives, "good"), "page", "-o", written("x.html"), "--model", "toru"], { encoding: "utf8" });
  assert.equal(wrong.status, 2);
  assert.match(wrong.stderr, /'torus'/);
  const nowhere = spawnSync(binary, ["browse", join(archives, "good"), "page", "-o", "/nonexistent/x.html"], { encoding: "utf8" });
  assert.equal(nowhere.status, 1);
  assert.equal(nowhere.stderr.trim().split("\n").length, 1, nowhere.stderr);
});
