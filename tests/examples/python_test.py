"""Tests of examples/python against an archive. Usage: python_test.py ARCHIVE"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ARCHIVE = pathlib.Path(sys.argv.pop(1)).resolve()
EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples" / "python"
sys.path.insert(0, str(EXAMPLES))

import h5py  # noqa: E402
import lumenline  # noqa: E402
import numpy as np  # noqa: E402


def datasets_of(file):
    found = []
    with h5py.File(file) as opened:
        # Links to other files are not followed.
        opened.visititems(lambda n, o: found.append(o.name) if isinstance(o, h5py.Dataset) else None)
    return found


def damage(file, path, harm):
    with h5py.File(file, "r+") as opened:
        values, attributes = opened[path][()], dict(opened[path].attrs)
        del opened[path]
        if harm == "remove" or (harm == "shorten" and np.size(values) < 1):
            return
        if harm == "retype":
            values = np.zeros(np.shape(values), "i4" if values.dtype.kind == "S" else "S4")
        if harm == "garble" and np.size(values) > 0 and np.ndim(values) > 0:
            made = opened.create_dataset(path, data=values, chunks=np.shape(values), fletcher32=True)
            opened.flush()
            origin = (0,) * np.ndim(values)
            _, chunk = made.id.read_direct_chunk(origin)
            made.id.write_direct_chunk(origin, bytes([chunk[0] ^ 0x55]) + chunk[1:])
        else:
            opened[path] = values[:-1] if harm == "shorten" and np.ndim(values) else values
        opened[path].attrs.update(attributes)


def sentences(archive, path, test):
    """Reads all that the reader has a word for. @returns how often it refused"""
    refused = 0

    def attempt(read):
        nonlocal refused
        try:
            read()
        except (lumenline.Damaged, KeyError, FileNotFoundError) as error:
            test.assertNotIn("\n", str(error))
            refused += 1

    def reads(cohort):
        yield lambda: cohort.ids
        for table in ("models", "failures", "branches"):
            yield lambda table=table: cohort.table(table)
        yield lambda: cohort["wide"].lines()
        yield lambda: cohort["wide"].surface()
        yield lambda: cohort["wide"].table("diagnostics")
        yield lambda: cohort["wide"].table("branches")
        yield lambda: cohort["wide"].field(path)

    with lumenline.open(archive) as cohort:
        for read in reads(cohort):
            attempt(read)
    return refused


class Reader(unittest.TestCase):
    def setUp(self):
        self.cohort = lumenline.open(ARCHIVE)
        self.addCleanup(self.cohort.close)

    def test_models_by_id(self):
        self.assertEqual(self.cohort.ids, ["wide", "narrow", "broken"])
        self.assertEqual(len(self.cohort), 3)
        model = self.cohort["narrow"]
        self.assertEqual((model.id, model.status, model["group"]), ("narrow", "warning", "b"))
        with self.assertRaisesRegex(KeyError, "there are wide, narrow, broken"):
            self.cohort["nobody"]

    def test_table_has_units_and_failures(self):
        table = self.cohort.table()
        self.assertEqual(list(table["status"]), ["warning", "warning", "failed"], "both ends are equally large")
        self.assertTrue(np.isnan(table["radius_mean"][2]))
        self.assertEqual(table.attrs["units"]["radius_mean"], "mm")
        failures = self.cohort.table("failures")
        self.assertEqual(list(failures["id"]), ["broken"])
        self.assertEqual(list(failures["group"]), ["b"], "joined from the table of models")

    def test_lines(self):
        (line,) = self.cohort["wide"].lines()
        self.assertAlmostEqual(line.length, 20, places=6)
        self.assertTrue(np.allclose(line.radius, 5, rtol=1e-3))
        self.assertEqual(len(line.values["ball_radius"]), len(line.points))
        self.assertEqual(self.cohort["broken"].lines(), [])

    def test_fields_and_surface(self):
        model = self.cohort["wide"]
        points, triangles = model.surface()
        self.assertLess(triangles.max(), len(points))
        self.assertEqual(len(model.field("surface/geodesic_distance")), len(points))
        self.assertEqual(model.units("surface/geodesic_distance"), "mm")
        self.assertIn("voronoi/ball_radius", model)
        self.assertNotIn("voronoi", self.cohort["broken"])

    def test_tables_of_a_model(self):
        endpoints = self.cohort["wide"].table("endpoints")
        self.assertEqual(list(endpoints["role"]), ["inlet", "outlet"])
        self.assertIn("point_x", endpoints)

    def test_damage_gives_one_sentence(self):
        """Datasets in turn removed, cut short, of another type and not readable: what reads them works, or says one sentence."""
        with tempfile.TemporaryDirectory() as folder:
            copy = pathlib.Path(folder) / "copy"
            shutil.copytree(ARCHIVE, copy)
            refused = 0
            of_use = {"models/wide.hdf": ["/centerlines/offsets", "/centerlines/points", "/surface/triangles"],
                      "cohort.h5": ["/tables/models/id", "/tables/models/status"]}
            for name in of_use:
                for harm in ("remove", "shorten", "retype", "garble"):
                    for path in datasets_of(ARCHIVE / name)[::37] + of_use[name]:
                        damage(copy / name, path, harm)
                        refused += sentences(copy, path, self)
                        shutil.copy(ARCHIVE / name, copy / name)
            self.assertGreater(refused, 15, "much of the damage is seen")
            (copy / "cohort.h5").write_bytes((ARCHIVE / "cohort.h5").read_bytes()[:5000])
            with self.assertRaisesRegex(lumenline.Damaged, "no complete HDF5 file"):
                lumenline.open(copy)
            with self.assertRaises(FileNotFoundError):
                lumenline.open(copy / "nowhere")

    def test_one_file(self):
        with lumenline.open(ARCHIVE / "models" / "wide.hdf") as model:
            self.assertEqual(model.id, "wide")

    def test_missing_files_are_named(self):
        (ARCHIVE / "models" / "wide.hdf").rename(ARCHIVE / "models" / "away")
        try:
            with lumenline.open(ARCHIVE) as cohort, self.assertRaisesRegex(FileNotFoundError, "'wide' is missing"):
                cohort["wide"]
        finally:
            (ARCHIVE / "models" / "away").rename(ARCHIVE / "models" / "wide.hdf")


class Scripts(unittest.TestCase):
    def run_script(self, name, *arguments):
        with tempfile.TemporaryDirectory() as folder:
            plot = pathlib.Path(folder) / "plot.png"
            done = subprocess.run([sys.executable, EXAMPLES / name, ARCHIVE, *arguments, plot], capture_output=True,
                                  text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(plot.read_bytes()[:4], b"\x89PNG")
            return done.stdout

    def test_narrowest_point(self):
        row = self.run_script("narrowest.py", "narrow").splitlines()[1].split("\t")
        self.assertAlmostEqual(float(row[1]), 10, delta=0.3)
        self.assertAlmostEqual(float(row[2]), 2.5, delta=0.05)

    def test_cohort_plot(self):
        self.assertRegex(self.run_script("cohort_plot.py", "radius_mean", "group"), r"(?m)^a +1.0 +4\.9999")

    def test_wall_map(self):
        self.assertIn("geodesic_distance:", self.run_script("wall_map.py", "narrow", "geodesic_distance"))


if __name__ == "__main__":
    unittest.main()
