"""Elevation files that the tests of the window open: makeData.py folder.

hill.asc: a valley side at 2,600,000 / 1,200,000, as of the Swiss grid. jacksboro.tif: the sample DEM."""
import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Examples"))
import sample_dem

folder = sys.argv[1]
os.makedirs(folder, exist_ok=True)
with open(os.path.join(folder, "hill.asc"), "w") as file:
    n, cell = 61, 10.0
    file.write(f"ncols {n}\nnrows {n}\nxllcorner 2600000\nyllcorner 1200000\ncellsize {cell}\nnodata_value -9999\n")
    for row in range(n):
        north = 1.0 - row / (n - 1)
        # Steep in the upper third, flat in the valley, with a gully down the middle. Banks around the valley keep every
        # rock: one that left would move the camera and the notes.
        def height(east):
            bank = max(0.0, 1 - north / 0.08, (1 - min(east, 1 - east) / 0.06) * max(0.0, 1 - north / 0.6))
            return (900 + 20 * bank + 320 / (1 + math.exp(-9 * (north - 0.62)))
                    - 25 * math.exp(-((east - 0.5) / 0.12) ** 2) * north)
        file.write(" ".join(f"{height(column / (n - 1)):.2f}" for column in range(n)) + "\n")
sample_dem.write_geotiff(sample_dem.find_sample("jacksboro_fault_dem.npz"), os.path.join(folder, "jacksboro.tif"))
