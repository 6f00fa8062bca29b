"""The search: which ground does best, how surely, and how it does on deposits that it has not seen.

Candidates are spread over the parameters' ranges by a Halton sequence. Each is simulated once, and its
scores per deposit are kept; leaving deposits out, and the bootstrap, then choose among the same
candidates by other deposits and cost no more simulations. The choice is by the energy score of the
stopping points.
"""
import csv
import os

import numpy as np

from site_scores import CRPS, ES, MEAN, climatology, covered

PRIMES = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29)
SAMPLES = 1000  # of the bootstrap


def halton(number, base):
    value, part = 0.0, 1.0
    while number:
        part /= base
        number, digit = divmod(number, base)
        value += part * digit
    return value


def candidates(count, ranges):
    """Values (count, parameters) within ranges [(low, high)], at most ten of them."""
    low, high = np.array(list(ranges), float).T
    unit = np.array([[halton(k, base) for base in PRIMES[:len(low)]] for k in range(1, count + 1)])
    return np.array([[float(f"{value:.4g}") for value in row] for row in low + unit * (high - low)])


def best(scores, deposits):
    """The candidate of the least mean energy score over some deposits."""
    return int(np.argmin(scores[:, deposits, ES].mean(axis=1)))


def folds(observed, count):
    """Folds with deposits of every group, as far as they go. Those that are the same stay together."""
    fold = np.zeros(len(observed.group), int)
    for group in observed.groups():
        distinct = {}
        for k in np.nonzero(observed.group == group)[0]:
            fold[k] = distinct.setdefault(observed.same[k], len(distinct)) % count
    return fold


def splits(observed, count):
    """Ways of holding deposits out: (name, fold of each)."""
    found = []
    groups = observed.groups()
    count = min(count, *(len(np.unique(observed.same[observed.group == g])) for g in groups))
    if count > 1:
        found.append((f"{count} folds" + (" with runs of every group" if len(groups) > 1 else ""),
                      folds(observed, count)))
    if len(groups) > 1:
        found.append(("one group left out at a time", np.searchsorted(groups, observed.group)))
    return found


def held_out(scores, fold):
    """Predictions of every deposit by the candidate that does best on the other folds."""
    chosen = np.array([best(scores, fold != f) for f in fold])
    return scores[chosen, np.arange(len(fold))], chosen


class Search:
    """The candidates and their scores, candidate by candidate."""

    def __init__(self, names, ranges, count):
        self.names = list(names)
        self.values = candidates(count, ranges)
        self.scores = []

    def add(self, scores):
        self.scores.append(scores)

    def write(self, path):
        with open(path + ".part", "w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow([*self.names, "MeanRunOut_m", "CRPS_m", "EnergyScore_m", "Covered"])
            for values, score in zip(self.values, self.scores):
                writer.writerow([f"{v:g}" for v in values] + [
                    f"{score[:, k].mean():.3f}" for k in (MEAN, CRPS, ES)] + [f"{covered(score):.3f}"])
        os.replace(path + ".part", path)


class Fit:
    """What a search has found."""

    def __init__(self, search, observed, folds_wanted, seed):
        self.search, self.observed = search, observed
        self.scores = np.array(search.scores)
        self.deposits = np.arange(len(observed.run_out))
        self.best = best(self.scores, self.deposits)
        random = np.random.default_rng(seed)
        runs = len(self.deposits)
        drawn = [best(self.scores, random.integers(runs, size=runs)) for _ in range(SAMPLES)]
        self.spread = search.values[drawn]
        self.reference = climatology(observed)
        self.splits = [(name, fold, *held_out(self.scores, fold))
                       for name, fold in splits(observed, folds_wanted)]

    def values(self):
        return self.search.values[self.best]

    def parameters(self):
        """Rows (name, value, low, high, deviation): 90 % of the bootstrap."""
        return [(name, self.values()[k], *np.percentile(self.spread[:, k], (5, 95)),
                 self.spread[:, k].std()) for k, name in enumerate(self.search.names)]

    def lines(self):
        """The same as text."""
        chosen = self.scores[self.best]
        lines = [f"Best of {len(self.scores)} candidates by the energy score of the stopping points "
                 f"(mean {chosen[:, ES].mean():.1f} m); 90 % of {SAMPLES} bootstrap samples:"]
        for name, value, low, high, deviation in self.parameters():
            lines.append(f"  {name:24}{value:9.4g}   {low:.4g} to {high:.4g}, deviation {deviation:.2g}")
        lines.append(f"Run-out on all runs: {self.line(chosen, self.deposits)}; "
                     f"without a model a CRPS of {self.reference:.1f} m")
        for name, fold, predicted, by in self.splits:
            lines.append(f"Held out, {name}: {self.line(predicted, self.deposits)}")
            if name.startswith("one group"):
                continue
            for group in self.observed.groups() if len(self.observed.groups()) > 1 else ():
                own = np.nonzero(self.observed.group == group)[0]
                lines.append(f"  {group} ({len(own)} runs): {self.line(predicted, own)}")
        for name, fold, predicted, by in self.splits:
            lines.append(f"Chosen for {name}:")
            for f in sorted(set(fold)):
                own = np.nonzero(fold == f)[0]
                values = ", ".join(f"{v:g}" for v in self.search.values[by[own[0]]])
                lines.append(f"  {self.fold_name(name, f)} ({len(own)} runs, by {values}): "
                             f"{self.line(predicted, own)}")
        return lines

    def fold_name(self, split, fold):
        return self.observed.groups()[fold] if split.startswith("one group") else f"fold {fold + 1}"

    def line(self, scores, deposits):
        made, seen = scores[deposits, MEAN].mean(), self.observed.run_out[deposits].mean()
        return (f"{made:.1f} m for {seen:.1f} m observed ({100 * (made / seen - 1):+.1f} %), CRPS "
                f"{scores[deposits, CRPS].mean():.1f} m, energy score "
                f"{scores[deposits, ES].mean():.1f} m, {100 * covered(scores[deposits]):.0f} % of the "
                "observed run-outs within 5 to 95 %")
