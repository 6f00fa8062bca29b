"""One rank's part of TestRankHash: runs the default slope and rocks, prints what came out on rank 0, and
then the same with each of the troubles that are named."""

import hashlib
import os
import sys

from paraview import servermanager
from paraview.simple import (
    DEMtoCFEMesh, RockBlocks, RockfallSimulation, UpdatePipeline)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkParallelCore import vtkMultiProcessController

os.dup2(1, 2)  # one stream, or mpiexec may hand on an error before the line that was printed before it
controller = vtkMultiProcessController.GetGlobalController()
first = controller.GetLocalProcessId() == 0
symmetric = servermanager.vtkProcessModule.GetProcessModule().GetSymmetricMPIMode()
sources, troubles = sys.argv[1], sys.argv[2:]

folder = os.path.dirname(os.path.abspath(sources))
slope = DEMtoCFEMesh(RoughnessDeviation=0.1, EmbankmentFile=os.path.join(folder, "dams.csv"),
                     TreeFile=os.path.join(folder, "trees.csv"), TreesBreak=1,
                     BarrierFile=os.path.join(folder, "nets.csv"))
rocks = RockBlocks(FileName=sources)
fall = RockfallSimulation(Terrain=slope, Rocks=rocks, EndTime=5.0, Iterations=11,
                          TrajectoryOutput="Events", PrintProgress=0)
algorithm = fall.GetClientSideObject()


def digest():
    """Over all bits of all outputs."""
    sha = hashlib.sha256()
    for port in range(5):
        data = algorithm.GetOutputDataObject(port)
        arrays = [data.GetPoints().GetData()] if port != 3 and data.GetPoints() else []
        for fields in ([data.GetRowData()] if port == 3 else
                       [data.GetPointData(), data.GetCellData()]):
            arrays += [fields.GetAbstractArray(k) for k in range(fields.GetNumberOfArrays())]
        for array in arrays:
            if array.IsNumeric():
                sha.update(vtk_to_numpy(array).tobytes())
    return sha.hexdigest()


def run():
    for time in (0.0, 2.5, 2.5):
        UpdatePipeline(time, fall)
    size = algorithm.GetOutputDataObject(3).GetNumberOfRows()
    if first:
        fall.UpdatePropertyInformation()
        print(f"RESULT rows={size} hash={fall.GetPropertyValue('StateHash') or '-'} all={digest()} "
              f"runs={fall.GetPropertyValue('NumberOfRuns')}", flush=True)
    elif size or algorithm.GetOutputDataObject(0).GetNumberOfPoints():
        print("RESULT of another rank than the first is not empty", flush=True)


run()
for trouble in troubles:
    if symmetric:
        controller.Barrier()  # what was said before belongs to what was before
    if first:
        print(f"TROUBLE {trouble}", flush=True)
    if symmetric:
        controller.Barrier()
    if trouble == "source":  # fails on the first rank only: the others' have nothing to read
        slope.FileName = "no such file.tif"
    elif trouble == "placement":
        rocks.FileName = ""
        rocks.Center = [-50, 0, 0]
    elif trouble == "property":
        fall.TimeStep = -1.0
    elif trouble == "abort":
        fall.Iterations = 100000
        if first:
            algorithm.AddObserver("ProgressEvent", lambda caller, _: caller.SetAbortExecute(1))
    run()
    # And then it goes well.
    algorithm.RemoveObservers("ProgressEvent")
    algorithm.SetAbortExecute(0)
    slope.FileName, rocks.FileName, fall.TimeStep, fall.Iterations = "", sources, 0.005, 2
    UpdatePipeline(1.0, fall)
    if first:
        print(f"AFTER rows={algorithm.GetOutputDataObject(3).GetNumberOfRows()}", flush=True)
