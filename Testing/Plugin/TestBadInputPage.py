"""docs/bad_input.md says for every message about bad input what to do. Each mistake is made here: the input is
given to ParaView, there is one error and no result. docs/data/bad_input.csv has the messages word by word; when
they differ, the table as it should be is left in this test's folder."""

import contextlib
import csv
import difflib
import io
import json
import os
import re
import runpy
import shutil
import sys

from helpers import errors_of, incline, is_empty, messages_of, write_grid, write_text, UTM16, WGS84

from paraview.simple import (
    BarrierDesign, DEMtoCFEMesh, Delete, GetSources, HazardPassageReader, MergeCollectors, OutputPort, RockBlocks,
    RockfallHazardMap, RockfallSimulation, TrajectoryCollector, UpdatePipeline)
from paraview import servermanager

HERE = os.path.dirname(os.path.abspath(__file__))
PAGE = os.path.join(HERE, "..", "..", "docs", "bad_input.md")
STUDY = os.path.join(HERE, "..", "..", "Examples", "study.py")
TABLE = os.path.join(HERE, "..", "..", "docs", "data", "bad_input.csv")

sections = []  # (title, [(what is wrong, message)])
failures = []


def section(title):
    sections.append((title, []))


def row(wrong, text):
    text = re.sub(r"^\w+ \(0x[0-9a-f]+\): ", "", text)
    text = text.replace(os.getcwd() + "/", "")
    text = re.sub(r"this machine has [\d.]+ GB", "this machine has … GB", text)
    text = text.replace("recognized as being in a supported", "recognized as a supported")  # as GDAL 3.6 says it
    text = re.sub(r"(At line \d+), character \d+", r"\1", text)  # which GDAL 3.13 counts otherwise
    sections[-1][1].append((wrong, text.replace("\n", " ")))


def one(wrong, proxy, ports=1, own=None):
    """The proxy has one error and makes nothing."""
    errors = errors_of(proxy, *range(ports))
    name = f"{sections[-1][0]}, {wrong}"
    if len(errors) != 1:
        failures.append(f"{name}: {len(errors)} errors instead of one: {errors}")
    if not all(is_empty(proxy, port) for port in range(ports)):
        failures.append(f"{name}: there is a result all the same")
    row(wrong, errors[0] if errors else "no error")
    Delete(proxy)


def dem(wrong, **properties):
    one(wrong, DEMtoCFEMesh(**properties))


def rocks(wrong, **properties):
    one(wrong, RockBlocks(**properties))


def features(geometries, properties="", crs="EPSG::32616"):
    """GeoJSON of these geometries."""
    return ('{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:' +
            crs + '"}},"features":[' + ",".join(
                '{"type":"Feature","properties":{' + properties + '},"geometry":' + g + "}"
                for g in geometries) + "]}")


SQUARE = '{"type":"Polygon","coordinates":[[[10,10],[30,10],[30,30],[10,30],[10,10]]]}'
BOW = '{"type":"Polygon","coordinates":[[[10,10],[30,30],[30,10],[10,30],[10,10]]]}'
LINE = '{"type":"LineString","coordinates":[[60,0],[60,100]]}'
POINT = '{"type":"Point","coordinates":[20,50]}'
good = write_grid("good.asc", incline(5, 5))

section("DEM and other grids")
dem("missing", FileName="missing.tif")
dem("empty", FileName=write_text("empty.tif", ""))
dem("wrong type: a text", FileName=write_text("letter.tif", "Dear reader\n"))
dem("wrong type: a vector layer", FileName=write_text("points.geojson", features([POINT])))
cut = write_grid("cut.asc", incline(5, 5))
text = open(cut).read().split("\n")
dem("truncated", FileName=write_text("cut.asc", "\n".join(text[:-2]) + "\n"))
write_text("raw.hdr", "ENVI\nsamples = 30\nlines = 40\nbands = 1\nheader offset = 0\nfile type = "
           "ENVI Standard\ndata type = 4\ninterleave = bsq\nbyte order = 0\n"
           "map info = {UTM, 1, 1, 600000, 5100000, 10, 10, 32, North, WGS-84}\n")
dem("truncated, binary", FileName=write_text("raw.dat", "\1" * 3000))
dem("one row only", FileName=write_grid("row.asc", [[1, 2, 3, 4]]))
dem("all of it nodata", FileName=write_grid("nodata.asc", [[-9999] * 4] * 4))
dem("a nodata value that is not declared", FileName=write_grid(
    "undeclared.asc", [[1.5, 2, 3], [4, -32768, 6], [7, 8, 9]]))
dem("the usual nodata value, not declared", FileName=write_text(
    "undeclared.asc", "ncols 3\nnrows 2\nxllcorner 700000\nyllcorner 4000000\ncellsize 10\n"
    "1.5 2 3\n4 -9999 6\n"))
dem("a mosaic of tiles with a gap, and no nodata value", FileName=write_text("mosaic.vrt", (
    '<VRTDataset rasterXSize="8" rasterYSize="2"><GeoTransform>700000, 10, 0, 4000020, 0, -10'
    '</GeoTransform><VRTRasterBand dataType="Float32" band="1"><SimpleSource><SourceFilename '
    'relativeToVRT="1">good.asc</SourceFilename><DstRect xOff="0" yOff="0" xSize="4" ySize="2"/>'
    '</SimpleSource></VRTRasterBand></VRTDataset>')))
dem("NaN", FileName=write_grid("nan.asc", [[1.5, 2, 3], [4, "nan", 6], [7, 8, 9]]))
dem("infinite", FileName=write_grid("inf.asc", [[1.5, 2, 3], [4, "inf", 6], [7, 8, 9]]))
dem("a word", FileName=write_grid("word.asc", [[1.5, 2, 3], [4, "high", 6], [7, 8, 9]]))
dem("a word in a GRASS grid", FileName=write_text(
    "grass.txt", "north: 4000020\nsouth: 4000000\neast: 700030\nwest: 700000\nrows: 2\ncols: 3\n"
    "1 high 3\n4 5 6\n"))
dem("a factor that is none", FileName=write_text(
    "grass.txt", "north: 4000020\nsouth: 4000000\neast: 700030\nwest: 700000\nrows: 2\ncols: 3\n"
    "multiplier: ten\n1 2 3\n4 5 6\n"))
dem("a place along one axis", FileName=write_text(
    "half.asc", "ncols 3\nnrows 2\nxllcorner 700000\ncellsize 10\n1 2 3\n4 5 6\n"))
dem("a virtual raster of a file that is not beside it", FileName=write_text("reach.vrt", (
    '<VRTDataset rasterXSize="2" rasterYSize="2"><VRTRasterBand dataType="Byte" band="1">'
    '<SimpleSource><SourceFilename>/etc/hostname</SourceFilename></SimpleSource></VRTRasterBand>'
    '</VRTDataset>')))
dem("an address", FileName="/vsicurl/http://127.0.0.1:9/dem.tif")
write_text("good.asc.aux.xml", (
    '<PAMDataset><Metadata domain="OVERVIEWS"><MDI key="OVERVIEW_FILE">/etc/hostname</MDI></Metadata></PAMDataset>'))
dem("overviews that are not beside it", FileName="good.asc")
os.remove("good.asc.aux.xml")
dem("a CRS that is a link", FileName=write_text("link.geojson", (
    '{"type":"FeatureCollection","crs":{"type":"link","properties":{"href":"http://127.0.0.1:9/crs"}},"features":['
    '{"type":"Feature","properties":{"elev":1},"geometry":' + LINE + "}]}")))
dem("SQL in a virtual layer", FileName=write_text("sql.vrt", (
    '<OGRVRTDataSource><OGRVRTLayer name="a"><SrcDataSource relativeToVRT="1">link.geojson</SrcDataSource>'
    '<SrcSQL>SELECT elev FROM link</SrcSQL></OGRVRTLayer></OGRVRTDataSource>')))
dem("a raster that is empty but for its size", FileName=write_text("huge.vrt", (
    '<VRTDataset rasterXSize="40000" rasterYSize="40000"><GeoTransform>0,5,0,100,0,-5'
    '</GeoTransform><VRTRasterBand dataType="Float32" band="1"><NoDataValue>-9999</NoDataValue>'
    '</VRTRasterBand></VRTDataset>')))
comma = DEMtoCFEMesh(FileName=write_grid("comma.asc", [[1, 2, 3], [4, "9,75", 6], [7, 8, 9]]))
UpdatePipeline(proxy=comma)
if comma.GetDataInformation().GetBounds()[5] != 9.75:
    failures.append(f"comma in a grid: {comma.GetDataInformation().GetBounds()}")
row("comma as decimal mark in an ASCII grid", "no error: as GDAL does, 9,75 is read as 9.75")
Delete(comma)
dem("degrees without a CRS",
    FileName=write_grid("degrees.asc", incline(5, 5), corner=(-84.5, 36.5), cell=0.001, crs=None))
dem("wrong CRS: metres that are called degrees",
    FileName=write_grid("called.asc", incline(5, 5), crs=WGS84))
dem("wrong CRS: half of the world",
    FileName=write_grid("world.asc", incline(5, 5), corner=(-60, -40), cell=20, crs=WGS84))
dem("a band that is not there", FileName=good, Band=3)
dem("a cell size that is negative", FileName=good, CellSize=-1.0)
dem("a cell size in kilometres", FileName=good, CellSize=0.000001)
dem("a cell size larger than the slope", FileName=good, CellSize=1000.0)
steep = DEMtoCFEMesh(FileName=write_grid("feet.asc", incline(11, 11, drop=23.0)))
notes = re.findall(r".*metres\?", messages_of(lambda: UpdatePipeline(proxy=steep)))
if len(notes) != 1:
    failures.append(f"heights in feet: {notes}")
row("heights in feet that nothing says are feet (a note, no error)", re.sub(r"^.*\|\s*", "", "".join(notes)))
Delete(steep)

section("Contour lines")
dem("missing", FileName="missing.gpkg")
dem("empty", FileName=write_text("none.csv", "WKT,elev\n"))
dem("truncated", FileName=write_text("cut.geojson", features([LINE] * 3, '"elev":10')[:-70]))
dem("wrong type: points",
    FileName=write_text("points.csv", 'WKT,elev\n"POINT(0 0)",10\n"POINT(0 30)",20\n'))
two = 'WKT,{}\n"LINESTRING(0 0,50 0)",{}\n"LINESTRING(0 30,50 30)",20\n'
dem("no field of heights", FileName=write_text("field.csv", two.format("h", 10)))
dem("a field of heights that is not there",
    FileName=write_text("field.csv", two.format("h", 10)), ElevationField="cote")
dem("two fields that may be heights", FileName=write_text("both.csv", (
    'WKT,level,contour\n"LINESTRING(0 0,50 0)",1,510\n"LINESTRING(0 30,50 30)",2,520\n')))
dem("a field and a z that differ", FileName=write_text("solid.csv", (
    'WKT,level\n"LINESTRING Z(0 0 510,50 0 510)",1\n"LINESTRING Z(0 30 520,50 30 520)",2\n')))
dem("one height only", FileName=write_text("level.csv", two.format("elev", 20)))
dem("an empty height", FileName=write_text("gap.csv", two.format("elev", "")))
dem("NaN", FileName=write_text("nan.csv", two.format("elev", "nan")))
dem("comma as decimal mark",
    FileName=write_text("comma.csv", two.replace(",{}", ";{}").replace(",20", ";20").format("elev", "10,5")))
dem("degrees without a CRS", FileName=write_text("degrees.csv", (
    'WKT,elev\n"LINESTRING(7 46,7.01 46)",1000\n"LINESTRING(7 46.01,7.01 46.01)",1200\n')))
dem("lines in a row", FileName=write_text("narrow.csv", (
    'WKT,elev\n"LINESTRING(0 0,700 0)",10\n"LINESTRING(0 0.1,700 0.1)",20\n')))

ZONES = 'WKT,class\n"POLYGON(({0} 0,{1} 0,{1} 100,{0} 100,{0} 0))",rock\n'
zones = write_text("zones.csv", ZONES.format(0, 250))
table = write_text("table.csv", "class,rv\nrock,0.8\n")

section("Layers of classes of ground")


def classes(wrong, layer, **more):
    dem(wrong, RestitutionLayer=layer, RestitutionTable=table, **more)


classes("missing", "missing.gpkg")
classes("empty", write_text("none.csv", "WKT,class\n"))
classes("truncated", write_text("cut.geojson", features([SQUARE] * 3, '"class":"rock"')[:-70]))
classes("wrong type: points", write_text("points.csv", 'WKT,class\n"POINT(0 0)",rock\n'))
classes("wrong type: a text", write_text("letter.gpkg", "Dear reader\n"))
classes("a polygon that cannot be read", write_text(
    "broken.csv", ZONES.format(0, 250) + '"POLYGON((0 0,250 0",rock\n'))
classes("no overlap, or another CRS", write_text("far.csv", ZONES.format(900, 990)))
classes("no field of classes", write_text("field.csv", ZONES.format(0, 250).replace("class", "id")))
classes("a field that is not there", zones, RestitutionField="geology")
classes("a class that the table does not have", write_text(
    "scree.csv", ZONES.format(0, 250).replace("rock", "scree")))
dem("no table with it", RestitutionLayer=zones)
classes("a grid that does not overlap", write_grid("classes.asc", [[1] * 5] * 5, crs=None))

section("Tables of classes of ground")


def bad_table(wrong, text, **more):
    dem(wrong, RestitutionLayer=zones, RestitutionTable=write_text("bad.csv", text), **more)


dem("missing", RestitutionLayer=zones, RestitutionTable="missing.csv")
bad_table("empty", "")
bad_table("a header only", "class,rv\n")
bad_table("no column of classes", "kind,rv\nrock,0.8\n")
bad_table("no column of values", "class,kind\nrock,hard\n")
bad_table("truncated", "class,rv\nrock,")
bad_table("out of range", "class,rv\nrock,1.8\n")
bad_table("negative", "class,rv\nrock,-0.1\n")
bad_table("NaN", "class,rv\nrock,nan\n")
bad_table("a word", "class,rv\nrock,hard\n")
bad_table("comma as decimal mark", 'class,rv\nrock,"0,8"\n')
bad_table("comma as decimal mark, not quoted", "class,rv\nrock,0,8\n")
bad_table("a class twice", "class,rv\nrock,0.8\nrock,0.7\n")
bad_table("a column twice", "class,rv,RV\nrock,0.8,0.7\n")
bad_table("a column by another name", "class,rv,rv_deviatoin\nrock,0.8,0.1\n")
bad_table("an unknown preset", "class,preset\nrock,cheese\n")
dem("φ in radians or grads, out of range", JointLayer=zones,
    JointTable=write_text("phi.csv", "class,phi\nrock,95\n"))

slope = DEMtoCFEMesh()  # x 0 to 250, y 0 to 100, heights from 57.7 down to 0
section("Layers of structures")


def structures(wrong, kind, text, name="layer.csv"):
    dem(wrong, **{kind: name if text is None else write_text(name, text)})


DAM = 'WKT,height,width,slope\n"LINESTRING(60 {0},60 {1})",{2},1.5,3:2\n'
TREE = "x,y,diameter,height\n60,50,{},{}\n"
NET = 'WKT,height,capacity\n"LINESTRING({0} 10,{0} 90)",{1},{2}\n'
structures("missing", "TreeFile", None, "missing.gpkg")
structures("empty", "TreeFile", "")
structures("a header only", "BarrierFile", "WKT,height,capacity\n")
structures("truncated", "TreeFile", features([POINT] * 3)[:-70], "cut.geojson")
structures("wrong type: a text", "EmbankmentFile", "Dear reader\n", "letter.gpkg")
structures("wrong type: points", "EmbankmentFile", 'WKT,height,width,slope\n"POINT(60 50)",3,1.5,3:2\n')
structures("no overlap, or another CRS", "BarrierFile", NET.format(5000, 4, 1000))
structures("an embankment without a height", "EmbankmentFile", DAM.format(20, 80, ""))
structures("an embankment under the ground", "EmbankmentFile",
           DAM.format(20, 80, 5).replace("height", "crest"))
structures("an embankment that goes beyond the slope", "EmbankmentFile", DAM.format(20, 120, 3))
structures("no diameter", "TreeFile", "x,y,height\n60,50,20\n")
structures("a diameter in millimetres", "TreeFile", TREE.format(3500, 20))
structures("a column by another name", "BarrierFile",
           NET.format(60, 4, 1000).replace("capacity", "capacity_kJ"))
structures("a diameter in metres", "TreeFile", TREE.format(0.35, 20))
structures("a height in feet, or none of a tree", "TreeFile", TREE.format(35, 328))
structures("a height of a net in centimetres", "BarrierFile", NET.format(60, 400, 1000))
structures("a capacity in J", "BarrierFile", NET.format(60, 4, 300000))
structures("negative", "BarrierFile", NET.format(60, -4, 1000))
structures("NaN", "EmbankmentFile", DAM.format(20, 80, "nan"))
structures("a word", "BarrierFile", NET.format(60, 4, "strong"))
structures("comma as decimal mark", "TreeFile", TREE.format('"32,5"', 20))
structures("comma as decimal mark, not quoted", "TreeFile", TREE.format("32,5", 20))
structures("10⁷ features", "TreeFile", "x,y,diameter,height\n" + "60,50,35,20\n" * 1_000_001, "many.csv")

section("Layers and tables of sources")


def sources(wrong, text, name="sources.csv", terrain=True, **more):
    rocks(wrong, FileName=write_text(name, text), Terrain=slope if terrain else None, **more)


rocks("missing", FileName="missing.csv", Terrain=slope)
sources("empty", "")
sources("a header only", "x,y,amount\n")
sources("truncated", features([SQUARE] * 3)[:-70], "cut.geojson")
sources("wrong type: a text", "Dear reader\n", "letter.gpkg")
sources("wrong type: a collection", features(
    ['{"type":"GeometryCollection","geometries":[' + SQUARE + "]}"]), "mixed.geojson")
sources("no places", "a,b\n1,2\n")
sources("an empty cell", "x,y,z\n20,,60\n")
sources("a word", "x,y,amount\n20,50,many\n")
sources("negative", "x,y,amount\n20,50,-3\n")
sources("NaN", "x,y,vol_dev\n20,50,nan\n")
sources("a volume of nothing", "x,y,volume\n20,50,0\n")
sources("comma as decimal mark", 'x,y,height\n20,50,"1,5"\n')
sources("comma as decimal mark, not quoted", "x,y,height\n20,50,1,5\n")
sources("an unknown shape", "x,y,shape\n20,50,ball\n")
sources("an unknown material", "x,y,material\n20,50,cheese\n")
sources("a column by another name", "x,y,materiel\n20,50,granite\n")
sources("a column twice", "x,y,volume,Volume\n20,50,1,2\n")
sources("lengths of what is no box", "x,y,shape,lx,ly,lz\n20,50,cube,1,2,3\n")
sources("a box that is too thin", "x,y,shape,lx,ly,lz\n20,50,box,1,2,1e-6\n")
sources("a polygon that crosses itself", features([BOW]), "bow.geojson")
sources("a polygon without a terrain", features([SQUARE]), "square.geojson", terrain=False)
sources("no overlap, or another CRS", "x,y\n700000,4000000\n")
site = DEMtoCFEMesh(FileName=write_grid("site.asc", incline(31, 21)))
rocks("a TargetCRS that is not the terrain's", Terrain=site, TargetCRS="EPSG:2056",
      FileName=write_text("site.geojson", features(['{"type":"Point","coordinates":[700100,4000100]}'])))
rocks("a TargetCRS that nobody knows", TargetCRS="EPSG:99999999",
      FileName=write_text("site.geojson", features(['{"type":"Point","coordinates":[700100,4000100,100]}'])))
# Of ten million no more are read than these.
sources("10⁷ features", "x,y\n" + "20,50\n" * 1_000_001, "many.csv")
sources("10⁷ rocks of one feature", "x,y,amount\n20,50,10000000\n")

section("Places of release")


def release(wrong, terrain=None, **properties):
    one(wrong, RockfallSimulation(Terrain=terrain or slope, Rocks=RockBlocks(**properties),
                                  EndTime=0.1), ports=4)


hole = incline(11, 11)
for r in range(4, 7):
    hole[r][4:7] = [-9999] * 3
holed = DEMtoCFEMesh(FileName=write_grid("holed.asc", hole))
release("beside the slope", Center=[-20, 50, 58])
release("nodata in the release cell", holed, Center=[700050, 4000050, 50])
rocks("nodata in the release cell, by a table", Terrain=holed, PlaceOnGround=1,
      FileName=write_text("hole.csv", "x,y\n700055,4000055\n"))
release("under the slope", Center=[40, 50, 34])
release("far over the slope: feet, or another reference", Center=[40, 50, 1834])
release("NaN", Center=[40, 50, float("nan")])
release("a volume that is negative", Volume=-1.0)
release("a density that is negative", Density=-2500.0)
one("springs that do not hold the rock", RockfallSimulation(
    Terrain=slope, Rocks=RockBlocks(Center=[5, 50, 58]), EndTime=0.1, NormalPenalty=1e5), ports=4)

section("Tables of contacts between rocks")
two = write_text("two.csv", "x,y,z,material,mat_name\n5,40,58,granite,\n5,60,58,,Slag\n")
CONTACTS = "material_a,material_b,restitution,phi,cohesion\n"


def contacts(wrong, text, **properties):
    one(wrong, RockfallSimulation(
        Terrain=slope, Rocks=RockBlocks(**(properties or {"FileName": two})), EndTime=0.1,
        RockRockContact=1, RockContactFile=text if text == "missing.csv" else
        write_text("contacts.csv", text)), ports=4)


contacts("missing", "missing.csv")
contacts("empty", "")
contacts("a header only", CONTACTS)
contacts("no column of the other material", "material_a,restitution,phi\ngranite,0.5,30\n")
contacts("no column of the restitution", "material_a,material_b,phi\ngranite,slag,30\n")
contacts("no column of the friction angle", "material_a,material_b,restitution\ngranite,slag,0.5\n")
contacts("a column by another name", CONTACTS.replace("cohesion", "coh") + "granite,slag,0.5,30,200\n")
contacts("a column twice", CONTACTS.replace("cohesion", "PHI") + "granite,slag,0.5,30,35\n")
contacts("truncated", CONTACTS + "granite,slag,0.5,")
contacts("one material only", CONTACTS + "granite,,0.5,30,0\n")
contacts("a material that no rock is of", CONTACTS + "granite,slab,0.5,30,0\n")
contacts("rocks without a material", CONTACTS + "granite,slag,0.5,30,0\n", Center=[5, 50, 58])
contacts("a pair twice", CONTACTS + "granite,slag,0.5,30,0\ngranite,slag,0.4,30,0\n")
contacts("a pair twice, the other way round", CONTACTS + "granite,slag,0.5,30,0\nslag,granite,0.4,30,0\n")
contacts("out of range", CONTACTS + "granite,slag,1.5,30,0\n")
contacts("negative", CONTACTS + "granite,slag,0.5,30,-200\n")
contacts("NaN", CONTACTS + "granite,slag,nan,30,0\n")
contacts("φ in grads, out of range", CONTACTS + "granite,slag,0.5,95,0\n")
contacts("a word", CONTACTS + "granite,slag,hard,30,0\n")
contacts("comma as decimal mark", CONTACTS + 'granite,slag,"0,5",30,0\n')
contacts("comma as decimal mark, not quoted", CONTACTS + "granite,slag,0,5,30,0\n")

section("Shape files")


def shape(wrong, name, text=None):
    rocks(wrong, Shape="From File", ShapeFileName=name if text is None else write_text(name, text))


CORNERS = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
PLY = ("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
       "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n")
shape("missing", "missing.stl")
shape("empty", "empty.stl", "")
shape("empty points", "empty.xyz", "")
shape("truncated", "cut.ply", PLY + "0 0 0\n1 0 0\n")
shape("a list of negative length", "list.ply", PLY + "0 0 0\n1 0 0\n0 1 0\n0 0 1\n-5 1 2 3\n")
shape("wrong type", "rock.doc", "0 0 0\n")
shape("words", "words.csv", "x,y,z\n0,0,0\n1,two,3\n")
shape("no columns x, y and z", "axes.csv", "a,b,c\n0,0,0\n")
shape("coordinates in feet", "feet.csv", "x [ft],y [ft],z [ft]\n0,0,0\n")
shape("comma as decimal mark between commas", "commas.csv", "x,y,z\n0,5,0,5,0,5\n")
shape("the same without a header", "commas.xyz", "0,5,0,5,0,5\n")
shape("numbers of the points, and no header", "count.xyz", "1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n")
shape("single precision far from the origin", "far.ply", PLY.replace("float", "double") +
      "500123.375 5200456 812.130005\n500124.375 5200456 812.130005\n500123.375 5200457 812.130005\n"
      "500123.375 5200456 813.130005\n3 0 2 1\n")
shape("six digits", "six.obj", "v 500123 5.20046e+06 812.13\nv 500124 5.20046e+06 812.13\n")
shape("NaN", "nan.csv", "x,y,z\n0,0,0\n1,nan,3\n1,0,0\n0,1,0\n0,0,1\n")
shape("all in a plane", "flat.csv", "0,0,0\n1,0,0\n0,1,0\n1,1,0\n")
shape("open", "open.obj", CORNERS + "f 1 3 2\nf 1 2 4\nf 1 4 3\n")
shape("inside out", "inverted.obj", CORNERS + "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n")
shape("a vertex that is not there", "range.obj", CORNERS + "f 1 2 9\n")

section("Lines of collectors")
fall = RockfallSimulation(Terrain=slope, Rocks=RockBlocks(), EndTime=2.0, Iterations=1)


def lines(wrong, text, name="lines.csv"):
    file = name if text is None else write_text(name, text)
    one(wrong, TrajectoryCollector(Input=OutputPort(fall, 1), FileName=file), ports=4)


ROAD = 'WKT,name,height\n"LINESTRING({0} 0,{0} 100)",road,{1}\n'
lines("missing", None, "missing.gpkg")
lines("empty", "WKT,name\n")
lines("truncated", features([LINE] * 3)[:-70], "cut.geojson")
lines("wrong type: points", 'WKT,name\n"POINT(8 0)",road\n')
lines("of another place, or another CRS", ROAD.format(9000, 3))
lines("a line of one place", 'WKT,name\n"LINESTRING(8 0,8 0)",road\n')
lines("a word", ROAD.format(8, "high"))
lines("negative", ROAD.format(8, -3))
lines("NaN", ROAD.format(8, "nan"))
lines("comma as decimal mark", ROAD.format(8, '"4,5"'))
lines("10⁷ features", "WKT,name\n" + '"LINESTRING(8 0,8 100)",road\n' * 10_001)
one("a drawn line of one point", TrajectoryCollector(
    Input=OutputPort(fall, 1), Points=[100, 50, 0]), ports=4)
one("a barrier that is negative", TrajectoryCollector(
    Input=OutputPort(fall, 1), FileName=write_text("lines.csv", ROAD.format(8, "")),
    BarrierHeight=-1.0), ports=4)
line = TrajectoryCollector(Input=OutputPort(fall, 1))
one("a partial factor below 1", BarrierDesign(Input=line, TrajectoryFactor=0.9), ports=4)
one("a mass that is negative", BarrierDesign(Input=line, DesignMass=-1.0), ports=4)
one("parallels where the line is", TrajectoryCollector(
    Input=OutputPort(fall, 1), ParallelLines=3, ParallelSpacing=0.0), ports=4)
Delete(line)

section("Trajectories")
one("the wrong output of the simulation", RockfallHazardMap(Input=OutputPort(fall, 0), Terrain=slope))
one("a slope that they did not fall on", RockfallHazardMap(
    Input=OutputPort(fall, 1), Terrain=site, CropToTrajectories=1))
one("a cell size that is negative", RockfallHazardMap(Input=OutputPort(fall, 1), CellSize=-1.0))

section("Passages and crossings of several runs")
writer = servermanager.writers.HazardPassageWriter(
    Input=OutputPort(fall, 1), Terrain=slope, FileName=os.path.abspath("good.passages"))
writer.UpdatePipeline()
writer.CellSize = 10.0
writer.FileName = os.path.abspath("coarse.passages")
writer.UpdatePipeline()
with open("good.passages", "rb") as file:
    whole = file.read()
with open("cut.passages", "wb") as file:
    file.write(whole[:-100])
one("missing", HazardPassageReader(FileNames=["missing.passages"]))
one("empty", HazardPassageReader(FileNames=[write_text("empty.passages", "")]))
one("truncated", HazardPassageReader(FileNames=["cut.passages"]))
one("wrong type", HazardPassageReader(FileNames=[good]))
one("cells of another size", HazardPassageReader(FileNames=["good.passages", "coarse.passages"]))
one("a run twice", HazardPassageReader(FileNames=["good.passages", "good.passages"]))
one("not the crossings of a collector", MergeCollectors(Input=[OutputPort(fall, 1)]), ports=3)

section("Studies")
for source in list(GetSources().values()):
    Delete(source)
shutil.rmtree("results", ignore_errors=True)
write_grid("dem.asc", incline())
study = {"terrain": {"FileName": "dem.asc"}, "rocks": {"Center": [700025, 4000060, 146]},
         "simulation": {"EndTime": 0.5}, "iterations": 2, "chunk": 1}


def run(wrong, text=None, name="study.json", folder="no-results", **changes):
    if text is None:
        text = json.dumps({**study, **changes})
    if text:
        write_text(name, text)
    kept, sys.argv = sys.argv, [STUDY, folder, name]
    end = None
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            runpy.run_path(STUDY, run_name="__main__")
    except SystemExit as refused:
        end = refused
    finally:
        sys.argv = kept
    if wrong:
        if end is None:
            failures.append(f"study, {wrong}: no error")
        row(wrong, str(end))


run("missing", "", "missing.json")
run("empty", " ")
run("truncated", json.dumps(study)[:-40])
run("wrong type", "[1, 2]")
run("a part that is not known", json.dumps({**study, "itterations": 3}))
run("a part of another type", terrain="dem.asc")
run("negative", chunk=-2)
run("NaN", iterations=float("nan"))
run("a text for a number", iterations="10")
run("comma as decimal mark", json.dumps(study).replace("0.5", "0,5"))
run("a file that is missing", terrain={"FileName": "missing.tif"})
run("a property that is not there", simulation={"EndTimes": 3})
run("a map of trajectories that are not kept", map={}, simulation={"TrajectoryOutput": "Events"})
run("lines without a file", lines={})
run(None, folder="results")
run("another study in the folder", folder="results", chunk=2)

# What the program says, word by word.
made = io.StringIO()
table = csv.writer(made, lineterminator="\n")
table.writerow(["input", "wrong", "message"])
for title, rows in sections:
    for wrong, text in rows:
        table.writerow([title, wrong, text])
with open(TABLE, encoding="utf-8", newline="") as file:
    told = file.read()
if told != made.getvalue():
    write_text("bad_input.csv", made.getvalue())
    failures.append("docs/data/bad_input.csv is not what the program says, this test's folder has it as it should be:\n" +
                    "".join(difflib.unified_diff(told.splitlines(True), made.getvalue().splitlines(True),
                                                 "docs", "made", n=0)))

# Words of a message are on the page, with what to do. … stands for anything.
with open(PAGE, encoding="utf-8") as file:
    page = file.read()
words = [re.compile(".*".join(re.escape(piece) for piece in phrase.split("…")), re.IGNORECASE)
         for line in page.splitlines() if line.startswith("| *")
         for phrase in re.findall(r"\*([^*]+)\*", line.split(" | ")[0])]
for title, rows in sections:
    for wrong, text in rows:
        if not text.startswith("no error") and not any(phrase.search(text) for phrase in words):
            failures.append(f"bad_input.md does not say what to do about {title}, {wrong}: {text}")
if failures:
    raise SystemExit("\n".join(failures))
print(sum(len(rows) for _, rows in sections), "kinds of bad input, one message each")
