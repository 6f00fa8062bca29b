"""Contour lines of a Gaussian hill become a slope: as the triangulation leaves it, with its top cut off
at the last contour, and with the flat triangles relaxed. Ends with the picture of both beside the closed
form, contours.png, as in docs/DEMtoCFEMesh.md."""

import math

import matplotlib
import numpy
from paraview.simple import DEMtoCFEMesh
from paraview.vtk.util.numpy_support import vtk_to_numpy

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

HEIGHT, WIDTH = 100.0, 60.0  # m, of the hill
INTERVAL = 12.0  # m, between contours
CELL = 2.0  # m


def write_contours(path):
    lines = ["WKT,elevation"]
    level = 8.0
    while level < HEIGHT:
        radius = WIDTH * math.sqrt(2 * math.log(HEIGHT / level))
        points = [(radius * math.cos(a), radius * math.sin(a))
                  for a in numpy.linspace(0, 2 * math.pi, 181)]
        points[-1] = points[0]
        text = ",".join(f"{x + 1000:.9f} {y + 1000:.9f}" for x, y in points)
        lines.append(f'"LINESTRING({text})",{level}')
        level += INTERVAL
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    return path


def heights(path, relax):
    slope = DEMtoCFEMesh(FileName=path, CellSize=CELL, RelaxFlats=relax)
    slope.UpdatePipeline()
    field = slope.GetClientSideObject().GetOutput().GetFieldData()
    columns, rows, cell, x, y = vtk_to_numpy(field.GetArray("TerrainGrid")).ravel()[:5]
    z = vtk_to_numpy(field.GetArray("TerrainHeights")).reshape(int(rows), int(columns))
    return z, x - 1000 + cell * numpy.arange(columns), y - 1000 + cell * numpy.arange(rows)[::-1]


def main():
    path = write_contours("contours.csv")
    figure, axes = pyplot.subplots(2, 2, figsize=(10, 6.5), height_ratios=(3, 2))
    light = matplotlib.colors.LightSource(315, 35)
    for k, (relax, title) in enumerate(((0, "as triangulated"), (1, "relaxed"))):
        z, x, y = heights(path, relax)
        exact = HEIGHT * numpy.exp(-(x[None, :] ** 2 + y[:, None] ** 2) / (2 * WIDTH ** 2))
        error = z - exact
        print(f"{title}: largest error {numpy.nanmax(abs(error)):.2f} m, "
              f"root mean square {math.sqrt(numpy.nanmean(error ** 2)):.2f} m")
        axes[0, k].imshow(light.hillshade(numpy.nan_to_num(z, nan=numpy.nanmin(z)), dx=CELL, dy=CELL),
                          cmap="gray", extent=(x[0], x[-1], y[-1], y[0]))
        axes[0, k].set_title(title)
        row = numpy.argmin(abs(y))
        axes[1, k].plot(x, exact[row], color="0.6", label="closed form")
        axes[1, k].plot(x, z[row], color="C3", label="slope")
        axes[1, k].set(xlabel="m", ylabel="m")
        axes[1, k].legend(frameon=False)
    figure.tight_layout()
    figure.savefig("contours.png", dpi=90)


main()
