"""A finished study as its folder has it. Whatever is wrong with a file is a schema.Bad that names the file and
the field."""
import copy
import csv
import itertools
import os
import time

import numpy as np
from osgeo import gdal, ogr, osr
from paraview.simple import DEMtoCFEMesh
from vtkmodules.util.numpy_support import vtk_to_numpy

import schema
import standing
from enough import ways_of
from combine import RESULTS
from identity import content, place
from schema import Bad, shown

gdal.UseExceptions()
ogr.UseExceptions()
osr.UseExceptions()


BLOCK = 100000  # rows
TEXTS = "LineName", "SourceName", "Shape", "Fate", "Class", "Kind", "Name"  # also where all of them are numbers


def field(path, whole, name, kind):
    """A field of a JSON object."""
    value = whole.get(name)
    if not isinstance(value, kind):
        raise Bad(f"{path}: \"{name}\" is {shown(value) if name in whole else 'missing'}, it must be "
                  f"{dict(dict='an object', str='a text', int='a whole number')[kind.__name__]}")
    return value


class Table:
    """Some columns of a CSV file, as numbers where all of them are."""

    def __init__(self, path, needed, wanted=()):
        self.path = path
        with open(path, newline="", encoding="utf-8") as file:
            rows = csv.reader(file)
            self.names = next(rows, [])
            for name in needed:
                if name not in self.names:
                    raise Bad(f"{path}: there is no column {name}")
            kept = [k for k, name in enumerate(self.names) if not wanted or name in needed or name in wanted]
            blocks = {k: [] for k in kept}  # millions of texts would take gigabytes
            first = 2
            while block := list(itertools.islice(rows, BLOCK)):
                for number, row in enumerate(block, first):
                    if len(row) != len(self.names):
                        raise Bad(f"{path}: row {number} has {len(row)} cells, it must have {len(self.names)}")
                for k in kept:
                    blocks[k].append(self.numbers([row[k] for row in block], self.names[k] in TEXTS))
                first += len(block)
        self.columns = {self.names[k]: self.one(made) for k, made in blocks.items()}

    @staticmethod
    def numbers(values, texts):
        try:
            return np.array(values, str if texts else float)
        except ValueError:
            return np.array(values, str)

    @staticmethod
    def one(blocks):
        return np.concatenate(blocks) if blocks else np.empty(0)

    def __getitem__(self, name):
        return self.columns[name]

    def __contains__(self, name):
        return name in self.columns

    def rows(self, kept, **changed):
        """Some of its rows, as a table; with columns that are others."""
        made = copy.copy(self)
        made.columns = {**{name: values[kept] for name, values in self.columns.items()}, **changed}
        return made

    def __len__(self):
        return len(next(iter(self.columns.values()), ()))

    def must_be_numbers(self, *names):
        for name in names:
            if self[name].dtype.kind != "f" and len(self):
                raise Bad(f"{self.path}: column {name} has {shown(self.bad(name))}, it must be a number")

    def bad(self, name):
        for text in self[name]:
            try:
                float(text)
            except ValueError:
                return str(text)
        return ""


class Slope:
    """The slope that the study was simulated on, and what stands on it."""

    def __init__(self, values):
        import rockfall_tables
        data = rockfall_tables.result(DEMtoCFEMesh(**values)).GetFieldData()

        def numbers(name):
            array = data.GetArray(name)
            return vtk_to_numpy(array) if array else np.empty((0, 1))

        def texts(name):
            array = data.GetAbstractArray(name)
            return [array.GetValue(k) for k in range(array.GetNumberOfValues())] if array else []

        columns, rows, self.cell, west, south, _ = numbers("TerrainGrid").ravel()
        self.heights = numbers("TerrainHeights").reshape(int(rows), int(columns)).astype(float)
        self.west, self.south = west, south
        self.east, self.north = west + (columns - 1) * self.cell, south + (rows - 1) * self.cell
        self.origin = numbers("LocalOrigin").ravel()[:2]
        self.crs = "".join(texts("TerrainCRS"))
        self.notes, self.ground = texts("Notes"), "".join(texts("Ground"))
        self.numbers, self.texts = numbers, texts
        self.trees, self.embankments, self.barriers = (
            numbers(name) for name in ("TerrainTrees", "TerrainEmbankments", "TerrainBarriers"))
        self.lying, self.lying_axes = self.trees[:0], []
        ends = numbers("TerrainLyingStems")
        if len(ends):
            which = ends[:, 0].astype(int)
            self.lying = self.trees[which]
            self.lying_axes = np.stack([self.lying[:, 1:3], ends[:, 1:3]], axis=1) + self.origin
            self.trees = np.delete(self.trees, which, axis=0)

    def axes_of(self, name, counts):
        """The lines of embankments or barriers, in the slope's coordinates."""
        points = self.numbers(name) + self.origin if len(counts) else self.numbers(name)
        return np.split(points, np.cumsum(counts.astype(int))[:-1]) if len(counts) else []

    def extent(self):
        return self.west, self.east, self.south, self.north


class Raster:
    """hazard.tif: its bands by name, and where it lies."""

    def __init__(self, path):
        try:
            data = gdal.Open(path)
        except RuntimeError as error:
            raise Bad(f"{path}: {error}") from None
        west, self.cell, _, north, _, _ = data.GetGeoTransform()
        self.extent = (west, west + self.cell * data.RasterXSize, north - self.cell * data.RasterYSize, north)
        self.numbers = {data.GetRasterBand(k + 1).GetDescription(): k + 1 for k in range(data.RasterCount)}
        if "ReachProbability" not in self.numbers:
            raise Bad(f"{path}: there is no band ReachProbability")
        self.data, self.path = data, path

    def __contains__(self, name):
        return name in self.numbers

    def band(self, name):
        try:
            values = self.data.GetRasterBand(self.numbers[name]).ReadAsArray().astype(float)
        except (RuntimeError, AttributeError) as error:
            raise Bad(f"{self.path}: band {name}: {error}") from None
        if name not in ("Passages", "Rocks"):
            values[self.data.GetRasterBand(self.numbers["Rocks"]).ReadAsArray() == 0] = np.nan
        return values


def released(bodies):
    """The rocks as they are released; of one that broke RunOut is that of its farthest piece. Endless: 1 if it is not known."""
    first, ways, endless = ways_of(bodies)
    return bodies.rows(first, RunOut=ways, Endless=endless)


class Study:
    def __init__(self, folder):
        self.folder = folder
        path = self.path("manifest.json")
        if not os.path.isfile(path):
            raise Bad(f"{folder} is not the folder of a study: it has no manifest.json")
        if not os.path.isfile(self.path(RESULTS)):
            raise Bad(f"{folder} has no {RESULTS}: the study is not finished. Start it again")
        self.manifest = schema.load(path)
        results = schema.load(self.path(RESULTS))
        self.iterations = field(self.path(RESULTS), results, "iterations", int)
        self.hash = field(self.path(RESULTS), results, "whole", str)
        self.finished = time.strftime("%Y-%m-%d %H:%M:%S %z", time.localtime(os.path.getmtime(self.path(RESULTS))))
        self.given = field(path, self.manifest, "identity", dict)
        self.program = field(path, self.manifest, "program", str)
        self.values = field(path, self.manifest, "values", dict)
        self.files = field(path, self.manifest, "files", dict)
        self.notes = self.manifest.get("notes", [])  # a study of an earlier version has none
        if not isinstance(self.notes, list) or not all(isinstance(note, str) for note in self.notes):
            raise Bad(f"{path}: \"notes\" is {shown(self.notes)}, it must be a list of texts")
        self.name = os.path.basename(field(path, self.manifest, "study", str))
        self.inputs = self.read_inputs(path)
        self.slope = Slope(self.properties("terrain"))
        # A row for each body: rocks as they are released, each with its pieces behind it where it broke.
        self.bodies = Table(self.path("summary.csv"), (
            "Iteration", "BlockId", "SourceId", "Shape", "Fate", "FateCode", "StartX", "StartY", "RunOut", "Mass", "Volume",
            "MaxSpeed", "ContactSteps", "UnsettledSteps", "EnergyReleased", "EnergyNumerical"),
            ("Frequency", "SourceName", "Piece", "StopX", "StopY"))
        self.bodies.must_be_numbers("Iteration", "BlockId", "SourceId", "FateCode", "StartX", "StartY", "RunOut", "Mass", "Volume")
        if not len(self.bodies):
            raise Bad(f"{self.path('summary.csv')}: there are no rocks")
        self.rocks = released(self.bodies)
        self.standing = Table(self.path(standing.TABLE), ("Kind", "StructureId", "Name", "Rocks", "Hits", "EnergyMaximum")) \
            if len(self.slope.trees) or len(self.slope.lying) or len(self.slope.embankments) or len(self.slope.barriers) else ()
        self.map = Raster(self.path("hazard.tif")) if "map" in self.given else None
        self.lines = self.crossings = self.exceedance = None
        self.drawn_lines, self.design, self.places = [], [], None
        if "lines" in self.given:
            self.read_lines()

    def path(self, name):
        return os.path.join(self.folder, name)

    def given_lines(self):
        """Rows of lines.csv that are no parallels."""
        return [k for k in range(len(self.lines)) if self.lines["Offset"][k] == 0.0]

    def lines_with_parallels(self):
        """Of each line that was given: its name, and its rows and those of its parallels, in the order of offsets."""
        families = []
        for row, offset in enumerate(self.places["Offset"] if self.places else ()):
            if offset == 0.0:
                families.append((str(self.places["LineName"][row]), []))
            families[-1][1].append(row)
        return [(name, sorted(rows, key=lambda row: self.places["Offset"][row])) for name, rows in families]

    def properties(self, part):
        """As the study sets them; files by their names."""
        return {name: self.files[f"{part} {name}"][0] if isinstance(value, dict) else value
                for name, value in self.given[part].items()}

    def read_inputs(self, path):
        """Of every file: parts and properties that read it, name, CRS, hash. They must be those of the study."""
        inputs = {}
        for key, names in self.files.items():
            part, prop = key.split(" ", 1)
            known = self.given.get(part, {}).get(prop)
            if not isinstance(known, dict) or not isinstance(names, list) or not names:
                raise Bad(f"{path}: \"{key}\" of files has no hashes in identity")
            for name in names:
                where = f"{path}: {key}: {name}"
                if not os.path.isfile(name):
                    raise Bad(f"{where} is not there any more")
                if known.get(place(name, names[0])) != "sha256 " + content(name):
                    raise Bad(f"{where} changed since the study")
            crs = crs_of(names[0])
            for name in names:
                one = inputs.setdefault(name, {"use": [], "file": name, "crs": "", "size": os.path.getsize(name),
                                               "hash": content(name)})
                one["use"].append(key)
                if name == names[0]:
                    one["crs"] = crs
        return list(inputs.values())

    def read_lines(self):
        self.lines = Table(self.path("lines.csv"), ("LineName", "Offset", "Rocks", "Share", "HighestQuantile", "MovingBefore",
                                                    "OverEdgeBefore", "InNodataBefore"))
        self.crossings = Table(self.path("crossings.csv"), (
            "LineName", "Iteration", "BlockId", "Passing", "KineticEnergy"), ("Piece",))
        self.exceedance = Table(self.path("exceedance.csv"), (
            "Line", "EnergyInKilojoules", "HeightOverGround", "ShareOfPassing"))
        if len(self.crossings):
            self.crossings.must_be_numbers("Iteration", "BlockId", "Passing", "KineticEnergy")
        names = ("design.csv", ("Quantile", "EnergyInKilojoules")), ("design_classes.csv", ("Class", "Caught")), \
            ("design_sources.csv", ("SourceId", "Rocks"))
        self.design = [Table(self.path(name), ("LineName", *needed)) for name, needed in names]
        self.places = Table(self.path("design_places.csv"), (
            "LineName", "Offset", "Rocks", "Share", "UncaughtShare", "AnnualFrequency", "UncaughtFrequency",
            *(f"{what}{level}{end}" for what in ("EnergyInKilojoules", "TopHeight") for level in (95, 99)
              for end in ("", "Low", "High"))))
        values = self.properties("lines")
        self.drawn_lines = lines_of(values["FileName"], values.get("LayerName", ""), self.slope.crs)


def name_of_crs(reference):
    code = reference.GetAuthorityCode(None)
    return reference.GetName() + (f" (EPSG:{code})" if code else "")


def crs_of(path):
    """The name of a data set's CRS; empty if it has none, or is no data set of GDAL's."""
    try:
        data = gdal.OpenEx(path, gdal.OF_RASTER | gdal.OF_VECTOR)
        reference = data.GetSpatialRef() if data.RasterCount else data.GetLayer(0).GetSpatialRef()
        return name_of_crs(reference) if reference else ""
    except (RuntimeError, AttributeError):
        return ""


def lines_of(path, layer_name, crs):
    """Names and points of the lines, in this CRS. Of polygons the outlines."""
    try:
        data = gdal.OpenEx(path, gdal.OF_VECTOR)
        layer = data.GetLayerByName(layer_name) if layer_name else data.GetLayer(0)
        own, change = layer.GetSpatialRef(), None
        if own and crs:
            to = osr.SpatialReference(crs)
            for one in (own, to):
                one.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
            change = None if own.IsSame(to) else osr.CoordinateTransformation(own, to)
        lines = []
        for feature in layer:
            geometry = feature.GetGeometryRef()
            if geometry is None:
                continue
            geometry = geometry.Clone().GetLinearGeometry()
            if change:
                geometry.Transform(change)
            lines += parts_of(geometry)
        return lines
    except (RuntimeError, AttributeError) as error:
        raise Bad(f"{path}: {error}") from None


def parts_of(geometry):
    if geometry.GetGeometryCount():
        return [points for k in range(geometry.GetGeometryCount()) for points in parts_of(geometry.GetGeometryRef(k))]
    points = np.array(geometry.GetPoints() or [])
    return [points[:, :2]] if len(points) > 1 else []
