"""Strict runs: an error of a source or filter is an exception. Tables as NumPy arrays."""

import os
import sys

sys.path[:0] = [os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Examples")]
import rockfall_strict

rockfall_strict.on()
rockfall_strict.on()  # once is enough

from helpers import delete_sources
from paraview import servermanager
from paraview.simple import *
from vtkmodules.util.numpy_support import vtk_to_numpy


def error_of(action):
    try:
        action()
    except rockfall_strict.RockfallError as error:
        return str(error)
    return ""


def fall_of(slope, **changes):
    rocks = RockBlocks(Terrain=slope, Amount=3)
    return RockfallSimulation(Terrain=slope, Rocks=rocks, EndTime=0.5, **changes)


slope = DEMtoCFEMesh(FileName="nowhere.tif")
assert "nowhere.tif: no such file" in error_of(slope.UpdatePipeline)
assert "nowhere.tif" in error_of(lambda: UpdatePipeline(proxy=slope))
delete_sources()

rocks = RockBlocks(FileName="nowhere.csv")
assert "nowhere.csv" in error_of(lambda: SaveData("strict.vtp", proxy=rocks))
delete_sources()

# Far behind the filter that fails.
fall = fall_of(DEMtoCFEMesh(FileName="nowhere.tif"))
assert "nowhere.tif" in error_of(lambda: servermanager.Fetch(fall, idx=3))
delete_sources()

# What is good goes on.
fall = fall_of(DEMtoCFEMesh())
table = servermanager.Fetch(fall, idx=3)
fates = vtk_to_numpy(table.GetRowData().GetArray("MaxKineticEnergy"))
assert fates.shape == (3,) and (fates > 0.0).all(), fates
delete_sources()

rockfall_strict.off()
slope = DEMtoCFEMesh(FileName="nowhere.tif")
assert error_of(slope.UpdatePipeline) == ""
print("errors are exceptions")
