"""What a forest, an embankment and a net keep from a road.

Rocks fall from a face through a forest towards a road; one half of the road has an embankment, the other half a
net. The same rocks, with the same draws of roughness, restitution and friction, fall without structures, with
each of them alone and with all three. Counted is who comes to the road; confidence intervals are over
iterations, because the rocks of one iteration meet the same draws. The site is invented, see
structures_parts/slope_site.py; docs/structures.md says how to give your own layers. Run it with

    bash Examples/run.sh structures.py [--output FOLDER --iterations N --rocks N --picture 0]

and find in output/structures the layers, shares.csv and shares.txt, what the structures met (met.csv), and the
picture structures.png.
"""
import argparse
import csv
import os
import sys

here = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [here, os.path.join(here, "mass_fall_parts"), os.path.join(here, "structures_parts")]

import numpy as np
from paraview.simple import *
from vtkmodules.util.numpy_support import vtk_to_numpy

import site_picture
import slope_site as site
from counts import interval
from rockfall_tables import result

SEED, END = 11, 45.0
CASES = {"no structures": (), "forest": ("TreeFile",), "embankment": ("EmbankmentFile",),
         "net": ("BarrierFile",), "all three": ("TreeFile", "EmbankmentFile", "BarrierFile")}


def arguments():
    parser = argparse.ArgumentParser(description="What a forest, an embankment and a net keep from a road.")
    parser.add_argument("--output", default=os.path.join(os.path.dirname(here), "output", "structures"))
    parser.add_argument("--iterations", type=int, default=20, help="realisations of each case (20)")
    parser.add_argument("--rocks", type=int, default=44, help="sources in the face (44)")
    parser.add_argument("--picture", type=int, default=1, help="0 makes no picture, which needs no X server")
    chosen = parser.parse_args()
    for name, least in (("iterations", 2), ("rocks", 1)):
        if getattr(chosen, name) < least:
            parser.error(f"--{name} is {getattr(chosen, name)}, it must be at least {least}")
    os.makedirs(chosen.output, exist_ok=True)
    return chosen


def on_road(fall, slope, road, iterations):
    """Rocks per iteration that come to the road: their first passing of its uphill side."""
    collector = TrajectoryCollector(Input=OutputPort(fall, 1), Terrain=slope, FileName=road)
    data = result(collector).GetPointData()
    passing, number = (vtk_to_numpy(data.GetArray(name)) if data.GetArray(name) else np.empty(0, int)
                       for name in ("Passing", "Iteration"))
    return np.bincount(number[passing == 0], minlength=iterations)


def met(fall):
    """How often the net stopped or lost, and trees broke."""
    outcome = result(fall, 4).GetPointData().GetArray("Outcome")
    outcome = vtk_to_numpy(outcome) if outcome else np.empty(0, int)
    return [int((outcome == k).sum()) for k in (0, 1, 3)]


def write_shares(counts, events, rocks, iterations, in_folder):
    """Shares of all rocks in per cent, and what each case keeps off the road that came there without."""
    bare = counts["no structures"] / rocks
    rows = []
    for name, on in counts.items():
        share = [100.0 * v for v in interval(on / rocks)]
        fewer = [100.0 * v for v in interval(bare - on / rocks)]
        rows.append([name, rocks * iterations, int(on.sum()), *share, *fewer, *events[name]])
    with open(in_folder("shares.csv"), "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["case", "rocks", "on_road", "share", "share_low", "share_high", "fewer", "fewer_low",
                        "fewer_high", "caught", "net_broken", "trees_broken"])
        table.writerows([row[:3] + [f"{v:.2f}" for v in row[3:9]] + row[9:] for row in rows])
    lines = [f"{rocks} rocks in {iterations} iterations; in brackets 95 % confidence", "",
             f"{'':16}{'come to the road, %':>24}{'fewer than without':>24}{'caught':>9}{'net broken':>12}"
             f"{'trees broken':>14}"]
    for row in rows:
        share = "{:.1f} ({:.1f} to {:.1f})".format(*row[3:6])
        fewer = "–" if row[0] == "no structures" else "{:.1f} ({:.1f} to {:.1f})".format(*row[6:9])
        lines.append(f"{row[0]:16}{share:>24}{fewer:>24}{row[9]:>9}{row[10]:>12}{row[11]:>14}")
    with open(in_folder("shares.txt"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    print("\n".join(lines))


def main():
    chosen = arguments()
    in_folder = lambda name: os.path.join(chosen.output, name)
    dem = site.write_slope(in_folder("slope.asc"))
    sources = site.write_sources(in_folder("sources.csv"), chosen.rocks)
    road = site.write_road(in_folder("road.csv"))
    layers = {"TreeFile": site.write_trees(in_folder("trees.csv")),
              "EmbankmentFile": site.write_embankment(in_folder("embankment.csv")),
              "BarrierFile": site.write_net(in_folder("net.csv"))}
    slopes, falls, counts, events = {}, {}, {}, {}
    for name, kinds in CASES.items():
        slope = DEMtoCFEMesh(FileName=dem, RestitutionCoefficient=0.7, RestitutionDeviation=0.05,
                             FrictionAngle=25, FrictionAngleDeviation=3, RoughnessDeviation=0.15,
                             TreesBreak=1, **{kind: layers[kind] for kind in kinds})
        rocks = RockBlocks(FileName=sources, Terrain=slope, AttitudeLaw="As given")
        fall = RockfallSimulation(Terrain=slope, Rocks=rocks, EndTime=END, Iterations=chosen.iterations,
                                  Seed=SEED)
        counts[name] = on_road(fall, slope, road, chosen.iterations)
        events[name] = met(fall)
        slopes[name], falls[name] = slope, fall
        print(f"{name}: {counts[name].sum()} of {chosen.rocks * chosen.iterations} come to the road", flush=True)
    SaveData(in_folder("met.csv"), proxy=OutputPort(falls["all three"], 4), Precision=12)
    write_shares(counts, events, chosen.rocks, chosen.iterations, in_folder)
    if chosen.picture:
        site_picture.draw([(name, slopes[name], falls[name]) for name in ("no structures", "all three")],
                          {name: 100.0 * counts[name].sum() / (chosen.rocks * chosen.iterations)
                           for name in counts}, in_folder("structures.png"))


main()
