"""Counts of rocks per iteration and how sure their means are."""
import csv

import numpy as np


def interval(counts, share=0.95, draws=20000, seed=1):
    """Mean of counts per iteration and its confidence interval, by drawing iterations anew (bootstrap).
    Rocks of one iteration push each other, so that iterations are what is independent, not rocks."""
    counts = np.asarray(counts, float)
    random = np.random.default_rng(seed)
    means = counts[random.integers(0, len(counts), (draws, len(counts)))].mean(axis=1)
    low, high = np.quantile(means, [(1 - share) / 2, (1 + share) / 2])
    return counts.mean(), low, high


def typical(cases):
    """The iteration whose numbers on the road, with collisions and without, are nearest to their means."""
    road = [np.asarray(cases[name]["road"], float) for name in ("without collisions", "with collisions")]
    return int(np.argmin(sum(abs(counts - counts.mean()) for counts in road)))


def write_counts(cases, table, text):
    """`cases`: {name: {place: counts per iteration}}; places are step, foot and road."""
    with open(table, "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["case", "iteration", "step", "foot", "road"])
        for name, counts in cases.items():
            for k in range(len(counts["road"])):
                rows.writerow([name, k, *(int(counts[p][k]) for p in ("step", "foot", "road"))])
    with open(text, "w") as file:
        file.write("Rocks of 41 per iteration, mean and 95 % confidence interval\n\n")
        file.write(f"{'':32}{'on the step':>20}{'at the foot':>20}{'on the road':>20}\n")
        for name, counts in cases.items():
            cells = ["{:.2f} ({:.2f}–{:.2f})".format(*interval(counts[p])) for p in ("step", "foot", "road")]
            file.write(f"{name:32}" + "".join(f"{cell:>20}" for cell in cells) + "\n")
        more = cases["with collisions"]["road"] - cases["without collisions"]["road"]
        file.write("\nMore on the road with collisions, same iterations: "
                   "{:.2f} ({:.2f} to {:.2f})\n".format(*interval(more)))
        for name in [n for n in ("without collisions", "with collisions") if n + ", embankment" in cases]:
            stopped = cases[name]["road"] - cases[name + ", embankment"]["road"]
            file.write(f"Kept from the road by the embankment, {name}: "
                       "{:.2f} ({:.2f} to {:.2f})\n".format(*interval(stopped)))
