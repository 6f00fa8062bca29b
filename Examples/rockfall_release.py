"""What goes into the main job: the steepest escarpment, the rocks' sources."""
import csv

import numpy as np

# Radius of the sphere around each shape of 1 m³. A box is 1.5 : 1 : 0.67 here.
REACH = {"cube": 0.866, "tetrahedron": 1.249, "octahedron": 0.909, "dodecahedron": 0.711,
         "icosahedron": 0.733, "box": 0.964, "eota111": 0.688, "eota221": 0.868}
SHAPES = tuple(REACH)
BOX = np.array([1.5, 1.0, 1 / 1.5])


def steepest_escarpment(ground, steep):
    """Rows and columns of the largest connected area of cells that are steeper than `steep` degrees.

    Connected, because a DEM's steepest single cells are river banks, quarries and errors."""
    angles = ground.angles()
    left = set(zip(*(index.tolist() for index in np.nonzero(angles > steep))))
    largest = []
    while left:
        area, edge = [], [left.pop()]
        while edge:
            row, column = edge.pop()
            area.append((row, column))
            for near in ((row + i, column + j) for i in (-1, 0, 1) for j in (-1, 0, 1)):
                if near in left:
                    left.remove(near)
                    edge.append(near)
        largest = max(largest, area, key=len)
    if not largest:
        raise SystemExit(f"No cell of the slope is steeper than {steep} degrees.")
    rows, columns = np.array(sorted(largest)).T
    return rows, columns, angles[rows, columns]


def place_rocks(ground, rows, columns, count, seed):
    """Sources of `count` rocks in the highest cells of an escarpment, as dictionaries.

    One rock per cell, so that none touches another; shapes in turn, volumes of 0.5 to 1.5 m³, any
    attitude. The sphere around the rock is 1 m over the highest ground beneath it.
    """
    if count > len(rows):
        raise SystemExit(f"The escarpment has {len(rows)} cells, one for each rock: {count} are too many.")
    random = np.random.default_rng(seed)
    x, y = ground.centre(rows, columns)
    highest = np.argsort(-ground.height(x, y), kind="stable")[:max(count, min(len(rows), 150))]
    sources = []
    for k, cell in enumerate(random.permutation(highest)[:count]):
        shape = SHAPES[k % len(SHAPES)]
        volume = round(random.uniform(0.5, 1.5), 3)
        reach = REACH[shape] * volume ** (1 / 3)
        turn = np.linspace(0, 2 * np.pi, 16, endpoint=False)
        under = ground.height(x[cell] + reach * np.append(np.cos(turn), 0),
                              y[cell] + reach * np.append(np.sin(turn), 0)).max()
        source = {"x": x[cell], "y": y[cell], "z": round(under + reach + 1.0, 3),
                  "shape": shape, "volume": volume}
        source.update(zip(("rx", "ry", "rz"), random.uniform(-180, 180, 3).round(2)))
        if shape == "box":
            source.update(zip(("lx", "ly", "lz"), (BOX * volume ** (1 / 3)).round(4)))
        sources.append(source)
    return sources


def write_sources(sources, path):
    """As a CSV table that Rock Blocks reads."""
    with open(path, "w", newline="") as file:
        table = csv.DictWriter(file, "x y z shape volume rx ry rz lx ly lz".split())
        table.writeheader()
        table.writerows(sources)
