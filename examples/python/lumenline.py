"""Reads Lumenline's archives with h5py: models, lines, fields, and the tables of a cohort as pandas data frames.

    import lumenline

    with lumenline.open("examples/results") as cohort:
        print(cohort.table("models"))
        model = cohort["portal_vein"]
        for line in model.lines():
            print(line.target, line.length, line.radius.min())
        distance = model.field("surface/geodesic_distance")

The format is described in io/ARCHIVE.md; this module adds nothing to it. Nothing is read before it is asked for.
"""
from __future__ import annotations

import pathlib
from dataclasses import dataclass, field
from typing import Iterator

import h5py
import numpy as np

__all__ = ["open", "Cohort", "Model", "Line", "Damaged"]


class Damaged(ValueError):
    """A file that cannot be read or contradicts itself: one sentence that says where. `lumenline validate-archive` says
    all that is wrong with it."""


def open(path) -> Cohort | Model:  # noqa: A001 - as h5py.File, for what the user thinks of as a file
    """An archive (its directory or `cohort.h5`) as a Cohort, or one model's file as a Model; both close in `with`."""
    path = pathlib.Path(path)
    path = path / "cohort.h5" if path.is_dir() else path
    try:
        file = h5py.File(path, "r")
    except FileNotFoundError:
        raise
    except OSError as error:
        raise Damaged(f"{path} is no complete HDF5 file: {_one_line(error)}") from None
    kind = _text(file.attrs.get("format", b""))
    if kind == "lumenline-cohort":
        return Cohort(file)
    if kind == "lumenline-model":
        return Model(file)
    file.close()
    raise ValueError(f"{path} is no file of Lumenline's: its attribute 'format' is {kind!r}")


class _Closing:
    def __init__(self, group):
        self.group = group  #: the h5py object, for whatever this module has no word for

    def close(self):
        self.group.file.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class Cohort(_Closing):
    """The index of an archive: a mapping of ids to models, and tables."""

    @property
    def ids(self) -> list[str]:
        """Ids of all models, failed ones included, in the order of the table."""
        return [str(id) for id in _read(self.group, "tables/models/id", "SO")]

    @property
    def tables(self) -> list[str]:
        return list(self.group["tables"])

    def __len__(self) -> int:
        return len(self.ids)

    def __iter__(self) -> Iterator[str]:
        return iter(self.ids)

    def __getitem__(self, model_id: str) -> Model:
        try:
            return Model(self.group["models"][model_id])
        except (KeyError, OSError, RuntimeError) as error:
            if model_id not in self.ids:
                raise KeyError(f"no model {model_id!r}; there are {', '.join(self.ids)}") from None
            file = pathlib.Path(self.group.file.filename).parent / "models" / f"{model_id}.hdf"
            if not file.exists():
                raise FileNotFoundError(f"the file of model {model_id!r} is missing: {file}") from None
            raise Damaged(f"{file} cannot be read: {_one_line(error)}") from None

    def table(self, name: str = "models"):
        """A table as a pandas.DataFrame; units and definitions of its columns are in its `attrs`.

        Columns of the models' table that another table lacks (group, covariates) are joined by the model's id.
        """
        import pandas

        group = self.group["tables"][name]
        columns = {key: _read(group, key) for key in group}
        lengths = {np.shape(values) for values in columns.values()}
        if len(lengths) > 1 or any(len(shape) != 1 for shape in lengths):
            raise Damaged(f"{_place(group)}: its columns are not of one length")
        frame = pandas.DataFrame(columns)
        frame.attrs["units"] = {key: _text(group[key].attrs.get("units", b"")) for key in group}
        frame.attrs["definitions"] = {key: _text(group[key].attrs.get("description", b"")) for key in group}
        if name == "models" or "id" not in frame:
            return frame
        models = self.table("models")
        if "id" not in models or models["id"].dtype != object or frame["id"].dtype != object:
            raise Damaged(f"{_place(self.group['tables'])}: {name} and models have no columns 'id' of text to join by")
        models = models.set_index("id")
        joined = frame.join(models[[c for c in models if c not in frame]], on="id")
        joined.attrs = frame.attrs
        return joined


@dataclass
class Line:
    """A centerline from its source to its target: one value per point."""

    source: int  #: row of the endpoints; -1 = none
    target: int
    points: np.ndarray = field(repr=False)  #: (K, 3) [length]
    radius: np.ndarray = field(repr=False)  #: best estimate of the maximal inscribed ball's [length]
    abscissa: np.ndarray = field(repr=False)  #: arc length from the source [length]
    values: dict = field(repr=False)  #: all arrays of the points by name: ball_radius, clearance, radius_error, ...

    @property
    def length(self) -> float:
        return float(self.abscissa[-1] - self.abscissa[0])


class Model(_Closing):
    """One model's record."""

    @property
    def id(self) -> str:
        return self["id"]

    @property
    def status(self) -> str:
        """ok, warning or failed."""
        return self["status"]

    @property
    def length_unit(self) -> str:
        return self["length_unit"]

    def __getitem__(self, attribute: str):
        """An attribute of the model: id, subject, group, failure_sentence, ..."""
        value = self.group.attrs[attribute]
        return _text(value) if isinstance(value, (bytes, np.bytes_, str)) else value

    def __contains__(self, path: str) -> bool:
        """Whether the model has a group or dataset: what a stage did not make is left out."""
        return path in self.group

    def field(self, path: str) -> np.ndarray:
        """Any dataset, "surface/geodesic_distance" or "voronoi/ball_radius"; text as str."""
        return _read(self.group, path)

    def units(self, path: str) -> str:
        """Unit of a dataset, "length" resolved to the model's."""
        units = _text(self.group[path].attrs["units"])
        return units.replace("length", self.length_unit)

    def surface(self) -> tuple[np.ndarray, np.ndarray]:
        """Points (N, 3) and triangles (M, 3) of the conditioned surface, extensions and caps included."""
        return self.field("surface/points"), self.field("surface/triangles")

    def lines(self) -> list[Line]:
        """The centerlines; empty where none was made."""
        if "centerlines" not in self.group:
            return []
        group = self.group["centerlines"]
        arrays = {k: _read(group, k) for k in group if isinstance(group[k], h5py.Dataset)}
        for needed in ("offsets", "source", "target", "points", "radius", "abscissa"):
            if needed not in arrays or arrays[needed].ndim == 0 or arrays[needed].dtype.kind not in "iuf":
                raise Damaged(f"{_place(group)}: there is no array {needed!r} of numbers")
        offsets = arrays.pop("offsets")
        ascend = offsets.dtype.kind in "iu" and len(offsets) > 0 and offsets[0] == 0 and np.all(np.diff(offsets) >= 0)
        if not ascend or len(arrays["source"]) != len(offsets) - 1 or len(arrays["target"]) != len(offsets) - 1:
            raise Damaged(f"{_place(group)}: offsets, source and target do not describe lines")
        count = offsets[-1]
        if any(len(arrays[k]) != count for k in ("points", "radius", "abscissa")):
            raise Damaged(f"{_place(group)}: its points, radii and abscissae are not of one length")
        per_point = {k: v for k, v in arrays.items() if k not in ("source", "target", "loop") and len(v) == count}
        lines = []
        for i, (first, last) in enumerate(zip(offsets[:-1], offsets[1:])):
            part = {k: v[first:last] for k, v in per_point.items()}
            lines.append(Line(int(arrays["source"][i]), int(arrays["target"][i]), part["points"], part["radius"],
                              part["abscissa"], part))
        return lines

    def table(self, name: str):
        """A group of columns of equal length ("diagnostics", "endpoints", "branches") as a pandas.DataFrame; columns of
        points become three."""
        import pandas

        columns = {}
        for key, dataset in self.group[name].items():
            if not isinstance(dataset, h5py.Dataset):
                continue
            values = _read(self.group[name], key)
            if values.ndim == 2:
                names = "xyz" if values.shape[1] == 3 else range(values.shape[1])
                columns.update({f"{key}_{axis}": values[:, k] for k, axis in enumerate(names)})
            elif values.ndim == 1:
                columns[key] = values
        length = len(next(iter(columns.values()), ()))
        return pandas.DataFrame({k: v for k, v in columns.items() if len(v) == length})


def _one_line(error) -> str:
    return " ".join(str(error).split())


def _place(group) -> str:
    return f"{group.file.filename}: {group.name}"


def _read(group, path: str, kinds: str = "") -> np.ndarray:
    """Values of a dataset; `kinds`: of numpy, that it must be of."""
    if path not in group or not isinstance(group[path], h5py.Dataset):
        near = ", ".join(group) if "/" not in path else ""
        raise KeyError(f"{_place(group)} has no dataset {path!r}" + (f"; it has {near}" if near else ""))
    try:
        values = _column(group[path])
    except (OSError, TypeError, ValueError) as error:
        raise Damaged(f"{_place(group[path])} cannot be read: {_one_line(error)}") from None
    if kinds and values.dtype.kind not in kinds:
        raise Damaged(f"{_place(group[path])} is of another type than it should be: {values.dtype}")
    return values


def _text(value) -> str:
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)


def _strings(dataset) -> list[str]:
    return [_text(v) for v in dataset[()]]


def _column(dataset) -> np.ndarray:
    if h5py.check_string_dtype(dataset.dtype) is None and dataset.dtype.kind != "S":
        return dataset[()]
    values = dataset[()]
    return np.array(_strings(dataset), dtype=object) if np.ndim(values) else np.array(_text(values), dtype=object)
