"""Real rocks on real ground: simulated run-outs beside those of a field experiment.

Given a folder of a field test with single rocks (see field_test.py for its four files), every run is
simulated on many realisations of the ground, each with attitudes of its own; the run-outs and stopping
points are compared with the observed ones, as a table and as a map: as simulated, and within the tracked
ground, which ends a cell of the grid beyond what was observed.

    bash Examples/run.sh validation/tschamut.py FOLDER [--output FOLDER] [--calibrate N] ...

The ground parameters that are the defaults are those of a meadow, found on 62 of the 80 runs of the
experiment in Tschamut 2014 (doi:10.16904/envidat.34); docs/validation.md has how, and how well. The
results are in output/tschamut: report.md, map.png, comparison.csv, runs.csv, stops.csv, and after a
calibration candidates.csv, calibration.txt and search.png.
"""
import argparse
import os
import sys

here = os.path.dirname(os.path.abspath(__file__))
examples = os.path.dirname(here)
sys.path[:0] = [here, examples, os.path.join(examples, "calibrate_parts")]

from paraview.simple import *

import site_runs
from field_rocks import Sources
from field_test import FieldTest
from rockfall_ground import Ground
from site_runs import made_by, say
from site_scores import Observed

# The ground: property, option, default, and the range that a calibration searches; one without a range
# keeps its value. The restitution is speed-dependent (RestitutionModel 2), friction that of slip.
PARAMETERS = (
    ("RestitutionCoefficient", "--restitution", 0.73, None, "Rn, 0 to 1"),
    ("RestitutionDeviation", "--restitution-deviation", 0.34, None, "of Rn"),
    ("RestitutionSpeed", "--restitution-speed", 7.0, None, "normal speed at which half of Rn is left, m/s"),
    ("TangentialRestitution", "--tangential", 1.0, None, "Rt, 0 to 1"),
    ("GroundModulus", "--modulus", 13.0, None, "ME in MN/m2, 0 for hard ground"),
    ("ScarDepthFactor", "--depth-factor", 0.125, None, "of the scar's depth"),
    ("ScarCompaction", "--compaction", 0.45, None, "Cs"),
    ("ScarSpinDrag", "--spin-drag", 0.0, None, "Cw"),
    ("SlipFrictionMin", "--least-friction", 0.98, (0.75, 1.1), "friction without slip"),
    ("SlipFrictionMax", "--most-friction", 2.0, None, "friction after much slip, 0 for a constant one"),
    ("SlipFrictionGrowth", "--friction-growth", 3.0, None, "in 1/m"),
    ("SlipFrictionDecay", "--friction-decay", 185.0, None, "in 1/s"),
    ("FrictionAngle", "--friction", 30.0, None, "in degrees, if no friction of slip is given"),
    ("RollingResistance", "--rolling", 0.18, (0.14, 0.24), "of the rock's radius"),
    ("GroundDeviation", "--ground-deviation", 0.1, None, "of ln S, how soft the ground is"),
    ("GroundDeviationLength", "--ground-length", 30.0, None, "over which it is alike, m"),
    ("RoughnessDeviation", "--roughness", 0.1, None, "deviation of the ground's height in m"),
    ("RoughnessLength", "--roughness-length", 2.0, None, "its correlation length in m, 0 for the nodes'"),
)
CELL = 0.5  # m: about the size of the rocks, for which the ground is rough
END = 60.0  # s


def arguments():
    parser = argparse.ArgumentParser(
        description="Simulates the runs of a field test and compares them with what was observed.")
    parser.add_argument("folder", help="folder with block_metadata.csv, release_points.csv, "
                                       "observed_deposition.csv and terrain.asc")
    parser.add_argument("--output", default=os.path.join(
        os.path.dirname(examples), "output", "tschamut"), help="folder for the results")
    parser.add_argument("--attitudes", type=int, default=1,
                        help="rocks per run in each iteration, with attitudes of their own (1)")
    parser.add_argument("--iterations", type=int, default=80, help="realisations of the ground (80)")
    parser.add_argument("--seed", type=int, default=1, help="of all random numbers (1)")
    parser.add_argument("--threads", type=int, default=0, help="0, the default, takes all")
    parser.add_argument("--calibrate", type=int, default=0, metavar="N",
                        help="search N candidates for the best ground parameters, then use those")
    parser.add_argument("--pixels", action="store_true",
                        help="xllcorner of terrain.asc is the corner of a pixel, as GDAL has it, not "
                             "the place of a node")
    for name, option, default, _, what in PARAMETERS:
        parser.add_argument(option, type=float, default=default, dest=name, metavar="VALUE",
                            help=f"{what} ({default:g})")
    chosen = parser.parse_args()
    for name in ("attitudes", "iterations"):
        if getattr(chosen, name) < 1:
            parser.error(f"--{name} is {getattr(chosen, name)}, it must be at least 1")
    if chosen.attitudes * chosen.iterations < 2:
        parser.error("--attitudes 1 and --iterations 1 make one rock per run, at least 2 are needed")
    if chosen.calibrate < 0 or chosen.seed < 0 or chosen.threads < 0:
        parser.error("--calibrate, --seed and --threads must not be negative")
    try:
        os.makedirs(chosen.output, exist_ok=True)
    except OSError as error:
        parser.error(f"--output {chosen.output}: {error.strerror}")
    return chosen


def make_site(test, chosen):
    """The pipeline: the slope, and the rocks of all runs at once. Every run is foretold by its own."""
    grid = os.path.join(chosen.output, "terrain.asc")
    test.write_terrain(grid, chosen.pixels)
    slope = DEMtoCFEMesh(FileName=grid, CellSize=CELL, RestitutionDeviation=0, RoughnessMean=0,
                         RestitutionModel="Speed-dependent", DeviationPer="Impact")
    slope.UpdatePipeline()
    sources = Sources(test, Ground(made_by(slope)), chosen.attitudes, chosen.output)
    sources.rocks.UpdatePipeline()
    made_by(sources.rocks)
    observed = Observed([run.start[:2] for run in test.runs], [run.stop for run in test.runs],
                        range(len(test.runs)), [test.blocks[run.block].name for run in test.runs],
                        float(test.header["cellsize"]))
    site = site_runs.Site(slope, sources.rocks, observed, sources.run, {
        "EndTime": END, "Iterations": chosen.iterations, "Seed": chosen.seed,
        "NumberOfThreads": chosen.threads})
    say(f"{len(test.runs)} runs of {len(observed.groups())} blocks, {len(sources.run)} rocks, "
        f"{chosen.iterations} iterations; release heights are taken from the terrain, "
        f"{min(sources.raised):+.1f} to {max(sources.raised):+.1f} m beside those of the table")
    return site


def main():
    chosen = arguments()
    if "RockfallSimulation" not in globals():
        raise SystemExit("The plugin RockfallDDA is not loaded: run this with bash Examples/run.sh.")
    test = FieldTest(chosen.folder)
    site = make_site(test, chosen)
    values = {name: getattr(chosen, name) for name, *_ in PARAMETERS}
    for name, value in values.items():
        setattr(site.slope, name, value)
    fit = None
    if chosen.calibrate:
        ranges = {name: span for name, _, _, span, _ in PARAMETERS if span}
        fit = site_runs.search(site, ranges, chosen.calibrate, 5, chosen.seed, chosen.output)
        values.update(zip(ranges, fit.values()))
    name = os.path.basename(os.path.normpath(chosen.folder))
    site_runs.compare(site, values, [run.id for run in test.runs], name, chosen.output, fit)


main()
