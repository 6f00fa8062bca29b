"""What goes into the main job: the DEM as a GeoTIFF, the steepest escarpment, the rocks' sources."""
import csv
import os

import numpy as np

# Radius of the sphere around each shape of 1 m³. A box is 1.5 : 1 : 0.67 here.
REACH = {"cube": 0.866, "tetrahedron": 1.249, "octahedron": 0.909, "dodecahedron": 0.711,
         "icosahedron": 0.733, "box": 0.964, "eota111": 0.688, "eota221": 0.868}
SHAPES = tuple(REACH)
BOX = np.array([1.5, 1.0, 1 / 1.5])


def find_sample(name):
    """Path of a file of matplotlib's sample data (Debian: python-matplotlib-data)."""
    folders = ["/usr/share/matplotlib/mpl-data/sample_data", "/usr/share/matplotlib/sample_data"]
    try:
        import matplotlib
        folders.insert(0, os.path.join(matplotlib.get_data_path(), "sample_data"))
    except ImportError:
        pass
    for folder in folders:
        path = os.path.join(folder, name)
        if os.path.isfile(path):
            return path
    raise SystemExit(f"{name} is not in {' or '.join(folders)}: install python-matplotlib-data.")


def write_geotiff(sample, path):
    """Writes the sample's elevations as a GeoTIFF in WGS 84 and returns (rows, columns, heights).

    Its bounds are the outer edges of the cells: they are as many cells apart as there are columns
    and rows (between centres it would be one less), and the centres then stand at whole multiples of
    3", as in SRTM. The file calls the northern bound ymin.
    """
    from PIL import Image, TiffImagePlugin  # comes with matplotlib
    data = np.load(sample)
    heights = data["elevation"]
    rows, columns = heights.shape
    west, east = sorted(float(data[k]) for k in ("xmin", "xmax"))
    south, north = sorted(float(data[k]) for k in ("ymin", "ymax"))
    dx, dy = float(data["dx"]), float(data["dy"])
    if abs((east - west) / dx - columns) > 0.01 or abs((north - south) / dy - rows) > 0.01:
        raise SystemExit(f"{sample}: {columns} x {rows} cells of {dx} x {dy} degrees do not fill the "
                         f"bounds {west} to {east}, {south} to {north}.")
    tags = TiffImagePlugin.ImageFileDirectory_v2()
    for tag, kind, values in (
            (33550, 12, (dx, dy, 0.0)),                        # ModelPixelScale
            (33922, 12, (0.0, 0.0, 0.0, west, north, 0.0)),    # ModelTiepoint: the upper left corner
            (34735, 3, (1, 1, 0, 4,                            # GeoKeyDirectory with four keys:
                        1024, 0, 1, 2,                         # a geographic system,
                        1025, 0, 1, 1,                         # cells are areas,
                        2048, 0, 1, 4326,                      # WGS 84,
                        2054, 0, 1, 9102))):                   # in degrees
        tags.tagtype[tag] = kind
        tags[tag] = values
    # Float, because Pillow's 16-bit images are unsigned.
    Image.fromarray(heights.astype(np.float32), mode="F").save(
        path, format="TIFF", tiffinfo=tags, compression="tiff_deflate")
    return rows, columns, heights


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
