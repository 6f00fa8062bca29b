"""A folder of Rockyfor3D of 200 x 200 cells, made by hand, comes in as a study that runs, and its results go out under
the names that are known there. What does not fit is one line that names the raster."""

import json
import math
import os
import shutil
import sys

import numpy as np
from osgeo import gdal

from helpers import delete_sources, files_of, rows_of, run_script, write_grid, write_text

EXAMPLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Examples")
sys.path[:0] = [os.path.join(EXAMPLES, "rockyfor3d_parts")]
import folder_in
import grids

SIZE, CELL = 200, 2
for folder in ("folder", "study", "results", "rasters", "bad", "other", "capitals"):
    shutil.rmtree(folder, ignore_errors=True)
os.makedirs("folder")
rows, columns = np.mgrid[0:SIZE, 0:SIZE]


def grid(name, values, folder="folder", **more):
    write_grid(os.path.join(folder, name + ".asc"), [[f"{v:g}" for v in row] for row in np.broadcast_to(values, (SIZE, SIZE))],
               cell=CELL, **more)


def only(cells, value, elsewhere=0.0):
    made = np.full((SIZE, SIZE), float(elsewhere))
    for row, column in cells:
        made[row, column] = value
    return made


# A plane that falls along +x by 80 %; four sources near its top, one of each shape; soil by halves, stones on a strip.
SOURCES = (100, 10), (101, 10), (102, 10), (103, 12)
grid("dem", 0.8 * CELL * (SIZE - 1 - columns))
grid("rockdensity", only(SOURCES, 2700))
grid("d1", only(SOURCES, 1.0)), grid("d2", only(SOURCES, 0.8)), grid("d3", only(SOURCES, 0.5))
shapes = only(SOURCES, 1)
shapes[101, 10], shapes[102, 10], shapes[103, 12] = 2, 3, 4
grid("blshape", shapes)
grid("soiltype", np.where(rows < 100, 6, 4))
stones = (columns >= 50) & (columns < 60)
for name, size in (("rg70", 0.05), ("rg20", 0.1), ("rg10", 0.254)):
    grid(name, np.where(stones, size, 0.0))
wood = (rows < 100) & (columns >= 100) & (columns < 150)  # 100 m by 200 m: 2 ha
for name, value in (("nrtrees", 400.0), ("dbhmean", 30.0), ("dbhstd", 6.0), ("conif_percent", 25.0)):
    grid(name, np.where(wood, value, 0.0))
net = [(row, 160 + row // 50) for row in range(80, 120)]
grid("net_number", only(net, 7) + only([(5, 5)], 8)), grid("net_energy", only(net, 500)), grid("net_height", only(net, 3) +
                                                                                          only([(5, 5)], 3))


def run(script, *arguments):
    said, message = run_script(os.path.join(EXAMPLES, script), *arguments)
    delete_sources()
    return said if message is None else message


said = run("rockyfor3d.py", "in", "folder", "study", "--iterations", "3", "--seed", "5")
assert "4 source cells" in said and "from memory" in said and "Left out, as cells by themselves: net 8" in said, said
with open("study/notes.txt") as file:
    assert file.read().strip() in said

# Sources: the middle of their cells, volumes by hand.
blocks = rows_of("study/sources.csv")
assert [(float(b["x"]), float(b["y"])) for b in blocks] == [
    (700000 + CELL * (column + 0.5), 4000000 + CELL * (SIZE - row - 0.5)) for row, column in SOURCES]
for one, (shape, volume, edges) in zip(blocks, (("box", 0.4, True), ("box", math.pi / 6 * 0.4, True), (
        "icosahedron", math.pi / 6 * (2.3 / 3) ** 3, False), ("box", math.pi / 4 * 0.4, True))):
    assert one["shape"] == shape and abs(float(one["volume"]) - volume) < 1e-5 and one["density"] == "2700", one
    assert (one["lx"], one["ly"], one["lz"]) == (("1", "0.8", "0.5") if edges else ("", "", "")), one
assert folder_in.block(2, 1.0, 1.0, 0.9)[0] == "icosahedron"

# Ground: four classes, heights rounded up to a centimetre.
classes = rows_of("study/ground.csv")
assert [(c["preset"], c["rg70"], c["rg20"], c["rg10"]) for c in classes] == [
    ("Talus", "0", "0", "0"), ("Talus", "0.05", "0.1", "0.26"), ("Rock", "0", "0", "0"), ("Rock", "0.05", "0.1", "0.26")]
number = gdal.Open("study/ground.asc").ReadAsArray()
assert (number == np.where(rows < 100, 3, 1) + stones).all()

# Forest: counts, diameters and conifers within four standard deviations of what is asked.
stems = rows_of("study/trees.csv")
assert abs(len(stems) - 800) < 4 * math.sqrt(800), len(stems)
diameters = np.array([float(s["diameter"]) for s in stems])
assert abs(diameters.mean() - 30) < 4 * 6 / math.sqrt(800) and abs(diameters.std() - 6) < 4 * 6 / math.sqrt(1600)
spruce = np.mean([s["factor"] == "0.9" for s in stems])
assert abs(spruce - 0.25) < 4 * math.sqrt(0.25 * 0.75 / 800), spruce
x, y = (np.array([float(s[name]) for s in stems]) for name in "xy")
assert x.min() >= 700200 and x.max() <= 700300 and y.min() >= 4000200 and y.max() <= 4000400
run("rockyfor3d.py", "in", "folder", "other", "--seed", "5")
assert rows_of("other/trees.csv") == stems

# Names as other programs write them.
shutil.copytree("folder", "capitals")
for name in os.listdir("capitals"):
    stem, end = os.path.splitext(name)
    os.rename(f"capitals/{name}", f"capitals/{stem.upper()}{end.upper() if end == '.asc' else end}")
os.rename("capitals/DEM.ASC", "capitals/Dem.asc")
shutil.rmtree("other")
run("rockyfor3d.py", "in", "capitals", "other", "--seed", "5")
for name in ("sources.csv", "trees.csv", "nets.csv", "ground.csv", "dem.asc"):
    with open(f"study/{name}", "rb") as one, open(f"other/{name}", "rb") as same:
        assert one.read() == same.read(), name
shutil.copy("folder/dem.asc", "capitals/dem.asc")
assert "capitals has Dem.asc and dem.asc: which one is it?" in run("rockyfor3d.py", "in", "capitals", "other")

# The net: along its cells, with its numbers.
line, = rows_of("study/nets.csv")
assert (line["name"], line["height"], line["capacity"]) == ("net 7", "3", "500"), line
points = [tuple(map(float, p.split())) for p in line["WKT"][11:-1].split(",")]
assert len(points) == 40 and {p[0] for p in points} == {700323.0, 700325.0}, points
assert {points[0][1], points[-1][1]} == {4000161.0, 4000239.0}, points

# A straight net of an even number of cells has a point in each.
for name, value in (("net_number", only([(row, 160) for row in range(80, 120)], 9)), ("net_energy", 500), ("net_height", 3)):
    grid(name, value, "capitals")
    os.remove(f"capitals/{name.upper()}.ASC")
os.remove("capitals/dem.asc")
run("rockyfor3d.py", "in", "capitals", "other")
assert rows_of("other/nets.csv")[0]["WKT"].count(",") == 39

# A net in two pieces is two lines: there is none in the gap.
grid("net_number", only([(row, 160) for row in range(80, 120) if not 95 <= row < 105], 9), "capitals")
run("rockyfor3d.py", "in", "capitals", "other")
assert [(row["name"], row["WKT"].count(",")) for row in rows_of("other/nets.csv")] == [("net 9", 14), ("net 9, part 2", 14)]

# The study runs, for two seconds; its map goes out on the map's own grid.
with open("study/study.json") as file:
    study = json.load(file)
study["simulation"]["EndTime"] = 4.0
write_text("study/study.json", json.dumps(study))
said = run("study.py", "results", "study/study.json")
assert "Done: results" in said, said
said = run("rockyfor3d.py", "out", "results", "rasters")
assert "E_95CI.asc: KineticEnergy95, kJ" in said and "Ph_95CI.asc" in said, said
map_ = gdal.Open("results/hazard.tif")
bands = {map_.GetRasterBand(k + 1).GetDescription(): map_.GetRasterBand(k + 1).ReadAsArray() for k in range(map_.RasterCount)}
came = bands["Rocks"] > 0
assert came.sum() > 12
for name, expected in (("E_95CI", np.where(came, bands["KineticEnergy95"] / 1000.0, -9999)),
                       ("Ph_95CI", np.where(came, bands["HeightOverGround95"], -9999)),
                       ("E_mean", np.where(came, bands["KineticEnergyMean"] / 1000.0, -9999)),
                       ("Nr_deposited", bands["StoppingPoints"]), ("Nr_passages", bands["Passages"]),
                       ("Reach_probability", 100.0 * bands["ReachProbability"])):
    raster = gdal.Open(f"rasters/{name}.asc")
    assert raster.GetDriver().ShortName == "AAIGrid" and raster.GetGeoTransform() == map_.GetGeoTransform(), name
    assert raster.GetRasterBand(1).GetNoDataValue() == -9999 and "UTM" in raster.GetProjection(), name
    assert np.allclose(raster.ReadAsArray(), expected, rtol=2e-6, atol=1e-9), name
rested = sum(row["Fate"] == "rested" for row in rows_of("results/summary.csv"))
assert gdal.Open("rasters/Nr_deposited.asc").ReadAsArray().sum() == rested > 0, rested
assert gdal.Open("rasters/Nr_passages.asc").ReadAsArray().sum() >= 12


# What does not fit: a study that is there stays as it was, and an empty folder empty.
there = files_of("other")
for name in ("empty", "fresh"):
    shutil.rmtree(name, ignore_errors=True)
    os.makedirs(name)


def refused(word, name, values=None, **more):
    shutil.rmtree("bad", ignore_errors=True)
    shutil.copytree("folder", "bad")
    if values is None:
        os.remove(f"bad/{name}.asc")
    elif isinstance(values, str):
        write_text(f"bad/{name}.asc", values)
    else:
        grid(name, values, "bad", **more)
    for target, files in (("other", there), ("empty", {})):
        message = run("rockyfor3d.py", "in", "bad", target)
        assert word in message and "bad" in message and "\n" not in message, (word, message)
        assert files_of(target) == files, (word, sorted(files_of(target)))


refused("has no dem.asc", "dem")
refused("has no rg20.asc", "rg20")
refused("has nrtrees.asc, but no dbhstd.asc", "dbhstd")
refused("has net_number.asc, but no net_energy.asc", "net_energy")
refused("d2.asc is not a raster in ESRI ASCII", "d2", "nonsense")


def text_of(name, old, new):
    with open(f"folder/{name}.asc", encoding="utf-8") as file:
        text = file.read()
    assert old in text, (name, old)
    return text.replace(old, new, 1)


# What is no number is no 0, and nothing is missing or too much.
refused("rockdensity.asc: row 101, column 11 is 2700kg, it must be a number", "rockdensity", text_of("rockdensity", "2700", "2700kg"))
refused("dem.asc: row 1, column 1 is #REF!, it must be a number", "dem", text_of("dem", "318.4", "#REF!"))
refused("soiltype.asc: row 1, column 1 is nan", "soiltype", text_of("soiltype", "6 ", "nan "))
refused("d1.asc has 39999 numbers, ncols 200 and nrows 200 make 40000", "d1", text_of("d1", "0 0\n", "0\n"))
refused("d1.asc has 40001 numbers", "d1", text_of("d1", "0 0\n", "0 0 0\n"))
refused("d1.asc: ncols is 200x, it must be a number of 1 or more", "d1", text_of("d1", "ncols 200", "ncols 200x"))
# Each axis as it says; a word may stand for nodata.
text = text_of("d3", "yllcorner 4000000", "yllcenter 4000001").replace("NODATA_value -9999", "NODATA_value null")
write_text("centre.asc", text.replace("0 0\n", "null 0,5\n", 1))
read = grids.Grid.read("centre.asc")
assert (read.west, read.north) == (700000.0, 4000400.0) and np.isnan(read.values[0, -2]) and read.values[0, -1] == 0.5
refused("d2.asc: west edge is 700001, that of dem.asc is 700000", "d2", only(SOURCES, 0.8), corner=(700001, 4000000))
refused("soiltype.asc: there is a value 8", "soiltype", 8)
refused("soiltype.asc: there is a value 2.5, they must be whole numbers from 0 to 7", "soiltype", 2.5)
refused("rockdensity.asc: there is a value 27000 kg/m³", "rockdensity", only(SOURCES, 27000))
refused("there are no sources", "rockdensity", 0)
refused("d3.asc: row 101, column 11 is 0", "d3", 0)
refused("rg70 must not be above rg20", "rg70", 0.3)
refused("does it count by hectare or by cell", "nrtrees", 100000)
refused("dbhmean.asc: row 1, column 101 is 0 cm", "dbhmean", 0)
refused("net 7 has the height 0 m", "net_height", 0)
refused("net_energy.asc: row 101, column 163 of net 7 is 0 kJ, another cell of it 500 kJ", "net_energy", only(net[:20], 500))
# Too many classes for any step: obstacles are at most as high as the highest.
many = {name: grids.Grid(name, values, 0.0, 400.0, 2.0) for name, values in (
    ("dem", rows * 1.0), ("soiltype", columns % 8.0), ("rg70", rows / 10.0), ("rg20", rows / 10.0 + columns / 50.0),
    ("rg10", rows / 10.0 + columns / 10.0))}
assert folder_in.ground(many, "bad")[1] == math.inf
assert max(float(row["rg10"]) for row in rows_of("bad/ground.csv")) == 39.8, rows_of("bad/ground.csv")
refused("the cells of net 7 that touch each other do not lie along one line, as one is 10.0 cells off", "net_number",
        only([(row, column) for column in (150, 170) for row in range(80, 120)] + [(120, column) for column in range(150, 171)], 7))
# Whose a file is that the new study does not have nobody knows: it is named, and nothing is written.
run("rockyfor3d.py", "in", "folder", "other", "--seed", "5")
there = files_of("other")
shutil.rmtree("bad")
shutil.copytree("folder", "bad")
for name in ("net_number", "net_energy", "net_height"):
    os.remove(f"bad/{name}.asc")
os.remove("bad/dem.prj")
for name in ("dem.prj", "ground.prj", "nets.csv"):
    message = run("rockyfor3d.py", "in", "bad", "other")
    assert message == f"other/{name} is not of this study: remove it, or take another folder", message
    assert files_of("other") == there
    os.remove(f"other/{name}")
    del there[name]
run("rockyfor3d.py", "in", "bad", "other", "--seed", "5"), run("rockyfor3d.py", "in", "bad", "fresh", "--seed", "5")
assert files_of("other") == files_of("fresh") and "nets.csv" not in files_of("other")
there = files_of("bad")
assert run("rockyfor3d.py", "in", "bad", "./bad") == "./bad is the folder of the rasters: take another one"
assert files_of("bad") == there
assert "--iterations is 0" in run("rockyfor3d.py", "in", "folder", "other", "--iterations", "0")
assert "it has no results.json" in run("rockyfor3d.py", "out", "folder", "rasters")
os.remove("results/hazard.tif")
assert "results has no hazard.tif" in run("rockyfor3d.py", "out", "results", "rasters")
print("a folder of Rockyfor3D comes in and goes out")
