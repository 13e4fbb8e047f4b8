// The cohort view: everything in the table, filters, sorting, plots that lead to models, failures, the keyboard.
import assert from "node:assert/strict";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { archives, chromium, content, difference, hostileId, hostileText, openPage, picture, serve } from "./support.mjs";

let browser, server, page, problems;
before(async () => {
  browser = await chromium();
  server = await serve(join(archives, "good"), "--port", "0");
  ({ page, problems } = await openPage(browser));
  await page.goto(server.address);
  await page.waitForSelector("table.models tbody tr");
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

const ids = () => page.locator("table.models td.id").allTextContents();
const search = (text) => page.getByRole("searchbox").fill(text);

test("the table has every model, also one whose name is markup", async () => {
  assert.deepEqual((await ids()).sort(), ["broken", "cylinder", "helix", "stenosis", "torus", "tree", hostileId].sort());
  assert.ok((await page.locator("table.models").innerText()).includes(hostileText));
  assert.equal(await page.locator("table.models img, table.models script").count(), 0);
  assert.equal(await page.locator(".count").innerText(), "7 models");
});

test("a covariate has the name and the letters of the table, also one that is named as a column of the program", async () => {
  const headings = await page.locator("table.models th .label").allTextContents();
  const column = headings.indexOf("edge_over_radius");
  assert.ok(column > 0, headings.join(", "));
  const row = page.locator("table.models tr[data-row]").filter({ has: page.locator("a", { hasText: /^stenosis$/ }) });
  assert.equal(await row.locator("td").nth(column).innerText(), "mäßig");
});

test("failures have their sentences", async () => {
  const failures = page.locator(".failures");
  assert.match(await failures.innerText(), /1 model failed/);
  assert.match(await failures.innerText(), /broken\.ply/);
});

test("words and comparisons filter", async () => {
  for (const [text, wanted] of [
    ["sten", ["stenosis"]],
    ["radius_min<2.6", ["stenosis"]],
    ["group=patient", ["stenosis", "tree", "broken"]],
    ["group=control age>40", ["torus", "cylinder"]],
    ["age>=61 age<=70", ["stenosis", "tree"]],
    ["group!=control status!=failed", ["stenosis", "tree"]],
    ["remark:narr", ["stenosis"]],
    ["age=", ["broken"]],
    ["remark!=", ["stenosis", "torus", "tree"]],
    ["remark!=narrow", ["torus", "tree"]],
    ["no such thing", []],
  ]) {
    await search(text);
    assert.deepEqual((await ids()).sort(), [...wanted].sort(), text);
  }
  await search("colour<3");
  assert.match(await page.locator(".toolbar .problem").innerText(), /colour<3/);
  await search("");
  await page.getByRole("button", { name: /^failed/ }).click();
  assert.deepEqual(await ids(), ["broken"]);
  await page.getByRole("button", { name: /^failed/ }).click();
});

test("columns sort up, down, and back; what is missing comes last", async () => {
  const heading = page.locator("th button", { hasText: /^age/ });
  const before = await ids();
  await heading.click();
  assert.deepEqual((await ids()).slice(0, 3), [hostileId, "helix", "torus"]);
  assert.equal((await ids()).at(-1), "broken");
  await heading.click();
  assert.deepEqual((await ids())[0], "tree");
  assert.equal((await ids()).at(-1), "broken");
  await heading.click();
  assert.deepEqual(await ids(), before);
});

test("columns can be chosen", async () => {
  const count = () => page.locator("table.models th").count();
  const had = await count();
  await page.locator("summary", { hasText: "Columns" }).click();
  await page.locator(".menu-body label", { hasText: "triangles" }).click();
  assert.equal(await count(), had + 1);
  await page.locator(".menu-body label", { hasText: "triangles" }).click();
  await page.locator("summary", { hasText: "Columns" }).click();
});

test("plots are drawn, follow the filter, and name the model under the pointer", async () => {
  const plots = page.locator(".plot");
  const whole = await picture(plots.nth(0), "cohort-distribution");
  assert.ok(content(whole).share > 0.01 && content(whole).colours > 5, JSON.stringify(content(whole)));
  assert.ok(content(await picture(plots.nth(1), "cohort-scatter")).colours > 5);
  await page.locator("table.models td.id", { hasText: "stenosis" }).hover();
  const tip = plots.nth(0).locator(".tip");
  assert.match(await tip.innerText(), /stenosis/);
  await picture(page, "cohort");
  await page.mouse.move(5, 5);
  await search("group=patient");
  await page.waitForTimeout(300);
  assert.ok(difference(whole, await picture(plots.nth(0), "cohort-distribution-patients")) > 0.002);
  await search("");
});

test("a click on a point opens its model", async () => {
  await page.locator("table.models td.id", { hasText: "stenosis" }).hover();
  const plot = page.locator(".plot").nth(0);
  const box = await plot.boundingBox();
  const point = await plot.locator(".tip").evaluate((tip) => ({ x: Number(tip.dataset.x), y: Number(tip.dataset.y) }));
  await page.mouse.click(box.x + point.x, box.y + point.y);
  await page.waitForURL(/#\/model\/stenosis/);
  await page.waitForSelector(".scene[data-ready]");
  await page.goBack();
  await page.waitForSelector("table.models");
});

test("the keyboard walks through the table and opens a model", async () => {
  await page.keyboard.press("/");
  assert.equal(await page.evaluate(() => document.activeElement.type), "search");
  await page.locator(".table-scroll").focus();
  await page.keyboard.press("ArrowDown");
  await page.keyboard.press("ArrowDown");
  const chosen = page.locator("tr.chosen td.id");
  assert.equal(await chosen.innerText(), (await ids())[1]);
  await page.keyboard.press("Enter");
  await page.waitForURL(/#\/model\//);
  await page.waitForSelector(".scene[data-ready]");
  await page.keyboard.press("g");
  await page.waitForSelector("table.models");
  await page.keyboard.press("?");
  await page.waitForSelector("dialog[open]");
  await page.keyboard.press("Escape");
});

test("the keyboard stays with what it was with", async () => {
  const heading = page.locator("thead button", { hasText: "radius min" });
  await heading.focus();
  await page.keyboard.press("Enter");
  assert.match(await page.evaluate(() => document.activeElement.textContent), /radius min/);
  await page.keyboard.press("?");
  await page.keyboard.press("?");
  assert.equal(await page.locator("dialog").count(), 1);
  await page.goto(`${server.address}#/model/torus`);
  await page.keyboard.press("Escape");
  await page.waitForSelector(".scene[data-ready]");
  const preset = page.getByRole("radio", { name: "Surface" });
  await preset.focus();
  await page.keyboard.press("Enter");
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "Surface");
  await page.keyboard.press("?");
  await page.keyboard.press("g");
  assert.match(page.url(), /model\/torus/, "the page behind a dialog hears no keys");
  await page.keyboard.press("Escape");
  await page.keyboard.press("g");
  await page.waitForSelector("table.models");
});

test("a model that the filter hides is not opened", async () => {
  await page.locator(".table-scroll").focus();
  await page.keyboard.press("Home");
  const search = page.getByRole("searchbox");
  const chosen = await page.locator("tr.chosen td.id").innerText();
  await search.fill(chosen === "torus" ? "helix" : "torus");
  await page.waitForFunction(() => !document.querySelector("tr.chosen"));
  await page.locator(".table-scroll").focus();
  await page.keyboard.press("Enter");
  await page.waitForTimeout(300);
  assert.equal(await page.locator("table.models").count(), 1);
  await search.fill("");
});

test("another archive need not be opened after all", async () => {
  await page.getByRole("button", { name: "Open…" }).click();
  await page.waitForSelector(".start");
  await page.getByRole("link", { name: "Cohort" }).click();
  await page.waitForSelector("table.models tbody tr");
});

test("light and dark differ, and both are readable in contrast", async () => {
  const light = await picture(page, "cohort-light");
  await page.emulateMedia({ colorScheme: "dark" });
  await page.waitForTimeout(300);
  const dark = await picture(page, "cohort-dark");
  assert.ok(difference(light, dark) > 0.8);
  for (const scheme of ["dark", "light"]) {
    await page.emulateMedia({ colorScheme: scheme });
    const ratio = await page.evaluate(() => {
      const part = (x) => (x <= 0.03928 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
      const light = (name) => {
        const hex = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
        const [r, g, b] = [1, 3, 5].map((i) => part(parseInt(hex.slice(i, i + 2), 16) / 255));
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
      };
      const contrast = (a, b) => (Math.max(light(a), light(b)) + 0.05) / (Math.min(light(a), light(b)) + 0.05);
      return Math.min(...["--text", "--text-2", "--accent", "--failed"].map((name) => contrast(name, "--surface")),
        contrast("--ok", "--ok-soft"), contrast("--warning", "--warning-soft"), contrast("--failed", "--failed-soft"));
    });
    assert.ok(ratio >= 4.5, `${scheme}: contrast ${ratio}`);
  }
});

test("nothing went wrong on the way", () => assert.deepEqual(problems, []));
