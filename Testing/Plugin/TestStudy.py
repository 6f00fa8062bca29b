"""A study that is killed and started again ends with the same files, byte for byte, as one that nobody
disturbed; on two ranks as well. A changed one is refused."""

import glob
import json
import os
import shutil
import signal
import subprocess
import time

from helpers import incline, outside_mpi, write_grid, write_text

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Examples", "study.py")
MPIEXEC = shutil.which("mpiexec")

terrain = write_grid("incline.asc", incline())
rocks = write_text("sources.csv", "x,y,z,shape,volume\n" + "\n".join(
    f"700025,{4000060 + 10 * k},{146 + k},{shape},{0.5 + 0.25 * k}"
    for k, shape in enumerate(["cube", "icosahedron", "octahedron"])) + "\n")
study = {
    "terrain": {"FileName": "incline.asc", "RoughnessDeviation": 0.2},
    "rocks": {"FileName": "sources.csv"},
    "simulation": {"EndTime": 6.0, "TrajectoryOutput": "Events"},
    "iterations": 11, "chunk": 2}


def write_study(name="study.json", **changes):
    return write_text(name, json.dumps({**study, **changes}))


def command(folder, path, ranks=1):
    start = [MPIEXEC, "-n", str(ranks), "--oversubscribe", "--bind-to", "none"] if ranks > 1 else []
    return start + ["pvbatch"] + (["--sym"] if ranks > 1 else []) + [SCRIPT, folder, path]


def run(folder, path="study.json", ranks=1):
    done = subprocess.run(command(folder, path, ranks), stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, timeout=200,
                          env=outside_mpi())
    return done.returncode, done.stdout


def files_of(folder):
    result = {}
    for name in sorted(os.listdir(folder)):
        with open(os.path.join(folder, name), "rb") as file:
            result[name] = file.read()
    return result


for folder in glob.glob("results-*"):
    shutil.rmtree(folder)
write_study()

code, said = run("results-calm")
assert code == 0, said
calm = files_of("results-calm")
assert sorted(calm) == sorted(
    [f"chunk-{k:05d}.{kind}" for k in range(6) for kind in ("npz", "vtp")] +
    ["manifest.json", "study.json", "summary.csv"]), sorted(calm)
assert calm["summary.csv"].count(b"\n") == 1 + 33

# Killed as soon as there is a second chunk, so within the third one or while a file is written.
process = subprocess.Popen(command("results-killed", "study.json"), stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL, env=outside_mpi())
while process.poll() is None and not os.path.exists("results-killed/chunk-00001.npz"):
    time.sleep(0.002)
process.send_signal(signal.SIGKILL)
process.wait()
left = files_of("results-killed")
assert "summary.csv" not in left, "it was done before it could be killed"
for name, data in left.items():
    assert name.startswith(".unfinished-") or data == calm[name], f"{name} is not whole"
write_text("results-killed/.unfinished-chunk-00003.npz", "half of it")
code, said = run("results-killed")
assert code == 0, said
assert "chunks are there already" in said, said
assert files_of("results-killed") == calm, "the restarted study has other files"

# What is there is not done again.
code, said = run("results-killed")
assert code == 0 and "6 of 6 chunks are there already" in said, said
assert files_of("results-killed") == calm

if MPIEXEC:
    code, said = run("results-ranks", ranks=2)
    assert code == 0, said
    assert files_of("results-ranks") == calm, "two ranks make other files"

# Another study, by a number or by the content of a file.
write_study("other.json", simulation={"EndTime": 7.0, "TrajectoryOutput": "Events"})
code, said = run("results-calm", "other.json")
assert code != 0 and "another study: changed are simulation EndTime." in said, said
write_text("sources.csv", open(rocks).read().replace("0.75", "0.8"))
code, said = run("results-calm")
assert code != 0 and "changed are rocks FileName." in said, said
assert files_of("results-calm") == calm
if MPIEXEC:
    code, said = run("results-calm", ranks=2)
    assert code != 0 and said.count("changed are rocks FileName.") == 1, said

# Bad descriptions.
for bad, word in (("{", "is not JSON"), ('{"itterations": 3}', '"itterations"'),
                  (json.dumps({**study, "chunk": 0}), '"chunk" is 0'),
                  (json.dumps({**study, "iterations": 2.5}), '"iterations" is 2.5'),
                  (json.dumps({**study, "terrain": {"FileName": "no.tif"}}), "no.tif"),
                  (json.dumps({**study, "simulation": {"Iterations": 3}}), '"Iterations"')):
    write_text("bad.json", bad)
    code, said = run("results-bad", "bad.json")
    assert code != 0 and word in said, (bad, said)
assert not os.path.exists("results-bad")
print("a study goes on where it was")
