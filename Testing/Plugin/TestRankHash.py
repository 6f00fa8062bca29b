"""The same bits on 1 and 2 ranks (the full form: and on 4), and by either way of running a script on them; what fails or is
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


def run(ranks, symmetric=True, troubles=()):
    start = [MPIEXEC, "-n", str(ranks), "--oversubscribe", "--bind-to", "none"] if ranks else []
    done = subprocess.run(
        start + ["pvbatch"] + (["--sym"] if symmetric and ranks else []) + [SCRIPT, sources, *troubles],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120,
        env=outside_mpi())
    assert done.returncode == 0, f"{ranks} ranks, {troubles}: {done.stdout}"
    return done.stdout


def result_of(text):
    found = re.findall(r"RESULT (.*)", text)
    assert len(found) == 1, text
    return found[0]


WORDS = {"source": "no such file.tif", "placement": "outside the slope", "property": "TimeStep is -1",
         "abort": ""}
alone = result_of(run(0))
assert "rows=55 " in alone and "runs=1" in alone, alone
if MPIEXEC:
    ways = [(2, True, WORDS), (2, False, ("source",))]
    if os.environ.get("ROCKFALL_VERIFICATION") == "full":
        ways.append((4, True, ()))
    for ranks, symmetric, troubles in ways:
        # What goes well, and then one trouble after the other, each followed by what goes well.
        text, *parts = re.split(r"TROUBLE \w+\n", run(ranks, symmetric, troubles))
        assert result_of(text) == alone, f"{ranks} ranks, --sym {symmetric}: {text}, alone: {alone}"
        assert "ERR|" not in text, text
        assert len(parts) == len(troubles), parts
        for trouble, text in zip(troubles, parts):
            assert "rows=0 hash=-" in result_of(text), text
            errors = re.findall(r"ERR\|", text)
            word = WORDS[trouble]
            assert len(errors) == (1 if word else 0) and word in text, text
            assert "AFTER rows=10" in text, text
print("ranks agree:", alone)
