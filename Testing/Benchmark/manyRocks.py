"""100,000 trajectories on a generated DEM of 2000 x 2000 nodes: time and memory of the whole pipeline.

    PV_PLUGIN_PATH=build/lib/paraview-5.11/plugins/RockfallDDA /usr/bin/time -v \\
      pvbatch Testing/Benchmark/manyRocks.py FOLDER [--trajectories 100000 --keep Thinned --no-impacts --threads 0]

The DEM is a slope of 35° with gullies that flattens out, 2 m cells; the rocks are cubes and icosahedra of
1 m3, 100 of them in 1000 iterations.
"""
import argparse
import os
import resource
import time

import numpy as np
from paraview.simple import *

NODES, CELL = 2000, 2.0

parser = argparse.ArgumentParser()
parser.add_argument("folder")
parser.add_argument("--trajectories", type=int, default=100000)
parser.add_argument("--rocks", type=int, default=100)
parser.add_argument("--keep", default="Thinned")
parser.add_argument("--interval", type=float, default=0.05)
parser.add_argument("--no-impacts", action="store_true")
parser.add_argument("--threads", type=int, default=0)
chosen = parser.parse_args()
os.makedirs(chosen.folder, exist_ok=True)


def mark(text):
    gigabytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    print(f"{time.time() - started:8.1f} s, at most {gigabytes:.2f} GB so far: {text}", flush=True)


started = time.time()
x, y = np.meshgrid(np.arange(NODES) * CELL, np.arange(NODES)[::-1] * CELL)
heights = (600.0 * np.exp(-x / 700.0) + 3.0 * np.sin(y / 15.0) * np.exp(-x / 900.0) +
           0.5 * np.sin(x / 7.0)).astype("<f4")
dem = os.path.join(chosen.folder, "dem.img")
heights.tofile(dem)
with open(os.path.join(chosen.folder, "dem.hdr"), "w") as file:
    file.write(f"ENVI\nsamples = {NODES}\nlines = {NODES}\nbands = 1\nheader offset = 0\n"
               "file type = ENVI Standard\ndata type = 4\ninterleave = bsq\nbyte order = 0\n"
               f"map info = {{Arbitrary, 1, 1, 0, {NODES * CELL}, {CELL}, {CELL}}}\n")
sources = os.path.join(chosen.folder, "sources.csv")
with open(sources, "w") as file:
    file.write("x,y,z,shape,volume\n")
    for k in range(chosen.rocks):
        column, row = 20 + k % 5, 200 + (k * (NODES - 400)) // chosen.rocks
        z = heights[row - 2:row + 3, column - 2:column + 3].max() + 3.0
        file.write(f"{column * CELL},{(NODES - 1 - row) * CELL},{z},"
                   f"{'cube' if k % 2 else 'icosahedron'},1\n")

slope = DEMtoCFEMesh(FileName=dem, RestitutionCoefficient=0.7, FrictionAngle=32,
                     RoughnessDeviation=0.1, MaximumDisplayCells=200000)
rocks = RockBlocks(FileName=sources)
fall = RockfallSimulation(OutputInterval=chosen.interval,
    Terrain=slope, Rocks=rocks, Iterations=max(1, chosen.trajectories // chosen.rocks), EndTime=60,
    TrajectoryOutput=chosen.keep, KeepImpacts=not chosen.no_impacts, NumberOfThreads=chosen.threads, PrintProgress=1)
slope.UpdatePipeline()
mark("the slope is there")
UpdatePipeline(0.0, fall)
fall.UpdatePropertyInformation()
lines = fall.GetClientSideObject().GetOutputDataObject(1)
impacts = fall.GetClientSideObject().GetOutputDataObject(2)
mark(f"{fall.GetClientSideObject().GetOutputDataObject(3).GetNumberOfRows()} trajectories, "
     f"{lines.GetNumberOfPoints()} points kept ({chosen.keep}), "
     f"{lines.GetActualMemorySize() / 2**20:.2f} GB of them, "
     f"{impacts.GetNumberOfPoints()} impacts, {impacts.GetActualMemorySize() / 2**20:.2f} GB, "
     f"state hash {fall.GetPropertyValue('StateHash')}")
