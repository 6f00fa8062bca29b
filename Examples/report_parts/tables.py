"""Tables of a report, as rows of texts."""
import csv
import math
import os
import re

import numpy as np

import charts
from enough import most_of_none
from identity import differences
from schema import Bad
from standing import UNKNOWN

HERE = os.path.dirname(os.path.abspath(__file__))
MODELS = ("whole velocity", "normal and tangential", "speed-dependent")
MOST_SOURCES = 10  # of a line
SHARES = 4  # rows of a line's table: how many rocks pass
MANY_VOLUMES = 4  # of one source: a law's, not those of its rows
FEW = "\u00a0*"  # behind a value that too few rocks give
SIDE_BY_SIDE = 5  # columns of a table that fit on a page
# Of lines.csv: column, what a person reads, unit, factor
QUANTITIES = (("KineticEnergy", "energy", "kJ", 1e-3), ("HeightOverGround", "height of the lowest point", "m", 1.0),
              ("Speed", "speed", "m/s", 1.0))
STATISTICS = (("50", "50 %"), ("90", "90 %"), ("95", "95 %"), ("99", "99 %"), ("Maximum", "largest"), ("Mean", "mean"),
              ("Deviation", "standard deviation"))
LINES = (("Rocks", "rocks that pass", "", 1.0), ("Passings", "passings", "", 1.0), ("Share", "share of the released", "%", 100.0),
         ("ShareError", "± standard error of it", "%", 100.0), ("HighestQuantile", "highest quantile with enough rocks", "%", 1.0),
         ("BarrierHeight", "barrier: height", "m", 1.0), ("BarrierCapacity", "barrier: capacity", "kJ", 1.0),
         ("Caught", "barrier: rocks that it catches", "", 1.0),
         ("CaughtShare", "barrier: catches of the passing", "%", 100.0),
         ("CaughtShareError", "± standard error of it", "%", 100.0),
         *((name + end, f"{text}, {stat}", unit, factor) for name, text, unit, factor in QUANTITIES
           for end, stat in STATISTICS))
LOST = (("MovingBefore", "still moved at the end of the simulated time"), ("OverEdgeBefore", "left over the edge of the slope"),
        ("InNodataBefore", "were lost in nodata"))  # columns of lines.csv
YIELDING = (("M_E", "MN/m²"), ("scar factor", ""), ("density", "kg/m³"), ("C_s", ""), ("spin drag", ""), ("μ min", ""),
            ("μ max", ""), ("κ", "1/m"), ("β", "1/s"), ("μ_r", ""), ("softness, deviation", ""), ("softness, length", "m"), ("scar radius", "m"))


def number(value, digits=3):
    """For a person: so many digits that say something, no exponent from 0.001 to a million."""
    value = float(value)
    if not math.isfinite(value):
        return "–"
    if value == 0.0:
        return "0"
    places = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    if places > digits + 2 or abs(value) >= 1e7:
        return f"{value:.{digits - 1}e}"
    text = f"{round(value, digits - 1 - math.floor(math.log10(abs(value)))):,.{places}f}".replace(",", "\u2009")
    return text.rstrip("0").rstrip(".") if "." in text else text


def slices(items, size=SIDE_BY_SIDE):
    return [items[k:k + size] for k in range(0, len(items), size)]


def side_by_side(heads, rows):
    """Tables with a column for each head, as many as fit: [(heads, [(label, unit, cells)])]."""
    return [{"title": "", "heads": [heads[k] for k in some],
             "rows": [(label, unit, [cells[k] for k in some]) for label, unit, cells in rows]}
            for some in slices(range(len(heads)))]


def spread(value, deviation, factor=1.0):
    return number(value * factor) + (f" ± {number(deviation * factor)}" if deviation else "")


def ground(study):
    """Restitution and friction by class, with where the numbers come from."""
    slope, made = study.slope, []
    own, yielding = slope.numbers("TerrainMaterial").ravel(), slope.numbers("TerrainYielding")
    roughness = slope.numbers("TerrainRoughness").ravel()
    first = [(own[0], own[1], int(own[7]), own[8], own[9])]
    heads, share = shares(slope, "TerrainRestitution")
    rows = first + [(c[0], c[1], int(c[2]), c[3], c[4]) for c in slope.numbers("TerrainRestitutionClasses")]
    rough = [roughness, *slope.numbers("TerrainRestitutionRoughness")] if len(roughness) else []
    table = [("share of the slope", "%", share), ("model", "", [MODELS[r[2]] for r in rows]),
             ("Rv, or Rn", "", [spread(r[0], r[1]) for r in rows]),
             ("Rt", "", [number(r[3]) if r[2] else "–" for r in rows]),
             ("K", "m/s", [number(r[4]) if r[2] == 2 else "–" for r in rows])]
    for k, (label, unit) in enumerate(YIELDING[:yielding.shape[1]]):
        column = yielding[:, k]
        if np.any(column[yielding[:, 0] > 0]) or (k >= 5 and k <= 9 and np.any(column)):
            table.append((label, unit, [number(v) if yielding[i, 0] > 0 or 5 <= k <= 9 and v else "–" for i, v in enumerate(column)]))
    if rough and all(len(r) == 6 for r in rough) and len(rough) == len(rows):
        table += [("roughness, mean and deviation", "m", [spread(r[0], r[1]) for r in rough]),
                  ("its length", "m", [number(r[2]) for r in rough]),
                  ("obstacles of 70, 20, 10 %", "m", [", ".join(map(number, r[3:])) if any(r[3:]) else "–" for r in rough])]
    table = [row for row in table if any(cell != "–" for cell in row[2])]
    table += presets_of(study, "Restitution", heads)
    made += [{**one, "title": "Restitution and yielding"} for one in side_by_side(heads, table)]
    heads, share = shares(slope, "TerrainJoint")
    rows = [own[2:5], *slope.numbers("TerrainJointClasses")]
    degrees = 180.0 / math.pi
    table = [("share of the slope", "%", share), ("friction angle φ", "°", [spread(r[0], r[1], degrees) for r in rows]),
             ("cohesion", "N", [number(r[2]) for r in rows]), *presets_of(study, "Joint", heads)]
    return made + [{**one, "title": "Friction"} for one in side_by_side(heads, table)]


def shares(slope, stem):
    """Names of the classes, the slope's own first, and what share of its cells each has."""
    names = slope.texts(stem + "Names")
    cells = slope.numbers(stem + "Class").ravel().astype(int)
    count = np.bincount(cells, minlength=len(names) + 1) if len(cells) else np.array([1] + [0] * len(names))
    return ["elsewhere" if names else "all of the slope", *names], [number(100.0 * c / count.sum()) for c in count]


def classed(study):
    """The tables of classes: of what, and their files."""
    return [(text, os.path.basename(study.files[f"terrain {kind}Table"][0]))
            for kind, text in (("Restitution", "Restitution"), ("Joint", "Friction")) if f"terrain {kind}Table" in study.files]


def presets_of(study, kind, heads):
    """A row with the presets that a table of classes names, if it is CSV and does."""
    files = study.files.get(f"terrain {kind}Table")
    if not files or not files[0].lower().endswith(".csv"):
        return []
    with open(files[0], newline="", encoding="utf-8-sig", errors="replace") as file:
        rows = [{str(name).strip().lower(): cell or "" for name, cell in row.items()} for row in csv.DictReader(file)]
    known = {row.get(key, "").strip().casefold(): row.get("preset", "").strip() for row in rows for key in ("class", "name")}
    names = [known.get(head.casefold(), "") for head in heads[1:]]
    return [("preset of the class", "", ["–", *(name or "–" for name in names)])] if any(names) else []


def has_preset(study):
    preset = study.given["terrain"].get("Preset", 0)
    return preset != 0 and not str(preset).startswith("None")


def source_of(study):
    """Of the slope's own numbers: the preset with what supports it, or that they were typed."""
    if not has_preset(study):
        return "typed in the study, or the program's default"
    name = str(study.values["terrain"].get("Preset") or study.given["terrain"]["Preset"])
    path = os.path.join(HERE, "..", "..", "docs", "materials.md")
    if os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            for line in file:
                cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
                if len(cells) == 11 and name.startswith(cells[0]) and cells[0] != "Preset":
                    sources = re.sub(r"\[(.*?)\]\(.*?\)", r"\1", cells[10])
                    return f"preset {cells[0]} ({cells[1]}): {sources}"
    return f"preset {name}"


def rocks(study):
    """By shape: how many, how large."""
    table, made = study.rocks, []
    for shape in sorted(set(table["Shape"])):
        own = table["Shape"] == shape
        volume, mass = table["Volume"][own], table["Mass"][own]
        made.append([str(shape), number(own.sum(), 7), *(number(f(volume)) for f in (np.min, np.median, np.max)),
                     *(number(f(mass)) for f in (np.min, np.median, np.max))])
    return made


def source_name(study, source):
    """Its number, and the names that its rocks have."""
    names = set(study.rocks["SourceName"][study.rocks["SourceId"] == source]) if "SourceName" in study.rocks else set()
    names -= {"", f"source {source:.0f}"}
    return " ".join([number(source, 9), ", ".join(sorted(map(str, names)))]).strip()


def sources(study):
    """By source: how many rocks, how large, and how often one of them falls, if that is known; and how many sources
    more there are."""
    table, made = study.rocks, []
    first = table["Iteration"] == table["Iteration"].min()
    every = np.unique(table["SourceId"])
    for source in every[:MOST_SOURCES]:
        own = table["SourceId"] == source
        made.append([source_name(study, source), number(own.sum(), 7),
                     *(number(f(table["Volume"][own])) for f in (np.min, np.median, np.max)),
                     *([number(table["Frequency"][own & first].sum())] if "Frequency" in table else [])])
    return made, len(every) - len(made)


def frequencies(study):
    """What the study says of how often rocks fall; nothing if it says nothing."""
    units = {"AnnualFrequency": " 1/a", "EnergyThresholds": " kJ", "ReturnPeriods": " a"}
    told = lambda value: ", ".join(map(str, value)) if isinstance(value, list) else str(value)
    made = [(part, name, told(value) + units.get(name, "")) for part in study.given if isinstance(study.given[part], dict)
            for name, value in study.given[part].items() if re.search("Frequency|ReturnPeriod|EnergyThreshold", name)]
    if "Frequency" in study.rocks:
        first = study.rocks["Iteration"] == study.rocks["Iteration"].min()
        made.append(("rocks", "Frequency of all releases, 1/a", number(study.rocks["Frequency"][first].sum())))
    return made


def structures(study):
    slope, made = study.slope, []
    if len(slope.lying):
        cm = slope.lying[:, 3] * 100.0
        made.append(("stems that lie", f"{number(len(cm), 7)}, diameter {number(cm.min())} to {number(cm.max())} cm; energy that "
                     f"breaks one {span(slope.lying[:, 5] / 1000.0)}"))
    if len(slope.trees):
        area = (slope.east - slope.west) * (slope.north - slope.south) / 1e4
        cm, capacity = slope.trees[:, 3] * 100.0, slope.trees[:, 5] / 1000.0
        made.append(("stems", f"{number(len(cm), 7)} on {number(area)} ha of map, diameter {number(cm.min())} to "
                     f"{number(cm.max())} cm, mean {number(cm.mean())} cm; energy that breaks one "
                     f"{span(capacity)}"))
    names = slope.texts("TerrainEmbankmentNames") or [""] * len(slope.embankments)
    for name, row in zip(names, slope.embankments):
        size = f"{number(row[1])} m high" if row[1] else f"crest at {number(row[2], 6)} m"
        made.append((f"embankment {row[0]:.0f} {name}".strip(), f"{size}, crest {number(row[3])} m wide, slopes (across to up) {number(row[4])} "
                     f"uphill, {number(row[5])} downhill"))
    names = slope.texts("TerrainBarrierNames") or [""] * len(slope.barriers)
    for name, row in zip(names, slope.barriers):
        made.append((f"net or fence {row[0]:.0f} {name}".strip(), f"{number(row[1])} m high, capacity {span(row[2:3] / 1000.0)}" +
                     (", records only" if row[4] else "") +
                     (f", braking distance {number(row[6])} m" if row[6] > 0 else "") +
                     (f", {number(100.0 * row[7])} % of its height with its capacity used up" if row[7] >= 0 else "") +
                     (f", full with {number(row[8])} m³/m" if row[8] > 0 else "")))
    return made


def standing(study):
    """What came to each structure, by its name."""
    made = []
    for k in range(len(study.standing)):
        row = {name: values[k] for name, values in study.standing.columns.items()}
        net, stems = row["Kind"] == "net", row["Kind"] == "stems"
        whole = lambda name: "not known" if row[name] == UNKNOWN else "–" if row[name] < 0 else number(row[name], 7)
        real = lambda name, of: "not known" if row[of] == UNKNOWN and math.isnan(row[name]) else number(row[name])
        energy = real("EnergyMaximum", "Over") + (f", class {whole('RequiredClass')}" if net and row["Rocks"] else "")
        useful = number(row["UsefulHeightMinimum"]) if net else "–"
        enough = "–" if row["HeldAll"] < 0 else "yes" if row["HeldAll"] == 1 else "no"
        made.append([row["Name"] if stems else f"{row['Kind']} {row['StructureId']:.0f} {row['Name']}".strip(),
                     whole("Rocks"), whole("Hits"), whole("Held"), "–" if row["Kind"] == "embankment" else whole("Broke"),
                     whole("Struck"), whole("Over"), energy, enough, real("TopHeightMaximum", "Over"),
                     number(row["BrakingDistanceMaximum"] or math.nan), useful,
                     *([real("AnnualFrequency", "Hits")] if known_often(study) else [])])
    return made


def known_often(study):
    return len(study.standing) > 0 and bool(np.isfinite(study.standing["AnnualFrequency"]).any())


def span(capacity):
    if np.all(capacity < 0):
        return "without limit"
    low, high = number(capacity.min()), number(capacity.max())
    return f"{low} kJ" if low == high else f"{low} to {high} kJ"


def quantile_of(column):
    """Of KineticEnergy95 it is 95; 0 of what is no quantile."""
    found = re.fullmatch(r"(?:KineticEnergy|HeightOverGround|Speed)(\d+)", column)
    return int(found.group(1)) if found else 0


def lost(study, row):
    """Rocks that were lost before they came to a line."""
    return sum(int(study.lines[column][row]) for column, _ in LOST)


def often(study, row):
    """How often a line is passed, 1/a, with and without the rocks that were lost before it; of one that nothing passed the limit,
    with 95 % confidence, as maps have it, if no rock was lost before it."""
    frequency = study.places["AnnualFrequency"][row]
    more = study.places["LostFrequency"][row] if "LostFrequency" in study.places else math.nan
    if frequency > 0.0 and more > 0.0:
        return f"{number(frequency)} to {number(frequency + more)}"
    together = study.values.get("lines", {}).get("AnnualFrequency") or 0.0
    if frequency != 0.0 or not (together or "Frequency" in study.rocks):
        return number(frequency)
    total = len(study.rocks)
    each = np.full(total, together / total) if together else study.rocks["Frequency"] / study.iterations
    return f"below {number(min(each.sum(), most_of_none(total, lost(study, row)) * each.max()))}"


def lines(study):
    """A column for each line that was given, a row for each quantity, in kJ where there is energy; a star where too
    few rocks passed for it."""
    table, rows, given = study.lines, [], study.given_lines()
    known = {name for name, *_ in LINES}
    names = [(name, *rest) for name, *rest in LINES if name in table]
    names += [(name, name, "", 1.0) for name in table.names if name not in known and name not in (
        "Line", "LineName", "Offset", *(column for column, _ in LOST))]
    for name, label, unit, factor in names:
        values = table[name][given]
        few = (table["HighestQuantile"][given] < quantile_of(name)) & (table["Rocks"][given] > 0)
        rows.append((label, unit, [(number(v * factor) if values.dtype.kind == "f" else str(v)) + (FEW if less else "")
                                   for v, less in zip(values, few)]))
    yearly = study.places["AnnualFrequency"][given] if study.places else np.full(len(given), np.nan)
    if np.isfinite(yearly).any():
        rows.insert(SHARES, ("a rock passes every", "a", [number(1.0 / f) if f > 0.0 else "–" for f in yearly]))
        rows.insert(SHARES, ("rocks that pass", "1/a", [often(study, k) for k in given]))
    shares = [charts.share(table["Rocks"][k], len(study.rocks), lost(study, k)) for k in given]
    rows.insert(SHARES, ("95 % limits of the share", "%", [f"{number(low)} to {number(high)}" for _, low, high in shares]))
    return side_by_side([str(table["LineName"][k]) for k in given], rows)


def design(study):
    """What barriers on the lines have to hold, line by line: levels with their intervals, classes of net, and where
    rocks that get past come from."""
    made = []
    if not study.design:
        return made
    for name, _ in study.lines_with_parallels():
        levels, classes, sources = ([{c: table[c][k] for c in table.columns} for k in np.nonzero(table["LineName"] == name)[0]]
                                    for table in study.design)
        between = lambda row, what: number(row[what]) + (
            f" ({number(row[what + 'Low'])} to {number(row[what + 'High'])})" if math.isfinite(row[what + "Low"]) else "")
        known = all(math.isfinite(row["CaughtFrequency"]) for row in classes)
        sources.sort(key=lambda row: (-number_or_zero(row["UncaughtShare"]), -row["Rocks"]))
        made.append({
            "line": name,
            "levels": [("largest" if row["Quantile"] == 100 else f"{number(row['Quantile'])} %",
                        *(between(row, what) for what in ("EnergyInKilojoules", "Speed", "TopHeight")),
                        number(row["DesignEnergyInKilojoules"]), number(row["RequiredHeight"]),
                        "–" if row["RequiredClass"] < 0 else number(row["RequiredClass"]),
                        "too few rocks" if row["Rocks"] < row["LeastRocks"] else "") for row in levels],
            "classes": [(str(row["Class"]), number(row["BarrierHeight"]), number(row["MaximumEnergyLevel"], 4),
                         *(f"{row[what]:.0f} ({number(100.0 * row[what + 'Share'])} %)" for what in ("Caught", "Over", "TooStrong")),
                         number(100.0 * row["UncaughtShareHigh"]),
                         *([number(row["OverFrequency"] + row["TooStrongFrequency"])] if known else [])) for row in classes],
            "sources": [(source_name(study, row["SourceId"]), *(f"{row[what]:.0f}" for what in ("Rocks", "Caught", "Over", "TooStrong")),
                         number(100.0 * row["Share"]), number(row["EnergyMaximum"]),
                         *([number(row["AnnualFrequency"]), number(row["UncaughtFrequency"])] if known else []))
                        for row in sources[:MOST_SOURCES]],
            "known": known,
            "reached": any(row["Rocks"] for row in levels),
            "more": max(0, len(sources) - MOST_SOURCES)})
    return made


def passing(study, name):
    """Of a line by its name: how many pass, how often, with how much energy."""
    passed, energy = charts.first_passings(study, name)
    texts = []
    for value, low, high in (charts.share(len(energy), len(study.rocks), charts.lost(study, passed)), charts.quantile(energy)):
        known = math.isfinite(low)
        texts.append(number(value) + (f" ({number(low)} to {number(high)})" if known else FEW if math.isfinite(value) else ""))
    row = list(study.lines["LineName"]).index(name)
    return texts[0], often(study, row), texts[1]


def beside(study, other):
    """Of lines of one name in two studies what passes them, and in what the studies differ."""
    has = [] if study.lines is None or other.lines is None else [
        str(study.lines["LineName"][k]) for k in study.given_lines() if study.lines["LineName"][k] in list(other.lines["LineName"])]
    if not has:
        raise Bad(f"{other.folder}: no line has the name of one of {study.folder}")
    names = ("rocks that pass, %", "rocks that pass, 1/a", "energy, 95 %, kJ")
    rows = [(name if k == 0 else "", label, *cells) for name in has
            for k, (label, *cells) in enumerate(zip(names, passing(study, name), passing(other, name)))]
    return {"name": other.name, "rows": rows, "differs": differences(study.given, other.given),
            "counts": [(len(one.rocks), one.iterations) for one in (study, other)]}


def number_or_zero(value):
    return value if math.isfinite(value) else 0.0


def breaks(study):
    """From how much energy by volume on rocks break, kJ/m³; 0 if they do not."""
    values = study.values.get("simulation", {})
    return values.get("FragmentationEnergy", 0.0) / 1000.0 if values.get("Fragmentation") else 0.0


def fates(study):
    names, counts = np.unique(study.bodies["Fate"], return_counts=True)
    return [(str(name), int(count), number(100.0 * count / len(study.bodies))) for name, count in zip(names, counts)]


def fixed_volumes(study):
    """How many releases there are, if they have volumes of a law that is the same in all iterations; else 0."""
    table, law = study.rocks, study.values.get("rocks", {})
    first = table["Iteration"] == table["Iteration"].min()
    volumes = table["Volume"][first]
    many = any(len(np.unique(volumes[table["SourceId"][first] == source])) >= MANY_VOLUMES
               for source in np.unique(table["SourceId"][first]))
    return int(first.sum()) if study.iterations > 1 and many and not law.get("RedrawVolume") else 0


def notes(study):
    """What a reader should know before the numbers."""
    made = list(dict.fromkeys(re.sub(r"(?<!\S)/\S*/", "", note) for note in study.slope.notes + study.notes))  # files by their names
    rocks_, total = study.rocks, len(study.rocks)
    least = study.given.get("map") or {}
    if least.get("LeastReach"):
        made.append(f"Cells of the map below LeastReach {least['LeastReach']} are left empty where that holds of each source: "
                    "outliers, which are no less possible for it.")
    if least.get("LeastAngle"):
        made.append(f"Rocks do not count in cells of the map where their energy-line angle is below LeastAngle {least['LeastAngle']}°: "
                    "they come there all the same.")
    unmoved = int((rocks_["RunOut"] < 0.1).sum())
    if unmoved:
        made.append(f"{unmoved} of {total} rocks got no farther than 0.1 m.")
    fixed = fixed_volumes(study)
    if fixed:
        made.append(f"The volumes of the {fixed} releases are drawn once: all iterations have the same, and more of them try no "
                    "others. RedrawVolume draws them anew in each.")
    often = study.rocks["Frequency"] if "Frequency" in study.rocks else np.zeros(1)
    if often.max() > (1.0 + 1e-9) * often.min():
        made.append("Rocks differ in their frequencies, but shares, 95 % values and design levels count each simulated rock alike, so rare "
                    "rocks count too much in them. Release amounts in proportion to frequencies, or read the annual frequencies.")
    steps = study.bodies["ContactSteps"].sum()
    unsettled = study.bodies["UnsettledSteps"].sum() / steps if steps else 0.0
    if unsettled > 0.003:
        made.append(f"{number(1000 * unsettled)} of 1000 steps with contacts had not settled: a reason for doubt.")
    if study.lines:
        for k in study.given_lines():
            name, count = study.lines["LineName"][k], int(study.lines["Rocks"][k])
            if count == 0:
                before = lost(study, k)
                made.append(f"No rock reached line {name}: of {total} rocks" + (f", of which {before} were lost before it," if before else "") +
                            f" the share that passes is below {number(100.0 * most_of_none(total, before) / total)} % with 95 % confidence.")
            elif study.lines["HighestQuantile"][k] < 99:
                few = study.lines["HighestQuantile"][k] < 95
                made.append(f"{count} {'rock' if count == 1 else 'rocks'} passed line {name}: too few for its " +
                            ("95 % values, which take 59, and 99 %, which take 299. Those numbers are too low." if few else
                             "99 % values, which take 299. Those are too low."))
            for column, text in LOST:
                gone = int(study.lines[column][k])
                if gone:
                    made.append(f"{gone} {'rock' if gone == 1 else 'rocks'} {text} before they came to line {name}.")
    return [note if note.endswith((".", "?")) else note + "." for note in made]


def values_in_force(study):
    """By part: names and values; whether the study sets them."""
    made = []
    for part, values in study.values.items():
        rows = []
        for name, value in sorted(values.items()):
            given = study.given.get(part)
            told = isinstance(given, dict) and name in given
            if value in ("", [], None) and not told or name.endswith(("Values",)) or "unfinished" in str(value):
                continue
            if f"{part} {name}" in study.files:
                value = os.path.basename(study.files[f"{part} {name}"][0])
            text = ", ".join(map(str, value)) if isinstance(value, list) else str(value)
            rows.append((name, text if len(text) < 60 else text[:57] + "…", told))
        made.append((part, rows))
    return made
