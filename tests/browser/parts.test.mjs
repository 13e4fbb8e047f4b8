// Parts of the page that compute, without a browser: the way over the diagram, areas along a line, profiles of branches.
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { join } from "node:path";
import { test } from "node:test";
import { viewer } from "./support.mjs";

const esbuild = createRequire(createRequire(join(viewer, "package.json")).resolve("vite"))("esbuild");

/** What a source file of the page exports. */
async function part(path) {
  const { outputFiles } = await esbuild.build({ entryPoints: [join(viewer, "src", path)], bundle: true, write: false, format: "esm" });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString("base64")}`);
}

/** An open file of which these datasets are all there is. */
const fileOf = (datasets) => ({
  has: (path) => path in datasets,
  info: (path) => (path in datasets ? { shape: [datasets[path].length / (path.endsWith("vertices") ? 3 : 1)] } : null),
  numbers: (path) => Float64Array.from(datasets[path]),
  points: (path) => Float64Array.from(datasets[path]),
  indices: (path) => Int32Array.from(datasets[path]),
  offsets: (path) => Int32Array.from(datasets[path]),
});

test("the way over the diagram leaves it for the end where that is shortest", async () => {
  const { Diagram } = await part("archive/diagram.ts");
  // A strip of squares along x; the line crosses it at x = 2.5, and the distance goes on falling to a vertex at x = 5.
  const [points, corners, offsets, distance] = [[], [], [0], []];
  for (let x = 0; x <= 5; ++x)
    for (const y of [0, 1]) {
      points.push(x, y, 0);
      distance.push(10 - x + y / 10);
    }
  for (let x = 0; x < 5; ++x) {
    corners.push(2 * x, 2 * x + 2, 2 * x + 3, 2 * x + 1);
    offsets.push(corners.length);
  }
  const diagram = new Diagram(fileOf({
    "/voronoi/vertices": points, "/voronoi/polygon_vertices": corners, "/voronoi/polygon_offsets": offsets,
    "/voronoi/centerline_distance": distance,
  }), "", [0, 0, 0]);
  assert.deepEqual(diagram.descent(0, [2.5, 0, 0]), [0, 0, 0, 1, 0, 0, 2, 0, 0]);
  assert.deepEqual(diagram.descent(0, [0, -1, 0]), [0, 0, 0]);
});

test("areas lie between the sections of a point's branch, and are unknown beyond and beside one that is not closed", async () => {
  const { areasAlong } = await part("archive/areas.ts");
  const file = fileOf({
    "/sections/branch_id": [0, 0, 0, 1, 1], "/sections/abscissa": [3, 1, 2, 1, 2], "/sections/area": [30, 10, 20, 100, 300],
    "/sections/closed": [0, 1, 1, 1, 1],
    "/centerlines/branch_id": [0, 0, 0, 0, 1, 1, 2], "/centerlines/branch_abscissa": [0.5, 1, 1.5, 2.5, 1.25, 2.5, 1],
  });
  assert.deepEqual([...areasAlong(file, "", 7)], [NaN, 10, 15, NaN, 150, NaN, NaN]);
});

test("profiles of branches are told by their own abscissa, with a gap at a section that is not closed", async () => {
  const { branchCurves } = await part("compare/branches.ts");
  const column = (name, values) => ({ name, label: name, units: "mm", description: "", [typeof values[0] === "string" ? "texts" : "numbers"]: values });
  const table = {
    rows: 4,
    columns: [column("id", ["a", "a", "a", "b"]), column("branch_label", ["1", "1", "1", "2"]), column("abscissa", [9, 5, 7, 1]),
      column("abscissa_relative", [0.9, 0.5, 0.7, 0.1]), column("closed", [1, 1, 0, 1]), column("area", [3, 1, 2, 4])],
  };
  const { curves } = branchCurves(table, "1", "area");
  assert.equal(curves.length, 1);
  assert.deepEqual([...curves[0].x], [5, 7, 9]);
  assert.deepEqual([...curves[0].share], [...Float32Array.of(0.5, 0.7, 0.9)]);
  assert.deepEqual([...curves[0].y], [1, NaN, 3]);
});

test("the column of groups is offered in a small cohort, a column of remarks is not", async () => {
  const { groupings } = await part("cohort/rows.ts");
  const column = (name, texts) => ({ name, label: name, units: "1", description: "", texts });
  const columns = [column("id", ["a", "b", "c", "d"]), column("group", ["x", "y", "z", "z"]), column("remark", ["p", "q", "r", "s"])];
  assert.deepEqual(groupings({ rows: 4, columns }).map(({ name }) => name), ["group"]);
});
