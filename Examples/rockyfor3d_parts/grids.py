"""Rasters of Rockyfor3D: ESRI ASCII, north row first, all of one grid."""
import os

import numpy as np
from osgeo import gdal, osr

gdal.UseExceptions()
osr.UseExceptions()
NODATA = -9999


class Bad(Exception):
    """A folder that cannot be taken; the text names the file and what is wrong with it."""


class Grid:
    """Values with NaN for nodata."""

    def __init__(self, path, values, west, north, cell, crs=""):
        self.path, self.values, self.west, self.north, self.cell, self.crs = path, values, west, north, cell, crs

    @classmethod
    def read(cls, path):
        try:
            data = gdal.OpenEx(path, gdal.OF_RASTER, allowed_drivers=["AAIGrid"])
            band = data.GetRasterBand(1)
            values = band.ReadAsArray().astype(float)
        except (RuntimeError, AttributeError):
            raise Bad(f"{path} is not a whole raster in ESRI ASCII") from None
        west, cell, _, north, _, high = data.GetGeoTransform()
        if abs(cell + high) > 1e-9 * cell:
            raise Bad(f"{path}: cells are {cell:g} by {-high:g} m, they must be square")
        nodata = band.GetNoDataValue()
        values[values == (NODATA if nodata is None else nodata)] = np.nan
        return cls(path, values, west, north, cell, data.GetProjection())

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
