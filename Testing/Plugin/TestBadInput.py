"""Bad input gives one error that names the file or block and the value, and no result."""

from helpers import errors_of, incline, is_empty, write_grid, write_text

from paraview.simple import DEMtoCFEMesh, Delete, Plane, RockBlocks, RockfallSimulation

failures = []


def expect(what, errors, words, empty):
    if len(errors) != 1:
        failures.append(f"{what}: {len(errors)} errors instead of one: {errors}")
    elif any(word not in errors[0] for word in words):
        failures.append(f"{what}: not all of {words} are in: {errors[0]}")
    if not empty:
        failures.append(f"{what}: there is a result all the same")
    print(f"{what}: {errors[0] if errors else 'no error'}")


def bad_dem(what, words, **properties):
    dem = DEMtoCFEMesh(**properties)
    expect(what, errors_of(dem), words, is_empty(dem))
    # The simulation after it adds no error of its own.
    simulation = RockfallSimulation(Terrain=dem, Rocks=RockBlocks(), EndTime=0.1)
    further = errors_of(simulation, 0, 3)
    if further or not is_empty(simulation):
        failures.append(f"{what}: the simulation after it: {further}")
    Delete(simulation)
    Delete(dem)


def bad_rocks(what, words, **properties):
    rocks = RockBlocks(**properties)
    expect(what, errors_of(rocks), words, is_empty(rocks))
    Delete(rocks)


def bad_run(what, words, rocks=None, terrain=None, **properties):
    simulation = RockfallSimulation(
        Terrain=terrain or DEMtoCFEMesh(), Rocks=RockBlocks(**(rocks or {})), EndTime=0.1)
    for name, value in properties.items():
        setattr(simulation, name, value)
    errors = errors_of(simulation, 0, 1, 2, 3)
    expect(what, errors, words, all(is_empty(simulation, port) for port in range(4)))
    Delete(simulation)


# Structures.
layer = write_text("dams.csv", 'WKT,height,width,slope\n"LINESTRING(50 20,50 80)",-3,1,1.5\n')
bad_dem("negative crest", [layer, "row 1", "height", "-3"], EmbankmentFile=layer)
layer = write_text("trees.csv", "x,y,height\n50,50,20\n")
bad_dem("tree without diameter", [layer, "row 1", "diameter"], TreeFile=layer)
layer = write_text("nets.csv", 'WKT,height,capacity\n"LINESTRING(5000 20,5000 80)",3,100\n')
bad_dem("barrier beside the terrain", [layer, "does not overlap"], BarrierFile=layer)
bad_dem("missing layer", ["/no/such/nets.gpkg"], BarrierFile="/no/such/nets.gpkg")

# Rasters.
bad_dem("missing file", ["/no/such/dem.tif"], FileName="/no/such/dem.tif")
text = write_text("notes.txt", "no raster at all\n")
bad_dem("not a raster", [text], FileName=text)
name = write_grid("degrees.asc", incline(5, 5), corner=(-84.5, 36.5), cell=0.001, crs=None)
bad_dem("no CRS with a geographic-looking extent", [name, "-84.4995"], FileName=name)
name = write_grid("nodata.asc", [[-9999] * 4] * 4)
bad_dem("all nodata", [name, "nodata"], FileName=name)
name = write_grid("nan.asc", [[1.5, 2, 3], [4, "nan", 6], [7, 8, 9]])
bad_dem("NaN height", [name, "nan"], FileName=name)
name = write_grid("inf.asc", [[1.5, 2, 3], [4, "inf", 6], [7, 8, 9]])
bad_dem("infinite height", [name, "inf"], FileName=name)
name = write_grid("row.asc", [[1, 2, 3, 4]])
bad_dem("one-row raster", [name, "1 row"], FileName=name)
name = write_grid("good.asc", incline(5, 5))
bad_dem("band", [name, "3"], FileName=name, Band=3)
bad_dem("cell size", ["CellSize", "-1"], CellSize=-1.0)
bad_dem("restitution model", ["RestitutionModel", "3"], RestitutionModel=3)
bad_dem("tangential restitution", ["TangentialRestitution", "1.5"], TangentialRestitution=1.5)
bad_dem("restitution speed", ["RestitutionSpeed", "0"], RestitutionSpeed=0.0)
bad_dem("restitution", ["RestitutionCoefficient", "2"], RestitutionCoefficient=2.0)

# Contour lines.
name = write_text("level.csv", 'WKT,elev\n"LINESTRING(0 0,50 0)",10\n"LINESTRING(0 30,50 30)",10\n')
bad_dem("contours of one height", [name, "10 m", "no slope"], FileName=name)
name = write_text("comma.csv", 'WKT;elev\n"LINESTRING(0 0,50 0)";10,5\n"LINESTRING(0 9,50 9)";20\n')
bad_dem("decimal comma", [name, "row 1", "10,5", "decimal"], FileName=name)
name = write_text("points.csv", 'WKT,elev\n"POINT(0 0)",10\n"POINT(0 30)",20\n')
bad_dem("points for contours", [name, "POINT", "LINESTRING"], FileName=name)
name = write_text("lines.csv", 'WKT,h\n"LINESTRING(0 0,50 0)",10\n"LINESTRING(0 30,50 30)",20\n')
bad_dem("no field of heights", [name, "row 1", "ElevationField"], FileName=name)
bad_dem("another field of heights", [name, "cote", '"h"'], FileName=name, ElevationField="cote")

# Classes of ground.
zones = write_text("zones.csv", 'WKT,class\n"POLYGON((0 0,250 0,250 100,0 100,0 0))",rock\n')
far = write_text("far.csv", 'WKT,class\n"POLYGON((900 0,990 0,990 90,900 90,900 0))",rock\n')
rv = write_text("rv.csv", "class,rv\nrock,0.8\n")
other = write_text("other.csv", "class,rv\ntalus,0.4\n")
high = write_text("high.csv", "class,rv\nrock,1.8\n")
phi = write_text("phi.csv", "class,phi\nrock,95\n")
bad_dem("layer without a table", ["RestitutionLayer", zones, "RestitutionTable"],
        RestitutionLayer=zones)
bad_dem("table without a layer", ["JointTable", phi, "JointLayer"], JointTable=phi)
bad_dem("class without a row", [zones, "row 1", "rock", other],
        RestitutionLayer=zones, RestitutionTable=other)
bad_dem("layer elsewhere", [far, "does not overlap", "900 ... 990", "0 ... 250"],
        RestitutionLayer=far, RestitutionTable=rv)
bad_dem("Rv out of range", [high, "row 1", "rv", "1.8"],
        RestitutionLayer=zones, RestitutionTable=high)
bad_dem("friction out of range", [phi, "row 1", "phi", "95"], JointLayer=zones, JointTable=phi)
bad_dem("field of the classes", [zones, "geology", '"class"'],
        RestitutionLayer=zones, RestitutionTable=rv, RestitutionField="geology")
bad_dem("missing table", ["/no/such.csv"], RestitutionLayer=zones, RestitutionTable="/no/such.csv")
bad_dem("preset", ["Preset", "8"], Preset=8)

# Rocks.
bad_rocks("zero volume", ["Volume", "0"], Volume=0.0)
bad_rocks("negative volume", ["Volume", "-1"], Volume=-1.0)
bad_rocks("zero density", ["Density", "0"], Density=0.0)
bad_rocks("negative density", ["Density", "-2500"], Density=-2500.0)
bad_rocks("missing sources", ["/no/such/rocks.csv"], FileName="/no/such/rocks.csv")
name = write_text("sources.csv", "x,y,z,density\n1,2,3,2500\n4,5,6,heavy\n")
bad_rocks("sources", [name, "row 2", "heavy"], FileName=name)
slope = DEMtoCFEMesh()  # x 0 to 250, y 0 to 100, 30° down to x = 100
SQUARE = '{"type":"Polygon","coordinates":[[[10,10],[30,10],[30,30],[10,30],[10,10]]]}'


def layer(name, geometry, properties=""):
    """A GeoJSON layer in UTM coordinates, of one feature."""
    return write_text(name, '{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":'
                      '"urn:ogc:def:crs:EPSG::32616"}},"features":[{"type":"Feature","properties":{'
                      f'{properties}}},"geometry":{geometry}}}]}}')


def bad_sources(what, words, header, cells):
    name = write_text("bad.csv", f"x,y,{header}\n20,50,{cells}\n")
    bad_rocks(what, [name, "row 1"] + words, FileName=name, Terrain=slope)


bad_sources("negative amount", ["amount", "-3"], "amount", "-3")
bad_sources("amount that is no number", ["amount", "many"], "amount", "many")
bad_sources("NaN deviation", ["vol_dev", "nan"], "vol_dev", "nan")
bad_sources("volume of no rock", ["Volume is 1e+308", "no rock has more"], "volume", "1e308")
bad_sources("decimal comma", ["height", "1,5", "point"], "height", '"1,5"')
bad_sources("unknown shape in a mix", ["shape", "ball"], "shape", "cube:2;ball:1")
bad_sources("bounds of a distribution", ["VolumeMaximum is 2", "3"], "vol_law,vol_min,vol_max",
            "uniform,3,2")
bad_sources("too many rocks", ["10000000 rocks", "MaximumRocks", "GB"], "amount", "10000000")
name = write_text("far.csv", "x,y\n700000,4000000\n")
bad_rocks("no overlap", [name, "x 700000", "x 0 to 250", "y 0 to 100"], FileName=name, Terrain=slope)
name = write_text("none.csv", "x,y,amount\n")
bad_rocks("empty layer", [name, "no row"], FileName=name, Terrain=slope)
name = layer("square.geojson", SQUARE)
bad_rocks("polygon without terrain", [name, "POLYGON", "Terrain"], FileName=name)
name = layer("mixed.geojson", '{"type":"GeometryCollection","geometries":[' + SQUARE + "]}")
bad_rocks("wrong geometry", [name, "GEOMETRYCOLLECTION"], FileName=name, Terrain=slope)
site = DEMtoCFEMesh(FileName=write_grid("site.asc", incline(31, 21)))
name = layer("site.geojson", '{"type":"Point","coordinates":[700100,4000100]}')
bad_rocks("CRS beside the terrain's", ["TargetCRS", "EPSG:2056", "UTM zone 16N"], FileName=name,
          Terrain=site, TargetCRS="EPSG:2056")
bad_rocks("threshold without terrain", ["SlopeThreshold", "30", "Terrain"], SlopeThreshold=30.0)
bad_rocks("nothing so steep", ["SlopeThreshold", "31"], SlopeThreshold=31.0, Terrain=slope)
bad_rocks("threshold out of range", ["SlopeThreshold", "90"], SlopeThreshold=90.0, Terrain=slope)
bad_rocks("ground without terrain", ["PlaceOnGround", "Terrain"], PlaceOnGround=1)
bad_rocks("mix", ["Shape mix", "sum"], ShapeMix="cube:0")
bad_rocks("terrain from elsewhere", ["Terrain", "DEM to CFE Mesh"], Terrain=Plane())
broken = DEMtoCFEMesh(FileName="/no/such/dem.tif")
errors = errors_of(RockBlocks(Terrain=broken))
if len(errors) != 1 or "/no/such/dem.tif" not in errors[0]:
    failures.append(f"a terrain that failed: {errors}")

corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
name = write_text("open.obj", corners + "f 1 3 2\nf 1 2 4\nf 1 4 3\n")
bad_rocks("open mesh", [name, "open"], Shape="From File", ShapeFileName=name)
name = write_text("inverted.obj", corners + "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n")
bad_rocks("inverted mesh", [name, "inward"], Shape="From File", ShapeFileName=name)

# The run.
bad_run("zero time step", ["TimeStep", "0"], TimeStep=0.0)
bad_run("negative time step", ["TimeStep", "-0.01"], TimeStep=-0.01)
bad_run("negative penalty", ["NormalPenalty", "-1"], NormalPenalty=-1e9)
bad_run("no end time", ["EndTime", "0"], EndTime=0.0)
bad_run("restitution between rocks", ["RockRestitution", "1.5"], RockRestitution=1.5)
bad_run("friction between rocks", ["RockFrictionAngle", "95"], RockFrictionAngle=95)
bad_run("rocks in each other", ["block 1", "block 2", "same rock twice"],
        rocks={"Amount": 2, "AttitudeLaw": "As given"}, RockRockContact=1)
bad_run("rock outside the slope", ["block 1", "-20", "outside"], rocks={"Center": [-20, 50, 58]})
bad_run("rock inside the slope", ["block 1", "40", "inside"], rocks={"Center": [40, 50, 34]})
bad_run("terrain from elsewhere", ["Terrain", "DEM to CFE Mesh"], terrain=Plane())
bad_run("rock of no volume", ["Volume", "0"], rocks={"Volume": 0.0})

if failures:
    raise SystemExit("\n".join(failures))
