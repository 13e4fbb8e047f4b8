// A packed archive in the library that myHDF5 and H5Web are made of (h5wasm): every dataset reads, of the index and of
// every model, since nothing in the file is a link to another one.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { test } from "node:test";
import { archives, binary, viewer } from "./support.mjs";

function datasetsOf(group, found = []) {
  for (const key of group.keys()) {
    const item = group.get(key);
    assert.ok(item, `${group.path}/${key} leads nowhere`);
    if (item.type === "Group") datasetsOf(item, found);
    else found.push(item);
  }
  return found;
}

test("every dataset of a packed archive reads in h5wasm", async () => {
  const h5wasm = await import(pathToFileURL(join(viewer, "node_modules/h5wasm/dist/node/hdf5_hl.js")).href);
  await h5wasm.ready;
  const packed = join(archives, "packed-for-viewers.h5");
  const done = spawnSync(binary, ["pack", join(archives, "good"), "-o", packed], { encoding: "utf8" });
  assert.equal(done.status, 0, done.stderr);
  const file = new h5wasm.File(packed, "r");
  const datasets = datasetsOf(file);
  assert.ok(datasets.length > 1000, `${datasets.length} datasets`);
  for (const dataset of datasets) {
    const count = dataset.shape.reduce((a, b) => a * b, 1);
    const value = dataset.value;
    const length = dataset.shape.length === 0 ? 1 : value.length;
    assert.equal(length, count, dataset.path);
    assert.ok(dataset.attrs["units"] && dataset.attrs["description"], dataset.path);
  }
  file.close();
});
