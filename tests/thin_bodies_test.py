#!/usr/bin/env python3
"""Random thin bodies from files, plates, bars, fins, slots and tubes, that turn as they go: the mesh resolves them.

    thin_bodies_test.py KROPLA [SEED [COUNT]]

Sizes and lengths of any scale; thin places are 0.16 to 0.8 surface sizes wide.
Flat faces keep the volume; round ones have that of a polyhedron inscribed, which lacks pi h^2/6 of a circle's area at most.
"""

import csv
import math
import pathlib
import random
import subprocess
import sys
import tempfile

LIMIT = 10  # of R/r, as by default
ROUNDING = 1e-12  # [-] of volumes
CASE = """
[domain]
min = [{low!r}, {low!r}, {low!r}]
max = [{high!r}, {high!r}, {high!r}]
[size]
surface = {surface!r}
growth = {growth!r}
far = {far!r}
[time]
end = 1
steps = 3
[[body]]
name = "thin"
shape = "surface"
file = "thin.stl"
centre = [0, 0, 0]
scale = {scale!r}
[body.motion]
x = "{way!r}*t"
angle = "{angle!r}*t"
axis = {axis!r}
"""


def area(polygon):
    return sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(polygon, polygon[1:] + polygon[:1])) / 2


def drawn(polygon, fan, half_length):
    """The triangles of a polygon in x and y, cut into `fan`, drawn along z."""
    low, high = ([(x, y, z) for x, y in polygon] for z in (-half_length, half_length))
    triangles = [face for i, j, k in fan for face in ((high[i], high[j], high[k]), (low[i], low[k], low[j]))]
    for i in range(len(polygon)):
        j = (i + 1) % len(polygon)
        triangles += [(low[i], low[j], high[j]), (low[i], high[j], high[i])]
    return triangles


def block(width, depth):
    return [(-width, -depth), (width, -depth), (width, depth), (-width, depth)], [(0, 1, 2), (0, 2, 3)]


def fin(w):
    return ([(-1, -0.5), (1, -0.5), (1, 0), (w, 0), (w, 1), (-w, 1), (-w, 0), (-1, 0)],
            [(0, 1, 3), (1, 2, 3), (0, 3, 6), (0, 6, 7), (3, 4, 5), (3, 5, 6)])


def slot(w):
    return ([(-1, -1), (1, -1), (1, 1), (w, 1), (w, 0), (-w, 0), (-w, 1), (-1, 1)],
            [(0, 1, 4), (1, 2, 4), (2, 3, 4), (0, 4, 5), (0, 5, 7), (5, 6, 7)])


def tube(w, corners=20):
    ring = [(math.cos(2 * math.pi * i / corners), math.sin(2 * math.pi * i / corners)) for i in range(corners)]
    inner = 0.8 - 2 * w
    triangles = []
    for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1]):
        for radius, turned in ((0.8, False), (inner, True)):
            a, b = (radius * ax, radius * ay), (radius * bx, radius * by)
            quad = [(*a, -0.6), (*b, -0.6), (*b, 0.6), (*a, 0.6)]
            triangles += [t[::-1] if turned else t for t in ((quad[0], quad[1], quad[2]), (quad[0], quad[2], quad[3]))]
        for z, turned in ((-0.6, True), (0.6, False)):
            a, b, c, d = ((r * x, r * y, z) for r, x, y in ((inner, ax, ay), (0.8, ax, ay), (0.8, bx, by), (inner, bx, by)))
            triangles += [t[::-1] if turned else t for t in ((a, b, c), (a, c, d))]
    return triangles, 1.2 * (0.8 ** 2 - inner ** 2) * area(ring)


def thin_body(kind, half_width):
    """Triangles, and the volume that they bound."""
    if kind == "tube":
        return tube(half_width)
    polygon, fan = {"plate": lambda: block(1, half_width), "bar": lambda: block(half_width, half_width),
                    "fin": lambda: fin(half_width), "slot": lambda: slot(half_width)}[kind]()
    return drawn(polygon, fan, 1), 2 * area(polygon)


def write_stl(file, triangles):
    lines = ["solid thin"]
    for triangle in triangles:
        corners = "\n".join("vertex %r %r %r" % corner for corner in triangle)
        lines.append(f"facet normal 0 0 0\nouter loop\n{corners}\nendloop\nendfacet")
    file.write_text("\n".join(lines + ["endsolid thin\n"]), encoding="utf-8")


def fault_of(program, kind, rng):
    scale, surface = 10 ** rng.uniform(-6, 2), rng.uniform(0.35, 0.5)
    half_width = surface * 10 ** rng.uniform(-0.8, -0.1) / 2
    triangles, volume = thin_body(kind, half_width)
    edge = min(surface, 1.5 * 2 * half_width)
    bound = 1.2 * math.pi / 6 * edge ** 2 / volume if kind == "tube" else ROUNDING
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_stl(folder / "thin.stl", triangles)
        (folder / "case.toml").write_text(CASE.format(
            low=-3.2 * scale, high=3.2 * scale, surface=surface * scale, growth=rng.uniform(0.25, 0.4), far=scale, scale=scale,
            way=rng.uniform(-0.5, 0.5) * scale, angle=rng.uniform(-1, 1), axis=[rng.uniform(-1, 1) for _ in range(3)]),
            encoding="utf-8")
        run = subprocess.run([program, "run", "case.toml", "--out", "out"], cwd=folder, capture_output=True, text=True)
        if run.returncode != 0:
            return f"exit code {run.returncode}: {run.stderr.strip().splitlines()[-1]}"
        with open(folder / "out/steps.csv", encoding="utf-8") as table:
            rows = list(csv.DictReader(table))
    if len(rows) != 3:
        return f"{len(rows)} steps"
    worst = max(float(row["max_aspect_ratio"]) for row in rows)
    off = max(abs(float(row["volume_thin [m^3]"]) / (volume * scale ** 3) - 1) for row in rows)
    print(f"{kind}: R/r {worst:.2f}, volume to {off:.1e} of {bound:.1e}, {rows[-1]['tets']} tets", flush=True)
    return f"R/r {worst}" if worst > LIMIT else f"volume off by {off}" if off > bound else None


def main():
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    count = int(sys.argv[3]) if len(sys.argv) > 3 else 5
    program, faults = pathlib.Path(sys.argv[1]).resolve(), 0
    for i in range(count):
        kind = ("plate", "bar", "fin", "slot", "tube")[i % 5]
        if fault := fault_of(program, kind, random.Random(f"{seed} {i}")):
            print(f"seed {seed}, number {i}, {kind}: {fault}")
            faults += 1
    print(f"{count - faults} of {count} thin bodies, seed {seed}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
