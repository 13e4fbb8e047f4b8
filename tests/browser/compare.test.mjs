// The compare view: both models drawn, cameras linked, profiles of the whole cohort below.
import assert from "node:assert/strict";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { archives, chromium, content, difference, openPage, picture, serve } from "./support.mjs";

let browser, server, page, problems;
before(async () => {
  browser = await chromium();
  server = await serve(join(archives, "good"), "--port", "0");
  ({ page, problems } = await openPage(browser));
  await page.goto(`${server.address}#/compare/torus/stenosis`);
  await page.waitForFunction(() => document.querySelectorAll(".scene[data-ready]").length === 2);
  await page.waitForSelector(".plot[data-ready=true]");
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

const scene = (side) => page.locator(".scene").nth(side);

test("both models and the profiles are drawn", async () => {
  for (const side of [0, 1]) assert.ok(content(await picture(scene(side), `compare-${side}`)).share > 0.02);
  const plot = content(await picture(page.locator(".band .plot"), "compare-band"));
  assert.ok(plot.share > 0.02 && plot.colours > 8, JSON.stringify(plot));
  assert.match(await page.locator(".band .count").innerText(), /6 of 7 models have this line/);
  await picture(page, "compare");
});

test("cameras are linked both ways", async () => {
  for (const [turned, other] of [[0, 1], [1, 0]]) {
    const before = await picture(scene(other), "compare-before");
    const box = await scene(turned).boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2 + 90, box.y + box.height / 2 + 50, { steps: 4 });
    await page.mouse.up();
    await page.waitForTimeout(400);
    assert.ok(difference(before, await picture(scene(other), "compare-after")) > 0.01);
  }
});

test("walls are coloured over one range", async () => {
  const before = await picture(scene(0), "compare-plain");
  await page.locator(".compare .toolbar select").first().selectOption("geodesic_distance");
  await page.waitForFunction(() => document.querySelector(".bars")?.textContent.includes("D_g"));
  await page.waitForTimeout(500);
  assert.ok(difference(before, await picture(scene(0), "compare-coloured")) > 0.02);
});

test("arrow keys move the slider that they are with, and a choice keeps the keyboard", async () => {
  const opacity = page.getByRole("slider", { name: "Opacity" });
  await opacity.focus();
  const before = [await opacity.inputValue(), await picture(scene(0), "compare-keys-before")];
  await page.keyboard.press("ArrowLeft");
  assert.notEqual(await opacity.inputValue(), before[0]);
  await page.getByRole("combobox", { name: "Walls" }).focus();
  await page.keyboard.press("ArrowDown");
  assert.equal(await page.evaluate(() => document.activeElement.labels?.[0]?.textContent), "Walls");
  await page.getByRole("combobox", { name: "Walls" }).selectOption("geodesic_distance");
});

test("profiles can be shown by abscissa, of another quantity, of another line, together", async () => {
  const plot = page.locator(".band .plot");
  let shown = await picture(plot, "compare-share");
  const changed = async (act, name) => {
    await act();
    await page.waitForSelector(".plot[data-ready=true]");
    await page.waitForTimeout(400);
    const now = await picture(plot, name);
    assert.ok(difference(shown, now) > 0.003, name);
    shown = now;
  };
  const select = (label) => page.locator(".band .field", { hasText: label }).locator("select");
  await changed(() => page.getByLabel("By share of length").uncheck(), "compare-abscissa");
  await changed(() => select("Quantity").selectOption("clearance"), "compare-clearance");
  await changed(() => select("By").selectOption(""), "compare-together");
});

test("the profile of a branch by its label comes from the tables of the index", async () => {
  const select = (label) => page.locator(".band").getByLabel(label, { exact: true });
  const plot = page.locator(".band .plot");
  const before = await picture(plot, "compare-before-branch");
  await select("Of").selectOption({ label: "branch 1" });
  await page.waitForFunction(() => document.querySelector(".band .count")?.textContent.includes("have this branch"));
  assert.match(await page.locator(".band .count").innerText(), /^6 of 7 models have this branch$/);
  assert.equal(await select("Quantity").inputValue(), "equivalent_diameter");
  await page.waitForTimeout(400);
  assert.ok(difference(before, await picture(plot, "compare-branch")) > 0.003);
  assert.match(page.url(), /branch=1/);
  await select("Of").selectOption("-1");
  await page.waitForFunction(() => document.querySelector(".band .count")?.textContent.includes("have this line"));
  await page.waitForSelector(".plot[data-ready=true]");
  assert.equal(await select("Quantity").inputValue(), "radius");
});

test("another model takes its place", async () => {
  await page.getByRole("combobox", { name: "right model" }).selectOption("helix");
  await page.waitForURL(/compare\/torus\/helix/);
  await page.waitForFunction(() => document.querySelectorAll(".scene[data-ready]").length === 2);
  await page.waitForSelector(".plot[data-ready=true]");
});

test("a model without lines is left out and the other one stays", async () => {
  await page.goto(`${server.address}#/compare/broken/torus`);
  await page.waitForSelector(".plot[data-ready=true]");
  assert.match(await page.locator(".band .count").innerText(), /6 of 7/);
});

test("nothing went wrong on the way", () => assert.deepEqual(problems, []));
