"""Rasters of Rockyfor3D: ESRI ASCII, north row first, all of one grid."""
import math
import os
import re

import numpy as np
from osgeo import gdal, osr

gdal.UseExceptions()
osr.UseExceptions()
NODATA = -9999
HEAD = {"ncols", "nrows", "xllcorner", "yllcorner", "xllcenter", "yllcenter", "cellsize", "dx", "dy", "nodata_value"}
NUMBER = re.compile(r"[+-]?(\d+[.,]?\d*|[.,]\d+)([eE][+-]?\d+)?")  # a comma is a decimal mark, as for the plugin
PLAIN = re.compile(r"[-+.\deE\s]*")  # a line that numpy may try first


class Bad(Exception):
    """A folder that cannot be taken; the text names the file and what is wrong with it."""


class Grid:
    """Values with NaN for nodata."""

    def __init__(self, path, values, west, north, cell, crs=""):
        self.path, self.values, self.west, self.north, self.cell, self.crs = path, values, west, north, cell, crs

    @classmethod
    def read(cls, path):
        """By its text: GDAL takes words for 0, and one corner for the kind of both."""
        try:
            crs = gdal.OpenEx(path, gdal.OF_RASTER, allowed_drivers=["AAIGrid"]).GetProjection()
        except (RuntimeError, AttributeError):
            raise Bad(f"{path} is not a raster in ESRI ASCII") from None
        with open(path, encoding="utf-8-sig", errors="replace") as file:
            head, line = {}, file.readline()
            while line and (not line.strip() or line.split()[0].lower() in HEAD):
                name, *value = line.split() or [""]
                if name and len(value) != 1:
                    raise Bad(f"{path}: {name} is {' '.join(value) or 'empty'}, it must be one number")
                head[name.lower()] = "".join(value)
                line = file.readline()
            columns, rows = (int(number_of(path, head, name, 1)) for name in ("ncols", "nrows"))
            cell, high = (number_of(path, head, "cellsize" if "cellsize" in head else name, 1e-9) for name in ("dx", "dy"))
            if abs(cell - high) > 1e-9 * cell:
                raise Bad(f"{path}: cells are {cell:g} by {high:g} m, they must be square")
            west, south = (number_of(path, head, axis + "corner") if axis + "corner" in head else
                           number_of(path, head, axis + "center") - 0.5 * cell for axis in ("xll", "yll"))
            values = values_of(path, line, file, columns, head.get("nodata_value", str(NODATA)))
        if len(values) != columns * rows:
            raise Bad(f"{path} has {len(values)} numbers, ncols {columns} and nrows {rows} make {columns * rows}")
        return cls(path, values.reshape(rows, columns), west, south + rows * cell, cell, crs)

    def must_fit(self, other):
        """Another raster of the same grid."""
        mine, its = ((one.values.shape[1], one.values.shape[0], one.west, one.north, one.cell) for one in (self, other))
        for name, a, b in zip(("columns", "rows", "west edge", "north edge", "cell size"), mine, its):
            if abs(a - b) > 1e-6 * max(1.0, self.cell):
                raise Bad(f"{self.path}: {name} is {a:g}, that of {os.path.basename(other.path)} is {b:g}: all rasters must "
                          "be of one grid")

    def must_be(self, low, high, unit="", whole=False):
        """Within a range, where there are values."""
        known = self.values[~np.isnan(self.values)]
        wrong = (known < low) | (known > high) | (whole & (known != np.round(known)))
        if wrong.any():
            raise Bad(f"{self.path}: there is a value {known[wrong][0]:g}{unit}, they must be {'whole numbers ' if whole else ''}"
                      f"from {low:g} to {high:g}{unit}")

    def centres(self, rows, columns):
        return self.west + (columns + 0.5) * self.cell, self.north - (rows + 0.5) * self.cell


def number_of(path, head, name, least=-math.inf):
    """Of the head of a raster."""
    text = head.get(name, "nothing")
    if not NUMBER.fullmatch(text) or not least <= float(text.replace(",", ".")) < math.inf:
        raise Bad(f"{path}: {name} is {text}, it must be a number{f' of {least:g} or more' if least >= 1 else ''}")
    return float(text.replace(",", "."))


def values_of(path, line, file, columns, nodata):
    """The numbers of a line and of all behind it, NaN for nodata, which may be a word."""
    parts, count = [np.empty(0)], 0
    while line:
        words = line.split()
        try:
            if not PLAIN.fullmatch(line):
                raise ValueError
            parts.append(np.array(words, float))
        except ValueError:
            wrong = next((k for k, word in enumerate(words) if word != nodata and not NUMBER.fullmatch(word)), None)
            if wrong is not None:
                raise Bad(f"{path}: row {(count + wrong) // columns + 1}, column {(count + wrong) % columns + 1} is {words[wrong][:40]}, "
                          "it must be a number") from None
            parts.append(np.array([float(word.replace(",", ".")) if NUMBER.fullmatch(word) else math.nan for word in words]))
        count += len(words)
        line = file.readline()
    values = np.concatenate(parts)
    if NUMBER.fullmatch(nodata):
        with np.errstate(over="ignore"):  # written as 32 bits by some
            values[values.astype(np.float32) == np.float32(nodata.replace(",", "."))] = np.nan
    if np.isinf(values).any():
        at = int(np.flatnonzero(np.isinf(values))[0])
        raise Bad(f"{path}: row {at // columns + 1}, column {at % columns + 1} is infinite, it must be a number")
    return values


def write(path, values, west, north, cell, crs="", whole=False):
    """An ESRI ASCII raster, and its .prj if there is a CRS."""
    rows, columns = values.shape
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"ncols {columns}\nnrows {rows}\nxllcorner {west:.6f}\nyllcorner {north - rows * cell:.6f}\n"
                   f"cellsize {cell:.10g}\nNODATA_value {NODATA}\n")
        for row in np.where(np.isnan(values), NODATA, values):
            file.write(" ".join(f"{v:.0f}" if whole or v == NODATA else f"{v:.7g}" for v in row) + "\n")
    if crs:
        reference = osr.SpatialReference(crs)
        reference.MorphToESRI()
        with open(os.path.splitext(path)[0] + ".prj", "w", encoding="utf-8") as file:
            file.write(reference.ExportToWkt())
