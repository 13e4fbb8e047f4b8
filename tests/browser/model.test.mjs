// The model view: every look is drawn, a click on the wall gives its values, plot and scene move together, and a link
// brings the view back.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { archives, chromium, content, decode, difference, drawn, hostileId, openPage, picture, serve } from "./support.mjs";

let browser, server, page, problems;
before(async () => {
  browser = await chromium();
  server = await serve(join(archives, "good"), "--port", "0");
  ({ page, problems } = await openPage(browser));
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

async function open(id) {
  await page.goto(`${server.address}#/`);
  await page.waitForSelector("table.models");
  await page.goto(`${server.address}#/model/${encodeURIComponent(id)}`);
  await drawn(page);
}

/** The scene once it has settled after `act`. */
async function after_(act, name) {
  const ready = await page.locator(".scene").getAttribute("data-ready");
  await act();
  await page.waitForFunction((before) => document.querySelector(".scene").dataset.ready !== before, ready);
  await drawn(page);
  return picture(page.locator(".scene"), name);
}

const look = (name) => page.getByRole("radio", { name }).click();

test("every look is drawn, and each unlike the others", async () => {
  await open("stenosis");
  const shown = [await picture(page.locator(".scene"), "model-lines")];
  for (const name of ["Surface", "Balls", "Arrival time", "Distance"])
    shown.push(await after_(() => look(name), `model-${name.toLowerCase().replace(" ", "-")}`));
  for (const [i, one] of shown.entries()) {
    const { share, colours } = content(one);
    assert.ok(share > 0.03 && colours > 12, `look ${i}: ${share} of the scene, ${colours} colours`);
    for (const other of shown.slice(0, i)) assert.ok(difference(one, other) > 0.01, "looks are told apart");
  }
});

test("colour bars state quantity, unit and range", async () => {
  await open("stenosis");
  assert.match(await page.locator(".bars").innerText(), /Lines: Radius \[mm\]/);
  await after_(() => look("Surface"), "model-surface");
  assert.match(await page.locator(".bars").innerText(), /Wall: Tangency deviation NTD/);
  const scene = await picture(page.locator(".scene"), "model-surface-viridis");
  const other = await after_(() => page.locator(".field", { hasText: "Colour map" }).locator("select").selectOption("magma"), "model-surface-magma");
  assert.ok(difference(scene, other) > 0.03, "another map, other colours");
  for (const key of ["geodesic_distance", "euclidean_distance", "abscissa", "centerline_id", "line_clearance"]) {
    const shown = await after_(() => page.locator("section", { hasText: "Opacity" }).locator("select").selectOption(key), `model-by-${key}`);
    assert.ok(content(shown).share > 0.03, key);
  }
});

test("a click on the wall gives the values there, its pole, and the place on the line", async () => {
  await open("stenosis");
  const before = await picture(page.locator(".scene"), "model-unpicked");
  const box = await page.locator(".scene canvas").boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height * 0.3);
  await page.waitForSelector(".picked h2");
  const text = await page.locator(".picked").innerText();
  assert.match(text, /Site \d+/);
  for (const name of ["D_g", "D_e", "NTD", "Abscissa", "ball at the pole", "by steepest descent"]) assert.ok(text.includes(name), name);
  await page.waitForTimeout(500);
  const picked = await picture(page.locator(".scene"), "model-picked");
  assert.ok(difference(before, picked) > 0.005, "the pole and its ball are drawn");
  // The site's abscissa is where the mark went.
  const abscissa = Number(/Abscissa\n([\d.]+) mm/.exec(text)[1]);
  const mark = Number(/s = ([\d.]+)/.exec(await page.locator(".readout").innerText())[1]);
  assert.ok(Math.abs(abscissa - mark) < 1.5, `${abscissa} and ${mark}`);
  await page.keyboard.press("Escape");
  await page.waitForFunction(() => !document.querySelector(".picked h2"));
});

test("slider, plot and ball move together: the throat is where the radius is least", async () => {
  await open("stenosis");
  const slider = page.getByRole("slider", { name: "place along the line" });
  await slider.fill("0.5");
  assert.match(await page.locator(".readout").innerText(), /s = 2[45][\d.]* mm, {1,2}r = 2\.[45]/);
  const middle = await picture(page.locator(".scene"), "model-throat");
  await slider.fill("0.05");
  assert.match(await page.locator(".readout").innerText(), /r = (4\.9|5)/);
  await page.waitForTimeout(300);
  assert.ok(difference(middle, await picture(page.locator(".scene"), "model-inlet")) > 0.003);
  const over = page.locator(".profile .u-over");
  const box = await over.boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  assert.match(await page.locator(".readout").innerText(), /s = 2[45]/);
  assert.ok(content(await picture(page.locator(".profile"), "model-profile")).share > 0.01);
});

test("a link brings the view back", async () => {
  await open("stenosis");
  await after_(() => look("Distance"), "model-link-look");
  await page.locator(".scene canvas").focus();
  for (const key of ["ArrowRight", "ArrowRight", "ArrowUp", "+"]) await page.keyboard.press(key);
  await page.locator(".scene canvas").blur();
  await page.waitForTimeout(600);
  const wanted = await picture(page.locator(".scene"), "model-link-made");
  const link = page.url();
  assert.match(link, /cam=/);
  const other = await openPage(browser);
  await other.page.goto(link);
  await drawn(other.page);
  await other.page.waitForTimeout(300);
  assert.ok(difference(wanted, await picture(other.page.locator(".scene"), "model-link-restored")) < 0.002);
  assert.deepEqual(other.problems, []);
  await other.page.close();
});

test("sections and bifurcations are drawn over the model, their tables stand beside it, and a link has them", async () => {
  await open("tree");
  const box = (name) => page.getByRole("checkbox", { name: new RegExp(`^${name} \\(`) });
  await box("Sections").waitFor();
  const bare = await picture(page.locator(".scene"), "model-without-sections");
  const cut = await after_(() => box("Sections").check(), "model-sections");
  assert.ok(difference(bare, cut) > 0.01, "sections");
  const both = await after_(() => box("Bifurcations").check(), "model-sections-and-bifurcations");
  assert.ok(difference(cut, both) > 0.0002, "bifurcations");
  const table = page.locator(".info details", { has: page.locator("summary", { hasText: /^Sections/ }) });
  await table.locator("summary").click();
  assert.equal(await table.locator("tbody tr").count(), Number(/\((\d+)\)/.exec(await table.locator("summary").innerText())[1]));
  assert.match(await table.locator("thead").innerText(), /area \[mm/i);
  await page.waitForFunction(() => location.hash.includes("bifurcations"));
  const other = await openPage(browser);
  await other.page.goto(page.url());
  await other.page.locator(".info [data-ready]").waitFor({ state: "attached" });
  await other.page.waitForFunction(() => Number(document.querySelector(".scene").dataset.ready) > 1);
  await drawn(other.page);
  // The address has rounded numbers of the camera, and thin circles tell.
  const restored = await picture(other.page.locator(".scene"), "model-sections-restored");
  const [near, far] = [difference(both, restored), difference(bare, restored)];
  assert.ok(near < far / 2, `${near} from what the link was made of, ${far} from the model without sections`);
  assert.deepEqual(other.problems, []);
  await other.page.close();
});

test("addresses that make no sense show the model as usual", async () => {
  await page.goto(`${server.address}#/`);
  await page.goto(`${server.address}#/model/stenosis?opacity=x&line=77&at=9&map=rainbow&balls=many&wallBy=nothing&cam=1,2&site=99999999`);
  await drawn(page);
  assert.ok(content(await picture(page.locator(".scene"), "model-odd-address")).share > 0.03);
});

test("a picture is saved with its colour bar", async () => {
  await open("stenosis");
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Picture" }).click()]);
  assert.equal(download.suggestedFilename(), "stenosis.png");
  const saved = decode(readFileSync(await download.path()));
  assert.ok(saved.width > 1000);
  assert.ok(content(saved).colours > 20);
});

test("keys turn, look and step", async () => {
  await open("tree");
  const first = await picture(page.locator(".scene"), "tree");
  await page.locator(".scene canvas").focus();
  await page.keyboard.press("5");
  await page.waitForTimeout(400);
  assert.ok(difference(first, await picture(page.locator(".scene"), "tree-from-above")) > 0.02);
  const line = page.getByRole("combobox", { name: "line", exact: true });
  const chosen = await line.inputValue();
  await page.keyboard.press("l");
  assert.notEqual(await line.inputValue(), chosen);
  const at = await page.locator(".readout").innerText();
  await page.keyboard.press(".");
  assert.notEqual(await page.locator(".readout").innerText(), at);
  await after_(() => page.keyboard.press("v"), "tree-next-look");
  await page.keyboard.press("]");
  await page.waitForURL((url) => !url.hash.startsWith("#/model/tree"));
  await drawn(page);
});

test("a view that is left at the moment when it writes itself into the address does not come back", async () => {
  await open("tree");
  await page.evaluate(() => {
    const [real, late] = [window.setTimeout, []];
    window.setTimeout = (act, wait, ...rest) => (wait === 250 ? late.push(act) && 0 : real(act, wait, ...rest));
    document.querySelector(".scene canvas").dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft", bubbles: true }));
    if (late.length === 0) throw new Error("the address does not follow the camera after 250 ms any more");
    location.hash = "#/model/torus"; // told to the page in an event of its own, a little later
    for (const act of late) act();
    window.setTimeout = real;
  });
  await page.waitForFunction(() => document.querySelector(".info h1")?.innerText === "torus");
  assert.match(page.url(), /#\/model\/torus/);
});

test("ends are named, and a name that is markup stays text", async () => {
  await open(hostileId);
  assert.equal(await page.locator(".info h1").innerText(), hostileId);
  assert.equal(await page.locator("main img, main script").count(), 0);
  assert.match((await page.locator(".labels .end").allTextContents()).join(" "), /inlet 0/);
});

test("a model that failed shows its sentence", async () => {
  await page.goto(`${server.address}#/`);
  await page.goto(`${server.address}#/model/broken`);
  await page.waitForSelector(".info h1");
  assert.match(await page.locator(".info").innerText(), /broken\.ply/);
  assert.match(await page.locator(".middle").innerText(), /no geometry/);
  assert.equal(await page.getByRole("button", { name: "Picture" }).count(), 0);
  await page.keyboard.press("s");
});

const numberIn = (text, name) => Number(new RegExp(`${name}\\s*=?\\s*(-?[\\d.]+)`).exec(text)[1]);

test("a click on the wall of another line takes line and mark there", async () => {
  await open("tree");
  const line = page.getByRole("combobox", { name: "line", exact: true });
  const wall = await page.locator(".scene canvas").boundingBox();
  const first = await line.inputValue();
  for (let share = 0.05; share < 1 && (await line.inputValue()) === first; share += 0.03) {
    await page.mouse.click(wall.x + wall.width * share, wall.y + wall.height * 0.2);
    await page.waitForTimeout(150);
  }
  assert.notEqual(await line.inputValue(), first, "no click met the wall of the other line");
  await page.waitForTimeout(700);
  const abscissa = numberIn(await page.locator(".picked").innerText(), "Abscissa");
  const mark = numberIn(await page.locator(".readout").innerText(), "s");
  assert.ok(Math.abs(abscissa - mark) < 1, `${abscissa} and ${mark}`);
  await page.keyboard.press("Escape");
});

/** Gives inputs, by their label or role, new values at once, without a breath between them. */
const atOnce = (...changes) => page.evaluate((all) => {
  for (const [selector, value, event] of all) {
    const control = document.querySelector(selector);
    control.value = value;
    control.dispatchEvent(new Event(event));
  }
}, changes);

test("what is moved or chosen while something is read stays", async () => {
  await open("tree");
  const slider = page.getByRole("slider", { name: "place along the line" });
  const ready = await page.locator(".scene").getAttribute("data-ready");
  const lines = await page.locator("section", { hasText: "Centerlines" }).locator("select").first().getAttribute("id");
  await atOnce([`#${lines}`, "curvature", "change"], ["[aria-label='place along the line']", "0.9", "input"]);
  await page.waitForFunction((before) => document.querySelector(".scene").dataset.ready !== before, ready);
  assert.equal(Number(await slider.inputValue()), 0.9);
  await atOnce(["[aria-label=quantity]", "torsion", "change"], ["[aria-label=quantity]", "radius", "change"]);
  await page.waitForTimeout(500);
  assert.match(await page.locator(".profile").getAttribute("aria-label"), /^Radius \[mm\] over Abscissa/);
});

test("the area of the sections is among the quantities of a line", async () => {
  await open("cylinder");
  await page.getByRole("combobox", { name: "quantity" }).selectOption("area");
  await page.waitForFunction(() => /^Area of the section \[mm\^2\]/.test(document.querySelector(".profile").ariaLabel));
  assert.ok(content(await picture(page.locator(".profile"), "model-area")).share > 0.01);
});

test("a reader that broke is replaced, and what it read has its place", async () => {
  const shown = async (name, disturb) => {
    const { page: other } = await openPage(browser);
    await other.goto(`${server.address}#/model/helix`);
    await other.locator(".info [data-ready]").waitFor({ state: "attached" });
    await disturb(other);
    const ready = await other.locator(".scene").getAttribute("data-ready");
    await other.getByRole("radio", { name: "Distance" }).click();
    await other.waitForFunction((before) => document.querySelector(".scene").dataset.ready !== before, ready);
    await drawn(other);
    const seen = await picture(other.locator(".scene"), name);
    await other.close();
    return seen;
  };
  const broken = async (other) => {
    const gone = other.workers()[0];
    await Promise.all([other.waitForEvent("worker"), gone.evaluate(() => void setTimeout(() => { throw new Error("on purpose"); }))]);
  };
  assert.ok(difference(await shown("model-reader", async () => {}), await shown("model-reader-replaced", broken)) < 0.01);
});

test("a click whose answer comes when the model was left does not come back", async () => {
  await open("stenosis");
  const box = await page.locator(".scene canvas").boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height * 0.3);
  await page.evaluate(() => (location.hash = "#/"));
  await page.waitForSelector("table.models");
  await page.waitForTimeout(700);
  assert.equal(new URL(page.url()).hash, "#/");
});

test("the pointer over the plot moves the mark, and leaves it where it was", async () => {
  await open("stenosis");
  const slider = page.getByRole("slider", { name: "place along the line" });
  await slider.fill("0.25");
  const box = await page.locator(".profile .u-over").boundingBox();
  await page.mouse.move(box.x + box.width * 0.8, box.y + box.height / 2);
  await page.waitForFunction(() => Number(document.querySelector("[aria-label='place along the line']").value) > 0.7);
  await page.mouse.move(box.x + box.width / 2, box.y - 200);
  await page.waitForFunction(() => Number(document.querySelector("[aria-label='place along the line']").value) === 0.25);
});

test("nothing went wrong on the way", () => assert.deepEqual(problems, []));
