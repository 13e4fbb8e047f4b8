"""Where a vessel is narrowest: the radius along each line with its estimated error, as a table and a plot.

Usage: narrowest.py ARCHIVE MODEL [PLOT.png]
"""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import lumenline

if len(sys.argv) < 3:
    sys.exit(__doc__)
archive, model_id = sys.argv[1:3]
with lumenline.open(archive) as cohort:
    model = cohort[model_id]
    figure, axes = plt.subplots(figsize=(8, 4), constrained_layout=True)
    print("line\tabscissa\tradius\terror\tx\ty\tz")
    for number, line in enumerate(model.lines()):
        error = line.values["radius_error"]
        at = line.radius.argmin()
        x, y, z = line.points[at]
        print(f"{number}\t{line.abscissa[at]:.4g}\t{line.radius[at]:.4g}\t{error[at]:.2g}\t{x:.5g}\t{y:.5g}\t{z:.5g}")
        drawn = axes.plot(line.abscissa, line.radius, label=f"to endpoint {line.target}")[0]
        axes.fill_between(line.abscissa, line.radius - error, line.radius + error, color=drawn.get_color(), alpha=0.25)
        axes.plot(line.abscissa[at], line.radius[at], "o", color=drawn.get_color())
    axes.set_xlabel(f"abscissa [{model.length_unit}]")
    axes.set_ylabel(f"radius [{model.length_unit}]")
    axes.set_ylim(bottom=0)
    axes.set_title(model.id)
    if len(model.lines()) <= 8:
        axes.legend()
    if len(sys.argv) > 3:
        figure.savefig(sys.argv[3], dpi=150)
