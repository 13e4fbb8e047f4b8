// Chromium, the program's server, and pictures that are looked at: used by all tests in a browser.
import { spawn } from "node:child_process";
import { mkdirSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { inflateSync } from "node:zlib";

export const source = resolve(dirname(fileURLToPath(import.meta.url)), "../..");
export const viewer = join(source, "io/viewer");
export const binary = process.env.LUMENLINE_BINARY ?? join(source, "build/release/lumenline");
/** The tests' program that damages files. */
export const damaging = process.env.LUMENLINE_DAMAGING ?? join(source, "build/release/tests/damage/damaged_files");
const folder = process.env.LUMENLINE_BROWSER_FOLDER ?? join(source, "build/release/tests/browser");
export const archives = join(folder, "archives");
export const pictures = join(folder, "pictures");

/** As an id it is a file name; as markup it would run. */
export const hostileId = "<img src=x onerror=hit()>";
export const hostileText = "<script>hit()<script> & \"quotes\"";

const kFlags = [
  "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
  "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
];

export async function chromium() {
  const playwright = createRequire(join(viewer, "package.json"))("playwright-core");
  return playwright.chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: kFlags });
}

/** A page whose errors are gathered in `problems`; pictures and blocked resources count. */
export async function openPage(browser, options = {}) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 720 }, colorScheme: "light", ...options });
  page.setDefaultTimeout(60_000);
  const problems = [];
  page.on("pageerror", (error) => problems.push(error.stack ?? error.message));
  page.on("console", (message) => {
    const quiet = /GPU stall|WebGL/.test(message.text());
    if (["error", "warning"].includes(message.type()) && !quiet) problems.push(message.text());
  });
  await page.addInitScript(() => {
    globalThis.hit = () => {
      throw new Error("text of the archive was run");
    };
  });
  return { page, problems };
}

/** The program's server on an archive; `stop` ends it. */
export function serve(archive, ...options) {
  const child = spawn(binary, ["browse", archive, "serve", ...options], { stdio: ["ignore", "pipe", "pipe"] });
  return new Promise((done, failed) => {
    let said = "";
    let complained = "";
    child.stderr.on("data", (data) => (complained += data));
    child.stdout.on("data", (data) => {
      said += data;
      const address = /http:\/\/127\.0\.0\.1:(\d+)\//.exec(said);
      if (address) done({ address: address[0], port: Number(address[1]), child, stop: () => stop(child) });
    });
    child.on("exit", (code) => failed(Object.assign(new Error(complained), { code })));
  });
}

function stop(child) {
  return new Promise((done) => {
    child.on("exit", (code) => done(code));
    child.kill("SIGINT");
  });
}

/** Waits until a scene has been drawn. */
export async function drawn(page) {
  await page.waitForSelector(".scene[data-ready]");
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}

/** A picture of the page, or of an element, kept under its name. */
export async function picture(target, name) {
  const png = await target.screenshot();
  mkdirSync(pictures, { recursive: true });
  writeFileSync(join(pictures, `${name}.png`), png);
  return decode(png);
}

/** Pixels of a PNG as browsers write it: 8 bits, three or four channels, not interlaced. */
export function decode(png) {
  const parts = [];
  let [width, height, channels] = [0, 0, 3];
  for (let at = 8; at < png.length; ) {
    const size = png.readUInt32BE(at);
    const kind = png.toString("latin1", at + 4, at + 8);
    const body = png.subarray(at + 8, at + 8 + size);
    if (kind === "IHDR") [width, height, channels] = [body.readUInt32BE(0), body.readUInt32BE(4), body[9] === 6 ? 4 : 3];
    if (kind === "IDAT") parts.push(body);
    at += size + 12;
  }
  const raw = inflateSync(Buffer.concat(parts));
  const stride = width * channels;
  const pixels = Buffer.alloc(stride * height);
  for (let y = 0; y < height; ++y) {
    const filter = raw[y * (stride + 1)];
    for (let x = 0; x < stride; ++x) {
      const left = x >= channels ? pixels[y * stride + x - channels] : 0;
      const up = y > 0 ? pixels[(y - 1) * stride + x] : 0;
      const corner = y > 0 && x >= channels ? pixels[(y - 1) * stride + x - channels] : 0;
      const guess = [0, left, up, (left + up) >> 1, paeth(left, up, corner)][filter];
      pixels[y * stride + x] = raw[y * (stride + 1) + 1 + x] + guess;
    }
  }
  return { width, height, channels, pixels };
}

function paeth(a, b, c) {
  const [pa, pb, pc] = [Math.abs(b - c), Math.abs(a - c), Math.abs(a + b - 2 * c)];
  return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

/** How much of a picture differs from its commonest colour, and how many colours it has (in steps of 16). */
export function content({ width, height, channels, pixels }) {
  const counts = new Map();
  for (let i = 0; i < width * height; ++i) {
    const at = i * channels;
    const key = ((pixels[at] >> 4) << 8) | ((pixels[at + 1] >> 4) << 4) | (pixels[at + 2] >> 4);
    counts.set(key, (counts.get(key) ?? 0) + 1);
  }
  const most = Math.max(...counts.values());
  return { share: 1 - most / (width * height), colours: counts.size };
}

/** Share of pixels in which two pictures of one size differ. */
export function difference(a, b) {
  let count = 0;
  for (let i = 0; i < a.width * a.height; ++i) {
    const at = i * a.channels;
    if ([0, 1, 2].some((c) => Math.abs(a.pixels[at + c] - b.pixels[at + c]) > 12)) count += 1;
  }
  return count / (a.width * a.height);
}
