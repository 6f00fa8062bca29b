"""Calibration: which ground does best, how surely, and how it does on runs that it has not seen.

Candidates are spread over the parameters' ranges by a Halton sequence. Each is simulated once, and its
scores per run are kept; leaving runs out, and the bootstrap, then choose among the same candidates
by other runs and cost no more simulations. The choice is by the energy score of the stopping points.
"""
import csv
import os

import numpy as np

NAMES = ("RestitutionCoefficient", "TangentialRestitution", "FrictionAngle", "RoughnessDeviation")
PRIMES = (7, 2, 3, 5)
CRPS, ES, MEAN = range(3)  # columns of the scores


def halton(number, base):
    value, part = 0.0, 1.0
    while number:
        part /= base
        number, digit = divmod(number, base)
        value += part * digit
    return value


def candidates(count, ranges):
    """Parameters (count, 4) within ranges {name: (low, high)}."""
    low, high = np.array([ranges[name] for name in NAMES]).T
    unit = np.array([[halton(k, base) for base in PRIMES] for k in range(1, count + 1)])
    return np.round(low + unit * (high - low), 4)


def best(scores, runs):
    """The candidate of the least mean energy score over some runs."""
    return int(np.argmin(scores[:, runs, ES].mean(axis=1)))


def folds(observed, count):
    """Folds with runs of every block, as far as they go. Runs that are the same stay together."""
    fold = np.zeros(len(observed.block), int)
    for block in sorted(set(observed.block)):
        distinct = {}
        for k in np.nonzero(observed.block == block)[0]:
            fold[k] = distinct.setdefault(observed.same[k], len(distinct)) % count
    return fold


def held_out(scores, observed, fold):
    """Predictions of every run by the candidate that does best on the other folds."""
    chosen = np.array([best(scores, fold != f) for f in fold])
    return scores[chosen, np.arange(len(fold))], chosen


def bootstrap(scores, observed, parameters, count, seed):
    """Parameters chosen by runs that are drawn with replacement, (count, 4)."""
    random = np.random.default_rng(seed)
    runs = len(observed.block)
    return parameters[[best(scores, random.integers(runs, size=runs)) for _ in range(count)]]


def report(scores, observed, parameters, reference, seed):
    """Lines of text about the calibration, and the number of the best candidate."""
    runs = np.arange(len(observed.block))
    chosen = best(scores, runs)
    spread = bootstrap(scores, observed, parameters, 1000, seed)
    lines = [f"Best of {len(parameters)} candidates by the energy score of the stopping points "
             f"(mean {scores[chosen, :, ES].mean():.1f} m); 90 % of 1000 bootstrap samples:"]
    for k, name in enumerate(NAMES):
        low, high = np.percentile(spread[:, k], (5, 95))
        searched = np.ptp(parameters[:, k]) > 0
        lines.append(f"  {name:24}{parameters[chosen, k]:9.4g}   " + (
            f"{low:.4g} to {high:.4g}, deviation {spread[:, k].std():.2g}" if searched
            else "not searched"))
    lines.append(f"Run-out on all runs: {line(scores[chosen], observed, runs)}; CRPS "
                 f"{scores[chosen, :, CRPS].mean():.1f} m, without a model {reference:.1f} m")
    distinct = len(np.unique(observed.same))
    blocks = sorted(set(observed.block))
    count = min(6, *(len(np.unique(observed.same[observed.block == block])) for block in blocks))
    splits = []
    if distinct > 1 and count > 1:
        splits.append((f"{count} folds with runs of every block", folds(observed, count)))
    if len(blocks) > 1:
        splits.append(("one block left out at a time", np.searchsorted(blocks, observed.block)))
    for name, fold in splits:
        predicted, by = held_out(scores, observed, fold)
        lines.append(f"Held out, {name}: {line(predicted, observed, runs)}; CRPS "
                     f"{predicted[:, CRPS].mean():.1f} m, energy score "
                     f"{predicted[:, ES].mean():.1f} m")
        for f in sorted(set(fold)):
            own = np.nonzero(fold == f)[0]
            values = ", ".join(f"{v:g}" for v in parameters[by[own[0]]])
            lines.append(f"  fold {f + 1} ({len(own)} runs, by {values}): "
                         f"{line(predicted, observed, own)}")
    return lines, chosen


def line(scores, observed, runs):
    made, seen = scores[runs, MEAN].mean(), observed.run_out[runs].mean()
    return f"{made:.1f} m for {seen:.1f} m observed ({100 * (made / seen - 1):+.1f} %)"


def write(path, parameters, scores):
    with open(path + ".part", "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow([*NAMES, "MeanRunOut_m", "CRPS_m", "EnergyScore_m"])
        for values, score in zip(parameters, scores):
            writer.writerow([f"{v:g}" for v in values] +
                            [f"{score[:, k].mean():.3f}" for k in (MEAN, CRPS, ES)])
    os.replace(path + ".part", path)
