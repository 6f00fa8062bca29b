"""A raster and a table of sources through the whole pipeline, into files and a picture.

Far from the coordinates' origin, so that single precision anywhere would show.
"""
# Renders

import os

from helpers import columns_of, incline, write_grid, write_text

from paraview import servermanager
from paraview.simple import (
    DEMtoCFEMesh, DispersionAngle, GetActiveViewOrCreate, GetAnimationScene,
    OpenDataFile, OutputPort, RockBlocks, RockfallSimulation, SaveData, SaveScreenshot, Show,
    UpdatePipeline)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

EAST, NORTH = 700000, 4000000

dem = DEMtoCFEMesh(FileName=write_grid("incline.asc", incline(), corner=(EAST, NORTH)))
dem.RoughnessMean, dem.RoughnessDeviation, dem.RestitutionDeviation = 0, 0.2, 0
rocks = RockBlocks(AttitudeLaw="As given", FileName=write_text(
    "sources.csv", "x,y,z,shape,volume\n" +
    "\n".join(f"{EAST + 25},{NORTH + 60 + 10 * k},{145 + k},{shape},{0.5 + 0.25 * k}"
              for k, shape in enumerate(["cube", "icosahedron", "eota111", "eota221"])) + "\n"))
simulation = RockfallSimulation(Terrain=dem, Rocks=rocks)
simulation.EndTime = 4.0
simulation.OutputInterval = 0.1
simulation.Iterations = 2
simulation.UpdatePipelineInformation()
assert len(simulation.TimestepValues) == 41, len(simulation.TimestepValues)

# The time series: rocks move, the run is simulated once.
scene = GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
assert scene.EndTime == 4.0, scene.EndTime
centres = []
for time in (0.0, 1.0, 2.55, 4.0):
    UpdatePipeline(time, simulation)
    shown = servermanager.Fetch(simulation, idx=0)
    points = vtk_to_numpy(shown.GetPoints().GetData())
    assert points.dtype == "float64"
    assert EAST < points[:, 0].min() and points[:, 0].max() < EAST + 310
    centres.append(points.mean(axis=0))
assert all(b[2] < a[2] - 1.0 for a, b in zip(centres, centres[1:])), centres
simulation.UpdatePropertyInformation()
assert simulation.GetPropertyValue("NumberOfRuns") == 1
simulation.ShownIteration = 1
UpdatePipeline(4.0, simulation)
simulation.UpdatePropertyInformation()
assert simulation.GetPropertyValue("NumberOfRuns") == 1

lines = servermanager.Fetch(simulation, idx=1)
assert lines.GetNumberOfLines() == 8
for name in ("Time", "Velocity", "RotationRate", "KineticEnergy"):
    assert lines.GetPointData().HasArray(name), name
assert lines.GetFieldData().HasArray("TerrainCRS")
assert "UTM zone 16N" in lines.GetFieldData().GetAbstractArray("TerrainCRS").GetValue(0)
assert servermanager.Fetch(simulation, idx=2).GetNumberOfVerts() > 0

summary = columns_of(servermanager.Fetch(simulation, idx=3))
assert summary["BlockId"] == [1, 2, 3, 4] * 2, summary["BlockId"]
assert summary["Shape"][:4] == ["cube", "icosahedron", "eota111", "eota221"], summary["Shape"]
assert all(EAST < x < EAST + 310 for x in summary["StopX"])
assert all(run > 10 for run in summary["RunOut"]), summary["RunOut"]

dispersion = DispersionAngle(Input=OutputPort(simulation, 1))
dispersion.UpdatePipeline()
angles = columns_of(servermanager.Fetch(dispersion))
assert len(angles["Group"]) == 4 and all(0 < theta < 45 for theta in angles["Theta"]), angles

# Into files and back.
SaveData("rocks.pvd", proxy=OutputPort(simulation, 0), WriteTimeSteps=1, DataMode="Binary")
again = OpenDataFile(os.path.abspath("rocks.pvd"))
assert len(again.TimestepValues) == 41, len(again.TimestepValues)
UpdatePipeline(4.0, again)
assert again.GetDataInformation().GetBounds() == simulation.GetDataInformation(0).GetBounds()
SaveData("trajectories.csv", proxy=OutputPort(simulation, 1))
with open("trajectories.csv") as file:
    header = file.readline()
for name in ("Time", "Velocity:0", "RotationRate:2", "Points:0"):
    assert f'"{name}"' in header, header
SaveData("terrain.vtp", proxy=dem, DataMode="Binary")
reopened = OpenDataFile(os.path.abspath("terrain.vtp"))
second = RockfallSimulation(Terrain=reopened, Rocks=rocks)
second.EndTime, second.OutputInterval, second.Iterations = 4.0, 0.1, 2
UpdatePipeline(proxy=second)
assert columns_of(servermanager.Fetch(second, idx=3)) == summary, "a reopened slope is another one"

# And to be seen: the slope in its colours, the lines over it in red.
view = GetActiveViewOrCreate("RenderView")
view.ViewSize = [600, 400]
view.OrientationAxesVisibility = 0
view.UseColorPaletteForBackground = 0
view.Background = [0, 0, 0]
slope = Show(dem, view)
slope.ColorArrayName = ["POINTS", ""]
slope.DiffuseColor = slope.AmbientColor = [0, 0.5, 0]
slope.Ambient, slope.Diffuse = 1.0, 0.0
shown = Show(OutputPort(simulation, 1), view)
shown.ColorArrayName = ["POINTS", ""]
shown.DiffuseColor = shown.AmbientColor = [1, 0, 0]
shown.Ambient, shown.Diffuse, shown.LineWidth = 1.0, 0.0, 3
view.ResetCamera(True)
SaveScreenshot("picture.png", view)
reader = vtkPNGReader()
reader.SetFileName("picture.png")
reader.Update()
pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).astype(int)
green = (pixels[:, 1] > 100) & (pixels[:, 0] < 60)
red = (pixels[:, 0] > 150) & (pixels[:, 1] < 100)
assert green.mean() > 0.2, f"the slope fills {green.mean():.3f} of the picture"
assert 0.0005 < red.mean() < 0.2, f"the trajectories fill {red.mean():.4f} of the picture"
print("the pipeline runs through")
