// Every dataset in turn removed, cut short, of another type or not readable: the page shows what is left, or says one
// sentence with the file and the dataset, and goes on with the next. LUMENLINE_DAMAGE=all tries the four on each dataset;
// else they take turns on some, and all are tried on those that nothing can be shown without.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { cpSync, rmSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { after, before, test } from "node:test";
import { archives, binary, chromium, content, damaging, openPage, picture, serve } from "./support.mjs";

let browser;
before(async () => (browser = await chromium()));
after(() => browser?.close());

/** Without these a part of the picture is missing, which has to be said. */
const kNeeded = ["/surface/points", "/surface/triangles", "/centerlines/points", "/centerlines/offsets", "/endpoints/point"];

/** Copies of a file of the good archive, damaged: name, dataset and what was done to it. */
function everyDamage(file, folder) {
  const done = spawnSync(damaging, [join(archives, "good", file), folder], { encoding: "utf8" });
  assert.equal(done.status, 0, done.stderr);
  return done.stdout.trim().split("\n").map((line) => line.split("\t"));
}

/** Some of them: each `step`-th dataset. */
function damagedFiles(file, folder, step) {
  const all = everyDamage(file, folder);
  if (process.env.LUMENLINE_DAMAGE === "all") return all;
  const datasets = [...new Set(all.map(([, path]) => path))];
  return datasets.flatMap((path, k) => {
    const ways = all.filter((entry) => entry[1] === path);
    return kNeeded.includes(path) ? ways : k % step === 0 ? [ways[(k / step) % ways.length]] : [];
  });
}

/** What the HDF5 library tells the console, in indented lines, is no problem of the page. */
const ofThePage = (problems) => problems.filter((text) => !/^(HDF5-DIAG| )/.test(text));

/** Does something that replaces the view, and waits for the new one: drawn, or a refusal, which is returned. */
async function shown(page, act, selector) {
  await page.evaluate(() => (document.querySelector(".stage").firstElementChild.dataset.old = "yes"));
  await act();
  const view = page.locator(".stage > :not([data-old])");
  await view.and(page.locator(".error")).or(view.locator(selector)).first().waitFor();
  const refusal = page.locator(".stage > .error p");
  return (await refusal.count()) > 0 ? refusal.first().innerText() : "";
}

function checkSentence(said, file, path, harm) {
  const which = `${path} ${harm}: ${said}`;
  assert.ok(said.includes(file), which);
  assert.doesNotMatch(said, /undefined|NaN|\[object|TypeError|not a function/, which);
  assert.equal(said.trim().split("\n").length, 1, which);
}

test("a model with any dataset damaged is shown in part or refused in one sentence", { timeout: 3_000_000 }, async (t) => {
  const folder = join(archives, "harmed");
  rmSync(folder, { recursive: true, force: true });
  cpSync(join(archives, "good"), folder, { recursive: true });
  const files = damagedFiles("models/tree.hdf", join(folder, "models"), 7);
  const server = await serve(folder, "--port", "0");
  t.after(() => server.stop());
  const { page, problems } = await openPage(browser);
  await page.goto(server.address);
  await page.waitForSelector("table.models tbody tr");
  let told = 0;
  for (const [name, path, harm] of files) {
    const id = name.replace(/\.hdf$/, "");
    const said = await shown(page, () => page.evaluate((hash) => (location.hash = hash), `#/model/${id}`), ".scene[data-ready]");
    if (said) checkSentence(said, name, path, harm);
    else await page.locator(".info [data-ready]").waitFor({ state: "attached" });
    const text = await page.locator(".stage").innerText();
    const tells = text.includes(name) && text.includes(path.split("/").slice(0, 2).join("/"));
    assert.ok(tells || !kNeeded.includes(path), `${path} ${harm} is not said`);
    told += tells ? 1 : 0;
    assert.deepEqual(ofThePage(problems), [], `${path} ${harm}`);
  }
  console.log(`${files.length} damaged models: ${told} are told, and all that is left is shown`);
  assert.equal(await shown(page, () => page.evaluate(() => (location.hash = "#/model/tree")), ".scene[data-ready]"), "");
  await page.close();
});

test("a quantity that cannot be read is said, and the model is shown without it, also beside another", async (t) => {
  const folder = join(archives, "garbled");
  rmSync(folder, { recursive: true, force: true });
  cpSync(join(archives, "good"), folder, { recursive: true });
  for (const [file, dataset] of [["models/tree.hdf", "/surface/geodesic_distance"], ["models/torus.hdf", "/centerlines/radius_error"]]) {
    const [copy] = everyDamage(file, join(folder, "copies")).find(([, path, harm]) => path === dataset && harm === "garbled");
    cpSync(join(folder, "copies", copy), join(folder, file));
  }
  const server = await serve(folder, "--port", "0");
  t.after(() => server.stop());
  const { page, problems } = await openPage(browser);
  await page.goto(`${server.address}#/model/tree?wallBy=geodesic_distance&opacity=1`);
  await page.waitForSelector(".scene[data-ready]");
  assert.match(await page.locator(".bars .problem").innerText(), /tree\.hdf.*\/surface\/geodesic_distance cannot be read/);
  assert.ok(content(await picture(page.locator(".scene"), "damage-plain-wall")).share > 0.03, "the wall is there");
  await page.goto(`${server.address}#/model/torus`);
  await page.locator(".strip-problems .problem").waitFor();
  assert.match(await page.locator(".strip-problems").innerText(), /torus\.hdf.*\/centerlines\/radius_error cannot be read/);
  assert.equal(await page.locator(".profile canvas").count(), 1, "the radius is there without its error");
  await page.locator(".info [data-ready]").waitFor({ state: "attached" });
  await page.goto(`${server.address}#/compare/torus/tree?wallBy=geodesic_distance&opacity=1`);
  await page.locator(".pane-scene .scene[data-ready]").nth(1).waitFor();
  assert.deepEqual((await page.locator(".pane > .problem").allInnerTexts()).map((text) => /geodesic_distance cannot be read/.test(text)), [false, true]);
  assert.deepEqual(ofThePage(problems), []);
  await page.close();
});

test("an index with any dataset damaged is shown in part or refused in one sentence", { timeout: 3_000_000 }, async () => {
  const files = damagedFiles("cohort.h5", join(archives, "harmed-indices"), 5);
  const html = join(archives, "for-indices.html");
  assert.equal(spawnSync(binary, ["browse", join(archives, "good"), "page", "--empty", "-o", html]).status, 0);
  const { page, problems } = await openPage(browser);
  await page.goto(pathToFileURL(html).href);
  await page.waitForSelector(".start");
  let refused = 0;
  for (const [name, path, harm] of files) {
    const choose = async () => {
      await page.getByRole("button", { name: "Open…" }).click();
      await page.locator("#open-file").setInputFiles(join(archives, "harmed-indices", name));
    };
    const said = await shown(page, choose, "table.models tbody tr");
    if (said) checkSentence(said, name, path, harm);
    refused += said ? 1 : 0;
    assert.deepEqual(ofThePage(problems), [], `${path} ${harm}`);
  }
  console.log(`${files.length} damaged indices: ${refused} refused, the others shown`);
  assert.ok(refused < files.length / 10, `${refused} of ${files.length} are refused`);
  await page.close();
});
