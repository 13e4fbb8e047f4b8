"""A measure of all models by group: points, median and quartiles.

Usage: cohort_plot.py ARCHIVE [MEASURE [GROUPING [PLOT.png]]]
"""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import lumenline

if len(sys.argv) < 2:
    sys.exit(__doc__)
archive = sys.argv[1]
measure, by = (sys.argv[2:4] + ["radius_mean", "group"][len(sys.argv[2:4]):])
with lumenline.open(archive) as cohort:
    table = cohort.table("models")
    units = table.attrs["units"][measure]
used = table[(table["status"] != "failed") & table[measure].notna()]
groups = used.groupby(by)[measure]
print(groups.describe().to_string())

figure, axes = plt.subplots(figsize=(6, 4), constrained_layout=True)
names = list(groups.groups)
axes.boxplot([groups.get_group(n) for n in names], labels=names, showfliers=False)
spread = np.random.default_rng(1)
for place, name in enumerate(names, 1):
    values = groups.get_group(name)
    axes.plot(place + spread.uniform(-0.08, 0.08, len(values)), values, "o", alpha=0.6)
axes.set_ylabel(f"{measure} [{units}]")
axes.set_title(f"{len(used)} of {len(table)} models")
if len(sys.argv) > 4:
    figure.savefig(sys.argv[4], dpi=150)
