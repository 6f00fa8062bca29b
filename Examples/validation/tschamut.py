"""Real rocks on real ground: simulated run-outs beside those of a field experiment.

Given a folder of a field test with single rocks (see field_test.py for its four files), every run is
simulated with many attitudes and many realisations of the ground; the run-outs and stopping points
are compared with the observed ones, as a table and as a map.

    bash Examples/run.sh validation/tschamut.py FOLDER [--output FOLDER] [--calibrate N] ...

The ground parameters that are the defaults were found with --calibrate on 18 of the 80 runs of the
experiment in Tschamut 2014 (doi:10.16904/envidat.34); docs/validation.md has how, and how well. The
results are in output/tschamut: map.png, comparison.csv, runs.csv, stops.csv, and after a calibration
candidates.csv and calibration.txt.
"""
import argparse
import csv
import os
import sys
import time

here = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [here, os.path.dirname(here)]

import numpy as np
from paraview.simple import *

import field_fit as fit
import field_map
import field_scores as scores
from field_rocks import Sources
from field_test import FieldTest
from rockfall_ground import Ground
from rockfall_tables import columns_of

# The ground: name, option, default, and the range that a calibration searches; one without a range
# keeps its value. The restitution is normal and tangential (RestitutionModel 1).
PARAMETERS = (
    ("RestitutionCoefficient", "--restitution", 0.3, None, "Rn, 0 to 1"),
    ("TangentialRestitution", "--tangential", 0.875, (0.84, 0.93), "Rt, 0 to 1"),
    ("FrictionAngle", "--friction", 46.0, (32.0, 52.0), "friction angle in degrees"),
    ("RoughnessDeviation", "--roughness", 0.041, (0.0, 0.06), "deviation of the nodes' heights in m"),
)
CELL = 0.5  # m: about the size of the rocks, for which the ground is rough
END = 60.0  # s
started = time.time()


def say(text):
    print(f"[{time.time() - started:6.1f} s] {text}", flush=True)


def arguments():
    parser = argparse.ArgumentParser(
        description="Simulates the runs of a field test and compares them with what was observed.")
    parser.add_argument("folder", help="folder with block_metadata.csv, release_points.csv, "
                                       "observed_deposition.csv and terrain.asc")
    parser.add_argument("--output", default=os.path.join(
        os.path.dirname(os.path.dirname(here)), "output", "tschamut"), help="folder for the results")
    parser.add_argument("--attitudes", type=int, default=8, help="attitudes at release per run (8)")
    parser.add_argument("--iterations", type=int, default=10, help="realisations of the ground (10)")
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


def made_by(proxy, port=0):
    """What a filter made; pvbatch is its own server, so nothing is copied."""
    data = proxy.GetClientSideObject().GetOutputDataObject(port)
    if data is None or data.GetNumberOfElements(6 if data.IsA("vtkTable") else 0) == 0:
        raise SystemExit(f"{proxy.GetXMLLabel()} made nothing; the message above says why.")
    return data


class Experiment:
    """The pipeline: the slope, the rocks of all runs at once, and what became of them."""

    def __init__(self, test, chosen):
        self.chosen = chosen
        grid = os.path.join(chosen.output, "terrain.asc")
        test.write_terrain(grid, chosen.pixels)
        self.slope = DEMtoCFEMesh(FileName=grid, CellSize=CELL,
                                  RestitutionModel="Normal and tangential")
        self.slope.UpdatePipeline()
        self.ground = Ground(made_by(self.slope))
        self.observed = scores.Observed(test)
        self.sources = Sources(test, self.ground, chosen.attitudes, chosen.seed, chosen.output)
        self.sources.rocks.UpdatePipeline()
        made_by(self.sources.rocks)
        self.simulation = RockfallSimulation(
            Terrain=self.slope, Rocks=self.sources.rocks, EndTime=END, OutputInterval=END,
            Iterations=chosen.iterations, Seed=chosen.seed, NumberOfThreads=chosen.threads)

    def run(self, values):
        for (name, *_), value in zip(PARAMETERS, values):
            setattr(self.slope, name, float(value))
        self.simulation.UpdatePipeline(0.0)
        columns = columns_of(made_by(self.simulation, 3))
        # The columns belong to the filter, which reuses their memory.
        columns = {name: np.array(column) for name, column in columns.items()}
        return scores.Simulated(self.observed, self.sources.run[columns["RockId"]], columns)


def calibrate(experiment, count, output, seed):
    parameters = fit.candidates(count, {name: span or 2 * (getattr(experiment.chosen, name),)
                                        for name, _, _, span, _ in PARAMETERS})
    every = []
    for k, values in enumerate(parameters):
        every.append(experiment.run(values).scores(experiment.observed))
        fit.write(os.path.join(output, "candidates.csv"), parameters, every)
        say(f"  candidate {k + 1} of {count}: " + ", ".join(f"{v:g}" for v in values) +
            f": run-out {every[-1][:, fit.MEAN].mean():.1f} m, "
            f"energy score {every[-1][:, fit.ES].mean():.2f} m")
    lines, best = fit.report(np.array(every), experiment.observed, parameters,
                             scores.climatology(experiment.observed), seed)
    text = "\n".join(lines)
    print(text)
    with open(os.path.join(output, "calibration.txt"), "w", encoding="utf-8") as file:
        file.write(text + "\n")
    return parameters[best]


def write_table(path, header, rows):
    with open(path + ".part", "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(header)
        writer.writerows(rows)
    os.replace(path + ".part", path)


def write_results(test, experiment, simulated, table, output):
    path = lambda name: os.path.join(output, name)
    number = lambda value: "" if value is None else f"{value:.3f}"
    write_table(path("comparison.csv"), ["What", "Unit", "Observed", "Simulated"],
                [[what, unit, number(seen), number(made)] for what, unit, seen, made in table])
    rows, observed = [], experiment.observed
    for k, (crps, energy, mean) in enumerate(simulated.scores(observed)):
        values = simulated.run_out[simulated.of(k)]
        rows.append([test.runs[k].id, test.runs[k].block, number(observed.run_out[k]), number(mean)] +
                    [number(np.percentile(values, q)) for q in scores.QUANTILES] +
                    [number(crps), number(energy)])
    write_table(path("runs.csv"),
                ["Run", "Block", "ObservedRunOut_m", "MeanRunOut_m"] +
                [f"RunOut{q}_m" for q in scores.QUANTILES] + ["CRPS_m", "EnergyScore_m"], rows)
    write_table(path("stops.csv"), ["Run", "X", "Y", "RunOut_m", "Started", "FateCode"],
                [[test.runs[k].id, f"{x:.3f}", f"{y:.3f}", f"{run:.3f}", int(moved), fate]
                 for k, (x, y), run, moved, fate in zip(simulated.run, simulated.stop, simulated.run_out,
                                                        simulated.started, simulated.fate)])


def print_table(table):
    print(f"\n{'':46}{'observed':>10}{'simulated':>11}")
    for what, unit, seen, made in table:
        print(f"{what + ', ' + unit:46}{'' if seen is None else f'{seen:.1f}':>10}{made:11.1f}")


def main():
    chosen = arguments()
    if "RockfallSimulation" not in globals():
        raise SystemExit("The plugin RockfallDDA is not loaded: run this with bash Examples/run.sh.")
    test = FieldTest(chosen.folder)
    experiment = Experiment(test, chosen)
    observed, raised = experiment.observed, np.array(experiment.sources.raised)
    say(f"{len(test.runs)} runs of {len(set(observed.block))} blocks, "
        f"{len(experiment.sources.run)} rocks, {chosen.iterations} iterations; release heights are taken from the terrain, "
        f"{raised.min():+.1f} to {raised.max():+.1f} m beside those of the table")
    values = [getattr(chosen, name) for name, *_ in PARAMETERS]
    if chosen.calibrate:
        values = calibrate(experiment, chosen.calibrate, chosen.output, chosen.seed)
    simulated = experiment.run(values)
    say("Ground: " + ", ".join(f"{name} {value:g}" for (name, *_), value in zip(PARAMETERS, values)))

    if not simulated.started.any():
        raise SystemExit(f"No rock ran farther than {scores.STARTED:g} m: nothing to compare.")
    drop = np.array([experiment.ground.height(*run.start[:2]) - experiment.ground.height(*run.stop)
                     for run in test.runs])
    table = scores.comparison(observed, simulated, drop)
    print_table(table)
    own = simulated.scores(observed)
    error = 100 * (table[0][3] / table[0][2] - 1)
    print(f"\nMean run-out: {error:+.1f} % of the observed one. CRPS of the run-out "
          f"{own[:, fit.CRPS].mean():.1f} m (without a model {scores.climatology(observed):.1f} m), "
          f"energy score of the stopping points {own[:, fit.ES].mean():.1f} m")
    write_results(test, experiment, simulated, table, chosen.output)
    name = os.path.basename(os.path.normpath(chosen.folder))
    field_map.draw(os.path.join(chosen.output, "map.png"), test, experiment.ground, observed,
                   simulated, f"{name}: {len(test.runs)} runs observed, "
                              f"{simulated.started.sum()} simulated")
    say(f"Written to {chosen.output}: map.png, comparison.csv, runs.csv, stops.csv")


main()
