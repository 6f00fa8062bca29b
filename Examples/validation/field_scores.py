"""How far simulated run-outs and stopping points are from observed ones.

Per run there is one observed stopping point y and a sample of n simulated ones, x. The energy score

    ES = mean |x - y| - 1/2 mean |x - x'|    over all x, and over all pairs of different x

is in metres, zero for a forecast that is sharp and right, and proper: no other forecast is expected
to score better than the distribution that y comes from. In one dimension, for the run-out, it is the
continuous ranked probability score (CRPS). Gneiting T., Raftery A.E. (2007), Strictly proper scoring
rules, prediction, and estimation, Journal of the American Statistical Association 102, 359-378.
"""
import numpy as np

QUANTILES = (5, 25, 50, 75, 95)
STARTED = 1.0  # m. A rock that stopped nearer to its release was not let go in the field either.


def energy_score(points, observed):
    """ES of points (n, d), n at least 2, for an observed one (d,)."""
    points, observed = np.atleast_2d(points), np.atleast_1d(observed)
    n = len(points)
    pairs = np.sqrt(((points[:, None] - points[None])**2).sum(-1)).sum()
    return float(np.sqrt(((points - observed)**2).sum(-1)).mean() - 0.5 * pairs / (n * (n - 1)))


class Observed:
    """The observations as arrays over runs, in m."""

    def __init__(self, test):
        self.start = np.array([run.start[:2] for run in test.runs])
        self.stop = np.array([run.stop for run in test.runs])
        self.block = np.array([run.block for run in test.runs])
        way = self.stop - self.start
        self.run_out = np.hypot(*way.T)
        # Runs are told apart by where they began and ended: one that is there twice counts as one
        # where runs are held out, or its copy would be no secret.
        ends = np.column_stack([self.start, self.stop])
        _, self.same = np.unique(ends, axis=0, return_inverse=True)
        down = way.sum(axis=0)
        length = np.linalg.norm(down)
        self.down = down / length if length else np.array([1.0, 0.0])
        self.across = way @ [-self.down[1], self.down[0]]


class Simulated:
    """Where the rocks of one simulation came to rest. `run` is the number of each rock's run."""

    def __init__(self, observed, run, columns):
        self.run = run
        self.stop = np.column_stack([columns["StopX"], columns["StopY"]])
        self.stop_z, self.start_z = np.array(columns["StopZ"]), np.array(columns["StartZ"])
        self.fate = np.array(columns["FateCode"])
        self.speed, self.mass = np.array(columns["MaxSpeed"]), np.array(columns["Mass"])
        self.energy = np.array(columns["MaxKineticEnergy"])
        way = self.stop - observed.start[run]
        self.run_out = np.hypot(*way.T)
        self.across = way @ [-observed.down[1], observed.down[0]]
        self.started = self.run_out >= STARTED

    def of(self, k):
        """Which rocks belong to run k and started; all of them if less than half did: then it is not
        the chance of an attitude but the ground that holds them."""
        own = self.run == k
        count = (own & self.started).sum()
        return own & self.started if count >= max(2, 0.5 * own.sum()) else own

    def scores(self, observed):
        """(CRPS of the run-out, ES of the stopping point, mean run-out) per run, (runs, 3), m."""
        return np.array([(energy_score(self.run_out[own][:, None], observed.run_out[k]),
                          energy_score(self.stop[own], observed.stop[k]), self.run_out[own].mean())
                         for k in range(len(observed.run_out)) for own in [self.of(k)]])


def climatology(observed):
    """Mean CRPS of every run forecast by the run-outs of the others: what a model has to beat."""
    scores = []
    for k, same in enumerate(observed.same):
        others = observed.run_out[observed.same != same]
        if len(others) >= 2:
            scores.append(energy_score(others[:, None], observed.run_out[k]))
    return float(np.mean(scores)) if scores else float("nan")


def comparison(observed, simulated, drop):
    """Rows (what, unit, observed, simulated) of the table; `drop` is the observed fall per run, m."""
    rows = []

    def add(what, unit, seen, made):
        rows.append((what, unit, None if seen is None else float(seen), float(made)))

    moved = simulated.started
    # Every run has the same weight, however many of its rocks started.
    weight = 1.0 / np.bincount(simulated.run[moved])[simulated.run[moved]]
    mean = lambda values: np.average(values[moved], weights=weight)
    deviation = lambda values: np.sqrt(mean((values - mean(values))**2))
    own = lambda values: np.std(values, ddof=1) if len(values) > 1 else 0.0
    add("run-out, mean", "m", observed.run_out.mean(), mean(simulated.run_out))
    add("run-out, deviation", "m", own(observed.run_out), deviation(simulated.run_out))
    for q in QUANTILES:
        add(f"run-out, {q} % quantile", "m", np.percentile(observed.run_out, q),
            np.percentile(simulated.run_out[moved], q))
    for block in sorted(set(observed.block)):
        of_block = np.isin(simulated.run, np.nonzero(observed.block == block)[0]) & moved
        add(f"run-out, mean of block {block}", "m", observed.run_out[observed.block == block].mean(),
            simulated.run_out[of_block].mean() if of_block.any() else np.nan)
    add("stop east, mean", "m", observed.stop[:, 0].mean(), mean(simulated.stop[:, 0]))
    add("stop north, mean", "m", observed.stop[:, 1].mean(), mean(simulated.stop[:, 1]))
    add("lateral offset, mean", "m", observed.across.mean(), mean(simulated.across))
    add("lateral offset, deviation", "m", own(observed.across), deviation(simulated.across))
    fall = simulated.start_z - simulated.stop_z
    mass = np.array([simulated.mass[simulated.run == k][0] for k in range(len(observed.run_out))])
    add("potential energy given up, mean", "kJ", np.mean(9.81e-3 * mass * drop),
        mean(9.81e-3 * simulated.mass * fall))
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
