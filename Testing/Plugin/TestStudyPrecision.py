"""A study that goes on until a share or an energy at a line is known, as precisely as was asked for."""

import json
import math
import os
import re
import shutil
import subprocess
import sys

import numpy as np
from helpers import delete_sources, files_of, incline, messages_of, outside_mpi, rows_of, run_script, write_grid, write_text

EXAMPLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Examples")
SCRIPT = os.path.join(EXAMPLES, "study.py")
sys.path[:0] = [os.path.join(EXAMPLES, "study_parts")]
import combine
import enough

# Clopper & Pearson, closed forms at the ends: 1 - (α/2)^(1/n). Tables for 4 of 10.
low, high = enough.share_interval(0, 20, 0.95)
assert low == 0.0 and abs(high - (1.0 - 0.025 ** (1.0 / 20.0))) < 1e-9, high
low, high = enough.share_interval(20, 20, 0.95)
assert high == 1.0 and abs(low - 0.025 ** (1.0 / 20.0)) < 1e-9, low
low, high = enough.share_interval(4, 10, 0.95)
assert abs(low - 0.12155) < 1e-4 and abs(high - 0.73762) < 1e-4, (low, high)
low, high = enough.share_interval(500000, 1000000, 0.95)
assert abs(high - low - 2.0 * 1.95996 * 0.0005) < 3e-6, (low, high)
# Of 20 rocks 4 pass, and of 3 that were lost nobody knows: from 4 of 20 to 7 of 20.
assert enough.share_interval(4, 20, 0.95, 3) == \
    (enough.share_interval(4, 20, 0.95)[0], enough.share_interval(7, 20, 0.95)[1])
assert enough.share_interval(0, 20, 0.95, 20) == (0.0, 1.0)
# Of none that passes at most ln 20 of them, the rule of three; of 4 that may have, 9.154 (Poisson, one-sided); never more
# than all.
assert abs(enough.most_of_none(1000, 0) - math.log(20.0)) < 1e-9 and abs(enough.most_of_none(1000, 4) - 9.1535) < 1e-4
assert abs(enough.most_of_none(20, 15) - 20.0) < 1e-9 and enough.most_of_none(100000, 30000) < 30300
assert enough.lost_before([(0, 1), (0, 2), (1, 2)], [(0, 2), (7, 7)]) == 2


# Order statistics against sums of the binomial distribution.
def at_most(k, n, p):
    return sum(math.comb(n, j) * p ** j * (1.0 - p) ** (n - j) for j in range(k + 1))


for n in (71, 72, 73, 100, 333):
    ranks = enough.quantile_ranks(n, 0.95, 0.95)
    lows = [k for k in range(1, n + 1) if at_most(k - 1, n, 0.95) <= 0.025]
    highs = [k for k in range(1, n + 1) if at_most(k - 1, n, 0.95) >= 0.975]
    assert ranks == ((lows[-1], highs[0]) if lows and highs else None), (n, ranks, lows[-1:], highs[:1])
assert enough.quantile_ranks(10, 0.95, 0.95) is None and enough.quantile_ranks(0, 0.95, 0.95) is None

write_grid("enough.asc", [[max(z - 75.0, 0.0) for z in row] for row in incline()])  # rocks end on it
write_grid("enough-edge.asc", incline())  # and beyond this one
write_text("enough-road.csv", 'WKT,name\n"LINESTRING(700045 3999990,700045 4000230)",near\n'
           '"LINESTRING(700005 3999990,700005 4000230)",far\n')
study = {
    "terrain": {"FileName": "enough.asc", "Preset": "Meadow (field data)"},
    "rocks": {"Center": [700025, 4000060, 72], "Amount": 5},
    "simulation": {"EndTime": 60.0, "TrajectoryOutput": "Thinned"},
    "lines": {"FileName": "enough-road.csv"}, "iterations": 12, "chunk": 2}


def run(folder, **changes):
    write_text("enough.json", json.dumps({**study, **changes}))
    try:
        said, message = run_script(SCRIPT, folder, "enough.json")
    finally:
        delete_sources()
    return (0, said) if message is None else (1, said + message)


for folder in os.listdir("."):
    if folder.startswith("enough-") and os.path.isdir(folder):
        shutil.rmtree(folder)
code, said = run("enough-share", until={"quantity": "Share", "within": 0.2})
assert code == 0 and "Enough rocks, " in said, said
manifest = json.loads(files_of("enough-share")["manifest.json"])
assert manifest["until"]["known"] and [one["line"] for one in manifest["until"]["lines"]] == ["near", "far"]
assert manifest["until"]["lines"][1]["reached"] == 0, manifest["until"]
for one in manifest["until"]["lines"]:
    assert one["to"] - one["from"] <= 0.4 and one["from"] <= one["reached"] / one["rocks"] <= one["to"], one
few = json.loads(files_of("enough-share")["results.json"])["iterations"]
assert 2 <= few < 12, few

# More precise in the same folder; then as many as there are, which is not enough.
code, said = run("enough-share", until={"quantity": "Share", "within": 0.01, "line": "near"})
assert code == 0 and "Not enough rocks, 60: Share at" in said, said
assert json.loads(files_of("enough-share")["results.json"])["iterations"] == 12
code, said = run("enough-share", until={"quantity": "KineticEnergy95", "within": 0.5})
assert code == 0 and '"far": not known yet' in said, said
# Left out, it is not in the manifest either.
code, said = run("enough-share")
assert code == 0 and "ough rocks" not in said, said
assert "until" not in json.loads(files_of("enough-share")["manifest.json"])

# Rocks that still move may reach it yet, or go farther: no number of them is enough.
short = {"simulation": {**study["simulation"], "EndTime": 0.5}}
code, said = run("enough-moving", until={"quantity": "Share", "within": 0.2}, **short)
assert code == 0 and 'Not enough rocks, 60: Share at "near": 0 to 1, as 60 were lost before it' in said, said
code, said = run("enough-ways", until={"quantity": "RunOut95", "within": 0.3}, iterations=20, **short)
assert code == 0 and "Not enough rocks, 100: RunOut95: not known yet" in said, said

# So may those that left the DEM.
code, said = run("enough-edge", until={"quantity": "Share", "within": 0.2, "line": "far"}, iterations=6,
                 terrain={**study["terrain"], "FileName": "enough-edge.asc"}, rocks={"Center": [700025, 4000060, 147], "Amount": 5})
left = sum(row["FateCode"] == "1" for row in rows_of("enough-edge/summary.csv"))
high = enough.share_interval(0, 30, 0.95, left)[1]
assert code == 0 and left > 15 and f'Not enough rocks, 30: Share at "far": 0 to {high:.4g}, as {left} were lost' in said, said

# Twenty chunks tell once whom they lost: ten lines of progress, and the notes of all.
logs = []
text = messages_of(lambda: logs.append(run(
    "enough-notes", iterations=20, chunk=1, simulation={**study["simulation"], "EndTime": 4.0, "TimeStep": 0.1})))
text = logs[0][1] + text
assert logs[0][0] == 0 and len(text.splitlines()) <= 20, text
moving = re.findall(r"(\d+) of 100 rocks were still moving at EndTime \(4 s\): they count", text)
rows = rows_of("enough-notes/summary.csv")
assert "(0.1 s)" not in text and "None of" not in text, text  # of the look at the inputs
assert moving == [str(sum(row["FateCode"] == "2" for row in rows))] != ["0"], text
# Of each chunk as of one run; that nothing moved is so where no chunk moved anything.
notes = [["2 of 9 rocks fell", "None of 9 rocks moved: x"], [], ["1 of 9 rocks fell"]]
assert combine.notes_of_all(notes, 27) == ["3 of 27 rocks fell"], combine.notes_of_all(notes, 27)
pushed = "PushRocksApart moved up to {} of 9 blocks, by up to {} m, in {} of 2 iterations"
notes = [[pushed.format(3, 0.5, 1)], [pushed.format(2, 1.25, 2)], []]
assert combine.notes_of_all(notes, 54) == ["PushRocksApart moved up to 3 of 9 blocks, by up to 1.25 m, in 3 iterations"]
# Of the look at the inputs what is so of the whole study.
assert combine.input_notes(["2 of 9 rocks were still moving", "A is 1, but has no effect: why", pushed.format(1, 2, 2),
                            "All 2 iterations are alike: nothing"], 50) == \
    ["A is 1, but has no effect: why", "All 50 iterations are alike: nothing"]
assert combine.notes_of_all([["None of 9 rocks moved: x"]] * 2, 18) == ["None of 18 rocks moved: x"]

# So are those that left the DEM: of a hundred that go 1 to 100 m ten go farther.
columns = {name: np.zeros(100) for name in ("BlockId", "StartX", "StartY", "StopX", "StopY")}
for left in (10, 0):
    np.savez("left.npz", **columns, Iteration=np.arange(100), RunOut=np.arange(1.0, 101.0), FateCode=np.arange(100) >= 100 - left)
    reach, known = enough.Enough({"quantity": "RunOut95", "within": 0.5}, []), left == 0
    reach.add("left")
    assert [one["known"] for one in reach.state()] == [known], reach.state()

# How far rocks go needs no line: order statistics of RunOut.
calm = {name: value for name, value in study.items() if name != "lines"}
study = {**calm, "iterations": 40, "chunk": 8}
code, said = run("enough-reach", until={"quantity": "RunOut95", "within": 0.3})
assert code == 0 and "Enough rocks, " in said and "RunOut95: " in said and " m" in said, said
known = json.loads(files_of("enough-reach")["manifest.json"])["until"]["lines"]
rows = rows_of("enough-reach/summary.csv")  # whoever was lost may have gone any way
ways = sorted(math.inf if int(row["FateCode"]) in enough.ENDLESS else float(row["RunOut"]) for row in rows)
assert len(known) == 1 and known[0]["rocks"] == len(ways) >= 72, known
low, high = (ways[k - 1] for k in enough.quantile_ranks(len(ways), 0.95, 0.95))
assert math.isclose(known[0]["from"], low) and math.isclose(known[0]["to"], high), (known, low, high)
assert high - low <= 0.3 * (high + low)
study = {**calm, "lines": {"FileName": "enough-road.csv"}}

for until, word in (({"quantity": "RunOut95", "within": 0.1, "line": "near"}, "of all rocks"),
                    ({"quantity": "Shares", "within": 0.1}, "one of Share"), ({"quantity": "Share"}, "within"),
                    ({"quantity": "Share", "within": 2}, "between 0 and 1"),
                    ({"quantity": "Share", "within": 0.1, "line": "none"}, '"near", "far"'),
                    ({"quantity": "Share", "within": 0.1, "lines": 1}, 'no "lines" in until')):
    code, said = run("enough-bad", until=until)
    assert code != 0 and word in said and "Traceback" not in said, (until, said)
# On ranks.
if shutil.which("mpiexec"):
    write_text("enough.json", json.dumps({**study, "until": {"quantity": "Share", "within": 0.2}}))
    done = subprocess.run(
        ["mpiexec", "-n", "2", "--oversubscribe", "--bind-to", "none", "pvbatch", "--sym", SCRIPT,
         "enough-ranks", "enough.json"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        timeout=200, env=outside_mpi())
    assert done.returncode == 0 and done.stdout.count("Enough rocks, ") == 1, done.stdout
    assert json.loads(files_of("enough-ranks")["results.json"])["iterations"] == few
print("a study ends when it is enough")
