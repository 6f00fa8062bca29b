"""What came to embankments, nets and stems: of each chunk a small file, and of the study a row for each of them."""
import math
import os

import numpy as np
from paraview.simple import *
from vtkmodules.util.numpy_support import vtk_to_numpy

import schema
from gis import write_table
from together import from_first_rank, make, output, say
from wholefile import write_npz

TABLE = "structures.csv"
# To GONE as Outcome of port 4: OVER a net, or where another rock had broken it. HIT and CAME are of embankments.
HELD, BROKE, RECORDED, STEM_BROKE, STEM_PASSED, STRUCK, OVER, GONE, HIT, CAME = range(10)
HITS = (HELD, BROKE, RECORDED, STEM_BROKE, STEM_PASSED, STRUCK, HIT)
NONE, UNKNOWN = -1, -2  # in the place of a number of rocks: there is none, it is not known
RESTED, CAUGHT, BROKEN = 0, 3, 5  # as FateCode of port 3
MEL = (100.0, 250.0, 500.0, 1000.0, 1500.0, 2000.0, 3000.0, 4500.0)  # kJ, of the classes 0 to 7 (EAD 340059-00-0106)
EVENT = ("Structure", "Event", "Iteration", "RockId", "Piece", "Energy", "Height", "Braking", "Useful")


def numbers(data, name):
    array = data.GetArray(name)
    return vtk_to_numpy(array) if array else np.empty(0)


def bodies(data):
    """Iteration, rock and piece of each; without the last array there are whole rocks only."""
    iteration, rock, piece = (numbers(data, name) for name in ("Iteration", "RockId", "Piece"))
    return iteration, rock, piece if len(piece) else np.zeros(len(rock))


def of_slope(data):
    """What stands on a slope, by its field data: embankments and nets by features, and all stems as one."""
    origin, made = numbers(data, "LocalOrigin").ravel()[:2], []
    for kind, stem, columns in (("embankment", "TerrainEmbankment", (1, None)), ("net", "TerrainBarrier", (1, 2))):
        rows, points = numbers(data, stem + "s"), numbers(data, stem + "Points")
        names, next_point = data.GetAbstractArray(stem + "Names"), 0
        for k, row in enumerate(rows):
            end = next_point + int(row[-1])
            part = (points[next_point:end] + origin).tolist()
            next_point = end
            if made and made[-1]["kind"] == kind and made[-1]["id"] == int(row[0]):
                made[-1]["parts"].append(part)  # of one feature
                continue
            capacity = -1.0 if columns[1] is None else row[columns[1]] / 1000.0
            made.append({"kind": kind, "id": int(row[0]), "name": names.GetValue(k) if names else "", "parts": [part],
                         "height": float(row[columns[0]]), "capacity": float(capacity) if capacity >= 0.0 else None,
                         "limit": float(row[2]) if capacity >= 0.0 else math.inf,  # J, as it was given
                         "wears": kind == "net" and bool(row[7] >= 0.0)})
    stems = numbers(data, "TerrainTrees")
    if len(stems):
        made.append({"kind": "stems", "id": 0, "name": f"{len(stems)} stems", "parts": [], "height": 0.0, "capacity": None})
    return made


class Standing:
    """Looks at each chunk's rocks where they meet what stands on the slope. All ranks take part. Of embankments it takes the
    `paths` of rocks, which come over them, and their `impacts`; without these it is not known what came to them."""

    def __init__(self, slope, simulation, paths, impacts):
        self.simulation = simulation
        data = output(slope).GetFieldData()
        self.things = from_first_rank(lambda: of_slope(data))
        self.numbers = {(one["kind"], one["id"]): k for k, one in enumerate(self.things)}
        dams = [one for one in self.things if one["kind"] == "embankment"]
        for one in dams:
            one.update(paths=paths, impacts=impacts)
        if dams and not (paths and impacts):
            say("What comes to embankments is not known " + " and ".join(
                text for text, there in (("without paths (TrajectoryOutput)", paths), ("without impacts (KeepImpacts 0)", impacts))
                if not there) + f": {TABLE} has {UNKNOWN} and nan for it")
        self.collector = make(TrajectoryCollector, "structures", {
            "Input": OutputPort(simulation, 1), "Terrain": slope, "PrintNotes": 0,
            "Points": [0, 0, 0, 1, 1, 0]}) if dams and paths else None
        self.of_cfe = {}
        if dams:
            shown = slope.GetClientSideObject().GetOutputDataObject(1).GetCellData()
            kind, cfe, feature = (numbers(shown, name) for name in ("StructureKind", "CFEId", "StructureId"))
            self.of_cfe = {int(c): self.numbers["embankment", int(f)] for c, f in zip(cfe[kind == 0], feature[kind == 0])}

    def write(self, stem):
        """The chunk's file, of what the simulation has just made."""
        ports = [output(self.simulation, port) for port in (2, 3, 4)]
        rows = []
        from_first_rank(lambda: rows.extend(self.met(*ports)))
        for k, one in enumerate(self.things if self.collector else ()):
            for part in one["parts"] if one["kind"] == "embankment" else ():
                self.collector.Points = [value for x, y in part for value in (x, y, 0.0)]
                UpdatePipeline(proxy=self.collector)
                passed = output(self.collector).GetPointData()
                columns = [*bodies(passed), *(numbers(passed, name) for name in ("KineticEnergy", "TopHeight"))]
                rows += [(k, CAME, *row, 0.0, math.nan) for row in zip(*columns)]
        table = dict(zip(EVENT, np.array(rows, float).reshape(-1, len(EVENT)).T))
        from_first_rank(lambda: write_npz(stem + "-structures.npz", table))

    def met(self, impacts, summaries, structures):
        """Rows of nets and stems that were hit, and of impacts on embankments."""
        met = structures.GetPointData()
        names = ("KineticEnergy", "TopHeight", "BrakingDistance", "UsefulHeight")
        for feature, outcome, before, *row in zip(*(numbers(met, name) for name in ("StructureId", "Outcome", "HeldBefore")),
                                                  *bodies(met), *(numbers(met, name) for name in names)):
            thing = ("stems", 0) if outcome in (STEM_BROKE, STEM_PASSED) else ("net", int(feature))
            number = self.numbers[thing]
            yield number, event_of(self.things[number], int(outcome), row[3], before), *row
        if not self.of_cfe:
            return
        table = summaries.GetRowData()
        mass = {tuple(key): m for *key, m in zip(*bodies(table), numbers(table, "Mass"))}
        hits = impacts.GetPointData()
        cfes = numbers(hits, "CFEId")
        (iteration, rock, piece), speed = bodies(hits), numbers(hits, "VelocityBefore")
        for k in np.flatnonzero(np.isin(cfes, list(self.of_cfe))):
            key = (iteration[k], rock[k], piece[k])
            energy = 0.5 * mass[key] * float(speed[k] @ speed[k])
            yield self.of_cfe[int(cfes[k])], HIT, *key, energy, math.nan, 0.0, math.nan


def event_of(thing, outcome, energy, before):
    """Outcome of a rock of this energy (J) at a structure: a net that it strikes with a part breaks, for others, above what
    is left of its capacity, of which one that wears has lost what it held `before` (J)."""
    breaks = outcome == STRUCK and energy > thing["limit"] - (before if thing["wears"] else 0.0)
    return BROKE if breaks else outcome


def frequency_of(study, stems, wanted):
    """Of rocks by iteration and number what each adds to a frequency, 1/a; None if that is not known."""
    together = next((study[part]["AnnualFrequency"] for part in ("map", "lines")
                     if study.get(part, {}).get("AnnualFrequency")), 0.0)
    rocks, iterations, count = {}, set(), 0
    for stem in stems:
        with np.load(stem + ".npz") as table:
            whole = table["Piece"] == 0 if "Piece" in table else np.ones(len(table["RockId"]), bool)
            iteration, rock = table["Iteration"][whole], table["RockId"][whole]
            if not together and "Frequency" not in table:
                return None
            values = np.full(len(rock), together) if together else table["Frequency"][whole]
        iterations.update(np.unique(iteration).tolist())
        count += len(rock)
        for key, value in zip(zip(iteration.tolist(), rock.tolist()), values.tolist()):
            if key in wanted:
                rocks[key] = value
    return {key: value / (count if together else len(iterations)) for key, value in rocks.items()}


def side_of(line, place):
    """How far a place is from a line, and on which side of it: 1 left, -1 right, beyond an end as of the last segment."""
    points = np.array(line)
    points = points[np.append(True, np.diff(points, axis=0).any(axis=1))]
    along, beside = np.diff(points, axis=0), np.array(place) - points[:-1]
    length = np.hypot(*along.T)
    share = np.clip((beside * along).sum(axis=1) / length ** 2, 0.0, 1.0)
    away = np.hypot(*(beside - share[:, None] * along).T)
    left = (along[:, 0] * beside[:, 1] - along[:, 1] * beside[:, 0]) / length
    nearest = np.flatnonzero(away <= away.min() + 1e-6)  # two at a corner
    return away.min(), np.sign(left[nearest[np.argmax(np.abs(left[nearest]))]])


def lies_before(parts, start, stop):
    """Whether a rock ended on that side of an embankment from which it came."""
    part = min(parts, key=lambda line: side_of(line, stop)[0])
    return side_of(part, start)[1] * side_of(part, stop)[1] > 0.0


def ends_of(stems, wanted):
    """Of rocks by iteration and number their release and, of all that became of them, fate and place."""
    ends = {key: [None, []] for key in wanted}
    for stem in stems if wanted else ():
        with np.load(stem + ".npz") as table:
            columns = [table[name].tolist() for name in ("Iteration", "RockId", "FateCode", "StartX", "StartY", "StopX", "StopY")]
            piece = table["Piece"].tolist() if "Piece" in table else len(columns[0]) * [0]
        for iteration, rock, fate, x, y, stop_x, stop_y, number in zip(*columns, piece):
            if (iteration, rock) in ends:
                end = ends[iteration, rock]
                end[0] = (x, y) if number == 0 else end[0]
                if fate != BROKEN:
                    end[1].append((fate, (stop_x, stop_y)))
    return ends


def largest(values):
    values = values[np.isfinite(values)]
    return float(values.max()) if len(values) else math.nan


def keys_of(events, *names):
    return np.stack([events[name].astype(int) for name in names], axis=1)


def summary(thing, events, often, ends):
    """A row of structures.csv."""
    keys = keys_of(events, "Iteration", "RockId", "Piece")

    def met(*kinds):
        return {tuple(key) for key in keys[np.isin(events["Event"], kinds)].tolist()}

    def rocks_of(bodies):
        return {key[:2] for key in bodies}

    def rocks(*kinds):
        return rocks_of(met(*kinds))

    hit, broke, stem, net = rocks(*HITS), rocks(BROKE), thing["kind"] == "stems", thing["kind"] == "net"
    came = rocks(OVER, GONE, CAME) | hit
    # An embankment holds what hits it, does not come over its axis and ends before it: all else came over or beside it.
    # A net may miss a piece of a rock and hold another. Stems that hold are slope, which nothing counts.
    struck = set()
    if thing["kind"] == "embankment":
        held = {key for key in hit - rocks(CAME) if all(
            fate in (RESTED, CAUGHT) and lies_before(thing["parts"], ends[key][0], stop) for fate, stop in ends[key][1])}
        over = came - held
    else:
        over = rocks_of(met(OVER, GONE) - met(*HITS))
        struck = rocks_of(met(STRUCK) - met(HELD, BROKE))
        held = rocks(HELD) - broke - over - struck
    energy = largest(events["Energy"]) / 1000.0
    paths, impacts = thing.get("paths", True), thing.get("impacts", True)
    of_all = lambda value, unknown=UNKNOWN: value if paths and impacts else unknown
    return {
        "Kind": thing["kind"], "StructureId": thing["id"], "Name": thing["name"],
        "StructureHeight": math.nan if stem or not thing["height"] else thing["height"],
        "BarrierCapacity": math.nan if thing["capacity"] is None else thing["capacity"],
        "Rocks": of_all(len(came)), "Hits": len(hit) if impacts else UNKNOWN, "Held": NONE if stem else of_all(len(held)),
        "Broke": int((events["Event"] == STEM_BROKE).sum()) if stem else len(broke), "Struck": len(struck) if net else NONE,
        "Over": NONE if stem else of_all(len(over)),
        "EnergyMaximum": of_all(energy, math.nan), "RequiredClass": int(np.searchsorted(MEL, energy)) if net and came else NONE,
        "HeldAll": int(came == held) if net and came else NONE,
        "TopHeightMaximum": math.nan if stem or not paths else largest(events["Height"]),
        "BrakingDistanceMaximum": largest(events["Braking"][events["Event"] == HELD]),
        "UsefulHeightMinimum": -largest(-events["Useful"][np.isin(events["Event"], (HELD, BROKE, STRUCK, OVER))]),
        "AnnualFrequency": math.nan if often is None or not impacts else sum((often[key] for key in sorted(hit)), 0.0)}


def combine(study, folder, stems, things):
    """structures.csv of the chunks' files alone."""
    chunks = []
    for stem in stems:
        with np.load(stem + "-structures.npz") as chunk:
            chunks.append({name: chunk[name] for name in EVENT})
    events = {name: np.concatenate([chunk[name] for chunk in chunks]) for name in EVENT}
    often = frequency_of(study, stems, set(zip(events["Iteration"].astype(int).tolist(), events["RockId"].astype(int).tolist())))
    of_dams = np.isin(events["Structure"], [k for k, one in enumerate(things) if one["kind"] == "embankment"])
    ends = ends_of(stems, set(map(tuple, keys_of(events, "Iteration", "RockId")[of_dams].tolist())))
    rows = [summary(one, {name: values[events["Structure"] == k] for name, values in events.items()}, often, ends)
            for k, one in enumerate(things)]
    write_table(os.path.join(folder, TABLE), [{name: np.array([row[name] for row in rows]) for name in rows[0]}])
