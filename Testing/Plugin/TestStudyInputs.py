"""A study is the same study, or refused: every file that its data sets consist of counts. More iterations of
a finished one go on, with the files of one that had them from the start."""

import glob
import json
import os
import shutil
import sqlite3
import subprocess
import sys
import threading
import time

from helpers import (delete_sources, files_of, incline, rows_of, run_script, write_grid, write_text)

EXAMPLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Examples")
SCRIPT = os.path.join(EXAMPLES, "study.py")
sys.path[:0] = [os.path.join(EXAMPLES, "study_parts")]
import identity
import schema
import wholefile

write_grid("input.asc", incline())
write_text("input.csv", "x,y,z,shape,volume,source\n" + "\n".join(
    f"700025,{4000060 + k},{146 + 0.2 * k},{shape},0.01,{name}"
    for k, shape, name in ((0, "file", "=1+2"), (16, "cube", "-2.5"), (32, "cube", "@home"))) + "\n")
write_text("input-road.csv", 'WKT,name\n"LINESTRING(700045 3999990,700045 4000230)",=1+3\n')
tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
write_text("input.obj", tetrahedron)
study = {
    "terrain": {"FileName": "input.asc", "RoughnessDeviation": 0.2},
    "rocks": {"FileName": "input.csv", "ShapeFileName": "input.obj"},
    "simulation": {"EndTime": 3.0, "TrajectoryOutput": "Thinned"}, "map": {"CellSize": 5.0},
    "lines": {"FileName": "input-road.csv"}, "iterations": 5, "chunk": 2}


def run(folder, **changes):
    write_text("input.json", json.dumps({**study, **changes}))
    try:
        said, message = run_script(SCRIPT, folder, "input.json")
    finally:
        delete_sources()
    assert "Traceback" not in said, said
    return (0, said) if message is None else (1, said + message)


def results_of(folder):
    return {name: data for name, data in files_of(folder).items() if name != "manifest.json"}


for folder in os.listdir("."):
    if folder.startswith("inputs-"):
        shutil.rmtree(folder)

# The map and the lines of a study have one frequency.
code, said = run("inputs-often", map={"CellSize": 5.0, "AnnualFrequency": 3.0},
                 lines={"FileName": "input-road.csv", "AnnualFrequency": 7.0})
assert code and "AnnualFrequency of map is 3.0, of lines 7.0" in said, said

# From the start, and 1, 3, 4 and 5 iterations one after the other: whole chunks, and begun ones.
code, said = run("inputs-calm")
assert code == 0, said
assert said.count("left") <= 10, said
calm = results_of("inputs-calm")
for count in (1, 3, 4, 5):
    code, said = run("inputs-more", iterations=count)
    assert code == 0, said
    assert json.loads(files_of("inputs-more")["results.json"])["iterations"] == count
more = results_of("inputs-more")
assert more == calm, [name for name in calm if more.get(name) != calm[name]]
code, said = run("inputs-more", iterations=3)
assert code != 0 and "more than 3 iterations already" in said, said

# The manifest is for a person.
manifest = json.loads(files_of("inputs-calm")["manifest.json"])
assert manifest["program"].startswith("RockfallDDA ") and manifest["program"][-1].isdigit(), manifest
assert manifest["begun"][:2] == "20" and manifest["iterations"] == 5
assert [os.path.basename(f) for f in manifest["files"]["terrain FileName"]] == ["input.asc", "input.prj"]
assert manifest["values"]["terrain"]["FrictionAngle"] > 0, "defaults are in force, too"
assert manifest["values"]["simulation"]["EndTime"] == 3.0
assert manifest["identity"]["version"] == manifest["program"].split()[1]

# The shape of the rocks is another one.
shape = write_text("input.obj", tetrahedron.replace("0 0 1", "0 0 2"))
code, said = run("inputs-calm")
assert code != 0 and f"changed are rocks ShapeFileName ({shape})" in said, said
write_text("input.obj", tetrahedron)

# A spreadsheet does not run a name; a number stays one.
assert {row["LineName"] for row in rows_of("inputs-calm/lines.csv")} == {"'=1+3"}
assert {row["SourceName"] for row in rows_of("inputs-calm/summary.csv")} == {"'=1+2", "-2.5", "'@home"}
assert [wholefile.cell(v) for v in ("\t=1", "+a", "-", "a=1", "+1e3", -3, "-inf")] == \
    ["'\t=1", "'+a", "'-", "a=1", "+1e3", -3, "-inf"]

# Another DEM, another CRS beside it, another version.
write_grid("input.asc", incline(drop=6.0))
code, said = run("inputs-calm")
assert code != 0 and "changed are terrain FileName (" in said and "input.asc)" in said, said
write_grid("input.asc", incline())
write_text("input.asc.aux.xml", "<PAMDataset><Metadata><MDI key='a'>b</MDI></Metadata></PAMDataset>")
code, said = run("inputs-calm")
assert code != 0 and "input.asc, by what belongs to it: .asc.aux.xml)" in said, said
os.remove("input.asc.aux.xml")
older = json.loads(files_of("inputs-calm")["manifest.json"])
older["identity"]["version"] = "0.0.1"
write_text("inputs-calm/manifest.json", json.dumps(older))
code, said = run("inputs-calm")
assert code != 0 and "changed are version." in said, said
write_text("inputs-calm/manifest.json", json.dumps({"format": 2}))
code, said = run("inputs-calm")
assert code != 0 and "is not of this version of the program" in said, said

# Companions: what GDAL lists, and a GeoPackage's changes that are in its log still.
write_text("tiles.vrt", '<VRTDataset rasterXSize="31" rasterYSize="21"><GeoTransform>700000,10,0,4000210,0,-10'
           '</GeoTransform><VRTRasterBand dataType="Float64" band="1"><SimpleSource><SourceFilename '
           'relativeToVRT="1">input.asc</SourceFilename><SourceBand>1</SourceBand></SimpleSource>'
           '</VRTRasterBand></VRTDataset>')
there = [os.path.basename(name) for name in identity.members(os.path.abspath("tiles.vrt"))]
assert there[0] == "tiles.vrt" and "input.asc" in there, there
for left in glob.glob("log.gpkg*"):
    os.remove(left)
base = sqlite3.connect("log.gpkg")
base.execute("pragma journal_mode=wal")
base.execute("create table a (b)")
base.commit()
assert "log.gpkg-wal" in [os.path.basename(n) for n in identity.members(os.path.abspath("log.gpkg"))]
base.close()
write_text("grid.sgrd", "NAME = grid\nDATAFORMAT = FLOAT\nBYTEORDER_BIG = FALSE\nPOSITION_XMIN = 0\n"
           "POSITION_YMIN = 0\nCELLCOUNT_X = 2\nCELLCOUNT_Y = 2\nCELLSIZE = 1\nZ_FACTOR = 1\n")
with open("grid.sdat", "wb") as file:
    file.write(b"\0\0\x80?" * 4)
there = [os.path.basename(name) for name in identity.members(os.path.abspath("grid.sdat"))]
assert "grid.sgrd" in there, there

# A shapefile of many files, and data sets that are folders: Zarr, shapefiles.
shutil.rmtree("shapes", ignore_errors=True)
os.makedirs("shapes")
subprocess.run(["ogr2ogr", "-f", "ESRI Shapefile", "shapes/road.shp", "input-road.csv"], check=True)
there = [os.path.basename(name) for name in identity.members(os.path.abspath("shapes/road.shp"))]
assert sorted(there) == ["road.dbf", "road.shp", "road.shx"] and there[0] == "road.shp", there
shutil.rmtree("store.zarr", ignore_errors=True)
subprocess.run(["gdal_translate", "-q", "-of", "Zarr", "input.asc", "store.zarr"], check=True)
for folder, inner in (("shapes", "road.dbf"), ("store.zarr", os.path.join("store", "0.0"))):
    inputs = identity.Inputs({"terrain": {"FileName": folder}})
    inputs.read()
    assert any(name.endswith(inner) for name in inputs.of("terrain", "FileName")), inputs.sets
    with open(os.path.join(folder, inner), "ab") as file:
        file.write(b"x")
    try:
        inputs.check()
        raise AssertionError(f"nobody saw that {inner} changed")
    except identity.Changed as changed:
        assert inner in str(changed), changed

# While it runs: a file that changes, goes away, or comes; one that is only touched.
one = os.path.abspath("while.csv")
write_text(one, "a")
inputs = identity.Inputs({"rocks": {"FileName": one}})
inputs.read()
inputs.check()
os.utime(one)
inputs.check()
for change, back, word in (
        (lambda: write_text(one, "b"), lambda: write_text(one, "a"), "changed while the study ran"),
        (lambda: os.remove(one), lambda: write_text(one, "a"), "went away"),
        (lambda: write_text("while.prj", "c"), lambda: os.remove("while.prj"), "while.prj came")):
    change()
    try:
        inputs.check()
        raise AssertionError(f"nobody saw that a file {word}")
    except identity.Changed as changed:
        assert word in str(changed), changed
    back()
    inputs.check()

# The folder goes away in the middle: one line.
def take_away():
    while not os.path.exists("inputs-gone/chunk-00000.npz"):
        time.sleep(0.001)
    shutil.rmtree("inputs-gone", ignore_errors=True)


thief = threading.Thread(target=take_away, daemon=True)
thief.start()
code, said = run("inputs-gone", iterations=200, chunk=1)
assert code != 0 and "inputs-gone" in said.splitlines()[-1], said
thief.join()

# A chunk that is damaged.
code, said = run("inputs-damaged", iterations=2)
assert code == 0, said
write_text("inputs-damaged/chunk-00000.npz", "no archive")
code, said = run("inputs-damaged", iterations=2)
assert code != 0 and "chunk-00000.npz is damaged" in said, said
# Or that is another one's, from a copy that went wrong.
shutil.copytree("inputs-more", "inputs-copied")
for one, other in ((0, 1), (1, 0)):
    shutil.copy(f"inputs-more/chunk-0000{one}.npz", f"inputs-copied/chunk-0000{other}.npz")
    code, said = run("inputs-copied")
    assert code != 0 and f"chunk-0000{other}.npz has iterations of another chunk" in said, said
    shutil.copy(f"inputs-more/chunk-0000{other}.npz", "inputs-copied")

# Every file of a chunk counts: what is gone is made again, what was cut or overwritten is named, and until it is made
# again the study is not finished.
write_text("input-net.csv", 'WKT,height,capacity\n"LINESTRING(700050 3999990,700050 4000230)",4,1000\n')
write_text("input-near.csv", 'WKT,name\n"LINESTRING(700028 3999990,700028 4000230)",near\n')
netted = {"terrain": {**study["terrain"], "BarrierFile": "input-net.csv"}, "lines": {"FileName": "input-near.csv"}, "iterations": 4,
          "until": {"quantity": "Share", "within": 0.01}}
code, said = run("inputs-files", **netted)
assert code == 0, said
whole = results_of("inputs-files")
assert len(rows_of("inputs-files/crossings.csv")) > 3
for end in (".npz", ".vtp", ".passages", "-crossings.vtp", "-structures.npz"):
    name = "chunk-00001" + end
    data, path = whole[name], os.path.join("inputs-files", name)
    middle = data[:len(data) // 2], data[:len(data) // 2] + b"#" * 60 + data[len(data) // 2 + 60:]
    for bad in (b"", *middle[:1 if end == ".vtp" else 2]):  # nothing reads trajectories
        with open(path, "wb") as file:
            file.write(bad)
        code, said = run("inputs-files", **netted)
        assert code != 0 and said.endswith(f"{name} is damaged. Remove it, and it is made again."), (bad[:9], said)
        assert "results.json" not in files_of("inputs-files"), name
        os.remove(path)
        code, said = run("inputs-files", **netted)
        assert code == 0 and "1 of 2 chunks are there already" in said, said
        assert results_of("inputs-files") == whole, name

# Large and odd JSON takes as long as reading it.
start = time.monotonic()
for text, word in (
        ("{" + ",".join(f'"{k}":1' for k in range(200000)) + "}", "there is no"),
        (json.dumps({**study, "rocks": {"Center": [0] * 1000000}}), "1000000 values"),
        ('{"terrain":' + "[" * 900 + "]" * 900 + "}", "must be an object"),
        ('{"iterations":' + "9" * 5000 + "}", "input-odd.json"),
        ("{" + ",".join(f'"{k}":1' for k in range(100000)) + ',"7":2}', "twice")):
    write_text("input-odd.json", text)
    try:
        schema.check("input-odd.json", schema.load("input-odd.json"))
        raise AssertionError(f"{text[:60]} was taken")
    except schema.Bad as bad:
        assert word in str(bad) and len(str(bad)) < 300, bad
# Of another encoding.
with open("input-odd.json", "w", encoding="utf-16") as file:
    json.dump(study, file)
code, said = run_script(SCRIPT, "inputs-odd", "input-odd.json")[::-1]
assert "input-odd.json is not JSON" in code and "Traceback" not in said, (code, said)
assert time.monotonic() - start < 20.0, time.monotonic() - start
print("a study is the same, or refused")
