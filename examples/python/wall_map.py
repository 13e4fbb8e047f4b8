"""The wall of a model unrolled: a field of the surface over the abscissa and the angle around its centerline.

Usage: wall_map.py ARCHIVE MODEL [FIELD [PLOT.png]]; FIELD is a dataset of /surface, geodesic_distance by default.
The angle is taken around the line's own direction from a fixed perpendicular: enough for one smooth vessel.
"""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import lumenline

if len(sys.argv) < 3:
    sys.exit(__doc__)
archive, model_id = sys.argv[1:3]
name = sys.argv[3] if len(sys.argv) > 3 else "geodesic_distance"
with lumenline.open(archive) as cohort:
    model = cohort[model_id]
    lines = model.lines()
    points = model.field("surface/points")
    line_id = model.field("surface/centerline_id")
    abscissa = model.field("surface/abscissa")
    values = model.field(f"surface/{name}")
    wall = (model.field("surface/zone") == 0) & (line_id == 0)
    units = model.units(f"surface/{name}")

line = lines[0]
foot = np.column_stack([np.interp(abscissa[wall], line.abscissa, line.points[:, k]) for k in range(3)])
tangent = np.gradient(line.points, line.abscissa, axis=0)
tangent = np.column_stack([np.interp(abscissa[wall], line.abscissa, tangent[:, k]) for k in range(3)])
tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
least = np.argmin(np.abs(tangent).mean(axis=0))
first = np.cross(tangent, np.eye(3)[least])
first /= np.linalg.norm(first, axis=1, keepdims=True)
second = np.cross(tangent, first)
away = points[wall] - foot
angle = np.degrees(np.arctan2((away * second).sum(axis=1), (away * first).sum(axis=1)))
print(f"{name}: {np.nanmin(values[wall]):.4g} to {np.nanmax(values[wall]):.4g} {units} at {wall.sum()} sites of line 0")

figure, axes = plt.subplots(figsize=(8, 4), constrained_layout=True)
drawn = axes.scatter(abscissa[wall], angle, c=values[wall], s=4, cmap="viridis")
figure.colorbar(drawn, label=f"{name} [{units}]")
axes.set_xlabel(f"abscissa [{model.length_unit}]")
axes.set_ylabel("angle [degrees]")
axes.set_title(model.id)
if len(sys.argv) > 4:
    figure.savefig(sys.argv[4], dpi=150)
