"""A rock that breaks on its way down, and where its pieces go.

One rock falls over a face and breaks by docs/fragmentation.md's law. Drawn are the paths of the rock and its pieces,
coloured by volume, and the pieces as they stand at some moments. The site is that of structures.py, without
structures. Run it with

    bash Examples/run.sh fragmentation.py [--output FOLDER]

and find fragmentation.png and the table pieces.csv in output/fragmentation.
"""
import argparse
import os
import sys

here = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [here, os.path.join(here, "structures_parts")]

import numpy as np
from paraview.simple import *
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

import slope_site as site
from rockfall_ground import Ground, cells
from rockfall_tables import result
from rockfall_view import INK, flat, new_view, points_source, produce, show_slope, write
from site_picture import ground_patch, local

SEED, VOLUME, LEAST = 5, 6.0, 0.02  # m³
MOMENTS = (3.0, 6.0, 9.0)  # s


def shown(polydata):
    """In metres from the site's corner."""
    made = vtkPolyData()
    made.DeepCopy(polydata)
    points = vtk_to_numpy(made.GetPoints().GetData())
    points[:] = local(points.copy(), 0.0)
    return produce(made)


def coloured(source, view, table, **properties):
    display = Show(source, view)
    ColorBy(display, ("CELLS", "Volume"))
    display.LookupTable = table
    for name, value in properties.items():
        setattr(display, name, value)
    return display


def main():
    parser = argparse.ArgumentParser(description="A rock that breaks on its way down.")
    parser.add_argument("--output", default=os.path.join(os.path.dirname(here), "output", "fragmentation"))
    folder = parser.parse_args().output
    os.makedirs(folder, exist_ok=True)
    slope = DEMtoCFEMesh(FileName=site.write_slope(os.path.join(folder, "slope.asc")), RestitutionCoefficient=0.6,
                         RestitutionDeviation=0.05, FrictionAngle=28, FrictionAngleDeviation=3, RoughnessDeviation=0.2)
    rocks = RockBlocks(Terrain=slope, Center=[site.WEST + 4.0, site.SOUTH + 65.0, 124.5], Volume=VOLUME, Shape="Dodecahedron")
    fall = RockfallSimulation(Terrain=slope, Rocks=rocks, EndTime=45.0, Seed=SEED, Fragmentation=1, FragmentationEnergy=75e3,
                              FractalDimension=2.0, LeastFragment=LEAST, FragmentSpread=15.0)
    paths = result(fall, 1)
    SaveData(os.path.join(folder, "pieces.csv"), proxy=OutputPort(fall, 3), Precision=9)

    view = new_view((1300, 850))
    show_slope(ground_patch(Ground(result(slope)), 0.0), view)
    table = GetColorTransferFunction("Volume")
    table.ApplyPreset("Viridis (matplotlib)", True)
    coloured(shown(paths), view, table, LineWidth=2.0, Ambient=1.0, Diffuse=0.0)
    for moment in MOMENTS:
        UpdatePipeline(moment, fall)
        blocks = vtkPolyData()
        blocks.DeepCopy(result(fall, 0))
        coloured(shown(blocks), view, table, Ambient=0.35, Diffuse=0.7, Interpolation="Flat")
    table.RescaleTransferFunction(LEAST, VOLUME)
    table.MapControlPointsToLogSpace()
    table.UseLogScale = 1
    ends = vtk_to_numpy(paths.GetPoints().GetData())[np.cumsum(np.diff(vtk_to_numpy(paths.GetLines().GetOffsetsArray()))) - 1]
    fates = vtk_to_numpy(paths.GetCellData().GetArray("Fate"))
    flat(points_source(local(ends[fates != 5], 0.0), 0.7), view, INK)
    middle = np.array([0.48 * site.LENGTH, 0.5 * site.WIDTH + 12.0, 60.0])
    away = np.array([0.75, -0.55, 0.55])
    view.CameraViewUp, view.CameraViewAngle = [0.0, 0.0, 1.0], 30.0
    view.CameraFocalPoint, view.CameraPosition = middle.tolist(), (middle + 410.0 * away / np.linalg.norm(away)).tolist()
    bar = GetScalarBar(table, view)
    bar.Title, bar.ComponentTitle = "volume, m³", ""
    bar.TitleColor = bar.LabelColor = INK
    bar.TitleFontSize, bar.LabelFontSize, bar.WindowLocation = 20, 18, "Any Location"
    bar.Position, bar.ScalarBarLength = [0.90, 0.30], 0.42
    bar.UseCustomLabels, bar.CustomLabels, bar.AddRangeLabels = 1, [0.02, 0.1, 0.5, 2.0, 6.0], 0
    bar.Visibility = 1
    pieces = int((fates != 5).sum())
    write(view, f"A rock of {VOLUME:g} m³ and the {pieces} pieces that are left of it", (0.02, 0.94), 26, bold=True)
    write(view, "paths and blocks, to scale, at " + ", ".join(f"{t:g}" for t in MOMENTS) +
          f" s; dots: ends of pieces; other paths end in less than {LEAST:g} m³", (0.02, 0.90), 20)
    SaveScreenshot(os.path.join(folder, "fragmentation.png"), view, ImageResolution=list(view.ViewSize))
    print(f"{pieces} pieces; {os.path.join(folder, 'fragmentation.png')}")


main()
