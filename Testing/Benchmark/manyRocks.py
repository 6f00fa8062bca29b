"""100,000 trajectories on a generated DEM of 2000 x 2000 nodes, as a study with a hazard map and
collectors: time and memory of all of it.

    PV_PLUGIN_PATH=build/lib/paraview-5.11/plugins/RockfallDDA /usr/bin/time -v \\
      pvbatch Testing/Benchmark/manyRocks.py FOLDER [--trajectories 100000 --chunk 50 --threads 0 --alone --fall 600]

The DEM is a slope of 35° with gullies that flattens out, 600 m high, 2 m cells; the rocks are cubes and
icosahedra of 1 m3, 100 of them in 1000 iterations; two roads cross their way. The study is that of
Examples/study.py; what is in FOLDER already is not done again. A million trajectories take a quarter of an
hour on a slope that is 12 m high:

    ... manyRocks.py FOLDER --fall 12 --trajectories 1000000 --rocks 1000 --chunk 20
"""
import argparse
import json
import os
import resource
import runpy
import sys
import time

import numpy as np

NODES, CELL = 2000, 2.0
STUDY = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Examples", "study.py")

parser = argparse.ArgumentParser()
parser.add_argument("folder")
parser.add_argument("--trajectories", type=int, default=100000)
parser.add_argument("--rocks", type=int, default=100)
parser.add_argument("--chunk", type=int, default=50, help="iterations that are in memory at once")
parser.add_argument("--fall", type=float, default=600.0, help="height of the slope, m; its length goes with it")
parser.add_argument("--keep-trajectories", action="store_true")
parser.add_argument("--alone", action="store_true", help="without map and lines: the simulation by itself")
parser.add_argument("--threads", type=int, default=0)
chosen = parser.parse_args()
os.makedirs(chosen.folder, exist_ok=True)

started = time.time()
x, y = np.meshgrid(np.arange(NODES) * CELL, np.arange(NODES)[::-1] * CELL)
fall = chosen.fall
heights = (fall * np.exp(-x / (fall * 7 / 6)) + 3.0 * np.sin(y / 15.0) * np.exp(-x / (fall * 3 / 2)) +
           0.5 * np.sin(x / 7.0)).astype("<f4")
del x, y
dem = os.path.join(chosen.folder, "dem.img")
heights.tofile(dem)
with open(os.path.join(chosen.folder, "dem.hdr"), "w") as file:
    file.write(f"ENVI\nsamples = {NODES}\nlines = {NODES}\nbands = 1\nheader offset = 0\n"
               "file type = ENVI Standard\ndata type = 4\ninterleave = bsq\nbyte order = 0\n"
               f"map info = {{Arbitrary, 1, 1, 0, {NODES * CELL}, {CELL}, {CELL}}}\n")
first = max(3, round(fall / 30))  # column of the westernmost rocks
with open(os.path.join(chosen.folder, "sources.csv"), "w") as file:
    file.write("x,y,z,shape,volume\n")
    for k in range(chosen.rocks):
        column, row = first + k % 5, 200 + (k * (NODES - 400)) // chosen.rocks
        z = heights[row - 2:row + 3, column - 2:column + 3].max() + 3.0
        file.write(f"{column * CELL},{(NODES - 1 - row) * CELL},{z},"
                   f"{'cube' if k % 2 else 'icosahedron'},1\n")
del heights
with open(os.path.join(chosen.folder, "roads.csv"), "w") as file:
    file.write("WKT,name\n" + "".join(
        f'"LINESTRING({at:g} 0,{at:g} {NODES * CELL})",road at {at:g} m\n' for at in (first * CELL + fall * part / 600 for part in (160, 460))))
with open(os.path.join(chosen.folder, "study.json"), "w") as file:
    json.dump({
        "terrain": {"FileName": "dem.img", "RestitutionCoefficient": 0.7, "FrictionAngle": 32,
                    "RoughnessDeviation": 0.1, "MaximumDisplayCells": 200000},
        "rocks": {"FileName": "sources.csv"},
        "simulation": {"EndTime": 60, "TrajectoryOutput": "Thinned"},
        **({} if chosen.alone else {"map": {}, "lines": {"FileName": "roads.csv"}}),
        "trajectories": chosen.keep_trajectories,
        "iterations": max(1, chosen.trajectories // chosen.rocks), "chunk": chosen.chunk}, file)

sys.argv = [STUDY, os.path.join(chosen.folder, "results"), os.path.join(chosen.folder, "study.json"),
            "--threads", str(chosen.threads)]
runpy.run_path(STUDY, run_name="__main__")
used = resource.getrusage(resource.RUSAGE_SELF)
print(f"{time.time() - started:.0f} s, of processors {used.ru_utime + used.ru_stime:.0f} s, "
      f"at most {used.ru_maxrss / 2**20:.2f} GB", flush=True)
