"""The figures of `lumenline stats`, computed anew with NumPy and SciPy from a table of one row a subject.

Usage: second_implementation.py TABLE.tsv, with the columns group, age, first, second. Prints one JSON object.
"""
import csv
import json
import sys

import numpy as np
from scipy import stats

with open(sys.argv[1], newline="") as file:
    rows = list(csv.DictReader(file, delimiter="\t"))
group = np.array([r["group"] for r in rows])
age, first, second = (np.array([float(r[c]) for r in rows]) for c in ("age", "first", "second"))
a, b = first[group == "a"], first[group == "b"]

welch = stats.ttest_ind(a, b, equal_var=False)
mann_whitney = stats.mannwhitneyu(a, b)
brown_forsythe = stats.levene(a, b, center="median")
pearson = stats.pearsonr(age, first)
spearman = stats.spearmanr(age, first)

design = np.column_stack([np.ones(len(rows)), group == "b", age]).astype(float)
solution, left, _, _ = np.linalg.lstsq(design, first, rcond=None)
freedom = len(rows) - design.shape[1]
errors = np.sqrt(left[0] / freedom * np.diag(np.linalg.inv(design.T @ design)))

# ICC(A,1) from the sums of squares of the two-way table.
table = np.column_stack([first, second])
n, k = table.shape
mean = table.mean()
rows_ms = k * ((table.mean(axis=1) - mean) ** 2).sum() / (n - 1)
columns_ms = n * ((table.mean(axis=0) - mean) ** 2).sum() / (k - 1)
rest = table - table.mean(axis=1, keepdims=True) - table.mean(axis=0) + mean
rest_ms = (rest**2).sum() / ((n - 1) * (k - 1))
icc = (rows_ms - rest_ms) / (rows_ms + (k - 1) * rest_ms + k / n * (columns_ms - rest_ms))

print(json.dumps({
    "mean": a.mean(), "sd": a.std(ddof=1), "median": np.median(a),
    "lower_quartile": np.percentile(a, 25), "upper_quartile": np.percentile(a, 75),
    "welch_t": welch.statistic, "welch_p": welch.pvalue,
    "mann_whitney_u": mann_whitney.statistic, "mann_whitney_p": mann_whitney.pvalue,
    "brown_forsythe_f": brown_forsythe.statistic, "brown_forsythe_p": brown_forsythe.pvalue,
    "pearson_r": pearson.statistic, "pearson_p": pearson.pvalue,
    "spearman_rho": spearman.correlation, "spearman_p": spearman.pvalue,
    "coefficient": solution[1], "error": errors[1], "p": 2 * stats.t.sf(abs(solution[1] / errors[1]), freedom),
    "icc": icc, "bias": (second - first).mean(), "agreement_sd": (second - first).std(ddof=1),
}))
