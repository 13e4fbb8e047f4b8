"""Profiles over the normalised abscissa of all sections, a second time: from the exported table, with NumPy.

Usage: second_profile.py sections.csv COLUMN BINS
"""
import csv
import json
import sys

import numpy as np

file, column, bins = sys.argv[1], sys.argv[2], int(sys.argv[3])
values = {}
with open(file, newline="") as table:
    for row in csv.DictReader(table):
        if row["status"] == "failed" or not row[column] or not row["abscissa_relative"]:
            continue
        place = min(int(float(row["abscissa_relative"]) * bins), bins - 1)
        values.setdefault((place, row["group"]), {}).setdefault(row["subject"], []).append(float(row[column]))
profile = []
for (place, group), subjects in sorted(values.items()):
    means = np.array([np.mean(v) for v in subjects.values()])
    profile.append({"bin": place, "group": group, "n": len(means), "mean": means.mean(), "sd": means.std(ddof=1),
                    "median": np.median(means), "p5": np.percentile(means, 5), "p95": np.percentile(means, 95)})
json.dump(profile, sys.stdout)
