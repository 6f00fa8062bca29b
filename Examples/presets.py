"""What each preset of ground makes of rocks, on slopes that field surveys speak of.

    bash Examples/run.sh presets.py [--output FOLDER --rocks N --presets Talus Meadow]

Rocks of 0.1, 1 and 10 m³ (EOTA rocks and cubes) are let go at the top of straight slopes with a flat
foot of the same ground, or of meadow. Written are presets.csv and presets.md: the greatest speed and the
greatest height over ground (95 % of the rocks), the speed at the foot (median), the reach angle of the
median and of the farthest 1 % (from release to stop), and the time until the last rock rests. Field
surveys: reach angles of the farthest rocks 27.5° to 32°, speeds below 30 m/s, jumps of some metres.
"""
import argparse
import csv
import os
import sys

here = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, here)

import numpy as np
from paraview.simple import *

import rockfall_tables as tables

SLOPES = ((30.0, 50.0), (40.0, 150.0), (35.0, 258.0))  # degrees, drop in m; the last one is 450 m long
VOLUMES = (0.1, 1.0, 10.0)                             # m³
SHAPES = ("eota111", "cube", "eota221")
CELL = 2.0      # m
WIDTH = 120.0   # m
TOP = 8.0       # of the slope above the release, m
SPACING = 0.04  # between releases, m: three, of one shape, are farther apart than sources given twice
BEYOND = 700.0  # of flat ground, m
END = 600.0     # s
MEADOW = "Meadow (field data)"
COLUMNS = ("preset", "slope, °", "drop, m", "foot", "volume, m³", "speed 95 %, m/s", "jump 95 %, m",
           "speed at the foot, m/s", "reach median, °", "reach 1 %, °", "last at rest, s")


def write_grid(path, values, cell, digits):
    with open(path, "w") as file:
        file.write(f"ncols {values.shape[1]}\nnrows {values.shape[0]}\nxllcorner 0\nyllcorner 0\n"
                   f"cellsize {cell}\n")
        np.savetxt(file, values, fmt=digits)


def make_slope(folder, angle, drop, meadow, **ground):
    """A straight slope that falls along +x; gives it and where its foot is, m."""
    foot = CELL * round((TOP + drop / np.tan(np.radians(angle))) / CELL)
    x = np.arange(0.5 * CELL, foot + BEYOND, CELL)
    heights = np.maximum(0.0, foot - x) * np.tan(np.radians(angle))
    rows = int(WIDTH / CELL)
    write_grid(os.path.join(folder, "slope.asc"), np.tile(heights, (rows, 1)), CELL, "%.6g")
    layers = {}
    if meadow:
        write_grid(os.path.join(folder, "classes.asc"), np.tile(x > foot, (rows, 1)), CELL, "%d")
        with open(os.path.join(folder, "classes.csv"), "w") as file:
            file.write(f"class,preset\n1,{MEADOW}\n0,{ground['Preset'] if ground.get('Preset') else MEADOW}\n")
        layers = {f"{kind}{part}": os.path.join(folder, "classes." + end)
                  for kind in ("Restitution", "Joint") for part, end in (("Layer", "asc"), ("Table", "csv"))}
    return DEMtoCFEMesh(FileName=os.path.join(folder, "slope.asc"), **layers, **ground), foot


def measure(folder, angle, drop, volume, meadow, rocks, penalty=None, **ground):
    """Figures of COLUMNS from the sixth on."""
    slope, foot = make_slope(folder, angle, drop, meadow, **ground)
    with open(os.path.join(folder, "rocks.csv"), "w") as file:
        file.write("x,y,height,volume,shape\n")
        for k in range(rocks):
            file.write(f"{TOP},{WIDTH / 2 + SPACING * (k - rocks / 2):.3f},2,{volume},{SHAPES[k % 3]}\n")
    blocks = RockBlocks(Terrain=slope, FileName=os.path.join(folder, "rocks.csv"), AttitudeLaw="Random",
                        Velocity=[1.5, 0.0, 0.0])
    fall = RockfallSimulation(Terrain=slope, Rocks=blocks, EndTime=END, OutputInterval=0.1, KeepImpacts=0)
    if penalty:
        fall.NormalPenalty = penalty
    paths = tables.Trajectories(tables.result(fall, 1))
    summary = {name: np.array(column) for name, column in tables.columns_of(tables.result(fall, 3)).items()}
    at_foot = []
    for rock in range(len(paths.block)):
        own = paths.of(rock)
        passed = np.nonzero(paths.points[own, 0] > foot)[0]
        at_foot.append(paths.speed[own][passed[0]] if len(passed) else 0.0)
    reach = np.degrees(np.arctan2(summary["StartZ"] - summary["StopZ"], summary["RunOut"]))
    for proxy in (fall, blocks, slope):
        Delete(proxy)
    return (np.percentile(summary["MaxSpeed"], 95), np.percentile(summary["MaxHeightOverGround"], 95),
            np.median(at_foot), np.median(reach), np.percentile(reach, 1), summary["EndTime"].max())


def main():
    parser = argparse.ArgumentParser(description="A table of what each preset makes of rocks.")
    parser.add_argument("--output", default=os.path.join(os.path.dirname(here), "output", "presets"),
                        help="folder for the tables (output/presets of this project)")
    parser.add_argument("--rocks", type=int, default=200, help="rocks of each size (200)")
    parser.add_argument("--presets", nargs="*", help="only these, without what stands in brackets")
    chosen = parser.parse_args()
    if chosen.rocks < 1:
        parser.error(f"--rocks is {chosen.rocks}, it must be at least 1")
    if "RockfallSimulation" not in globals():
        raise SystemExit("The plugin RockfallDDA is not loaded: run this with bash Examples/run.sh.")
    os.makedirs(chosen.output, exist_ok=True)
    known = servermanager.sources.DEMtoCFEMesh().GetProperty("Preset").Available[1:]
    presets = [p for p in known if not chosen.presets or p.split(" (")[0] in chosen.presets]
    rows = []
    for preset in presets:
        for angle, drop in SLOPES:
            for meadow in (False,) if preset == MEADOW else (False, True):
                for volume in VOLUMES if not meadow else (1.0,):
                    rows.append((preset.split(" (")[0], angle, drop, "meadow" if meadow else "same", volume) +
                                measure(chosen.output, angle, drop, volume, meadow, chosen.rocks, Preset=preset))
                    print("  ".join(f"{v:.3g}" if isinstance(v, float) else v for v in rows[-1]), flush=True)
    with open(os.path.join(chosen.output, "presets.csv"), "w", newline="") as file:
        csv.writer(file).writerows([COLUMNS, *rows])
    with open(os.path.join(chosen.output, "presets.md"), "w") as file:
        file.write("| " + " | ".join(COLUMNS) + " |\n" + "|---" * len(COLUMNS) + "|\n")
        for row in rows:
            file.write("| " + " | ".join(f"{v:.3g}" if isinstance(v, float) else v for v in row) + " |\n")
    print("In " + chosen.output + ": presets.csv, presets.md")


if __name__ == "__main__":
    main()
