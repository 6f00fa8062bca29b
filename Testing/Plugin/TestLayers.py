"""Files that hold rasters and layers side by side: which is read, that a note says so, and that more than
one which would do is an error that lists them. What each property for a layer or a sheet does."""

import json
import subprocess

import numpy as np
from helpers import UTM16, write_grid, write_text

from paraview import servermanager
from paraview.simple import (
    DEMtoCFEMesh, OutputPort, RockBlocks, RockfallSimulation, TrajectoryCollector, UpdatePipeline)
from vtkmodules.util.numpy_support import vtk_to_numpy

WEST, SOUTH = 700000, 4000000


def call(*words):
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)


def texts(data, name):
    array = data.GetFieldData().GetAbstractArray(name)
    return [array.GetValue(k) for k in range(array.GetNumberOfValues())] if array else []


def result(source):
    UpdatePipeline(proxy=source)
    data = servermanager.Fetch(source)
    return data, " ".join(texts(data, "Error")), " ".join(texts(data, "Notes"))


def slope(**properties):
    """Lowest and highest ground, error and notes."""
    data, error, notes = result(DEMtoCFEMesh(**properties))
    heights = data.GetFieldData().GetAbstractArray("TerrainHeights")
    heights = vtk_to_numpy(heights) if heights else np.array([np.nan])
    return np.nanmin(heights), np.nanmax(heights), error, notes


def layer(name, features):
    return write_text(name, json.dumps({
        "type": "FeatureCollection",
        "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32616"}},
        "features": [{"type": "Feature", "properties": properties,
                      "geometry": {"type": kind, "coordinates": places}}
                     for kind, places, properties in features]}))


def package(name, *parts):
    """A GeoPackage of rasters (name, file, options) and layers (name, file)."""
    call("rm", "-f", name)
    for k, (title, file, *options) in enumerate(parts):
        if file.endswith(".json"):
            call("ogr2ogr", *(["-update"] if k else []), "-f", "GPKG", "-nln", title, name, file)
        else:
            call("gdal_translate", "-q", "-of", "GPKG", "-co", f"RASTER_TABLE={title}",
                 *(["-co", "APPEND_SUBDATASET=YES"] if k else []), *options, file, name)
    return name


dem = write_grid("dem.asc", [[200 - 5 * c for c in range(31)] for _ in range(21)])
high = write_grid("high.asc", [[900 - 5 * c for c in range(31)] for _ in range(21)])
contours = layer("contours.json", [
    ("LineString", [[WEST + 2 * (50 - z), SOUTH], [WEST + 2 * (50 - z), SOUTH + 100]], {"elev": z})
    for z in range(50, -1, -10)])
road = layer("road.json", [("LineString", [[WEST + 100, SOUTH], [WEST + 100, SOUTH + 200]], {"name": "road"})])
place = layer("place.json", [("Point", [WEST + 55, SOUTH + 105], {"name": "a"})])
FLOAT = ("-ot", "Float32", "-a_srs", "EPSG:32616")
call("gdal_translate", "-q", "-ot", "Byte", "-b", "1", "-b", "1", "-b", "1", "-colorinterp", "red,green,blue",
     "-a_srs", "EPSG:32616", "dem.asc", "picture.tif")

# A picture is no slope where there are contours beside it.
package("picture.gpkg", ("basemap", "picture.tif", "-co", "TILE_FORMAT=PNG"), ("contours", contours))
low, top, error, notes = slope(FileName="picture.gpkg")
assert not error and abs(top - 50) < 1 and '"contours", which was taken' in notes, (error, top, notes)
low, top, error, notes = slope(FileName="picture.gpkg", LayerName="Basemap")
assert not error and top > 150, (error, top)

# A raster of heights and contours: it must be said.
package("both.gpkg", ("dem", "dem.asc", *FLOAT), ("contours", contours))
low, top, error, notes = slope(FileName="both.gpkg")
assert "both.gpkg" in error and '"contours"' in error and "LayerName" in error, error
assert abs(slope(FileName="both.gpkg", LayerName="contours")[1] - 50) < 1
assert abs(slope(FileName="both.gpkg", LayerName="dem")[1] - 200) < 1
error = slope(FileName="both.gpkg", LayerName="dam")[2]
assert 'no raster or layer "dam" (LayerName)' in error and '"contours"' in error, error

# Several rasters: in a GeoPackage, in a netCDF file.
package("two.gpkg", ("dem", "dem.asc", *FLOAT), ("high", "high.asc", *FLOAT))
error = slope(FileName="two.gpkg")[2]
assert '2 rasters that would do, "dem", "high"' in error, error
assert abs(slope(FileName="two.gpkg", LayerName="HIGH")[1] - 900) < 1
call("gdalbuildvrt", "-q", "-separate", "-a_srs", "EPSG:32616", "two.vrt", "dem.asc", "high.asc")
call("gdal_translate", "-q", "-of", "netCDF", "two.vrt", "two.nc")
error = slope(FileName="two.nc")[2]
assert '2 rasters that would do, "Band1", "Band2"' in error, error
assert abs(slope(FileName="two.nc", LayerName="band2")[1] - 900) < 1

# Sources, and lines of a collector.
package("site.gpkg", ("roads", road), ("release points", place))
ground = DEMtoCFEMesh(FileName=dem)
data, error, notes = result(RockBlocks(Terrain=ground, FileName="site.gpkg"))
assert not error and '"release points" was taken (LayerName' in notes, (error, notes)
rocks = RockBlocks(Terrain=ground, FileName="site.gpkg", LayerName="release points")
data, error, notes = result(rocks)
bounds = data.GetBounds()
assert not error and abs((bounds[0] + bounds[1]) / 2 - WEST - 55) < 1e-6, (error, bounds)
fall = RockfallSimulation(Terrain=ground, Rocks=rocks, EndTime=2)
collector = TrajectoryCollector(Input=OutputPort(fall, 1), Terrain=ground, FileName="site.gpkg")
data, error, notes = result(collector)
assert not error and '"roads" was taken (LayerName' in notes, (error, notes)
collector.LayerName = "release points"
data, error, notes = result(collector)
assert "a LINESTRING is needed" in error, error

# Structures by name.
nets = layer("nets.json", [("LineString", [[WEST + 100, SOUTH + 10], [WEST + 100, SOUTH + 190]], {"height": 4})])
old = layer("old.json", [("LineString", [[WEST + 90, SOUTH + 10], [WEST + 90, SOUTH + 190]], {"height": 2})])
package("nets.gpkg", ("nets", nets), ("old nets", old))
error = slope(FileName=dem, BarrierFile="nets.gpkg")[2]
assert 'nets.gpkg: has 2 layers that would do, "nets", "old nets"; say in BarrierLayerName' in error, error
error = slope(FileName=dem, BarrierFile="nets.gpkg", BarrierLayerName="old nets")[2]
assert not error, error
print("one layer of several, by name or because it alone will do")
