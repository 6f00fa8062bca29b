"""A study that is killed at some moment and started again, on other ranks, or in other chunks, ends with
the same files, byte for byte, as one that nobody disturbed: table, hazard map and what passed a road.
They are what the filters make of all trajectories at once. A changed study is refused."""

import csv
import glob
import io
import json
import math
import os
import random
import shutil
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree

from helpers import (
    delete_sources, files_of, incline, outside_mpi, run_script, write_grid, write_text)

import numpy as np
from paraview.simple import (
    DEMtoCFEMesh, GetSources, Delete, OutputPort, RockBlocks, RockfallHazardMap, RockfallSimulation,
    SaveData, TrajectoryCollector, UpdatePipeline)

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Examples", "study.py")
sys.path[:0] = [os.path.join(os.path.dirname(SCRIPT), "study_parts")]
import standing
from identity import FILES

MPIEXEC = shutil.which("mpiexec")

terrain = write_grid("incline.asc", incline())
rocks = write_text("sources.csv", "x,y,z,shape,volume\n" + "\n".join(
    f"700025,{4000060 + 10 * k},{146 + k},{shape},{0.5 + 0.25 * k}"
    for k, shape in enumerate(["cube", "icosahedron", "octahedron"])) + "\n")
road = write_text("road.csv", "WKT,name,height\n" + "\n".join(
    f'"LINESTRING({x} 3999990,{x} 4000230)","road, {x}",{h}' for x, h in ((700045, 1), (700055, 3))) + "\n")
write_text("held.csv", 'WKT,name,height,capacity,braking,residual\n"LINESTRING(700060 4000030,700060 4000066)",Upper net,4,300,5,60\n'
           '"LINESTRING(700050 4000030,700050 4000130)",Low net,0.9,20,5,60\n')
write_text("dams.csv", 'WKT,name,height,width,slope\n"LINESTRING(700064 4000067,700064 4000130)",Dam,2,1,1\n')
write_text("trees.csv", "x,y,diameter,height\n" + "\n".join(
    f"{700057 + k % 3},{4000056 + 2 * k},{15 + k},18" for k in range(15)) + "\n")
study = {
    "terrain": {"FileName": "incline.asc", "RoughnessDeviation": 0.2, "BarrierFile": "held.csv", "EmbankmentFile": "dams.csv",
                "TreeFile": "trees.csv"},
    "rocks": {"FileName": "sources.csv", "Lengths": [1.0, 2.0, 3.0]},
    "simulation": {"EndTime": 8.5, "TrajectoryOutput": "Thinned"},
    "map": {"CellSize": 5.0, "AnnualFrequency": 0.5, "EnergyThresholds": [10.0, 100.0]},
    "lines": {"FileName": "road.csv", "BarrierCapacity": 150.0, "AnnualFrequency": 0.5, "TrajectoryFactor": 1.1},
    "iterations": 11, "chunk": 2}
RESULTS = ["summary.csv", "hazard.tif", "crossings.csv", "lines.csv", "exceedance.csv", "design.csv",
           "design_classes.csv", "design_sources.csv", "design_places.csv", "structures.csv"]


def write_study(name="study.json", **changes):
    return write_text(name, json.dumps({**study, **changes}))


def command(folder, path="study.json", ranks=1):
    start = [MPIEXEC, "-n", str(ranks), "--oversubscribe", "--bind-to", "none"] if ranks > 1 else []
    return start + ["pvbatch"] + (["--sym"] if ranks > 1 else []) + [SCRIPT, folder, path]


def run(folder, path="study.json", ranks=0):
    """Its exit code and what it said; without ranks in this process, which is quicker."""
    if ranks:
        done = subprocess.run(command(folder, path, ranks), stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, timeout=200, env=outside_mpi())
        return done.returncode, done.stdout
    said, message = run_script(SCRIPT, folder, path)
    delete_sources()
    return (0, said) if message is None else (1, said + message)


def for_gis(names):
    """Companions of tables and map: types, CRS and styles."""
    return sorted(name for name in names if name.endswith((".csvt", ".qml", ".prj")))


def results_of(folder):
    """All files of a study but what its manifest says for a person, as the date."""
    there = files_of(folder)
    if "manifest.json" in there:
        there["manifest.json"] = json.dumps(json.loads(there["manifest.json"])["identity"])
    return there


def notes_of(folder):
    with open(os.path.join(folder, "manifest.json"), encoding="utf-8") as file:
        return json.load(file)["notes"]


def expect_same(folder, what):
    there = results_of(folder)
    assert notes_of(folder) == notes_of("results-calm"), f"{what}: {notes_of(folder)}"
    assert set(there) == set(calm), f"{what}: {sorted(set(there) ^ set(calm))}"
    assert there == calm, f"{what} makes other files: {[n for n in calm if there[n] != calm[n]]}"


for folder in glob.glob("results-*"):
    shutil.rmtree(folder)
write_study()

code, said = run("results-calm")
assert code == 0, said
calm = results_of("results-calm")
assert sorted(set(calm) - set(for_gis(calm))) == sorted(
    [f"chunk-{k:05d}{kind}" for k in range(6)
     for kind in (".npz", ".vtp", ".passages", "-crossings.vtp", "-structures.npz")] +
    ["manifest.json", "results.json"] + RESULTS), sorted(calm)
# All notes: of the slope, the rocks, the run and the map, each once; none of the look at the inputs.
notes = notes_of("results-calm")
for word in ("ground is bare rock", "Lengths is 1, 2, 3 m, but has no effect: only a box or an ellipsoid has lengths",
             "of 33 rocks were still moving at EndTime (8.5 s): they count",
             "of 33 rocks were still moving at EndTime (8.5 s) before they passed a line: they count",
             "of 33 rocks went over a barrier"):
    assert sum(word in note for note in notes) == 1, (word, notes)
assert len(set(notes)) == len(notes) and not any("(0.005 s)" in note or " of 6 rocks" in note for note in notes), notes
styled = [name[:-4] for name in RESULTS if name.endswith(".csv")]
assert {name for name in for_gis(calm) if not name.startswith("hazard")} == {
    "crossings.prj", *(name + end for name in styled for end in (".csvt", ".qml"))}, for_gis(calm)
assert calm["summary.csv"].count(b"\n") == 1 + 33
crossings = calm["crossings.csv"].count(b"\n") - 1
assert crossings > 15, calm["lines.csv"]

# Killed at some moment, the third time it gets that far: within a chunk, or while a file is written.
moment = random.Random()
last = 5
process = subprocess.Popen(command("results-killed"), stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL, env=outside_mpi())
awaited = f"results-killed/chunk-{moment.randrange(last):05d}.npz"
while process.poll() is None and not os.path.exists(awaited):
    time.sleep(0.001)
time.sleep(moment.uniform(0.0, 0.02))
process.send_signal(signal.SIGKILL)
process.wait()
left = results_of("results-killed")
assert "results.json" not in left, "it was done before it could be killed"
for name, data in left.items():
    assert name.startswith(".unfinished-") or data == calm[name], f"{name} is not whole"
write_text("results-killed/.unfinished-chunk-00003.npz", "half of it")
write_text("results-killed/.unfinished-hazard.tif", "half of it")
code, said = run("results-killed", ranks=4 if MPIEXEC else 1)
assert code == 0, said
assert "chunks are there already" in said, said
expect_same("results-killed", f"the study killed after {awaited} and restarted")

# What is there is not done again.
code, said = run("results-killed")
assert code == 0 and "6 of 6 chunks are there already" in said, said
expect_same("results-killed", "the study started once more")

if MPIEXEC:
    code, said = run("results-ranks", ranks=2)
    assert code == 0, said
    expect_same("results-ranks", "two ranks")

# In other chunks, and without keeping the trajectories.
write_study("one.json", chunk=11, trajectories=False)
code, said = run("results-one", "one.json")
assert code == 0, said
one = files_of("results-one")
assert sorted(notes_of("results-one")) == sorted(notes), notes_of("results-one")
assert "chunk-00000.vtp" not in one and len(one) == 4 + 2 + len(RESULTS) + len(for_gis(calm)), sorted(one)
for name in RESULTS + for_gis(calm):
    assert one[name] == calm[name], f"{name} depends on the chunks"

# The same of all trajectories at once.
slope = DEMtoCFEMesh(**study["terrain"])
fall = RockfallSimulation(Terrain=slope, Rocks=RockBlocks(FileName=rocks, Terrain=slope), EndTime=8.5,
                          TrajectoryOutput="Thinned", Iterations=11)
SaveData("hazard.tif", proxy=RockfallHazardMap(
    Input=OutputPort(fall, 1), CellSize=5.0, CropToTrajectories=0, AnnualFrequency=0.5,
    EnergyThresholds=[10.0, 100.0]))
with open("hazard.tif", "rb") as file:
    assert file.read() == calm["hazard.tif"], "the map is not that of Rockfall Hazard Map"
collector = TrajectoryCollector(Input=OutputPort(fall, 1), Terrain=slope, FileName=road,
                                BarrierCapacity=150.0)
UpdatePipeline(proxy=collector)
table = collector.GetClientSideObject().GetOutputDataObject(1)
rows = list(csv.DictReader(io.StringIO(calm["lines.csv"].decode())))
assert len(rows) == table.GetNumberOfRows() == 2
assert rows[0]["LineName"] == "road, 700045" and rows[1]["BarrierHeight"] == "3.0", rows
for k, row in enumerate(rows):
    assert int(row["Rocks"]) > 3, row
    for name, value in row.items():
        expected = table.GetValueByName(k, name)
        assert value == expected.ToString() if name == "LineName" else \
            float(value) == expected.ToDouble(), (name, value, expected)
assert collector.GetClientSideObject().GetOutputDataObject(0).GetNumberOfPoints() == crossings
levels = list(csv.DictReader(io.StringIO(calm["design.csv"].decode())))
assert len(levels) == 2 * 6, levels
assert all(float(row["DesignHeight"]) == 1.1 * float(row["TopHeight"]) for row in levels), levels
passing = [float(row["AnnualFrequency"]) for row in csv.DictReader(io.StringIO(calm["design_places.csv"].decode()))]
assert all(abs(f - 0.5 * int(row["Rocks"]) / 33) < 1e-12 for f, row in zip(passing, rows)), passing

# What came to each structure, with its name: as the simulation's own outputs have it.
def rocks_of(data, keep):
    return {(data.GetArray("Iteration").GetValue(k), data.GetArray("RockId").GetValue(k))
            for k in range(data.GetNumberOfTuples()) if keep(lambda name: data.GetArray(name).GetValue(k))}


stood = {row["Kind"] + row["StructureId"]: row for row in csv.DictReader(io.StringIO(calm["structures.csv"].decode()))}
assert [(row["Kind"], row["Name"]) for row in stood.values()] == [
    ("embankment", "Dam"), ("net", "Upper net"), ("net", "Low net"), ("stems", "15 stems")], stood
met, hits = (fall.GetClientSideObject().GetOutputDataObject(port).GetPointData() for port in (4, 2))
for number, capacity in ((1, 300.0), (2, 20.0)):
    net, mine = stood[f"net{number}"], lambda of: of("StructureId") == number and of("Outcome") not in (3, 4)
    held, broke, struck, over = (rocks_of(met, lambda of: mine(of) and of("Outcome") == k) for k in (0, 1, 5, 6))
    breaking = rocks_of(met, lambda of: mine(of) and of("Outcome") == 5 and of("KineticEnergy") > 1e3 * capacity)
    counted = {"Hits": held | broke | struck, "Held": held - broke - struck, "Broke": broke | breaking, "Struck": struck - breaking - held,
               "Over": over - held - broke - struck, "Rocks": held | broke | struck | over}
    assert {name: int(net[name]) for name in counted} == {name: len(rocks) for name, rocks in counted.items()}, (net, counted)
    assert held if number == 1 else struck - breaking and breaking and over and net["HeldAll"] == "0", (net, counted)
    points = [k for k in range(met.GetNumberOfTuples()) if mine(lambda name: met.GetArray(name).GetValue(k))]
    tops, centres, energies = ([met.GetArray(name).GetValue(k) for k in points] for name in ("TopHeight", "HeightOverGround", "KineticEnergy"))
    assert all(top > centre + 0.3 for top, centre in zip(tops, centres)) and float(net["TopHeightMaximum"]) == max(tops), (net, tops)
    assert abs(float(net["EnergyMaximum"]) - max(energies) / 1e3) < 1e-9 and float(net["BarrierCapacity"]) == capacity, net
    assert abs(float(net["AnnualFrequency"]) - 0.5 * len(held | broke | struck) / 33) < 1e-12, net
net = stood["net1"]
assert 0.0 < float(net["BrakingDistanceMaximum"]) <= 5.0 and 0.0 < float(net["UsefulHeightMinimum"]) <= 4.0, net
shown = slope.GetClientSideObject().GetOutputDataObject(1).GetCellData()
cfes = {shown.GetArray("CFEId").GetValue(k) for k in range(shown.GetNumberOfTuples()) if shown.GetArray("StructureKind").GetValue(k) == 0}
against = rocks_of(hits, lambda of: of("CFEId") in cfes)
assert against and int(stood["embankment1"]["Hits"]) == len(against), (stood, against)
assert int(stood["stems0"]["Broke"]) == sum(met.GetArray("Outcome").GetValue(k) == 3 for k in range(met.GetNumberOfTuples())) > 0
for source in list(GetSources().values()):
    Delete(source)


def row_of(thing, *events, ends=None):
    table = np.array([(0, kind, 0, rock, piece, 1e3, 1.0, 0.0, math.nan) for kind, rock, piece in events]).reshape(-1, 9)
    return standing.summary(thing, dict(zip(standing.EVENT, table.T)), None, ends)


# Of a rock that broke one piece is held and one flies over the net: the net has not held it.
one = row_of({"kind": "net", "id": 1, "name": "", "height": 3.0, "capacity": 100.0, "parts": []},
             (standing.OVER, 4, 2), (standing.HELD, 4, 1), (standing.HELD, 5, 0))
COUNTS = "Rocks", "Hits", "Held", "Broke", "Struck", "Over", "HeldAll"
assert [one[name] for name in COUNTS] == [2, 2, 1, 0, 0, 1, 0], one
# A rock that strikes a net with a part goes on: the net has not held all. One that it holds afterwards it has held. Another
# one comes where the net is broken.
net = {"kind": "net", "id": 1, "name": "", "height": 3.0, "capacity": 100.0, "limit": 1e5, "wears": False, "parts": []}
one = row_of(net, (standing.STRUCK, 0, 0), (standing.HELD, 1, 0))
assert [one[name] for name in COUNTS] == [2, 2, 1, 0, 1, 0, 0], one
one = row_of(net, (standing.STRUCK, 0, 0), (standing.HELD, 0, 0))
assert [one[name] for name in COUNTS] == [1, 1, 1, 0, 0, 0, 1], one
one = row_of(net, (standing.BROKE, 0, 0), (standing.GONE, 1, 0))
assert [one[name] for name in COUNTS] == [2, 1, 0, 1, 0, 1, 0], one
# Above what is left of its capacity what strikes a net breaks it.
for energy, before, wears, outcome in ((1e5, 0.0, False, standing.STRUCK), (100001.0, 0.0, False, standing.BROKE),
                                       (6e4, 5e4, False, standing.STRUCK), (6e4, 5e4, True, standing.BROKE)):
    assert standing.event_of({**net, "wears": wears}, standing.STRUCK, energy, before) == outcome, (energy, before, wears)
assert standing.event_of({**net, "limit": math.inf}, standing.STRUCK, 1e9, 0.0) == standing.STRUCK
# A dam with a bend, rocks from x = 0: one rests before it, one went round its end, one fell over the edge of the DEM,
# one is still moving, of one a piece went on, one came over the axis and back, one broke into pieces that lie before it.
dam = {"kind": "embankment", "id": 1, "name": "", "height": 3.0, "capacity": None, "parts": [[(50, 0), (50, 10), (45, 20)]]}
ends = {(0, rock): [(0.0, 5.0), list(bodies)] for rock, bodies in enumerate((
    [(0, (48.0, 5.0))], [(0, (70.0, 25.0))], [(1, (20.0, 40.0))], [(2, (40.0, 5.0))], [(0, (40.0, 5.0)), (0, (60.0, -3.0))],
    [(0, (47.0, 12.0))], [(0, (30.0, 12.0)), (3, (40.0, 25.0))]))}
one = row_of(dam, *((standing.HIT, rock, 0) for rock in range(7)), (standing.CAME, 5, 0), ends=ends)
assert [one[name] for name in ("Rocks", "Hits", "Held", "Over")] == [7, 7, 2, 5], one

# Nets and stems need no paths. What is not known of an embankment without them, or without impacts, is no number of rocks.
few = {key: value for key, value in study.items() if key not in ("map", "lines")}
found = {}
for name, changes in (("", {}), ("paths", {"TrajectoryOutput": "Nothing"}), ("impacts", {"KeepImpacts": 0})):
    write_text("still.json", json.dumps({**few, "simulation": {**study["simulation"], **changes}, "iterations": 4, "chunk": 4}))
    code, said = run(f"results-still{name}", "still.json")
    assert code == 0 and ("to embankments is not known without " + name in said if name else "not known" not in said), said
    with open(f"results-still{name}/structures.csv", newline="") as file:
        found[name] = list(csv.DictReader(file))
dam, *others = found.pop("")
assert int(dam["Hits"]) > 0 and sum(int(one["Rocks"]) for one in others[:2]) > 4, (dam, others)
for name, (unknown, *same) in found.items():
    assert same == others and unknown["HeldAll"] == "-1" and unknown["EnergyMaximum"] == "nan", (name, same, others, unknown)
    for column in ("Rocks", "Hits", "Held", "Over"):
        assert unknown[column] == (dam[column] if (name, column) == ("paths", "Hits") else "-2"), (name, column, dam, unknown)

# Another study, by a number or by the content of a file.
write_study("other.json", simulation={"EndTime": 7.0, "TrajectoryOutput": "Thinned"})
code, said = run("results-calm", "other.json")
assert code != 0 and "another study: changed are simulation EndTime." in said, said
write_study("other.json", map={"CellSize": 6.0})
code, said = run("results-calm", "other.json")
assert code != 0 and "another study: changed are map AnnualFrequency, map CellSize, map EnergyThresholds." in said, said
write_text("sources.csv", open(rocks).read().replace("0.75", "0.8"))
code, said = run("results-calm")
assert code != 0 and "changed are rocks FileName (" in said and "sources.csv)." in said, said
assert results_of("results-calm") == calm
if MPIEXEC:
    code, said = run("results-calm", ranks=2)
    assert code != 0 and said.count("changed are rocks FileName (") == 1, said

# Nets and other structures are files, too, and so is every property for which the GUI offers files.
nets = 'WKT,height,capacity\n"LINESTRING(700045 3999990,700045 4000230)",{},1000\n'
for left in glob.glob("nets.*"):
    os.remove(left)
shutil.rmtree("results-netted", ignore_errors=True)
write_text("nets.csv", nets.format(4))
netted = {**study["terrain"], "BarrierFile": "nets.csv"}
write_study("netted.json", terrain=netted, iterations=1, chunk=1)
code, said = run("results-netted", "netted.json")
assert code == 0, said
write_text("nets.csv", nets.format(0.1))
code, said = run("results-netted", "netted.json")
assert code != 0 and "changed are terrain BarrierFile (" in said, said
write_text("nets.prj", "")
write_text("nets.csv", nets.format(4))
code, said = run("results-netted", "netted.json")
assert code == 0, said  # an empty one says nothing
with open("incline.prj", encoding="utf-8") as file:
    write_text("nets.prj", file.read())
code, said = run("results-netted", "netted.json")
assert code != 0 and "changed are terrain BarrierFile (" in said and "belongs to it: .prj)" in said, said
for xml in glob.glob(os.path.join(os.path.dirname(SCRIPT), "..", "Plugin", "xml", "*.xml")):
    for prop in ElementTree.parse(xml).iter("StringVectorProperty"):
        if prop.find("FileListDomain") is not None and not prop.get("name").endswith(("Field", "FileNames")):
            assert prop.get("name").endswith(FILES), prop.get("name")

# Every input is read before the first chunk: nothing is left of a study that cannot be done, and what was
# put right does not make it another one.
TABLE = "x,y,z,source\n700025,4000060,146,H\u00f6hle\n"
CONTACTS = "material_a,material_b,restitution,phi\ngranite,granite,{},30\n"
for part, name, content, word in (
        ("rocks", "rocks.csv", (TABLE + "700025,4000070,146,").encode() + b"H\xf6hle\n", "rocks.csv, line 3"),
        ("rocks", "rocks.csv", TABLE.replace("146", "much").encode(), '"much" is not a number'),
        ("lines", "lines.csv", b'WKT,height\n"POINT(700045 4000060)",3\n', "a LINESTRING is needed"),
        ("lines", "lines.csv", b'WKT,height\n"LINESTRING(0 0,9 9)",3\n', "are far from the trajectories"),
        ("terrain", "nets.csv", b'WKT,height\n"LINESTRING(700045 4000000,700045 4000200)",high\n', '"high"'),
        ("simulation", "contacts.csv", CONTACTS.format("hard").encode(), '"hard" is not a number')):
    with open(name, "wb") as file:
        file.write(content)
    prop = {"terrain": "BarrierFile", "simulation": "RockContactFile"}.get(part, "FileName")
    more = {"RockRockContact": 1} if part == "simulation" else {}
    write_study("checked.json", iterations=2, chunk=1, **{part: {**study[part], prop: name, **more}})
    if part == "simulation":
        write_study("checked.json", iterations=2, chunk=1, rocks={**study["rocks"], "Material": 1},
                    simulation={**study[part], prop: name, **more})
    code, said = run("results-checked", "checked.json")
    assert code != 0 and word in said and name in said, (name, said)
    assert os.listdir("results-checked") == [], os.listdir("results-checked")
with open("rocks.csv", "wb") as file:
    file.write(TABLE.encode("latin-1"))
write_study("checked.json", iterations=2, chunk=1, rocks={"FileName": "rocks.csv"})
code, said = run("results-checked", "checked.json")
assert code == 0, said
with open("results-checked/summary.csv", encoding="utf-8") as file:
    assert {row["SourceName"] for row in csv.DictReader(file)} == {"H\u00f6hle"}

# Bad descriptions.
for bad, word in (("", "is not JSON"), ("{", "is not JSON"), ("[]", "must be an object"),
                  ('{"itterations": 3}', '"itterations"'),
                  (json.dumps({**study, "terrain": "dem.tif"}), '"terrain" is "dem.tif"'),
                  (json.dumps({**study, "chunk": 0}), '"chunk" is 0'),
                  (json.dumps({**study, "chunk": -2}), '"chunk" is -2'),
                  (json.dumps({**study, "chunk": True}), '"chunk" is true'),
                  (json.dumps({**study, "iterations": 2.5}), '"iterations" is 2.5'),
                  (json.dumps({**study, "iterations": "10"}), '"iterations" is "10"'),
                  (json.dumps({**study, "terrain": {"FileName": "no.tif"}}), "no.tif"),
                  (json.dumps({**study, "terrain": {**netted, "BarrierFile": "no.csv"}}), "no.csv"),
                  (json.dumps({**study, "simulation": {"Iterations": 3}}), '"Iterations"'),
                  (json.dumps({**study, "simulation": {"TrajectoryOutput": "Events"}}), '"Events"'),
                  (json.dumps({**study, "lines": {}}), '"lines" has no FileName'),
                  (json.dumps({**study, "lines": {"FileName": "no.gpkg"}}), "no.gpkg")):
    write_text("bad.json", bad)
    code, said = run("results-bad", "bad.json")
    assert code != 0 and word in said, (bad, said)
assert not os.path.exists("results-bad")
code, said = run("results-bad", "no.json")
assert code != 0 and "no.json: No such file" in said, said
write_study("bad.json", simulation={"EndTimes": 3})
code, said = run("results-bad", "bad.json")
assert code != 0 and "simulation: " in said and "EndTimes" in said, said
print("a study goes on where it was")
