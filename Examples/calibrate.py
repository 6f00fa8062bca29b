"""Calibration: which ground makes rocks stop where they were found.

Of a place with sources and observed stopping points, the parameters of the ground are searched within
ranges; each candidate is scored by how well the simulated stopping points foretell the observed ones.
Deposits that were held out, and a bootstrap, say how far the result may be believed.

    bash Examples/run.sh calibrate.py SITE.json [--output FOLDER] [--candidates N] ...

SITE.json, all paths from where it stands:

    {
      "terrain":    {"FileName": "dem.tif", "CellSize": 0.5,
                     "RestitutionModel": "Normal and tangential", "RestitutionCoefficient": 0.3},
      "rocks":      {"FileName": "sources.gpkg", "AttitudeLaw": "Random"},
      "simulation": {"EndTime": 60, "Iterations": 30},
      "deposits":   {"FileName": "deposits.gpkg", "BySource": true},
      "search":     {"TangentialRestitution": [0.84, 0.93], "FrictionAngle": [32, 52]}
    }

"terrain", "rocks" and "simulation" are properties of DEM to CFE Mesh, Rock Blocks and Rockfall
Simulation. "deposits" are points, read as a layer of sources is. With "BySource" each has a column
`source_id`, and is foretold by the rocks of that source; without it by the rocks of all. With
"TrackedMargin" (m) run-outs count to the edge of the tracked ground: what lies so far around the sources
and deposits, beyond which the terrain is a guess. "search" has
numbers of the slope with their ranges, ten at most; the rest of the ground is as "terrain" says.

The results are in output/NAME of SITE.json: report.md with map.png and search.png, candidates.csv,
calibration.txt, comparison.csv, runs.csv, stops.csv. docs/calibration.md has what they mean.
"""
import argparse
import json
import os
import sys

here = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [here, os.path.join(here, "calibrate_parts")]

from paraview.simple import *

import site_layers
import site_runs


def arguments():
    parser = argparse.ArgumentParser(
        description="Searches the ground with which rocks stop where they were found.")
    parser.add_argument("site", help="JSON file that describes the place")
    parser.add_argument("--output", help="folder for the results (output/NAME of the site's file)")
    parser.add_argument("--candidates", type=int, default=64,
                        help="how many are tried (64); 0 compares the ground as it is")
    parser.add_argument("--folds", type=int, default=5, help="parts that are held out in turn (5)")
    parser.add_argument("--seed", type=int, default=1, help="of all random numbers (1)")
    parser.add_argument("--threads", type=int, default=0, help="0, the default, takes all")
    chosen = parser.parse_args()
    for name, least in (("candidates", 0), ("folds", 2), ("seed", 0), ("threads", 0)):
        if getattr(chosen, name) < least:
            parser.error(f"--{name} is {getattr(chosen, name)}, it must be at least {least}")
    stem = os.path.splitext(os.path.basename(chosen.site))[0]
    if not chosen.output:
        chosen.output = os.path.join(os.path.dirname(here), "output", stem)
    try:
        os.makedirs(chosen.output, exist_ok=True)
    except OSError as error:
        parser.error(f"--output {chosen.output}: {error.strerror}")
    return chosen, stem


def main():
    chosen, stem = arguments()
    if "RockfallSimulation" not in globals():
        raise SystemExit("The plugin RockfallDDA is not loaded: run this with bash Examples/run.sh.")
    description = site_layers.read_site(chosen.site)
    site, names = site_layers.make_site(description, chosen.seed, chosen.threads)
    site_runs.say(f"{len(names)} deposits, {len(site.forecast)} rocks, "
                  f"{site.simulation.Iterations} iterations")
    ranges = description["search"]
    fit, values = None, {}
    if chosen.candidates and ranges:
        fit = site_runs.search(site, ranges, chosen.candidates, chosen.folds, chosen.seed, chosen.output)
        values = dict(zip(ranges, fit.values()))
    else:
        values = {name: getattr(site.slope, name) for name in ranges}
    site_runs.compare(site, values, names, stem, chosen.output, fit)
    print("Ground to use: " + json.dumps({"terrain": {
        name: float(value) for name, value in values.items()}}))


main()
