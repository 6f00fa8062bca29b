"""Runs of a field test that are held out: each is foretold by the ground that does best on the others.

    calibrateTschamut FOLDER --set GroundModulus=14.5 --output other.csv     # once for each ground
    python3 Examples/validation/folds.py preset.csv other.csv ...

The ground of each fold is that of the least mean CRPS of the run-outs, within the tracked ground, over
the runs of the other folds. Folds have runs of every rock; in a second way each is a rock.
"""
import csv
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "calibrate_parts"))

import site_scores as scores
from site_search import folds, held_out

FOLDS = 5
AS_SIMULATED, TRACKED = "as simulated", "within the tracked ground"  # in the column Scored
COLUMNS = {scores.CRPS: "CRPS", scores.ES: "EnergyScore", scores.MEAN: "MeanRunOut", scores.RANK: "Rank"}


class Runs:
    """The runs of a table, in order: what `folds` asks of observations."""

    def __init__(self, rows):
        self.run_out = np.array([float(row["ObservedRunOut"]) for row in rows])
        self.group = np.array([row["Block"] for row in rows])
        # A run that is there twice is held out together with its copy.
        _, self.same = np.unique([f'{row["Block"]} {row["ObservedRunOut"]}' for row in rows], return_inverse=True)

    def groups(self):
        return sorted(set(self.group))


def read(path):
    """The rows of a table by the way of scoring."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {way: [row for row in rows if row["Scored"] == way] for way in dict.fromkeys(r["Scored"] for r in rows)}


def print_line(name, predicted, seen):
    made = predicted[:, scores.MEAN].mean()
    print(f"  {name:12} {made:6.1f} m for {seen.mean():6.1f} m ({100 * (made / seen.mean() - 1):+5.1f} %), CRPS "
          f"{predicted[:, scores.CRPS].mean():5.2f} m, {100 * scores.covered(predicted):3.0f} % within 5 to 95 %")


def main(paths):
    tables = [read(path) for path in paths]
    first = tables[0][AS_SIMULATED]
    runs = Runs(first)
    if any([row["Run"] for row in table[AS_SIMULATED]] != [row["Run"] for row in first] for table in tables):
        raise SystemExit(f"{', '.join(paths)}: the tables have different runs")
    made = {way: np.array([[[float(row[COLUMNS[k]]) for k in range(len(COLUMNS))] for row in table[way]]
                           for table in tables]) for way in tables[0]}
    deciding = made[TRACKED].copy()
    deciding[..., scores.ES] = deciding[..., scores.CRPS]  # by which held_out() chooses
    for title, fold in ((f"{FOLDS} folds", folds(runs, FOLDS)),
                        ("one rock at a time", np.searchsorted(runs.groups(), runs.group))):
        _, chosen = held_out(deciding, fold)
        print(f"{title}: " + ", ".join(f"{name} foretells {(chosen == k).sum()}"
                                       for k, name in enumerate(paths) if (chosen == k).any()))
        for way, all_scores in made.items():
            predicted = all_scores[chosen, np.arange(len(fold))]
            print(f" {way}")
            print_line("all", predicted, runs.run_out)
            for group in runs.groups():
                own = runs.group == group
                print_line(f"rock {group}", predicted[own], runs.run_out[own])


if __name__ == "__main__":
    if len(sys.argv) < 3:
        raise SystemExit("two tables at least are needed: folds.py PRESET.csv OTHER.csv ...")
    main(sys.argv[1:])
