#!/usr/bin/env python3
"""Pictures of engine/characterize/README.md: which centerline each point of a wall gets.

usage: characterize_pictures.py LUMENLINE MODEL_FILE OUT.svg AXIS AXIS [CENTRE_X CENTRE_Y HALF_WIDTH]

MODEL_FILE is a model file of LUMENLINE with its surface characterized. The wall is projected on two axes (x, y or z).
Grey: sites whose nearest point of a path in a straight line is the one that the complex leads to. Red: sites whose
nearest point in a straight line is farther than D_e from it: it belongs to another vessel; a thin red line leads
there, a blue one to the point that the complex leads to. Needs nothing but Python.
"""
import math
import subprocess
import sys

WIDTH, HEIGHT = 900, 560


def read(lumenline, model_file, path):
    name = subprocess.run([lumenline, "browse", model_file, "list"], capture_output=True, text=True, check=True)
    model = name.stdout.splitlines()[1].split()[0]
    text = subprocess.run([lumenline, "browse", model_file, "get", model, path],
                          capture_output=True, text=True, check=True).stdout
    return [[float(v) for v in line.split()] for line in text.splitlines()]


def nearest_on_paths(x, points, offsets):
    best, foot = math.inf, None
    for first, last in zip(offsets, offsets[1:]):
        for k in range(first, last - 1):
            a, b = points[k], points[k + 1]
            e = [q - p for p, q in zip(a, b)]
            e2 = sum(v * v for v in e)
            t = sum((xi - ai) * ei for xi, ai, ei in zip(x, a, e)) / e2 if e2 > 0 else 0
            t = min(1, max(0, t))
            y = [ai + t * ei for ai, ei in zip(a, e)]
            d = math.dist(x, y)
            if d < best:
                best, foot = d, y
    return best, foot


def main():
    lumenline, model_file, out = sys.argv[1:4]
    u, v = ("xyz".index(a) for a in sys.argv[4:6])
    get = lambda path: read(lumenline, model_file, path)
    sites, centres = get("/surface/points"), get("/surface/centerline_point")
    zone = [int(r[0]) for r in get("/surface/zone")]
    points, offsets = get("/centerlines/path/points"), [int(r[0]) for r in get("/centerlines/path/offsets")]
    shown = [i for i in range(len(sites)) if zone[i] != 1 and not math.isnan(centres[i][0])]
    if len(sys.argv) > 6:
        cu, cv, half = (float(a) for a in sys.argv[6:9])
    else:
        lu, hu = min(sites[i][u] for i in shown), max(sites[i][u] for i in shown)
        lv, hv = min(sites[i][v] for i in shown), max(sites[i][v] for i in shown)
        cu, cv, half = (lu + hu) / 2, (lv + hv) / 2, max((hu - lu) / 2, (hv - lv) / 2 * WIDTH / HEIGHT) * 1.03
    scale = WIDTH / 2 / half
    to_page = lambda p: (WIDTH / 2 + (p[u] - cu) * scale, HEIGHT / 2 - (p[v] - cv) * scale)
    visible = lambda p: all(0 <= c <= w for c, w in zip(to_page(p), (WIDTH, HEIGHT)))

    wall, wrong, ways = [], [], []
    for i in shown:
        if not visible(sites[i]):
            continue
        _, naive = nearest_on_paths(sites[i], points, offsets)
        x, y = to_page(sites[i])
        if math.dist(naive, centres[i]) <= math.dist(sites[i], centres[i]):
            wall.append(f"M{x:.0f} {y:.0f}h0")
            continue
        wrong.append(f"M{x:.1f} {y:.1f}h0")
        (nx, ny), (ox, oy) = to_page(naive), to_page(centres[i])
        ways.append((f"M{x:.0f} {y:.0f}L{nx:.0f} {ny:.0f}", f"M{x:.0f} {y:.0f}L{ox:.0f} {oy:.0f}"))
    lines = []
    for first, last in zip(offsets, offsets[1:]):
        page = [to_page(p) for p in points[first:last]]
        lines.append("M" + "L".join(f"{x:.0f} {y:.0f}" for x, y in page))
    few = ways[:: max(1, len(ways) // 60)]
    with open(out, "w", encoding="utf-8") as svg:
        svg.write(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}">'
                  f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/><g fill="none" stroke-linecap="round">\n'
                  f'<path stroke="#b8b8b8" stroke-width="2.2" d="{"".join(wall)}"/>\n'
                  f'<path stroke="black" stroke-width="1.6" d="{"".join(lines)}"/>\n'
                  f'<path stroke="#d01c1c" stroke-width="0.7" d="{"".join(w[0] for w in few)}"/>\n'
                  f'<path stroke="#1c4fd0" stroke-width="0.7" d="{"".join(w[1] for w in few)}"/>\n'
                  f'<path stroke="#d01c1c" stroke-width="4" d="{"".join(wrong)}"/></g></svg>\n')
    print(f"{out}: {len(wall) + len(wrong)} sites, {len(wrong)} with another nearest line")


main()
