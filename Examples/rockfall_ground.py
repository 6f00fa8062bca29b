"""The slope as numbers: node heights, angles of the contact face elements, and patches to look at.

DEM to CFE Mesh carries the slope in its field data (TerrainHeights, TerrainGrid), with every node
even where its triangles show only some of them; this is what the simulation uses, too.
"""
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData


class Ground:
    """Node heights (north row first, m) and where they stand."""

    def __init__(self, mesh):
        field = mesh.GetFieldData()
        columns, rows, self.cell, self.west, self.south = \
            vtk_to_numpy(field.GetArray("TerrainGrid")).ravel()[:5]
        self.rows, self.columns = int(rows), int(columns)
        self.north = self.south + (self.rows - 1) * self.cell
        self.heights = vtk_to_numpy(field.GetArray("TerrainHeights")).reshape(self.rows, self.columns)
        self.crs = field.GetAbstractArray("TerrainCRS").GetValue(0)
        self.name = field.GetAbstractArray("Ground").GetValue(0)

    def angles(self):
        """Slope angle in degrees per cell: that of the flatter one of the cell's two CFEs, so that a
        cell counts as steep only as a whole. NaN where there is no CFE."""
        z = self.heights
        upper_left, upper_right = z[:-1, :-1], z[:-1, 1:]
        lower_left, lower_right = z[1:, :-1], z[1:, 1:]
        lower = np.hypot(lower_right - lower_left, upper_left - lower_left)
        upper = np.hypot(upper_right - upper_left, upper_right - lower_right)
        return np.degrees(np.arctan(np.minimum(lower, upper) / self.cell))

    def centre(self, rows, columns):
        """Easting and northing of the middles of cells."""
        return (self.west + (np.asarray(columns) + 0.5) * self.cell,
                self.north - (np.asarray(rows) + 0.5) * self.cell)

    def height(self, x, y):
        """Height of the CFE under each point. A cell is cut from its upper left to its lower right
        node."""
        across = (np.asarray(x, float) - self.west) / self.cell
        down = (self.north - np.asarray(y, float)) / self.cell
        column = np.clip(across.astype(int), 0, self.columns - 2)
        row = np.clip(down.astype(int), 0, self.rows - 2)
        u, v = across - column, down - row
        z = self.heights
        first, last = z[row, column], z[row + 1, column + 1]
        upper, lower = z[row, column + 1], z[row + 1, column]
        return np.where(u >= v, first + u * (upper - first) + v * (last - upper),
                        first + v * (lower - first) + u * (last - lower))

    def window(self, west, east, south, north):
        """Slices of rows and columns that cover these bounds."""
        first_row, last_row = (int((self.north - y) / self.cell) for y in (north, south))
        first_column, last_column = (int((x - self.west) / self.cell) for x in (west, east))
        return (slice(*np.clip([first_row, last_row + 2], 0, self.rows)),
                slice(*np.clip([first_column, last_column + 2], 0, self.columns)))

    def patch(self, west, east, south, north, shade, stride=1):
        """The CFEs of a window as a polydata with the point arrays Elevation and Shade (colours).

        `shade(heights, cell)` gives the colours, uint8 RGB."""
        rows, columns = self.window(west, east, south, north)
        heights = self.heights[rows, columns][::stride, ::stride]
        n, m = heights.shape
        x = self.west + self.cell * (columns.start + stride * np.arange(m))
        y = self.north - self.cell * (rows.start + stride * np.arange(n))
        points = np.empty((n, m, 3))
        points[..., 0], points[..., 1], points[..., 2] = x, y[:, None], heights
        node = np.arange(n * m).reshape(n, m)
        upper_left, upper_right, lower_left, lower_right = \
            node[:-1, :-1], node[:-1, 1:], node[1:, :-1], node[1:, 1:]
        triangles = np.stack([np.stack([upper_left, lower_left, lower_right], -1),
                              np.stack([upper_left, lower_right, upper_right], -1)], 2).reshape(-1, 3)
        there = ~np.isnan(heights.ravel())
        triangles = triangles[there[triangles].all(axis=1)]

        polydata = make_polydata(np.nan_to_num(points.reshape(-1, 3)))
        polydata.SetPolys(cells(triangles))
        add_array(polydata.GetPointData(), "Elevation", np.nan_to_num(heights.ravel()))
        add_array(polydata.GetPointData(), "Shade", shade(heights, stride * self.cell).reshape(-1, 3))
        return polydata


def hillshade(azimuth=315.0, altitude=42.0, smooth=4, low=(150, 168, 128), high=(236, 228, 204)):
    """Colours of a slope: a tint that goes from low to high ground, under a light from `azimuth`
    (0 is north) and `altitude`, in degrees.

    The angles that the light sees are averaged over 2 `smooth` + 1 nodes, because a DEM that was
    resampled to a finer grid has a crease at each of its original nodes."""
    def shade(heights, cell):
        z = np.where(np.isnan(heights), np.nanmin(heights), heights)
        down, across = (average(g, smooth) for g in np.gradient(z, cell))
        to_light = np.radians([90.0 - azimuth, altitude])
        light = np.array([np.cos(to_light[0]) * np.cos(to_light[1]),
                          np.sin(to_light[0]) * np.cos(to_light[1]), np.sin(to_light[1])])
        # The normal is (-dz/dx, -dz/dy, 1); rows run southward.
        lit = (-across * light[0] + down * light[1] + light[2]) / np.sqrt(1 + across**2 + down**2)
        lit = 0.35 + 0.80 * np.clip(lit, 0, 1)
        share = (z - z.min()) / max(np.ptp(z), 1.0)
        tint = np.array(low) + share[..., None] * (np.array(high) - np.array(low))
        return np.clip(tint * lit[..., None], 0, 255).astype(np.uint8)
    return shade


def average(values, reach):
    """Mean over a square of 2 reach + 1 nodes, twice, the edge continued outward."""
    size = 2 * reach + 1
    for _ in range(2):
        for axis in (0, 1):
            pad = [(reach + 1, reach) if a == axis else (0, 0) for a in (0, 1)]
            total = np.cumsum(np.pad(values, pad, mode="edge"), axis=axis)
            values = (np.take(total, np.arange(size, total.shape[axis]), axis) -
                      np.take(total, np.arange(total.shape[axis] - size), axis)) / size
    return values


def make_polydata(points):
    polydata = vtkPolyData()
    holder = vtkPoints()
    holder.SetData(numpy_to_vtk(np.ascontiguousarray(points, float), deep=True))
    polydata.SetPoints(holder)
    return polydata


def cells(rows):
    """A vtkCellArray with a cell per row: the numbers of its points."""
    array = vtkCellArray()
    offsets = np.cumsum([0] + [len(row) for row in rows])
    array.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True),
                  numpy_to_vtkIdTypeArray(np.concatenate(rows).astype(np.int64), deep=True))
    return array


def add_array(attributes, name, values):
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    attributes.AddArray(array)
