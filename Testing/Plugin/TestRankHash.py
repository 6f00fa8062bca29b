"""The same bits on 1, 2 and 4 ranks, and by either way of running a script on them; what fails or is
aborted on one rank ends on all of them, with one message."""

import os
import re
import shutil
import subprocess

from helpers import outside_mpi, write_text

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "rankRun.py")
MPIEXEC = shutil.which("mpiexec")
sources = write_text("sources.csv", "x,y,z,shape\n" + "\n".join(
    f"5,{30 + 10 * k},58,{shape}"
    for k, shape in enumerate(["cube", "icosahedron", "octahedron", "eota111", "tetrahedron"])) + "\n")

write_text("dams.csv", 'WKT,height,width,slope\n"LINESTRING(60 20,60 60)",1,1,1.5\n')
write_text("trees.csv", "x,y,diameter,height\n30,40,40,20\n32,50,10,12\n40,60,30,20\n")
write_text("nets.csv", 'WKT,height,capacity\n"LINESTRING(85 1,85 99)",3,150\n')


def run(ranks, symmetric=True, trouble=""):
    start = [MPIEXEC, "-n", str(ranks), "--oversubscribe", "--bind-to", "none"] if ranks else []
    done = subprocess.run(
        start + ["pvbatch"] + (["--sym"] if symmetric and ranks else []) +
        [SCRIPT, sources] + ([trouble] if trouble else []),
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120,
        env=outside_mpi())
    assert done.returncode == 0, f"{ranks} ranks, {trouble}: {done.stdout}"
    return done.stdout


def result_of(text):
    found = re.findall(r"RESULT (.*)", text)
    assert len(found) == 1, text
    return found[0]


alone = result_of(run(0))
assert "rows=115 " in alone and "runs=1" in alone, alone
if MPIEXEC:
    for ranks, symmetric in ((1, True), (2, True), (4, True), (2, False)):
        text = run(ranks, symmetric)
        assert result_of(text) == alone, f"{ranks} ranks, --sym {symmetric}: {text}, alone: {alone}"
        assert "ERR|" not in text, text
    for trouble, word, symmetric in (
            ("source", "no such file.tif", True), ("source", "no such file.tif", False),
            ("placement", "outside the slope", True), ("property", "TimeStep is -1", True),
            ("abort", "", True)):
        text = run(2, symmetric, trouble)
        assert "rows=0 hash=-" in result_of(text), text
        errors = re.findall(r"ERR\|", text)
        assert len(errors) == (1 if word else 0) and word in text, text
        assert "AFTER rows=10" in text, text
print("ranks agree:", alone)
