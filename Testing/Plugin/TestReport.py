"""A report of a finished study is one page that holds all it shows, with the study's own numbers; what is wrong with
a file of the study is one line that names file and field."""

import base64
import html
import json
import os
import re
import shutil
import subprocess
import sys
from xml.etree import ElementTree

import numpy as np

from helpers import delete_sources, incline, rows_of, run_script, write_grid, write_text

EXAMPLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Examples")
sys.path[:0] = [os.path.join(EXAMPLES, "study_parts"), os.path.join(EXAMPLES, "report_parts")]
import charts
import finished
import gis
import maps
import tables
from enough import most_of_none
from identity import content

write_grid("hill.asc", incline())
write_text("rocks.csv", "x,y,z,shape,volume\n" + "\n".join(
    f"700025,{4000060 + 10 * k},{146 + k},{shape},{0.5 + 0.25 * k}"
    for k, shape in enumerate(["cube", "icosahedron", "octahedron"])) + "\n")
write_text("road.csv", "WKT,name,height\n" + "\n".join(
    f'"LINESTRING({x} 3999990,{x} 4000230)","<b>road</b> {x}",{h}' for x, h in ((700045, 1), (700290, 3))) + "\n")
write_text("net.csv", 'WKT,name,height,capacity\n"LINESTRING(700048 4000030,700048 4000110)",Net <1>,4,1000\n')
write_text("stems.csv", 'WKT,diameter,height\n"LINESTRING(700200 4000180,700208 4000180)",40,\nPOINT(700250 4000185),30,20\n')
study = {
    "terrain": {"FileName": "hill.asc", "Preset": "Talus (assumed)", "BarrierFile": "net.csv", "TreeFile": "stems.csv"},
    "rocks": {"FileName": "rocks.csv", "Lengths": [1.0, 2.0, 3.0]},
    "simulation": {"EndTime": 6.0, "Seed": 77, "TrajectoryOutput": "Thinned", "FragmentSpread": 10.0}, "map": {"CellSize": 5.0, "LeastReach": 0.001},
    "lines": {"FileName": "road.csv", "BarrierCapacity": 150.0, "ParallelLines": 2, "ParallelSpacing": -10.0},
    "iterations": 4, "chunk": 2}


def run(script, *arguments):
    said, message = run_script(os.path.join(EXAMPLES, script), *arguments)
    delete_sources()
    return said if message is None else message


def finish(folder, description):
    shutil.rmtree(folder, ignore_errors=True)
    write_text("study.json", json.dumps(description))
    said = run("study.py", folder, "study.json")
    assert "Done" in said, said
    return said


finish("whole", study)
said = run("report.py", "whole", "--title", "Hill & <dale>", "--author", "Office")
assert "Report: " + os.path.join("whole", "report.html") in said, said
with open("whole/report.html", encoding="utf-8") as file:
    page = file.read()

# One file: all pictures are in it, nothing is fetched, no script runs, names are text.
sources = re.findall(r'src="([^"]*)"', page)
assert len(sources) == 9, len(sources)  # site, reach, energy, height, classes, exceedance, places of two, convergence
for source in sources:
    assert source.startswith("data:image/png;base64,")
    assert base64.b64decode(source.split(",", 1)[1], validate=True).startswith(b"\x89PNG")
assert not re.search(r"<script|<link|@import|url\(|https?://", page)
assert "Hill &amp; &lt;dale&gt;" in page and "<b>road" not in page
text = " ".join(html.unescape(re.sub(r"<[^>]*>", " ", page)).split())

# The study's own: inputs, ground, rocks, structures, lines, versions.
for name in ("hill.asc", "hill.prj", "rocks.csv", "road.csv", "net.csv", "stems.csv"):
    assert name in text and content(name) in text, name
lost = sum(row["FateCode"] in "124" for row in rows_of("whole/summary.csv"))
assert lost > 3
for word in ("WGS 84 / UTM zone 16N", "preset Talus (assumed): Lu et al. (2019)", "seed 77", "31 × 21 nodes every 10 m",
             "12 rocks, 3 releases in 4 iterations", "4 m high, capacity 1 000 kJ", "Office", "stems that lie 1, diameter 40 to 40 cm; energy that breaks one 194 kJ", "stems 1 on",
             "RockfallDDA", "gives no frequency of release", "source rocks volume, m³: least median largest 1 4 0.5 0.5 0.5", "Cells of the map below LeastReach 0.001 are left empty", "icosahedron 4 0.75 0.75 0.75",
             "Talus stops rocks too soon", "12 rocks were still moving at EndTime (6 s)",
             "Lengths is 1, 2, 3 m, but has no effect: only a box or an ellipsoid has lengths.",
             "Fragmentation is off, without which these have no effect: FragmentSpread.",
             f"No rock reached line <b>road</b> 700290: of 12 rocks, of which {lost} were lost before it, the share that passes is "
             f"below {tables.number(100.0 * most_of_none(12, lost) / 12.0)} % with 95 % confidence"):
    assert word in text, word
sections = re.findall(r"<h2>(\d+) ", page)
assert sections == [str(k) for k in range(1, 12)], sections
assert "judged by the height of the rock's top" in text and "by the rock's lowest point" not in text
line, other = (row for row in rows_of("whole/lines.csv") if float(row["Offset"]) == 0.0)
energy = tables.number(float(line["KineticEnergy95"]) / 1000.0).replace("\u2009", " ")
assert f"rocks that pass {line['Rocks']} " in text
# Structures by their names, with what came to them.
net = next(row for row in rows_of("whole/structures.csv") if row["Kind"] == "net")
assert int(net["Hits"]) > 0 and "net or fence 1 Net <1> 4 m high" in text, net
assert "net 1 Net <1> {Rocks} {Hits} {Held} {Broke} {Struck} {Over} {}, class {RequiredClass}".format(
    tables.number(float(net["EnergyMaximum"])), **net) in text, net
assert "hits, 1/a" not in text and "2 stems" in text
# Parallels are in the chart alone.
assert page.count('alt="Best place of a barrier"') == 2 and "700045 −20 m" not in text and "freeboard (0.5 m)" in text
assert f"energy, 95 % kJ {energy} * –" in text, energy  # of 12 rocks
for row in rows_of("whole/design.csv"):
    if row["LineName"] == line["LineName"] and row["Quantile"] == "95.0":
        assert tables.number(float(row["EnergyInKilojoules"])) in text and "too few rocks" in text, row
assert "What a barrier has to hold: <b>road</b> 700045" in text
assert "What a barrier has to hold: <b>road</b> 700290 No rock reached it." in text
own = finished.Study("whole")
# On maps, too, they have their names, and the legend leaves the scale bar free.
for stems in (True, False):
    sheet = maps.Sheet(own.slope, own.slope.extent(), 78.0, 17.0)
    sheet.mark(own, stems)
    shown = {one.get_text() for one in sheet.axes.texts}
    assert {"Net <1>", "<b>road</b> 700045", "<b>road</b> 700290"} <= shown, shown
    assert ("stems" if stems else "outline of the stems") in [one.get_label() for one in sheet.handles]
    sheet.legend(17.0, [maps.Patch(label="medium, 30 to 300 kJ")] * 3, columns=3)
    box = sheet.figure.axes[-1].get_legend().get_window_extent(sheet.figure.canvas.get_renderer())
    assert box.x1 / sheet.figure.dpi * 25.4 < maps.BESIDE, box
# Around a forest goes one line, around a stem that stands alone another.
edges = maps.outlines(np.array([[x, y] for x in range(0, 60, 12) for y in range(0, 60, 12)] + [[200.0, 20.0]]), 8.0)
assert len(edges) == 2 and sorted(np.ptp(edge[:, 0]) > 40.0 for edge in edges) == [False, True], edges
own.places.columns["AnnualFrequency"] = np.where(own.places["Rocks"] > 0, 0.25, 0.0)
rows = [row for table in tables.lines(own) for row in table["rows"]]
assert ("a rock passes every", "a", ["4", "–"]) in rows and not tables.fixed_volumes(own), rows
own.rocks.columns.update(SourceId=np.zeros(12), Frequency=np.full(12, 0.04))
least = f"below {tables.number(most_of_none(12, lost) * 0.04 / 4.0)}"  # below 0.03 if none were lost, as further down
assert [tables.often(own, k) for k in own.given_lines()] == ["0.25", least]
assert "count each simulated rock alike" not in " ".join(tables.notes(own))
own.given["map"]["LeastAngle"] = 27
assert "energy-line angle is below LeastAngle 27°" in " ".join(tables.notes(own))
own.rocks.columns.update(Frequency=np.linspace(0.01, 0.04, 12))
assert "count each simulated rock alike" in " ".join(tables.notes(own))
tables.MANY_VOLUMES = 3  # of one source: those of a law
assert tables.fixed_volumes(own) == 3
delete_sources()
share = 100.0 * int(line["Rocks"]) / 12.0
assert re.search(rf"road</b> 700045: share that passes % {re.escape(tables.number(share))} [\d.]+ to", text), share
fates = {row["Fate"] for row in rows_of("whole/summary.csv")}
for fate in fates:
    count = sum(row["Fate"] == fate for row in rows_of("whole/summary.csv"))
    assert f"{fate} {count} {tables.number(100.0 * count / 12.0)}" in text, fate

# Rocks that were lost before a line count both ways in its limits: they may come to it yet.
ends, few = own.rocks["Endless"].copy(), [one for one in own.given_lines() if own.lines["Rocks"][one] == 0]
for gone in (0, 5):
    own.rocks.columns["Endless"] = np.arange(12) < gone
    for column in ("MovingBefore", "OverEdgeBefore", "InNodataBefore"):
        own.lines.columns[column] = np.full(len(own.lines), gone if column == "OverEdgeBefore" else 0)
    high = charts.share(0, 12, gone)[2]
    assert tables.passing(own, "<b>road</b> 700290")[0] == f"0 (0 to {tables.number(high)})"
    curve = charts.settling(own, ["<b>road</b> 700290"])[1][1]
    assert curve[1] == "share that passes" and curve[-1][-1] == charts.share(0, 12, gone), curve
    assert ("95 % limits of the share", "%", f"0 to {tables.number(high)}") in [
        (*row[:2], row[2][-1]) for table in tables.lines(own) for row in table["rows"]]
    below = {0: "below 0.03", 5: "below 0.105"}[gone]  # at most 10.51 rocks of 12, 1/a each 0.04 / 4
    own.rocks.columns["Frequency"] = np.full(12, 0.04)
    assert tables.often(own, few[0]) == below, tables.often(own, few[0])
    told = f"of 12 rocks{', of which 5 were lost before it,' if gone else ''} the share that passes is below {87.6 if gone else 25}"
    assert told in " ".join(tables.notes(own)), tables.notes(own)
assert high > 60.0
own.rocks.columns["Endless"] = ends
# What is not known is told so, never a number or a yes.
row = {"Kind": "embankment", "StructureId": 1.0, "Name": "Dam", "Broke": 0.0, "Struck": -1.0, "RequiredClass": -1.0, "HeldAll": -1.0,
       "BrakingDistanceMaximum": np.nan, "UsefulHeightMinimum": np.nan, "AnnualFrequency": np.nan, "Hits": 4.0,
       **dict.fromkeys(("Rocks", "Held", "Over"), -2.0), **dict.fromkeys(("EnergyMaximum", "TopHeightMaximum"), np.nan)}
there, own.standing = own.standing, own.bodies.rows(slice(0, 0))
own.standing.columns = {name: np.array([value]) for name, value in row.items()}
assert tables.standing(own) == [["embankment 1 Dam", "not known", "4", "not known", "–", "–", "not known", "not known", "–", "not known",
                                 "–", "–"]], tables.standing(own)
own.standing = there

# Choices are in the values in force by their names, and how long it took is told.
with open("whole/manifest.json") as file:
    manifest = json.load(file)
assert manifest["values"]["terrain"]["Preset"] == "Talus (assumed)"
assert "TimestepValues" not in manifest["values"]["simulation"]
assert [one["iterations"] for one in manifest["sessions"]] == [4] and manifest["sessions"][0]["seconds"] > 0
assert "Preset: Talus (assumed)" in text and "model speed-dependent" in text
assert "numbers of section 3 count" in text

# Beside the tables and the map: types, CRS, styles with units; QGIS itself looks at them in qgisCheck.py.
said = subprocess.run(["ogrinfo", "-al", "-so", "whole/crossings.csv"], capture_output=True, text=True, check=True).stdout
assert "Geometry: Point" in said and "UTM zone 16N" in said and re.search(r"KineticEnergy: Real \(", said), said
assert re.search(r"BlockId: Integer64 \(", said) and re.search(r"LineName: String \(", said), said
bands = re.findall(r"Description = (\w+)", subprocess.run(["gdalinfo", "whole/hazard.tif"], capture_output=True, text=True,
                                                         check=True).stdout)
styles = {name: ElementTree.parse(os.path.join("whole", name)).getroot() for name in os.listdir("whole")
          if name.endswith(".qml")}
assert {"hazard.qml", "hazard-KineticEnergy95.qml", "hazard-HeightOverGround95.qml", "crossings.qml"} <= set(styles)
for name, style in styles.items():
    if name.startswith("hazard"):
        band = name[7:-4] if "-" in name else "ReachProbability"
        assert bands[int(style.find("pipe/rasterrenderer").get("band")) - 1] == band, name
labels = [item.get("label") for item in styles["hazard-KineticEnergy95.qml"].iter("item")]
assert labels[0] == "up to 10 kJ" and labels[-1] == "above 3000 kJ" and len(labels) == 7, labels
aliases = {one.get("field"): one.get("name") for one in styles["lines.qml"].iter("alias")}
assert aliases["KineticEnergy95"] == "Kinetic energy 95 (J)" and aliases["BarrierCapacity"] == "Barrier capacity (kJ)"
assert {one.get("name") for one in styles["crossings.qml"].find("expressionfields")} == {
    "KineticEnergy_kJ", "TranslationalEnergy_kJ", "RotationalEnergy_kJ"}
for name, unit in (("EnergyInKilojoulesLow", "kJ"), ("EnergyMaximum", "kJ"), ("EnergyFriction", "J"), ("LastingLoss", "J"),
                   ("TopHeight", "m"), ("VelocityX", "m/s"), ("RotationRateX", "rad/s"), ("StartX", "m"), ("Mass", "kg"),
                   ("UncaughtFrequency", "1/a"), ("Share", ""), ("Rocks", ""), ("VerticalAngle", "°"), ("Passing", ""), ("Offset", "m")):
    assert gis.unit_of(name) == unit, (name, gis.unit_of(name))
assert gis.raster_style("Intensity100a", 3).count("paletteEntry") == 3
# Classes by the map's own thresholds, however many and in whatever order they were typed; periods of half a year, too.
own_bands = ["ExceedanceProbability300kJ", "Intensity30a", "ExceedanceProbability30kJ", "ExceedanceProbability62.5kJ", "Intensity0.5a"]
assert gis.thresholds_of(own_bands) == [30.0, 62.5, 300.0] and gis.periods_of(own_bands)[0] == (0.5, "Intensity0.5a")
entries = re.findall(r'paletteEntry value="(\d)".*?label="([^"]*)"', gis.raster_style("Intensity0.5a", 5, [30.0, 62.5, 300.0]))
assert entries == [("1", "below 30 kJ"), ("2", "30 to 62.5 kJ"), ("3", "62.5 to 300 kJ"), ("4", "above 300 kJ")], entries
assert [one[1:] for one in gis.intensities([30.0, 300.0])][::2] == [("#f0c419", "weak, below 30 kJ"), ("#8b0a1a", "strong, above 300 kJ")]
assert gis.intensities([]) == [(1, "#f0c419", "of any energy")]
assert gis.raster_style("Passages", 1) is None

# Numbers, scales, rasters.
for value, shown in ((0, "0"), (1234.5, "1\u2009230"), (0.012345, "0.0123"), (99.96, "100"), (2.5, "2.5"),
                     (float("nan"), "–"), (1.5e9, "1.50e+09"), (1e-9, "1.00e-09"), (100, "100")):
    assert tables.number(value) == shown, (value, tables.number(value))
assert [maps.nice(v) for v in (0.9, 1.0, 1.1, 2.1, 21)] == [1.0, 1.0, 2.0, 5.0, 50.0]
cells = np.full((3, 5), np.nan)
cells[0, 4], cells[2, 0] = 7.0, -2.0
small, extent = maps.fewer(cells, (0.0, 10.0, 0.0, 6.0), 3)
assert small.shape == (2, 3) and small[0, 2] == 7.0 and small[1, 0] == -2.0 and np.isnan(small).sum() == 4
assert extent == (0.0, 12.0, -2.0, 6.0), extent
assert charts.share(0, 100, 0)[:2] == (0.0, 0.0) and abs(charts.share(0, 100, 0)[2] - 100 * (1 - 0.025 ** 0.01)) < 1e-6
assert charts.quantile(np.arange(1.0, 11.0))[0] == np.quantile(np.arange(1.0, 11.0), 0.95)
assert np.isnan(charts.quantile(np.arange(1.0, 11.0))[1])

# A study without map, lines and files.
finish("bare", {"simulation": {"EndTime": 2.0}, "iterations": 1, "chunk": 1})
assert "Report: other.html" in run("report.py", "bare", "--output", "other.html")
with open("other.html", encoding="utf-8") as file:
    bare = file.read()
for word in ("The study makes no map", "The study has no lines", "the test slope", "local coordinates"):
    assert word in bare, word


# Rocks that break count once, and reach as far as their farthest piece.
said = finish("pieces", {"rocks": study["rocks"], "map": {
    "CellSize": 5.0, "AnnualFrequency": 1.0, "EnergyThresholds": [300, 20, 60], "ReturnPeriods": [0.5, 30]}, "terrain": {"FileName": "hill.asc", "Preset": "Talus (assumed)"}, "simulation": {
    **study["simulation"], "Fragmentation": 1, "FragmentationEnergy": 2e4, "FractalDimension": 2.0, "LeastFragment": 0.1},
    "iterations": 2, "chunk": 2})
# The map of a study tells whom it lost, once, and the study all else.
assert "rocks broke in impacts of 20000 J/m³ or more" in said and "still moving" not in said, said
assert "Report: " in run("report.py", "pieces")
with open("pieces/report.html", encoding="utf-8") as file:
    text = " ".join(html.unescape(re.sub(r"<[^>]*>", " ", file.read())).split())
bodies = rows_of("pieces/summary.csv")
assert sum(row["Fate"] == "broken" for row in bodies) > 0 and len(bodies) > 6, bodies
assert "scenario of 0.5 years" in text and "scenario of 30 years" in text, text
assert "6 rocks, 3 releases in 2 iterations" in text and "from 20 kJ/m³ of normal energy" in text, text[:400]
few = own.bodies.rows(np.arange(4), Piece=np.array([0.0, 1.0, 2.0, 0.0]), StartX=np.array([0.0, 5.0, 5.0, 0.0]),
                      StopX=np.array([5.0, 30.0, 9.0, 7.0]), StartY=np.zeros(4), StopY=np.zeros(4))
assert list(finished.released(few)["RunOut"]) == [30.0, 7.0]
# Of a rock that left the DEM, or a piece of which did, nobody knows how far it goes; a 95 % value beyond is none.
few = few.rows(np.arange(4), FateCode=np.array([5.0, 0.0, 1.0, 0.0]))
assert list(finished.released(few)["Endless"]) == [True, False]
assert charts.quantile(np.arange(101.0))[0] == 95.0 and charts.quantile(np.append(np.arange(96.0), 5 * [np.inf]))[0] == 95.0
assert charts.quantile(np.append(np.arange(95.0), 6 * [np.inf]))[0] == np.inf

# A variant beside it: the same lines, and in what it differs.
finish("variant", {**study, "terrain": {name: value for name, value in study["terrain"].items() if name != "BarrierFile"}})
assert "Report: beside.html" in run("report.py", "whole", "--beside", "variant", "--output", "beside.html")
with open("beside.html", encoding="utf-8") as file:
    text = " ".join(html.unescape(re.sub(r"<[^>]*>", " ", file.read())).split())
first = rows_of("variant/lines.csv")[0]
count, before = int(first["Rocks"]), sum(int(first[column]) for column in ("MovingBefore", "OverEdgeBefore", "InNodataBefore"))
low, high = charts.share(count, 12, before)[1:]
assert f"{tables.number(100.0 * count / 12.0)} ({tables.number(low)} to {tables.number(high)})" in text
assert "They differ in terrain BarrierFile; 12 rocks in 4 iterations, and 12 in 4" in text
assert "pieces: no line has the name of one of whole" in run("report.py", "whole", "--beside", "pieces")

# The window's menu makes the same, in a process of its own.
scripts = os.path.join(os.environ["PV_PLUGIN_PATH"], "..", "RockfallScripts")
if os.path.isdir(scripts):  # it was built with a window
    sys.path.append(scripts)
    import rockfall_study
    assert rockfall_study.report("bare/manifest.json", show=False) == os.path.abspath("bare/report.html")
    with open("bare/report.html", encoding="utf-8") as file:
        assert file.read() == bare
    try:
        rockfall_study.report("nowhere/manifest.json", show=False)
        raise AssertionError("a report of nothing")
    except RuntimeError as error:
        assert "nowhere is not the folder of a study" in str(error), error


# What is wrong is told in one line.
def refused(word, name, change=None):
    shutil.rmtree("broken", ignore_errors=True)
    shutil.copytree("whole", "broken")
    if change is None:
        os.remove(os.path.join("broken", name))
    else:
        with open(os.path.join("broken", name), "rb") as file:
            data = file.read()
        with open(os.path.join("broken", name), "wb") as file:
            file.write(change(data))
    message = run("report.py", "broken")
    assert word in message and "broken" in message and "\n" not in message.strip(), (word, message)


def replaced(old, new):
    return lambda data: data.replace(old.encode(), new.encode(), 1)


assert "nowhere is not the folder of a study" in run("report.py", "nowhere")
refused("it has no manifest.json", "manifest.json")
refused("the study is not finished", "results.json")
refused("is not JSON", "manifest.json", lambda data: data[:100])
refused('"files" is 3, it must be an object', "manifest.json", lambda data: json.dumps(
    {**json.loads(data), "files": 3}).encode())
refused('"notes" is 3, it must be a list of texts', "manifest.json", lambda data: json.dumps(
    {**json.loads(data), "notes": 3}).encode())
refused("summary.csv: there is no column RunOut", "summary.csv", replaced("RunOut", "RunOff"))
refused("summary.csv: row 2 has", "summary.csv", lambda data: data.replace(b",", b";").replace(b";", b",", 39))
refused("summary.csv: column Iteration has \"x\"", "summary.csv", replaced("\n1,0,0,", "\n1,0,x,"))
refused("lines.csv: there is no column Share", "lines.csv", replaced("Share", "Shares"))
refused("hazard.tif", "hazard.tif", lambda data: b"no raster" + data[200:])
refused("lines.csv: No such file", "lines.csv")
write_grid("hill.asc", incline(drop=5.1))
refused(f"terrain FileName: {os.path.abspath('hill.asc')} changed since the study", "manifest.json", replaced("", ""))
os.remove("road.csv")
write_grid("hill.asc", incline())
refused(f"lines FileName: {os.path.abspath('road.csv')} is not there any more", "manifest.json", replaced("", ""))
print("a report says what the study has")
