"""A study of a folder of Rockyfor3D. Whatever its manual was not at hand for says so in notes.txt."""
import csv
import json
import math
import os
import tempfile

import numpy as np

from grids import Bad, Grid, write

NEEDED = "dem", "rockdensity", "d1", "d2", "d3", "blshape", "rg70", "rg20", "rg10", "soiltype"
FOREST = "nrtrees", "dbhmean", "dbhstd"  # and conif_percent
NETS = "net_number", "net_energy", "net_height"
NOT_ALWAYS = "dem.prj", "ground.prj", "trees.csv", "nets.csv"  # files of a study that another one may not have
# name: least, largest, unit, whole numbers
RANGES = {"rockdensity": (0, 5000, " kg/m³", False), "d1": (0, 100, " m", False), "d2": (0, 100, " m", False),
          "d3": (0, 100, " m", False), "blshape": (0, 4, "", True), "rg70": (0, 100, " m", False), "rg20": (0, 100, " m", False),
          "rg10": (0, 100, " m", False), "soiltype": (0, 7, "", True), "nrtrees": (0, 100000, "", False),
          "dbhmean": (0, 300, " cm", False), "dbhstd": (0, 200, " cm", False), "conif_percent": (0, 100, " %", False),
          "net_number": (0, 1e6, "", True), "net_energy": (0, 100000, " kJ", False), "net_height": (0, 30, " m", False)}
# What this program has for each type of soil; its own coefficients are others than Rockyfor3D's.
SOILS = (("river, swamp", "Soil"), ("fine soil, deeper than 1 m", "Soil"), ("fine soil, less than 1 m, or sand, gravel", "Soil"),
         ("scree, below 10 cm", "Talus"), ("talus, above 10 cm", "Talus"), ("bedrock with thin cover", "Bedrock with boulders"),
         ("bedrock", "Rock"), ("asphalt", "Asphalt"))
MOST_CLASSES, MOST_STEMS = 255, 1000000
MOST_OFF_NET = 1.5  # cells
ROUGHNESS_LENGTH = 2.0  # m, of the presets' obstacles
EQUANT = 1.25  # longest to shortest axis of an ellipsoid that an icosahedron may stand for
LEAST_STEM = 5.0  # cm
CONIFER, BROADLEAF = 0.9, 1.7  # factors of spruce and beech, as of docs/structures.md


def read(folder):
    """All rasters that are there, by name, checked."""
    grids, files = {}, {}
    for file in sorted(os.listdir(folder)):
        stem, end = os.path.splitext(file.lower())  # where Rockyfor3D runs, DEM.ASC is dem.asc
        if end == ".asc":
            if stem in files:
                raise Bad(f"{folder} has {files[stem]} and {file}: which one is it?")
            files[stem] = file
    for name in (*NEEDED, *FOREST, "conif_percent", *NETS):
        if name in files:
            grids[name] = Grid.read(os.path.join(folder, files[name]))
            if name != "dem":
                grids[name].must_fit(grids["dem"])
                grids[name].must_be(*RANGES[name])
        elif name in NEEDED:
            raise Bad(f"{folder} has no {name}.asc")
    for names in (FOREST, NETS):
        there = [name for name in names if name in grids]
        if there and len(there) < len(names):
            raise Bad(f"{folder} has {there[0]}.asc, but no {next(n for n in names if n not in grids)}.asc")
    return grids


def rows_to(path, names, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows([names, *rows])


def block(shape, d1, d2, d3):
    """Shape, volume and edges of a block."""
    axes, size = sorted((d1, d2, d3)), d1 * d2 * d3
    if shape in (0, 1):
        return "box", size, (d1, d2, d3)
    if shape == 3:
        return "icosahedron", math.pi / 6.0 * (sum(axes) / 3.0) ** 3, None
    if shape == 2 and axes[2] <= EQUANT * axes[0]:
        return "icosahedron", math.pi / 6.0 * size, None
    return "box", math.pi / (6.0 if shape == 2 else 4.0) * size, (d1, d2, d3)


def sources(grids, path):
    """A block in the middle of every cell with a density; how many."""
    density = grids["rockdensity"]
    rows = []
    for row, column in zip(*np.nonzero(density.values > 0)):
        sizes = [grids[name].values[row, column] for name in ("d1", "d2", "d3")]
        x, y = density.centres(row, column)
        for name, size in zip(("d1", "d2", "d3"), sizes):
            if not size > 0.0:
                raise Bad(f"{grids[name].path}: row {row + 1}, column {column + 1} is {size:g}, but rockdensity there is "
                          f"{density.values[row, column]:g}: it must be above 0 m")
        shape = grids["blshape"].values[row, column]
        kind, volume, edges = block(0 if math.isnan(shape) else int(shape), *sizes)
        edges = [f"{e:g}" for e in edges] if edges else ["", "", ""]
        rows.append([f"{x:.3f}", f"{y:.3f}", 0, kind, f"{volume:.6g}", *edges, f"{density.values[row, column]:g}", "random",
                     f"cell {row + 1} {column + 1}"])
    if not rows:
        raise Bad(f"{density.path} has no cell above 0: there are no sources")
    rows_to(path, ["x", "y", "height", "shape", "volume", "lx", "ly", "lz", "density", "dev_att", "source"], rows)
    return len(rows)


def ground(grids, folder):
    """Classes of soil and obstacles, as a raster and two tables; how many, and to what the heights were rounded."""
    soil = grids["soiltype"].values
    heights = np.stack([np.nan_to_num(grids[name].values) for name in ("rg70", "rg20", "rg10")]).round(4)  # read as floats
    if (heights[0] > heights[1]).any() or (heights[1] > heights[2]).any():
        raise Bad(f"{grids['rg70'].path}: rg70 must not be above rg20, nor rg20 above rg10, in any cell")
    known = ~np.isnan(soil)
    for step in (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, math.inf):
        up = lambda h: np.ceil(h / step - 1e-6) * step if math.isfinite(step) else np.where(h > 0.0, h.max(), 0.0)
        keys = np.stack([soil[known], *(up(h[known]) for h in heights)], axis=1)
        keys = keys.round(6) + 0.0  # no -0
        classes, number = np.unique(keys, axis=0, return_inverse=True)
        if len(classes) <= MOST_CLASSES:
            break
    values = np.full(soil.shape, np.nan)
    values[known] = number.ravel() + 1
    dem = grids["dem"]
    write(os.path.join(folder, "ground.asc"), values, dem.west, dem.north, dem.cell, dem.crs, whole=True)
    named = [(k + 1, f"{SOILS[int(c[0])][0]}, {c[1]:g} {c[2]:g} {c[3]:g} m", SOILS[int(c[0])][1], *(f"{h:g}" for h in c[1:]))
             for k, c in enumerate(classes)]
    rows_to(os.path.join(folder, "ground.csv"), ["class", "name", "preset", "rg70", "rg20", "rg10", "roughness_mean", "roughness",
                                                 "roughness_length"], [(*row, 0, 0, ROUGHNESS_LENGTH) for row in named])
    rows_to(os.path.join(folder, "friction.csv"), ["class", "name", "preset"], [row[:3] for row in named])
    return len(classes), step


def stems(grids, path, per, seed):
    """Stems drawn cell by cell; how many."""
    count, mean, deviation = (np.nan_to_num(grids[name].values) for name in FOREST)
    conifers = np.nan_to_num(grids["conif_percent"].values) if "conif_percent" in grids else np.full(count.shape, 100.0)
    dem, random, rows = grids["dem"], np.random.default_rng(seed), []
    expected = count * (dem.cell ** 2 / 1e4 if per == "hectare" else 1.0)
    expected[np.isnan(dem.values)] = 0.0
    if expected.sum() > MOST_STEMS:
        raise Bad(f"{grids['nrtrees'].path} makes {expected.sum():.0f} stems, at most {MOST_STEMS} can be: does it count by "
                  "hectare or by cell (--trees-per)?")
    for row, column in zip(*np.nonzero(expected > 0)):
        m, s = mean[row, column], deviation[row, column]
        if not m > 0:
            raise Bad(f"{grids['dbhmean'].path}: row {row + 1}, column {column + 1} is {m:g} cm, but nrtrees there is "
                      f"{count[row, column]:g}: it must be above 0 cm")
        number = random.poisson(expected[row, column])
        place = random.random((number, 2))
        diameter = random.gamma((m / s) ** 2, s * s / m, number) if s > 0 else np.full(number, m)
        conifer = random.random(number) * 100.0 < conifers[row, column]
        for (u, v), d, c in zip(place, np.maximum(diameter, LEAST_STEM), conifer):
            rows.append([f"{dem.west + (column + u) * dem.cell:.2f}", f"{dem.north - (row + v) * dem.cell:.2f}", f"{d:.1f}",
                         f"{1.3 + 24.0 * (1.0 - math.exp(-d / 22.0)):.1f}", CONIFER if c else BROADLEAF])
    if rows:
        rows_to(path, ["x", "y", "diameter", "height", "factor"], rows)
    return len(rows)


def pieces_of(rows, columns):
    """Cells, as indices, by the pieces in which they touch each other, also by corners."""
    left = {cell: k for k, cell in enumerate(zip(rows.tolist(), columns.tolist()))}
    while left:
        cells, piece = [next(iter(left))], []
        piece.append(left.pop(cells[0]))
        while cells:
            row, column = cells.pop()
            for near in ((row + down, column + right) for down in (-1, 0, 1) for right in (-1, 0, 1)):
                if near in left:
                    piece.append(left.pop(near))
                    cells.append(near)
        yield np.sort(piece)


def line_through(places, cell):
    """Points of a line along places, and how far the farthest place is off it, in cells."""
    along = places - places.mean(axis=0)
    axis = np.linalg.svd(along, full_matrices=False)[2][0]
    axis = axis if axis[np.argmax(np.abs(axis))] > 0 else -axis
    way = along @ axis
    step = np.round((way - way.min()) / cell).astype(int)
    line = np.array([places[step == k].mean(axis=0) for k in np.unique(step)])
    off = max(np.linalg.norm(line - place, axis=1).min() for place in places)
    return line, off / cell


def nets(grids, path):
    """A line through each piece of the cells of a number; how many, and the numbers of which a cell by itself was left out."""
    number, energy, height = (grids[name].values for name in NETS)
    rows, lost = [], []
    for one in np.unique(number[number > 0]):
        own = np.nonzero(number == one)
        places = np.stack(grids["net_number"].centres(*own), axis=1)
        made = 0
        for piece in pieces_of(*own):
            cells = tuple(index[piece] for index in own)
            if len(piece) < 2:
                lost.append(int(one))
                continue
            line, off = line_through(places[piece], grids["dem"].cell)
            if off > MOST_OFF_NET:
                raise Bad(f"{grids['net_number'].path}: the cells of net {one:.0f} that touch each other do not lie along one line, as one is "
                          f"{off:.1f} cells off it: give its arms numbers of their own")
            for name, values, unit in (("net_height", height, "m"), ("net_energy", energy, "kJ")):
                other = np.flatnonzero(~(values[cells] == values[cells][0]))  # nodata too
                if len(other):
                    row, column = (index[other[0]] + 1 for index in cells)
                    here, there = (f"{v:g} {unit}" if v == v else "nodata" for v in (values[row - 1, column - 1], values[cells][0]))
                    raise Bad(f"{grids[name].path}: row {row}, column {column} of net {one:.0f} is {here}, another cell of it {there}: "
                              "parts that differ need numbers of their own")
            made += 1
            rows.append([f"LINESTRING({','.join(f'{a:.3f} {b:.3f}' for a, b in line)})", f"net {one:.0f}" + (f", part {made}" if made > 1 else ""),
                         f"{height[cells][0]:g}", f"{energy[cells][0]:g}"])
            if not float(rows[-1][2]) > 0.0:
                raise Bad(f"{grids['net_height'].path}: net {one:.0f} has the height {rows[-1][2]} m, it must be above 0")
    if rows:
        rows_to(path, ["WKT", "name", "height", "capacity"], rows)
    return len(rows), sorted(set(lost))


def convert(source, target, iterations, per, seed):
    """All of the study is made before any of it takes its place."""
    if iterations < 1:
        raise Bad(f"--iterations is {iterations}, it must be at least 1")
    if os.path.samefile(source, target):
        raise Bad(f"{target} is the folder of the rasters: take another one")
    with tempfile.TemporaryDirectory(prefix=".rockyfor3d-", dir=target) as made:
        notes = make(source, made, iterations, per, seed)
        names = sorted(os.listdir(made))
        for name in (*names, *NOT_ALWAYS):  # whether it is of an earlier study or somebody's own, nobody knows
            path = os.path.join(target, name)
            if os.path.lexists(path) and (name not in names or os.path.isdir(path)):
                raise Bad(f"{path} is not of this study: remove it, or take another folder")
        for name in names:
            os.replace(os.path.join(made, name), os.path.join(target, name))
    return "\n".join([*notes, f"Study: {os.path.join(target, 'study.json')}"])


def make(source, target, iterations, per, seed):
    """Files of a study; its notes."""
    grids = read(source)
    into = lambda name: os.path.join(target, name)
    dem = grids["dem"]
    write(into("dem.asc"), dem.values, dem.west, dem.north, dem.cell, dem.crs)
    count = sources(grids, into("sources.csv"))
    classes, step = ground(grids, target)
    terrain = {"FileName": "dem.asc", "Preset": "Soil (assumed)", "RestitutionLayer": "ground.asc",
               "RestitutionTable": "ground.csv", "JointLayer": "ground.asc", "JointTable": "friction.csv"}
    notes = [
        f"{count} source cells, each with a block in its middle that touches the ground, drawn at a random attitude in each of "
        f"{iterations} iterations.",
        "blshape, codes as of NGU's tool for Rockyfor3D: 1 (and 0) is a box of d1, d2, d3; 3 an icosahedron of the sphere's volume; "
        f"2 an icosahedron of the ellipsoid's volume where the axes differ by at most {EQUANT:g}, else a box of its proportions and "
        "volume; 4 a box of its proportions and a disc's volume, π/4 d1 d2 d3 (assumed).",
        "soiltype is taken by presets of this program, which have coefficients of their own (assumed): "
        + "; ".join(f"{k} {name}: {preset}" for k, (name, preset) in enumerate(SOILS)) + ".",
        f"rg70, rg20, rg10 are the obstacles of {classes} classes of ground, of {ROUGHNESS_LENGTH:g} m length, in place of the "
        f"presets' roughness; heights were rounded up to {f'{step:g} m' if math.isfinite(step) else 'the largest of all cells'}. Whether that is Rockyfor3D's law is from memory.",
        "What Rockyfor3D varies by itself, as the volume of rocks or its heights of fall, is not in its rasters: set it in "
        "study.json."]
    if "nrtrees" in grids:
        made = stems(grids, into("trees.csv"), per, seed)
        if made:
            terrain.update(TreeFile="trees.csv", TreesBreak=1)
        notes.append(f"{made} stems were drawn (Poisson, gamma for diameters of at least {LEAST_STEM:g} cm, seed {seed}), the same "
                     f"in all iterations. That nrtrees counts by {per} is from memory. Factors of the energy they take: conifers "
                     f"{CONIFER:g} (spruce), others {BROADLEAF:g} (beech), from memory. Trees are 1.3 + 24 (1 − exp(−d / 22)) m high, d in cm (assumed).")
        if "conif_percent" not in grids:
            notes.append("There is no conif_percent.asc: all stems are conifers.")
    if "net_number" in grids:
        made, lost = nets(grids, into("nets.csv"))
        if made:
            terrain["BarrierFile"] = "nets.csv"
        notes.append(f"{made} nets: lines through the cells of a net_number that touch each other, with their net_energy (kJ) and net_height (m). "
                     "The names of these rasters and their units are from memory.")
        if lost:
            notes.append(f"Left out, as cells by themselves: net {', '.join(map(str, lost))}.")
    study = {"terrain": terrain, "rocks": {"FileName": "sources.csv"},
             "simulation": {"EndTime": 120, "Seed": 1, "TrajectoryOutput": "Thinned"}, "map": {}, "trajectories": False,
             "iterations": iterations, "chunk": max(1, min(iterations, 20000 // count))}
    with open(into("study.json"), "w", encoding="utf-8") as file:
        json.dump(study, file, indent=1)
    with open(into("notes.txt"), "w", encoding="utf-8") as file:
        file.write("\n".join(notes) + "\n")
    return notes
