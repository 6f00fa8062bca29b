"""Examples/validation/tschamut.py on a folder that is made here: what it computes and writes, and
what it says of folders that cannot be used."""

import os
import shutil
import sys

import numpy as np
from helpers import rows_of, run_script, write_text
from paraview.simple import RockBlocks
from vtkmodules.util.numpy_support import vtk_to_numpy

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCRIPT = os.path.join(ROOT, "Examples", "validation", "tschamut.py")
EXAMPLES = os.path.dirname(os.path.dirname(SCRIPT))
sys.path[:0] = [os.path.dirname(SCRIPT), EXAMPLES, os.path.join(EXAMPLES, "calibrate_parts")]

import field_rocks
import field_test
import site_scores
import site_search
import site_tracked

# 30 m of 35° slope, then flat: 17 x 9 nodes of 5 m. The south-west node is at (0, 0).
HEIGHTS = [[round(max(0.0, 30.0 - 5.0 * column) * 0.7, 3) for column in range(17)]] * 9
FILES = {
    "block_metadata.csv": "block_id,name,mass_kg,radius_m,size_x_m,size_y_m,size_z_m\n"
                          "1,Round,69,0.18,0.37,0.32,0.37\n"
                          "2,Plate,40,0.16,0.46,0.30,0.20\n",
    "release_points.csv": "trajectory_id,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps,block_id\n"
                          "a,6,15,19,1,0,0,1\n"
                          "b,6,20,19,1,0,0,1\n"
                          "c,6,25,19,1,0,0,2\n"
                          "d,7,20,18,1,0,0,2\n",
    "observed_deposition.csv": "trajectory_id,x_m,y_m\n"
                               "a,36,14\nb,40,22\nc,30,25\nd,37,20\n",
    "terrain.asc": "ncols 17\nnrows 9\nxllcorner 0\nyllcorner 0\ncellsize 5\nNODATA_value -9999\n" +
                   "".join(" ".join(map(str, row)) + "\n" for row in HEIGHTS),
}
failures = []


def expect(condition, text):
    if not condition:
        failures.append(text)


def make_folder(name, **changes):
    """The folder with some files changed: `file=(old, new)` by the file's stem; None leaves it out."""
    shutil.rmtree(name, ignore_errors=True)
    os.makedirs(name)
    for file, text in FILES.items():
        change = changes.pop(file.split(".")[0], ("", ""))
        if change is not None:
            assert change[0] in text, change
            write_text(os.path.join(name, file), text.replace(*change, 1))
    assert not changes, changes
    return name


def run(*arguments):
    return run_script(SCRIPT, *arguments)


# --- A run: its files, its numbers.
folder = make_folder("good")
FEW = ["--attitudes", "2", "--iterations", "2"]
said, message = run(folder, "--output", "out", *FEW)
expect(message is None, f"the good folder: {message}")
for name in ("map.png", "comparison.csv", "runs.csv", "stops.csv"):
    expect(os.path.isfile(os.path.join("out", name)), f"no {name}")
compared = {row["What"]: row for row in rows_of("out/comparison.csv")}
seen = [np.hypot(30, 1), np.hypot(34, 2), 24.0, 30.0]
# Three decimals are written.
expect(abs(float(compared["run-out, mean"]["Observed"]) - np.mean(seen)) < 1e-3,
       f"observed mean {compared['run-out, mean']}")
report = open("out/report.md", encoding="utf-8").read()
for part in ("| as simulated |", "| within the tracked ground |", "| without a model |", "CRPS"):
    expect(part in said and part in report, f"{part} was not printed and written: {said}")
stops = rows_of("out/stops.csv")
expect([stop["Run"] for stop in stops] == ["a", "a", "b", "b", "c", "c", "d", "d"] * 2,
       "each run has two rocks, iteration by iteration")
moved = np.array([float(stop["RunOut_m"]) for stop in stops])
expect(moved.max() > 15, f"no rock came down the slope: {moved}")
expect([row["Run"] for row in rows_of("out/runs.csv")] == list("abcd"), "runs.csv")

again = run(folder, "--output", "again", *FEW)
expect(open("again/stops.csv").read() == open("out/stops.csv").read(), "the same seed, other stops")

# --- The options reach the ground: the more is lost along it, the nearer rocks stop.
means = []
for tangential in ("0.95", "0.6"):
    run(folder, "--output", "option", *FEW, "--tangential", tangential, "--restitution", "0.3",
        "--modulus", "0", "--most-friction", "0", "--least-friction", "0", "--friction", "45",
        "--rolling", "0")
    means.append(float(rows_of("option/comparison.csv")[0]["Simulated"]))
expect(means[0] > means[1] + 1.0, f"run-outs at Rt 0.95 and 0.6: {means}")

# --- Calibration: the candidate of the least energy score is taken, runs are held out.
said, message = run(folder, "--output", "fit", *FEW, "--calibrate", "4")
tried = rows_of("fit/candidates.csv")
least = min(tried, key=lambda row: float(row["EnergyScore_m"]))
expect(message is None and len(tried) == 4, f"calibration: {message}, {len(tried)} candidates")
searched = ("SlipFrictionMin", "RollingResistance")
expect(all(f"{name} {least[name]}," in said.split("Ground: ")[1] for name in searched),
       f"the best candidate {least} was not used: {said}")
expect("Held out, 2 folds with runs of every group" in said and
       "Held out, one group left out at a time" in said, f"no runs were held out: {said}")

# --- Tracked ground: a square of 10 m, widened by 1 m.
square = site_tracked.TrackedGround([[0, 0], [10, 0], [10, 10], [0, 10], [5, 0], [5, 5]], 1.0)
expect(len(square.offset) == 4, f"a square has {len(square.offset)} sides")
expect(square.holds([[10.9, 5.0], [11.1, 5.0], [-0.9, -0.9]]).tolist() == [True, False, True], "holds")
cut = square.cut(np.array([[5.0, 5.0]] * 3), np.array([[8.0, 5.0], [17.0, 5.0], [5.0, -25.0]]))
expect(np.abs(cut - [[8, 5], [11, 5], [5, -1]]).max() < 1e-12, f"cut off at {cut}")
expect("of the rocks go beyond the tracked ground" in said, f"nothing is said of the tracked ground: {said}")

# --- The scores. Two points one on either side: mean distance 1, less half of the distance 2.
expect(abs(site_scores.energy_score([[0.0], [2.0]], [1.0])) < 1e-12, "energy score of two points")
expect(abs(site_scores.energy_score([[3.0, 4.0]] * 3, [0.0, 0.0]) - 5.0) < 1e-12, "of a sure forecast")

# A run that is in the table twice is held out together with its copy.
copied = make_folder("copied", release_points=("d,7,20,18", "d,6,25,19"),
                     observed_deposition=("d,37,20", "d,30,25"))
runs = field_test.FieldTest(copied).runs
observed = site_scores.Observed([run.start[:2] for run in runs], [run.stop for run in runs], range(4),
                                [run.block for run in runs])
fold = site_search.folds(observed, 2)
expect(fold[2] == fold[3] and fold[0] != fold[1], f"folds {fold}")

# Held out means held out: candidate 0 suits all runs but the last, which is predicted by what suits
# the others.
scores = np.zeros((2, 4, 4))
scores[0, 3, site_scores.ES], scores[1, :3, site_scores.ES], scores[1, :, site_scores.MEAN] = 100.0, 1.0, 9.0
predicted, chosen = site_search.held_out(scores, np.arange(4))
expect(chosen.tolist() == [1, 1, 1, 0] and predicted[3, site_scores.ES] == 100.0, f"held out by {chosen}")

# --- The rocks have the mass of the table: hulls of the points, at the density. 9 decimals are written.
for block in field_test.FieldTest(folder).blocks.values():
    np.savetxt("shape.csv", field_rocks.vertices(block), fmt="%.9f", delimiter=",")
    rock = RockBlocks(Shape="From File", ShapeFileName=os.path.abspath("shape.csv"), ScaleToVolume=0)
    rock.UpdatePipeline()
    data = rock.GetClientSideObject().GetOutputDataObject(0)
    mass = field_rocks.DENSITY * vtk_to_numpy(data.GetCellData().GetArray("Volume"))[0]
    expect(abs(mass / block.mass - 1) < 1e-6, f"{block.name} has {mass} kg, not {block.mass}")
    expect(data.GetNumberOfCells() == 26, f"{block.name} has {data.GetNumberOfCells()} faces")

# --- Folders that cannot be used.
BAD = [
    (dict(terrain=None), ["terrain.asc", "no such file"]),
    (dict(block_metadata=None), ["block_metadata.csv", "no such file"]),
    (dict(observed_deposition=None), ["observed_deposition.csv", "no such file"]),
    (dict(release_points=("vx_mps", "speed")), ["release_points.csv", '"vx_mps"', "no column"]),
    (dict(release_points=("a,6,15", "a,six,15")), ["release_points.csv, line 2", '"x_m"', '"six"']),
    (dict(release_points=("a,6,15", "a,nan,15")), ["line 2", '"x_m"', '"nan"']),
    (dict(release_points=("a,6,15", "a,,15")), ["line 2", '"x_m"', "is empty"]),
    (dict(release_points=("a,6,15", "a,6,5,15")), ["line 2", "9 fields, the header 8", "decimal mark"]),
    (dict(release_points=("b,6,20", "a,6,20")), ["line 3", '"a" is there twice']),
    (dict(release_points=("1,0,0,2", "1,0,0,7")), ['"block_id"', '"7" is not in block_metadata.csv']),
    (dict(release_points=("a,6,15", "a,600,15")), ['run "a"', "x 600", "outside the terrain"]),
    (dict(block_metadata=("1,Round,69", "1,Round,-69")), ['"mass_kg"', "-69 must be positive"]),
    (dict(block_metadata=("1,Round,69", "1,Round,690")), ['block "1"', "690 kg", "% of that box"]),
    (dict(block_metadata=(FILES["block_metadata.csv"], "")),
     ["block_metadata.csv", "the header has nothing"]),
    (dict(observed_deposition=("d,37,20\n", "")), ['run "d" has no row in observed_deposition.csv']),
    (dict(observed_deposition=("d,37,20\n", "d,37,20\ne,1,1\n")),
     ['run "e" has no row in release_points.csv']),
    (dict(observed_deposition=("a,36,14\nb,40,22\nc,30,25\nd,37,20\n", "")), ["has no rows"]),
    (dict(terrain=("cellsize 5\n", "")), ["terrain.asc", 'the header has no "cellsize"']),
    (dict(terrain=("cellsize 5", "cellsize five")), ['"cellsize"', '"five" is not a number']),
    (dict(terrain=(" ".join(map(str, HEIGHTS[0])) + "\n", "")), ["DEM to CFE Mesh made nothing"]),
]
for changes, parts in BAD:
    said, message = run(make_folder("bad", **changes), "--output", "none", *FEW)
    print(changes, message)
    for part in parts:
        expect(message is not None and part in message, f"{changes}: {part} is not in {message}")
    expect("Written to" not in said, f"{changes}: results were written")
flat = make_folder("flat")
write_text("flat/terrain.asc", FILES["terrain.asc"][:FILES["terrain.asc"].index(str(HEIGHTS[0][0]))] +
           (" ".join("0" * 17) + "\n") * 9)
said, message = run(flat, "--output", "none", *FEW, "--tangential", "0")
expect(message and "No rock ran farther than 1 m" in message, f"on flat ground: {message}")
said, message = run("nowhere", "--output", "none")
expect(message == "nowhere: there is no such folder", f"nowhere: {message}")
said, message = run(folder, "--attitudes", "0", "--output", "none")
expect("--attitudes is 0" in said, f"--attitudes 0: {said}")

if failures:
    raise SystemExit("\n".join(failures))
print("the example did as it should")
