#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The values that tests/image/test_metrics.c expects, computed in another way than in src/image/flip.c and src/image/compare.c: double
precision throughout, full two-dimensional kernels, statistics in two passes. Needs only Python.
usage: tests/data/image_figures.py        prints the table of the test
"""
from math import ceil, exp, hypot, log10, pi, sqrt

WIDTH, HEIGHT = 37, 29


def picture(kind):
    """The same formulas as in tests/image/test_metrics.c: integer levels."""
    rows = []
    for y in range(HEIGHT):
        row = []
        for x in range(WIDTH):
            if kind == "ramp":
                c = (7 * x % 256, 9 * y % 256, (5 * x + 3 * y) % 256)
            elif kind == "ramp shifted":
                c = (7 * (x + 1) % 256, 9 * y % 256, (5 * (x + 1) + 3 * y) % 256)
            elif kind == "edge":
                c = (200, 180, 40) if 2 * x + y < 50 else (30, 60, 90)
            elif kind == "edge dimmer":
                c = (190, 170, 40) if 2 * x + y < 50 else (30, 60, 90)
            elif kind == "grey":
                c = (128, 128, 128)
            elif kind == "dot":
                c = (255, 255, 255) if (x, y) == (18, 14) else (128, 128, 128)
            elif kind == "blue dot":
                c = (128, 128, 255) if (x, y) == (18, 14) else (128, 128, 128)
            elif kind == "noise":
                n = (x * 7919 + y * 104729 + x * y * 31) % 251
                c = (n, n * 3 % 251, n * 7 % 251)
            elif kind == "black":
                c = (0, 0, 0)
            elif kind == "white":
                c = (255, 255, 255)
            elif kind == "green":
                c = (0, 255, 0)
            elif kind == "blue":
                c = (0, 0, 255)
            row.append(c)
        rows.append(row)
    return rows


# --- PSNR and SSIM

def rmse(a, b):
    squares = [(p - q) ** 2 for ra, rb in zip(a, b) for ca, cb in zip(ra, rb) for p, q in zip(ca, cb)]
    return sqrt(sum(squares) / len(squares))


def ssim(a, b):
    grey = [[[0.299 * c[0] + 0.587 * c[1] + 0.114 * c[2] for c in row] for row in image] for image in (a, b)]
    weights = {(i, j): exp(-(i * i + j * j) / (2 * 1.5 ** 2)) for i in range(-5, 6) for j in range(-5, 6)}
    total = sum(weights.values())
    c1, c2 = (0.01 * 255) ** 2, (0.03 * 255) ** 2
    indices = []
    for y in range(5, HEIGHT - 5):
        for x in range(5, WIDTH - 5):
            def mean(f):
                return sum(w * f(grey[0][y + j][x + i], grey[1][y + j][x + i]) for (i, j), w in weights.items()) / total
            ma, mb = mean(lambda p, q: p), mean(lambda p, q: q)
            va, vb = mean(lambda p, q: (p - ma) ** 2), mean(lambda p, q: (q - mb) ** 2)
            ab = mean(lambda p, q: (p - ma) * (q - mb))
            indices.append((2 * ma * mb + c1) * (2 * ab + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2)))
    return sum(indices) / len(indices)


# --- FLIP

# Computed from the chromaticities of IEC 61966-2-1 with D65 to five digits (0.31271, 0.32902), not copied from a table:
# columns are the primaries, scaled so that their sum is white.
def solve(m, v):
    m = [row[:] + [x] for row, x in zip(m, v)]
    for i in range(3):
        p = max(range(i, 3), key=lambda r: abs(m[r][i]))
        m[i], m[p] = m[p], m[i]
        for r in range(3):
            if r != i:
                f = m[r][i] / m[i][i]
                m[r] = [s - f * t for s, t in zip(m[r], m[i])]
    return [m[i][3] / m[i][i] for i in range(3)]


PRIMARIES = [(0.64, 0.33), (0.30, 0.60), (0.15, 0.06)]
WHITE = (0.31271 / 0.32902, 1.0, (1 - 0.31271 - 0.32902) / 0.32902)
COLUMNS = [[(x, y, 1 - x - y)[i] for x, y in PRIMARIES] for i in range(3)]
SCALES = solve(COLUMNS, WHITE)
TO_XYZ = [[c * s for c, s in zip(row, SCALES)] for row in COLUMNS]


def linear(level):
    v = level / 255
    return v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4


def xyz_of(rgb):
    return [sum(m * c for m, c in zip(row, rgb)) for row in TO_XYZ]


def ycc_of(rgb):
    x, y, z = [v / w for v, w in zip(xyz_of(rgb), WHITE)]
    return [116 * y - 16, 500 * (x - y), 200 * (y - z)]


def rgb_of(ycc):
    y = (ycc[0] + 16) / 116
    xyz = [(ycc[1] / 500 + y) * WHITE[0], y * WHITE[1], (y - ycc[2] / 200) * WHITE[2]]
    return [min(max(c, 0), 1) for c in solve(TO_XYZ, xyz)]


def hunt(rgb):
    def f(t):
        return t ** (1 / 3) if t > (6 / 29) ** 3 else t / (3 * (6 / 29) ** 2) + 4 / 29
    x, y, z = [f(v / w) for v, w in zip(xyz_of(rgb), WHITE)]
    light = 116 * y - 16
    return [light, 0.01 * light * 500 * (x - y), 0.01 * light * 200 * (y - z)]


def hyab(p, q):
    return abs(p[0] - q[0]) + hypot(p[1] - q[1], p[2] - q[2])


def color_difference(d):
    most = hyab(hunt((0, 1, 0)), hunt((0, 0, 1))) ** 0.7
    power, knee = d ** 0.7, 0.4 * most
    return 0.95 * power / knee if power < knee else 0.95 + 0.05 * (power - knee) / (most - knee)


def square(radius, f):
    return {(x, y): f(x, y) for x in range(-radius, radius + 1) for y in range(-radius, radius + 1)}


def sensitivity(ppd, terms):
    radius = ceil(3 * sqrt(0.04 / (2 * pi ** 2)) * ppd)
    kernel = square(radius, lambda x, y: sum(a * sqrt(pi / b) * exp(-pi ** 2 * (x * x + y * y) / ppd ** 2 / b)
                                             for a, b in terms))
    total = sum(kernel.values())
    return {at: w / total for at, w in kernel.items()}


def feature(ppd, f):
    s = 0.5 * 0.082 * ppd
    kernel = square(ceil(3 * s), lambda x, y: f(x, s) * exp(-(x * x + y * y) / (2 * s * s)))
    up = sum(w for w in kernel.values() if w > 0)
    down = -sum(w for w in kernel.values() if w < 0)
    return {at: w / (up if w > 0 else down) for at, w in kernel.items()}


def turned(kernel):
    return {(y, x): w for (x, y), w in kernel.items()}


def filtered(plane, kernel):
    def at(x, y):
        return plane[min(max(y, 0), HEIGHT - 1)][min(max(x, 0), WIDTH - 1)]
    return [[sum(w * at(x + i, y + j) for (i, j), w in kernel.items()) for x in range(WIDTH)] for y in range(HEIGHT)]


def percept(image, ppd):
    ycc = [[ycc_of([linear(c) for c in color]) for color in row] for row in image]
    planes = [[[c[k] for c in row] for row in ycc] for k in range(3)]
    kernels = [sensitivity(ppd, t) for t in ([(1, 0.0047)], [(1, 0.0053)], [(34.1, 0.04), (13.5, 0.025)])]
    seen = [filtered(p, k) for p, k in zip(planes, kernels)]
    colors = [[hunt(rgb_of([seen[k][y][x] for k in range(3)])) for x in range(WIDTH)] for y in range(HEIGHT)]
    light = [[(v + 16) / 116 for v in row] for row in planes[0]]
    features = []
    for f in (lambda x, s: x, lambda x, s: x * x / (s * s) - 1):
        kernel = feature(ppd, f)
        across, down = filtered(light, kernel), filtered(light, turned(kernel))
        features.append([[hypot(p, q) for p, q in zip(rp, rq)] for rp, rq in zip(across, down)])
    return colors, features


def flip(a, b, ppd):
    (ca, fa), (cb, fb) = percept(a, ppd), percept(b, ppd)
    errors = []
    for y in range(HEIGHT):
        for x in range(WIDTH):
            df = max(abs(fa[k][y][x] - fb[k][y][x]) for k in range(2))
            errors.append(color_difference(hyab(ca[y][x], cb[y][x])) ** (1 - sqrt(df / sqrt(2))))
    return sum(errors) / len(errors), max(errors)


if __name__ == "__main__":
    for a, b, ppd in (("ramp", "ramp shifted", 67), ("ramp", "noise", 67), ("edge", "edge dimmer", 67),
                      ("edge", "ramp", 20), ("grey", "dot", 67), ("grey", "dot", 30),
                      ("grey", "blue dot", 67), ("black", "white", 67),
                      ("green", "blue", 67)):
        p, q = picture(a), picture(b)
        r = rmse(p, q)
        mean, most = flip(p, q, ppd)
        print('    {"%s", "%s", %d, %.9g, %.9g, %.9g, %.9g, %.9g},'
              % (a, b, ppd, r, 20 * log10(255 / r), ssim(p, q), mean, most), flush=True)
    for name, rgb in (("white", (1, 1, 1)), ("green", (0, 1, 0)), ("blue", (0, 0, 1)), ("dark", (0.001, 0.002, 0.004)),
                      ("skin", (0.5, 0.3, 0.2))):
        print("    {%s, {%.9g, %.9g, %.9g}, {%.9g, %.9g, %.9g}}," % ((rgb,) + tuple(ycc_of(rgb)) + tuple(hunt(rgb))))
    for d in (0, 1, 20, 100, hyab(hunt((0, 1, 0)), hunt((0, 0, 1)))):
        print("    {%.9g, %.9g}," % (d, color_difference(d)))
