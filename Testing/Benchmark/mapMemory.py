"""Memory that a hazard map of many cells takes, cropped to the trajectories and not, and its GeoTIFF.

    PV_PLUGIN_PATH=build/lib/paraview-5.11/plugins/RockfallDDA pvbatch Testing/Benchmark/mapMemory.py [million cells]

Each figure is the peak of the resident memory while it is done over what the process had before: ten rocks on a
plane of 35° with cells of 2 m.
"""
import math
import os
import sys
import tempfile

import numpy as np
from paraview.simple import *

MILLIONS = float(sys.argv[1]) if len(sys.argv) > 1 else 10.0
CELL = 2.0


def memory(what):
    """VmHWM or VmRSS of /proc/self/status, GB."""
    with open("/proc/self/status") as status:
        return next(float(line.split()[1]) for line in status if line.startswith(what)) / 2**20


def measure(title, work):
    with open("/proc/self/clear_refs", "w") as file:
        file.write("5")  # the peak begins anew
    before = memory("VmRSS")
    work()
    print(f"{title:28s} {memory('VmHWM') - before:6.2f} GB more at most, {memory('VmRSS') - before:6.2f} kept", flush=True)


def make_map(crop, **more):
    made = RockfallHazardMap(Input=OutputPort(fall, 1), CropToTrajectories=crop, **more)
    made.UpdatePipeline()
    return made


folder = tempfile.mkdtemp()
nodes = math.isqrt(int(MILLIONS * 1e6)) + 1
heights = np.broadcast_to((nodes * CELL - np.arange(nodes) * CELL) * math.tan(math.radians(35)), (nodes, nodes))
heights.astype("<f4").tofile(os.path.join(folder, "dem.img"))
del heights
with open(os.path.join(folder, "dem.hdr"), "w") as file:
    file.write(f"ENVI\nsamples = {nodes}\nlines = {nodes}\nbands = 1\nheader offset = 0\nfile type = ENVI Standard\n"
               "data type = 4\ninterleave = bsq\nbyte order = 0\n"
               f"map info = {{Arbitrary, 1, 1, 0, {nodes * CELL}, {CELL}, {CELL}}}\n")
slope = DEMtoCFEMesh(FileName=os.path.join(folder, "dem.img"), MaximumDisplayCells=100000, RoughnessDeviation=0.1)
slope.UpdatePipeline()
release = RockRelease(Terrain=slope, Points=[100, 100, 0, 100, nodes * CELL - 100, 0], Amount=10)
fall = RockfallSimulation(Rocks=release, Iterations=1, EndTime=30)
fall.UpdatePipeline()
print(f"{(nodes - 1)**2 / 1e6:.1f} million cells, {memory('VmRSS'):.2f} GB before", flush=True)
chosen = {}
measure("cropped", lambda: chosen.update(map=make_map(1)))
print(f"{chosen['map'].GetDataInformation().GetNumberOfCells() / 1e6:.2f} million cells")
Delete(chosen.pop("map"))
measure("uncropped", lambda: chosen.update(map=make_map(0)))
measure("GeoTIFF of it", lambda: SaveData(os.path.join(folder, "map.tif"), proxy=chosen["map"]))
print(f"{os.path.getsize(os.path.join(folder, 'map.tif')) / 2**20:.0f} MB of file")
if chosen["map"].GetProperty("Statistics"):
    Delete(chosen.pop("map"))
    measure("uncropped, all statistics",
            lambda: chosen.update(map=make_map(0, Statistics=["Mean", "Maximum", "50 %", "90 %", "95 %", "99 %"])))
    measure("GeoTIFF of it", lambda: SaveData(os.path.join(folder, "all.tif"), proxy=chosen["map"]))
