# SPDX-License-Identifier: MIT
# Writes the two environments of the path-traced cases beside this file: dusk.pfm, a smooth sky that is warm on one side
# and cold on the other, and window.pfm, a dim room with a small bright window.
import array
import math
import os

WIDTH, HEIGHT = 64, 32


def write(name, radiance):
    """Stores radiance(column, row, way) as a PFM file, whose rows begin at the bottom."""
    floats = array.array("f")
    for row in reversed(range(HEIGHT)):
        for column in range(WIDTH):
            turn, down = 2 * math.pi * ((column + 0.5) / WIDTH - 0.5), math.pi * (row + 0.5) / HEIGHT
            way = (math.sin(down) * math.sin(turn), math.cos(down), -math.sin(down) * math.cos(turn))
            floats.extend(radiance(column, row, way))
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), name), "wb") as file:
        file.write(b"PF\n%d %d\n-1.0\n" % (WIDTH, HEIGHT) + floats.tobytes())


def dusk(_column, _row, way):
    warm = 0.5 + 0.5 * (0.92 * way[0] + 0.24 * way[1] - 0.31 * way[2])
    return [1.5 * a * warm**3 + b * (1 - warm) ** 2 for a, b in zip((1, 0.5, 0.2), (0.1, 0.2, 0.45))]


def window(column, row, _way):
    return [60, 54, 45] if 10 <= column < 12 and 9 <= row < 11 else [0.02, 0.022, 0.026]


write("dusk.pfm", dusk)
write("window.pfm", window)
