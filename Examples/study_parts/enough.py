"""How many rocks are enough: as many as it takes to know their reach, or a quantity at a line, so precisely."""
import math

import numpy as np

from combine import crossings_of
from schema import Bad, shown

AT_LINES = ("Share", "KineticEnergy95")  # as lines.csv has them
REACH = "RunOut95"  # of RunOut in summary.csv
QUANTITIES = (*AT_LINES, REACH)
KNOWN = ("quantity", "within", "confidence", "line")
ENDLESS = (1, 2, 4)  # FateCode: left the DEM, moving at EndTime, in nodata: how far they go, and to which line, is not known


def check(path, study):
    """Of the part "until"."""
    until = study.get("until")
    if until is None:
        return
    for name in until:
        if name not in KNOWN:
            raise Bad(f"{path}: there is no {shown(name)} in until, it knows {', '.join(KNOWN)}")
    if until.get("quantity") not in QUANTITIES:
        raise Bad(f"{path}: \"quantity\" of until is {shown(until.get('quantity'))}, it must be one of "
                  f"{', '.join(QUANTITIES)}")
    if until["quantity"] in AT_LINES and "lines" not in study:
        raise Bad(f"{path}: \"until\" needs \"lines\" for {until['quantity']}")
    if until["quantity"] == REACH and "line" in until:
        raise Bad(f"{path}: \"line\" of until is {shown(until['line'])}, but {REACH} is of all rocks")
    for name, value in (("within", until.get("within")), ("confidence", until.get("confidence", 0.95))):
        if not isinstance(value, (int, float)) or isinstance(value, bool) or not 0.0 < value < 1.0:
            raise Bad(f"{path}: {shown(name)} of until is {shown(value)}, it must be between 0 and 1")
    if not isinstance(until.get("line", ""), str):
        raise Bad(f"{path}: \"line\" of until is {shown(until['line'])}, it must be a text")


def beta(a, b, x):
    """Regularised incomplete beta function I_x(a, b), by its continued fraction (Lentz)."""
    if x <= 0.0 or x >= 1.0:
        return float(x >= 1.0)
    if x > (a + 1.0) / (a + b + 2.0):
        return 1.0 - beta(b, a, 1.0 - x)
    front = math.exp(math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b) + a * math.log(x) +
                     b * math.log1p(-x)) / a
    tiny, c, d = 1e-300, 1.0, 1.0 - (a + b) * x / (a + 1.0)
    d = 1.0 / (d if abs(d) > tiny else tiny)
    value = d
    for m in range(1, 100000):
        for term in (m * (b - m) * x / ((a + 2 * m - 1.0) * (a + 2 * m)),
                     -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1.0))):
            d = 1.0 + term * d
            d = 1.0 / (d if abs(d) > tiny else tiny)
            c = 1.0 + term / c
            c = c if abs(c) > tiny else tiny
            value *= c * d
        if abs(c * d - 1.0) < 1e-13:
            break
    return front * value


def solve(function, wanted):
    """Where a function that grows from 0 to 1 is `wanted`."""
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if function(middle) < wanted else (low, middle)
    return 0.5 * (low + high)


def share_interval(count, total, confidence, lost=0):
    """Clopper & Pearson (1934). The lost ones count or do not: the interval has both."""
    tail = 0.5 * (1.0 - confidence)
    low = solve(lambda p: beta(count, total - count + 1, p), tail) if count else 0.0
    most = count + lost
    high = solve(lambda p: beta(most + 1, total - most, p), 1.0 - tail) if most < total else 1.0
    return low, high


def lost_before(endless, passed):
    """How many rocks were lost before a line: of those whose way has no known end, as keys, all that did not pass it. Each
    may pass it yet, or not, so it counts as both: the one rule of `until` and of reports."""
    return len(set(endless) - set(passed))


def most_of_none(total, lost):
    """Upper limit, with 95 % confidence, of how many of `total` rocks pass a line that none was seen to pass: Poisson's, of
    as many passings as rocks were lost before it. Of none lost it is ln 20, the rule of three."""
    k = np.arange(lost + 1)
    logs = np.cumsum(np.log(np.maximum(k, 1)))  # of k!

    def more(share):  # than so many passings of so many expected ones
        expected = share * total
        return 1.0 - np.exp(k * math.log(expected) - expected - logs).sum()

    return total * solve(more, 0.95)


def quantile_ranks(total, q, confidence):
    """Ranks, from 1, of the values between which the quantile is; None where there are too few."""
    tail = 0.5 * (1.0 - confidence)

    def at_most(k):  # of so many values, k or fewer are below the quantile
        return 1.0 if k >= total else beta(total - k, k + 1, 1.0 - q)

    def first(wanted):
        low, high = 0, total
        while low < high:
            middle = (low + high) // 2
            low, high = (low, middle) if at_most(middle) >= wanted else (middle + 1, high)
        return low

    low, high = first(tail), first(1.0 - tail) + 1
    if low > 0 and at_most(low) > tail:
        low -= 1
    low += 1
    return (low, high) if at_most(low - 1) <= tail and high <= total else None


def quantile_interval(values, confidence):
    """Of the 95 % quantile; None, None where there are too few, or too many without an end."""
    ranks = quantile_ranks(len(values), 0.95, confidence)
    ends = [float(np.sort(values)[k - 1]) for k in ranks or ()]
    return tuple(ends) if ends and math.isfinite(ends[1]) else (None, None)


def ways_of(table):
    """Of a table of bodies: rows of the rocks as released; how far each goes, of one that broke its farthest piece; and
    whether it, or a piece of it, goes on no one knows how far."""
    rows, breaking = len(table["Iteration"]), "Piece" in table
    first = np.flatnonzero(table["Piece"] == 0) if breaking else np.arange(rows)
    ways = table["RunOut"]
    if breaking:  # the pieces of each stand behind it
        of = np.repeat(first, np.diff(np.append(first, rows)))
        ways = np.maximum.reduceat(np.hypot(*(table["Stop" + axis] - table["Start" + axis][of] for axis in "XY")), first)
    endless = np.isin(table["FateCode"], ENDLESS)
    return first, ways, np.logical_or.reduceat(endless, first)


class Enough:
    """Of a study, chunk after chunk. `lines`: their names, of which the reach needs none."""

    def __init__(self, until, lines):
        self.until = until
        self.total = 0
        self.ways = []  # RunOut of each rock, m; without an end if it is not known
        self.lost = {}  # by line: rocks that were lost before it
        self.often = (np.inf, 0.0)  # least and most frequent rock, 1/a
        if until["quantity"] == REACH:
            return
        self.greatest = {name: [] for name in lines if until.get("line", name) == name}
        if not self.greatest:
            raise Bad(f"\"line\" of until is {shown(until.get('line'))}, the lines are "
                      f"{', '.join(map(shown, lines))}")

    def add(self, stem):
        with np.load(stem + ".npz") as chunk:
            first, ways, endless = ways_of(chunk)
            self.total += len(first)
            if "Frequency" in chunk:
                rates = chunk["Frequency"][first]
                self.often = min(self.often[0], rates.min(initial=np.inf)), max(self.often[1], rates.max(initial=0.0))
            if self.until["quantity"] == REACH:
                self.ways.extend(np.where(endless, np.inf, ways))
                return
            rocks_lost = set(zip(chunk["Iteration"][first][endless], chunk["BlockId"][first][endless]))
        points = crossings_of(stem)
        data = points.GetPointData()
        names = data.GetAbstractArray("LineName")
        greatest = {}
        for k in range(points.GetNumberOfPoints()):
            key = names.GetValue(k), *(data.GetArray(name).GetValue(k) for name in ("Iteration", "BlockId"))
            energy = data.GetArray("KineticEnergy").GetValue(k)
            greatest[key] = max(energy, greatest.get(key, energy))
        for (name, *_), energy in greatest.items():
            if name in self.greatest:
                self.greatest[name].append(energy)
        for name in self.greatest:
            before = lost_before(rocks_lost, {key[1:] for key in greatest if key[0] == name})
            self.lost[name] = self.lost.get(name, 0) + before

    def state(self):
        """Of each line: interval, and whether it is narrow enough."""
        confidence, within = self.until.get("confidence", 0.95), self.until["within"]
        if self.until["quantity"] == REACH:
            low, high = quantile_interval(self.ways, confidence)
            return [{"rocks": self.total, "from": low, "to": high,
                     "known": low is not None and high - low <= within * (high + low)}]
        result = []
        for name, energies in self.greatest.items():
            if self.until["quantity"] == "Share":
                low, high = share_interval(len(energies), self.total, confidence, self.lost.get(name, 0))
                known = high - low <= 2.0 * within
            else:
                low, high = quantile_interval(energies, confidence)
                known = low is not None and high - low <= within * (high + low)
            result.append({"line": name, "rocks": self.total, "reached": len(energies),
                           "lost": self.lost.get(name, 0), "from": low, "to": high, "known": bool(known)})
        return result

    def text(self):
        texts = []
        quantity = self.until["quantity"]
        unit, scale = {"Share": ("", 1.0), REACH: (" m", 1.0)}.get(quantity, (" kJ", 1e-3))
        for one in self.state():
            between = "not known yet" if one["from"] is None else \
                f"{one['from'] * scale:.4g} to {one['to'] * scale:.4g}{unit}"
            lost = f", as {one['lost']} were lost before it" if one.get("lost") else ""
            texts.append((f"{shown(one['line'])}: " if "line" in one else "") + between + lost)
        unlike = self.often[1] > (1.0 + 1e-9) * self.often[0]
        return quantity + (": " if quantity == REACH else " at ") + "; ".join(texts) + (
            ". Rocks differ in their frequencies, but each counts alike in it" if unlike else "")
