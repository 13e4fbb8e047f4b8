"""Reads .npy files beside a model file and compares them with its datasets as h5py has them.

Usage: npy_reads.py MODEL.hdf, with list.txt beside it: a file and a dataset a line.
"""
import pathlib
import sys

import h5py
import numpy

model = pathlib.Path(sys.argv[1])
with h5py.File(model, "r") as file:
    for line in (model.parent / "list.txt").read_text().splitlines():
        name, path = line.split()
        found, dataset = numpy.load(model.parent / name, allow_pickle=False), file[path]
        if dataset.dtype.kind in "SO":
            expected = numpy.array(dataset.asstr()[()])
        else:
            expected = dataset[()]
            assert found.dtype == dataset.dtype, (path, found.dtype, dataset.dtype)
        assert found.shape == expected.shape, (path, found.shape, expected.shape)
        assert numpy.array_equal(found, expected, equal_nan=dataset.dtype.kind == "f"), path
