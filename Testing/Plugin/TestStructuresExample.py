# Renders
"""The example of structures in a reduced form: fewer rocks come to the road with any of them than without, it
is they that stop them, and there are a table and a picture. The scripts of docs/structures.md run."""

import csv
import os
import re
import runpy
import shutil
import sys

from paraview.simple import Delete, GetSources, UpdatePipeline
from vtkmodules.util.numpy_support import vtk_to_numpy

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ROCKS, ITERATIONS = 22, 3

shutil.rmtree("results", ignore_errors=True)
sys.argv = ["structures.py", "--output", "results", "--rocks", str(ROCKS), "--iterations", str(ITERATIONS)]
runpy.run_path(os.path.join(ROOT, "Examples", "structures.py"))
with open(os.path.join("results", "shares.csv"), encoding="utf-8") as file:
    rows = {row["case"]: row for row in csv.DictReader(file)}
assert list(rows) == ["no structures", "forest", "embankment", "net", "all three"], rows
on_road = {name: int(row["on_road"]) for name, row in rows.items()}
bare = on_road.pop("no structures")
assert bare > ROCKS * ITERATIONS / 4, bare
for name, count in on_road.items():
    assert count < bare, (name, count, bare)
# Each half of the road has one of the two; with all, next to nothing gets through.
assert on_road["all three"] < 0.2 * bare, on_road
for name, row in rows.items():
    assert (int(row["caught"]) > 0) == (name in ("net", "all three")), row
    assert (int(row["trees_broken"]) > 0) == (name in ("forest", "all three")), row
    assert float(row["share_low"]) <= float(row["share"]) <= float(row["share_high"]), row
    assert abs(float(row["share"]) - 100 * int(row["on_road"]) / (ROCKS * ITERATIONS)) < 0.01, row
# What the net caught lies on its line.
with open(os.path.join("results", "met.csv")) as file:
    caught = [row for row in csv.DictReader(file) if row["Outcome"] == "0"]
assert len(caught) == int(rows["all three"]["caught"])
assert os.path.getsize(os.path.join("results", "structures.png")) > 100000
for source in list(GetSources().values()):
    Delete(source)

with open(os.path.join(ROOT, "docs", "structures.md"), encoding="utf-8") as file:
    page = file.read()
scripts = re.findall(r"^```python\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
assert len(scripts) == 1
scope = {}
exec(compile(scripts[0], "structures.md", "exec"), scope)
# Every one of its layers stands on the slope.
UpdatePipeline(proxy=scope["slope"])
shown = scope["slope"].GetClientSideObject().GetOutputDataObject(1)
kinds = vtk_to_numpy(shown.GetCellData().GetArray("StructureKind"))
assert {0, 1, 2} == set(kinds.tolist()) and (kinds == 1).sum() == 3 * 22, kinds
# And something comes of it.
outcome = scope["fall"].GetClientSideObject().GetOutputDataObject(4)
assert outcome.GetNumberOfPoints() > 0
print("structures do what they are for")
