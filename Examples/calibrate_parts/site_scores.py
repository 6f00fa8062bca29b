"""How far simulated run-outs and stopping points are from observed ones.

Per deposit there is one observed stopping point y and a sample of n simulated ones, x. The energy score

    ES = mean |x - y| - 1/2 mean |x - x'|    over all x, and over all pairs of different x

is in metres, zero for a forecast that is sharp and right, and proper: no other forecast is expected
to score better than the distribution that y comes from. In one dimension, for the run-out, it is the
continuous ranked probability score (CRPS). Gneiting T., Raftery A.E. (2007), Strictly proper scoring
rules, prediction, and estimation, Journal of the American Statistical Association 102, 359-378.
"""
import copy

import numpy as np

from site_tracked import TrackedGround

QUANTILES = (5, 25, 50, 75, 95)
STARTED = 1.0  # m. A rock that stopped nearer to its release was not let go in the field either.
INSIDE = (0.05, 0.95)  # ranks between which an observation counts as covered
MOST = 1500  # points of a sample whose pairs are formed
CRPS, ES, MEAN, RANK = range(4)  # columns of the scores


def pair_distance(points):
    """Mean distance of two different points of a sample (n, d), n at least 2; of a large sample in
    the plane, of every so manieth point."""
    n = len(points)
    if points.shape[1] == 1:
        ascending = np.sort(points[:, 0])
        return 2 * (ascending * (2 * np.arange(n) - n + 1)).sum() / (n * (n - 1))
    if n > MOST:
        return pair_distance(points[::-(-n // MOST)])
    return np.sqrt(((points[:, None] - points[None])**2).sum(-1)).sum() / (n * (n - 1))


def energy_score(points, observed, spread=None):
    """ES of points (n, d), n at least 2, for an observed one (d,); `spread` is their pair distance."""
    points, observed = np.atleast_2d(points), np.atleast_1d(observed)
    spread = pair_distance(points) if spread is None else spread
    return float(np.sqrt(((points - observed)**2).sum(-1)).mean() - 0.5 * spread)


class Observed:
    """The deposits as arrays, in m. `forecast` says by which simulated rocks a deposit is forecast:
    those of the same number. `group` is a name under which deposits are reported together. `margin`,
    m: beyond the tracked ground, which is widened by so much, run-outs count to its edge; None: the
    whole terrain counts."""

    def __init__(self, start, stop, forecast, group, margin=None):
        self.start, self.stop = np.asarray(start, float), np.asarray(stop, float)
        self.forecast, self.group = np.asarray(forecast), np.asarray(group)
        self.tracked = None if margin is None else TrackedGround(
            np.vstack([self.start, self.stop]), margin)
        way = self.stop - self.start
        self.run_out = np.hypot(*way.T)
        # Runs are told apart by where they began and ended: one that is there twice counts as one
        # where runs are held out, or its copy would be no secret.
        ends = np.column_stack([self.start, self.stop])
        _, self.same = np.unique(ends, axis=0, return_inverse=True)
        self.same = self.same.ravel()
        down = way.sum(axis=0)
        length = np.linalg.norm(down)
        self.down = down / length if length else np.array([1.0, 0.0])
        self.across = way @ [-self.down[1], self.down[0]]

    def groups(self):
        return sorted(set(self.group))


class Simulated:
    """Where the rocks of one simulation came to rest. `forecast` is the number of each rock's
    forecast, `columns` the table of Rockfall Simulation."""

    def __init__(self, observed, forecast, columns):
        numbers, first = np.unique(observed.forecast, return_index=True)
        known = np.isin(forecast, numbers)  # the others foretell no deposit
        columns = {name: np.array(column)[known] for name, column in columns.items()}
        self.forecast = forecast = forecast[known]
        self.stop = np.column_stack([columns["StopX"], columns["StopY"]])
        self.stop_z, self.start_z = columns["StopZ"], columns["StartZ"]
        self.fate, self.speed = columns["FateCode"], columns["MaxSpeed"]
        self.energy = columns["MaxKineticEnergy"]
        self.start = observed.start[first][np.searchsorted(numbers, forecast)]
        self.group = observed.group[first][np.searchsorted(numbers, forecast)]
        way = self.stop - self.start
        self.run_out = np.hypot(*way.T)
        self.across = way @ [-observed.down[1], observed.down[0]]
        self.started = np.hypot(self.stop[:, 0] - columns["StartX"],
                                self.stop[:, 1] - columns["StartY"]) >= STARTED

    def as_scored(self, observed):
        """The same with run-outs to the edge of the tracked ground, if there is one."""
        if observed.tracked is None:
            return self
        scored = copy.copy(self)
        scored.stop = observed.tracked.cut(self.start, self.stop)
        way = scored.stop - self.start
        scored.run_out = np.hypot(*way.T)
        scored.across = way @ [-observed.down[1], observed.down[0]]
        return scored

    def beyond(self, observed):
        """Share of the rocks that go beyond the tracked ground."""
        return float(np.mean(~observed.tracked.holds(self.stop))) if observed.tracked else 0.0

    def of(self, number):
        """Which rocks make a forecast: those that started; all of them if less than half did: then it
        is not the chance of an attitude but the ground that holds them."""
        own = self.forecast == number
        count = (own & self.started).sum()
        return own & self.started if count >= max(2, 0.5 * own.sum()) else own

    def scores(self, observed):
        """(CRPS and mean of the run-out, ES of the stopping point, rank of the observed run-out) per
        deposit, (deposits, 4): m, but for the rank, which is 0 to 1."""
        result = np.empty((len(observed.run_out), 4))
        for number in np.unique(observed.forecast):
            own = self.of(number)
            run_outs, stops = self.run_out[own][:, None], self.stop[own]
            spreads = pair_distance(run_outs), pair_distance(stops)
            for k in np.nonzero(observed.forecast == number)[0]:
                seen = observed.run_out[k]
                result[k, CRPS] = energy_score(run_outs, seen, spreads[0])
                result[k, ES] = energy_score(stops, observed.stop[k], spreads[1])
                result[k, MEAN] = run_outs.mean()
                result[k, RANK] = np.mean((run_outs < seen) + 0.5 * (run_outs == seen))
        return result


def covered(scores):
    """Share of the deposits whose run-out is between the 5 and the 95 % quantile of its forecast."""
    return float(np.mean((scores[:, RANK] >= INSIDE[0]) & (scores[:, RANK] <= INSIDE[1])))


def judgement(observed, simulated):
    """Rows (what, scores) of the figures by which a simulation is judged: as simulated, and within the
    tracked ground if there is one."""
    rows = [("as simulated", simulated.scores(observed))]
    if observed.tracked:
        rows.append(("within the tracked ground", simulated.as_scored(observed).scores(observed)))
    return rows


def climatology(observed):
    """Mean CRPS of every run forecast by the run-outs of the others: what a model has to beat."""
    scores = []
    for k, same in enumerate(observed.same):
        others = observed.run_out[observed.same != same]
        if len(others) >= 2:
            scores.append(energy_score(others[:, None], observed.run_out[k]))
    return float(np.mean(scores)) if scores else float("nan")


def comparison(observed, simulated, drop):
    """Rows (what, unit, observed, simulated) of the table; `drop` is the observed fall per deposit,
    m."""
    rows = []

    def add(what, unit, seen, made):
        rows.append((what, unit, None if seen is None else float(seen), float(made)))

    moved = simulated.started
    # Every deposit has the same weight, however many of its forecast's rocks started.
    numbers, of, rocks = np.unique(simulated.forecast[moved], return_inverse=True, return_counts=True)
    deposits = np.array([(observed.forecast == number).sum() for number in numbers])
    weight = (deposits / rocks)[of.ravel()]
    mean = lambda values: np.average(values[moved], weights=weight)
    deviation = lambda values: np.sqrt(mean((values - mean(values))**2))
    own = lambda values: np.std(values, ddof=1) if len(values) > 1 else 0.0
    add("run-out, mean", "m", observed.run_out.mean(), mean(simulated.run_out))
    add("run-out, deviation", "m", own(observed.run_out), deviation(simulated.run_out))
    for q in QUANTILES:
        add(f"run-out, {q} % quantile", "m", np.percentile(observed.run_out, q),
            np.percentile(simulated.run_out[moved], q))
    groups = observed.groups()
    for group in groups if len(groups) > 1 else ():
        of_group = (simulated.group == group) & moved
        add(f"run-out, mean of {group}", "m", observed.run_out[observed.group == group].mean(),
            simulated.run_out[of_group].mean() if of_group.any() else np.nan)
    add("stop east, mean", "m", observed.stop[:, 0].mean(), mean(simulated.stop[:, 0]))
    add("stop north, mean", "m", observed.stop[:, 1].mean(), mean(simulated.stop[:, 1]))
    add("lateral offset, mean", "m", observed.across.mean(), mean(simulated.across))
    add("lateral offset, deviation", "m", own(observed.across), deviation(simulated.across))
    fall = simulated.start_z - simulated.stop_z
    add("angle of reach, mean", "degrees", np.degrees(np.arctan2(drop, observed.run_out)).mean(),
        mean(np.degrees(np.arctan2(fall, simulated.run_out))))
    add("greatest kinetic energy, mean", "kJ", None, mean(1e-3 * simulated.energy))
    add("greatest speed, mean", "m/s", None, mean(simulated.speed))
    add("greatest speed, 95 % quantile", "m/s", None, np.percentile(simulated.speed[moved], 95))
    for code, what in ((1, "left the terrain"), (2, "still moving at the end")):
        add(f"rocks that {what}" if code == 1 else f"rocks {what}", "%", 0.0,
            100 * mean((simulated.fate == code).astype(float)))
    add("rocks that did not start (not counted above)", "%", 0.0, 100 * np.mean(~moved))
    return rows
