"""What is saved opens in the right place, says GDAL with its own tools: maps as GeoTIFF, trajectories,
impacts and crossings as GeoPackage and CSV. ParaView's own writer of TIFF pictures is still there."""

import glob
import json
import os
import re
import subprocess
import sys
from xml.etree import ElementTree

from helpers import errors_of, incline, messages_of, write_grid

from paraview import servermanager
from paraview.simple import (
    DEMtoCFEMesh, OutputPort, PolyLineSource, RockBlocks, RockfallHazardMap, RockfallSimulation,
    SaveData, TrajectoryCollector, Wavelet)

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Examples", "study_parts"))
import gis


def run(*command, text=None):
    done = subprocess.run(command, input=text, capture_output=True, text=True)
    assert done.returncode == 0, (command, done.stdout, done.stderr)
    return done.stdout


# A slope in UTM zone 16 that falls along +x; nodes at the centres of the cells, from (700005, 4000005).
dem = DEMtoCFEMesh(FileName=write_grid("slope.asc", incline(drop=5.0)), FrictionAngle=20,
                   RoughnessDeviation=0.05)
rocks = RockBlocks(Center=[700035, 4000105, 140], Volume=1, AttitudeLaw="As given")
fall = RockfallSimulation(Terrain=dem, Rocks=rocks, EndTime=20, Iterations=8)
hazard = RockfallHazardMap(Input=OutputPort(fall, 1), CropToTrajectories=0,
                           Statistics=["Mean", "Maximum", "95 %", "99 %"])
road = PolyLineSource(Points=[700100, 4000000, 0, 700100, 4000210, 0])
collector = TrajectoryCollector(Input=OutputPort(fall, 1), Lines=road, Terrain=dem)
for old in {*glob.glob("*.tif*"), *glob.glob("*.gpkg"), *glob.glob("paths.*")}:
    os.remove(old)

# The map: its cells lie between the nodes.
said = messages_of(lambda: SaveData("map.tif", proxy=hazard))
assert "ERR|" not in said, said
info = json.loads(run("gdalinfo", "-json", "map.tif"))
assert info["driverShortName"] == "GTiff"
assert info["metadata"]["IMAGE_STRUCTURE"]["LAYOUT"] == "COG", info["metadata"]
assert re.match(r"RockfallDDA \d+\.\d+\.\d+$", info["metadata"][""]["TIFFTAG_SOFTWARE"]), info["metadata"]
assert info["size"] == [30, 20], info["size"]
assert info["geoTransform"] == [700005, 10, 0, 4000205, 0, -10], info["geoTransform"]
assert "UTM zone 16N" in info["coordinateSystem"]["wkt"]
names = [band["description"] for band in info["bands"]]
assert names[:4] == ["Passages", "Rocks", "StoppingPoints", "ReachProbability"], names
assert {"KineticEnergy95", "SpeedMean", "HeightOverGroundMaximum", "RotationRate99"} <= set(names)
assert "Speed90" not in names, names
assert all(band["noDataValue"] == "NaN" for band in info["bands"])
assert info["bands"][names.index("KineticEnergy95")]["unit"] == "J"


def pixel(name, x, y):
    return float(run("gdallocationinfo", "-valonly", "-geoloc", "-b", str(names.index(name) + 1),
                     "map.tif", str(x), str(y)))


assert pixel("Rocks", 700035.0, 4000105.0 - 0.5) + pixel("Rocks", 700035.0, 4000105.0 + 0.5) >= 8
assert pixel("Rocks", 700250.0, 4000015.0) == 0
image = servermanager.Fetch(hazard)
for place in [(700040.5, 4000104.5), (700100.0, 4000100.0), (700060.0, 4000110.0)]:
    column, row = (int((place[k] - image.GetOrigin()[k]) // image.GetSpacing()[k]) for k in (0, 1))
    cell = row * 30 + column
    for name in ("Rocks", "SpeedMaximum"):
        here = image.GetCellData().GetArray(name).GetTuple1(cell)
        there = pixel(name, *place)
        assert here == there or (here != here and there != there) or \
            abs(here - there) < 1e-5 * abs(here), (place, name, here, there)

# ParaView's own writer of TIFF pictures has the extension tiff: it keeps all other images.
SaveData("map.tiff", proxy=hazard)
SaveData("picture.tiff", proxy=Wavelet(WholeExtent=[0, 9, 0, 9, 0, 0]))
assert json.loads(run("gdalinfo", "-json", "map.tiff"))["bands"][1]["description"] == "Rocks"
info = json.loads(run("gdalinfo", "-json", "picture.tiff"))
assert info["size"] == [10, 10] and "Rocks" not in json.dumps(info), info

# Trajectories as lines with time as measure, and where they end.
said = messages_of(lambda: SaveData("paths.gpkg", proxy=OutputPort(fall, 1), WriteSamples=1))
assert "ERR|" not in said, said
layers = run("ogrinfo", "-so", "-al", "paths.gpkg")
for layer, count in (("trajectories", 8), ("ends", 8)):
    assert re.search(rf"Layer name: {layer}\n(.*\n){{1,6}}Feature Count: {count}\n", layers), layers
assert layers.count('ID["EPSG",32616]') == 3 or layers.count("UTM zone 16N") >= 3, layers
assert "Measured" in layers and "Layer name: samples" in layers, layers
for name, port, words in (("samples.csv", 1, "a CSV file has one layer"), ("samples.gpkg", 2, "the Input has no lines")):
    said = messages_of(servermanager.writers.TrajectoryLayerWriter(
        Input=OutputPort(fall, port), FileName=os.path.abspath(name), WriteSamples=1).UpdatePipeline)
    assert f"{name}: WriteSamples is on, but has no effect: {words}" in said and "ERR|" not in said, said
for field in ("BlockId: Integer64", "Volume: Real", "VelocityX: Real", "Mass: Real"):
    assert field in layers, field
extent = [float(n) for n in re.findall(
    r"Layer name: trajectories\n(?:.*\n)*?Extent: \((.*?), (.*?)\) - \((.*?), (.*?)\)", layers)[0]]
bounds = fall.GetDataInformation(1).GetBounds()
assert max(abs(a - b) for a, b in zip(extent, [bounds[0], bounds[2], bounds[1], bounds[3]])) < 1e-3
first = run("ogrinfo", "-q", "-fid", "1", "paths.gpkg", "trajectories")
assert re.search(r"LINESTRING ZM \(700035 4000105 140 0,", first), first[:500]

# Impacts and crossings as points.
for name, proxy, port in (("impacts", fall, 2), ("crossings", collector, 0)):
    SaveData(name + ".gpkg", proxy=OutputPort(proxy, port))
    layers = run("ogrinfo", "-so", "-al", name + ".gpkg")
    count = proxy.GetDataInformation(port).GetNumberOfPoints()
    assert count > 0 and f"Feature Count: {count}\n" in layers and "3D Point" in layers, layers
assert "LineName: String" in layers and "CaughtShare" not in layers, layers
assert re.search(r"Extent: \(700100\.0+, 4000[01]", layers), layers

# QGIS finds a style for every layer, with units; energies in the classes of a study's tables.
def styles_of(path):
    rows = json.loads(run("ogr2ogr", "-f", "GeoJSON", "/vsistdout/", path, "layer_styles"))["features"]
    assert all(row["properties"]["useAsDefault"] for row in rows), rows
    return {row["properties"]["f_table_name"]: ElementTree.fromstring(row["properties"]["styleQML"]) for row in rows}


styles = styles_of("paths.gpkg")
assert {name: style.find("renderer-v2").get("type") for name, style in styles.items()} == {
    "trajectories": "singleSymbol", "ends": "categorizedSymbol", "samples": "graduatedSymbol"}, styles
assert [(one.get("value"), one.get("label")) for one in styles["ends"].iter("category")] == list(zip("012345", (
    "rested", "left the domain", "moving", "caught", "lost in nodata", "broken"))), styles["ends"]
crossing = styles_of("crossings.gpkg")["points"]
aliases = {one.get("field"): one.get("name") for one in crossing.iter("alias")}
assert aliases["KineticEnergy"] == "KineticEnergy (J)" and aliases["Mass"] == "Mass (kg)" and "Line" not in aliases
for name in ("KineticEnergy", "Mass", "VelocityX", "Time", "Distance", "HeightOverGround", "VerticalAngle", "Width"):
    assert aliases[name].endswith(f" ({gis.unit_of(name)})"), name
other = ElementTree.fromstring(gis.table_style(["KineticEnergy"], "KineticEnergy"))
for kind, values in (("range", lambda one: (float(one.get("lower")), float(one.get("upper")), one.get("label"))),
                     ("prop[@k='color']", lambda one: one.get("v"))):
    assert [values(one) for one in crossing.iterfind(f".//{kind}")] == [values(one) for one in other.iterfind(f".//{kind}")]

# CSV with geometry, types and CRS.
writer = servermanager.writers.TrajectoryLayerWriter(
    Input=OutputPort(fall, 1), FileName=os.path.abspath("paths.csv"))
writer.UpdatePipeline()
layers = run("ogrinfo", "-so", "-al", "paths.csv")
assert "Feature Count: 8" in layers and "UTM zone 16N" in layers, layers
assert f"{bounds[0]:.6f}" in layers, layers

# What cannot be written is one error, and leaves nothing.
for name, proxy in (("no/map.tif", hazard), ("no/paths.gpkg", OutputPort(fall, 1))):
    said = messages_of(lambda: SaveData(name, proxy=proxy))
    assert said.count("ERR|") == 1 and name in said and "no folder" in said, said
assert not glob.glob("*.part.*"), os.listdir(".")
assert not errors_of(collector)
print("what is saved is where it should be")
