// What the tests in a browser need: npm's packages, and archives made by the program: one of phantoms in two groups with
// a model that failed, texts that would be markup, and what becomes of it when files are lost or damaged.
import { spawnSync } from "node:child_process";
import { cpSync, existsSync, mkdirSync, readdirSync, readFileSync, renameSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { archives, binary, hostileId, hostileText, viewer } from "./support.mjs";

/** As long as the hostile id. */
const kPlaceholder = "replaced-by-hostile-text1";

function run(command, args, options = {}) {
  const done = spawnSync(command, args, { encoding: "utf8", ...options });
  if (done.error) throw done.error;
  return done;
}

function must(command, args, options) {
  const done = run(command, args, options);
  if (done.status !== 0) throw new Error(`${command} ${args.join(" ")}: ${done.stdout}${done.stderr}`);
}

function packages() {
  const lock = readFileSync(join(viewer, "package-lock.json"));
  const stamp = join(viewer, "node_modules", ".installed-lock.json");
  if (existsSync(stamp) && readFileSync(stamp).equals(lock)) return;
  must("npm", ["ci", "--no-audit", "--no-fund"], { cwd: viewer });
  writeFileSync(stamp, lock);
}

function cohort() {
  rmSync(archives, { recursive: true, force: true });
  mkdirSync(archives, { recursive: true });
  const phantom = (kind, file, ...options) => must(binary, ["phantom", kind, "-o", file, "--jitter", "0.2", ...options], { cwd: archives });
  phantom("stenosis", "stenosis.ply", "--points-around", "24");
  phantom("torus", "torus.ply", "--points-around", "20");
  phantom("helix", "helix.ply", "--points-around", "20");
  phantom("cylinder", "cylinder.ply", "--b", "3", "--points-around", "20");
  must(binary, ["phantom", "tree", "-o", "tree.ply", "--leaves", "2", "--points-around", "20"], { cwd: archives });
  writeFileSync(join(archives, "broken.ply"), "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nend_header\n1\n");
  const rows = [
    ["id", "surface", "group", "age", "remark", "edge_over_radius"],
    ["stenosis", "stenosis.ply", "patient", "61", "narrow", "mäßig"],
    ["torus", "torus.ply", "control", "44", hostileText, "klein"],
    ["helix", "helix.ply", "control", "39", "", ""],
    ["cylinder", "cylinder.ply", "control", "52", "", "groß"],
    ["tree", "tree.ply", "patient", "70", "branches", "groß"],
    [kPlaceholder, "torus.ply", "control", "33", "", ""],
    ["broken", "broken.ply", "patient", "n/a", "", ""],
  ];
  writeFileSync(join(archives, "models.tsv"), rows.map((row) => row.join("\t")).join("\n") + "\n");
  writeFileSync(join(archives, "cohort.yaml"), "cohort: browser\nlength_unit: mm\nmodels: {table: models.tsv}\narchive: {directory: good}\n");
  const done = run(binary, ["run", "cohort.yaml"], { cwd: archives });
  if (done.status !== 1) throw new Error(`the run is to end with the one failure: ${done.status} ${done.stdout}${done.stderr}`);
  const lean = "cohort: lean\nlength_unit: mm\nmodels: {list: [{id: helix, surface: helix.ply}]}\narchive: {directory: lean, fields: lines}\n";
  writeFileSync(join(archives, "lean.yaml"), lean);
  must(binary, ["run", "lean.yaml"], { cwd: archives });
}

/** A configuration may not have such ids; an archive from elsewhere may: its bytes are changed in place. */
function hostile() {
  const good = join(archives, "good");
  const files = [join(good, "cohort.h5"), ...readdirSync(join(good, "models")).map((name) => join(good, "models", name))];
  for (const file of files) {
    const bytes = readFileSync(file);
    let found = false;
    for (let at = bytes.indexOf(kPlaceholder); at >= 0; at = bytes.indexOf(kPlaceholder, at + 1)) {
      bytes.write(hostileId, at, "latin1");
      found = true;
    }
    if (found) writeFileSync(file, bytes);
  }
  renameSync(join(good, "models", `${kPlaceholder}.hdf`), join(good, "models", `${hostileId}.hdf`));
}

function damaged() {
  const copy = (name) => cpSync(join(archives, "good"), join(archives, name), { recursive: true });
  const index = readFileSync(join(archives, "good", "cohort.h5"));
  copy("missing");
  rmSync(join(archives, "missing", "models", "torus.hdf"));
  copy("truncated");
  const model = readFileSync(join(archives, "good", "models", "torus.hdf"));
  writeFileSync(join(archives, "truncated", "models", "torus.hdf"), model.subarray(0, model.length / 2));
  writeFileSync(join(archives, "truncated", "models", "helix.hdf"), "this is no HDF5 file");
  copy("scrambled");
  // Every 97th byte of the first half, with the header left: sometimes the library sees it, sometimes our checks do.
  const bytes = Buffer.from(model);
  for (let i = 4096; i < bytes.length / 2; i += 97) bytes[i] ^= 0x5a;
  writeFileSync(join(archives, "scrambled", "models", "torus.hdf"), bytes);
  mkdirSync(join(archives, "no-index"));
  writeFileSync(join(archives, "no-index", "cohort.h5"), index.subarray(0, 700));
}

packages();
cohort();
hostile();
damaged();
