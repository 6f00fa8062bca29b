"""A study with odd JSON, twice in one folder, and on a disk that is full: one line that says what is
wrong, and no file under its name that is not whole."""

import json
import os
import resource
import shutil
import sys
import tracemalloc

import jsonschema
import numpy as np
from helpers import delete_sources, files_of, incline, run_script, write_grid, write_text

EXAMPLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Examples")
SCRIPT = os.path.join(EXAMPLES, "study.py")
sys.path[:0] = [os.path.join(EXAMPLES, "study_parts")]
import schema
import wholefile

described = jsonschema.Draft202012Validator(schema.json_schema())
write_grid("folder.asc", incline())
write_text("folder.csv", "x,y,z,shape,volume\n" + "\n".join(
    f"700025,{4000060 + k},{146 + 0.2 * k},cube,0.01" for k in range(0, 40, 8)) + "\n")
study = {
    "terrain": {"FileName": "folder.asc"}, "rocks": {"FileName": "folder.csv"},
    "simulation": {"EndTime": 4.0, "TrajectoryOutput": "Thinned"}, "map": {"CellSize": 5.0},
    "iterations": 4, "chunk": 2}


def run(folder, largest=resource.RLIM_INFINITY):
    """Exit code and what was said; no file grows beyond `largest` (bytes)."""
    most = resource.getrlimit(resource.RLIMIT_FSIZE)[1]
    resource.setrlimit(resource.RLIMIT_FSIZE, (largest, most))  # Python ignores the signal
    try:
        said, message = run_script(SCRIPT, folder, "folder.json")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
        delete_sources()
    return (0, said) if message is None else (1, said + message)


def without_manifest(folder):
    return {name: data for name, data in files_of(folder).items() if name != "manifest.json"}


def taken_by_schema(text):
    """What JSON Schema, which editors know, says of a study of this text."""
    try:
        described.validate(json.loads(text))
    except jsonschema.ValidationError:
        return False
    return True


def refusal(text):
    """What is wrong with a study of this text, in one line."""
    with open("odd.json", "wb") as file:
        file.write(text if isinstance(text, bytes) else text.encode())
    try:
        schema.check("odd.json", schema.load("odd.json"))
        assert taken_by_schema(text.decode("utf-8-sig") if isinstance(text, bytes) else text), text
    except schema.Bad as bad:
        said = str(bad)
        assert said.startswith("odd.json") and "\n" not in said and len(said) < 300, said
        return said
    return ""


def odd(part=None, **changes):
    whole = {**study, **changes} if part is None else {**study, part: {**study[part], **changes}}
    return json.dumps(whole)


assert refusal(json.dumps(study)) == ""
for text, word in (
        (odd("terrain", FileName=3), "must be a text"), (odd("terrain", FileName=["a"]), "single value"),
        (odd("terrain", FileName={"a": 1}), "single value"), (odd("terrain", FileName=None), "text"),
        (odd("terrain", FileName="a\0.asc"), "character"), (odd("terrain", FileName="a\ud800"), "character"),
        (odd("simulation", EndTime="60"), "number"), (odd("simulation", EndTime=[60]), "single value"),
        (odd("simulation", EndTime=-1), "at least"), (odd("simulation", EndTime=True), "number"),
        (odd("simulation", Seed=True), "must be a number"), (odd("rocks", Amount=False), "must be a number"),
        (odd("simulation", EndTime=10**400), "a number can be"), (odd("simulation", Seed=1.5), "whole"),
        (odd("simulation", TrajectoryOutput="All"), "one of"), (odd("simulation", Rocks=1), "script sets"),
        (odd("simulation", EndTimes=1), "EndTimes"), (odd(iterations=1e30), "whole number"),
        (odd(iterations=10**30), "at most"), (odd(iterations=10**9, chunk=1), "chunks"),
        (odd(iterations=None), "null"), (odd(lines=[]), "an object"), (odd(trajectories=1), "true or false"),
        (odd().replace("4.0", "NaN"), "NaN"), (odd().replace("4.0", "-Infinity"), "-Infinity"),
        (odd()[:-1] + ', "chunk": 3}', "twice"), ("[" * 100000, "deep"), ('{"a":' * 100000, "deep"),
        (b"\xff\xfe{", "not JSON"), (b"{\0}", "not JSON"), ("3", "object"), ("", "not JSON")):
    assert word in refusal(text), (text[:200], word, refusal(text))
# But for what no schema can say, it refuses the same; it knows every property.
for text in (odd("terrain", FileName=3), odd("terrain", FileName=["a"]), odd("terrain", FileName="a\0.asc"),
             odd("simulation", EndTime="60"), odd("simulation", EndTime=[60]), odd("simulation", EndTime=-1),
             odd("simulation", Seed=1.5), odd("simulation", Seed=True), odd("simulation", TrajectoryOutput="All"),
             odd("simulation", Rocks=1), odd("simulation", EndTimes=1), odd("rocks", Velocity=[1.0, 2.0]), odd("rocks", Velocity=3.0),
             odd(iterations=10**30), odd(iterations=None), odd(lines=[]), odd(trajectories=1), odd(itterations=1),
             json.dumps({"terrain": {}})):
    assert refusal(text) and not taken_by_schema(text), text
assert refusal(odd("rocks", Velocity=[1.0, 2.0, 3.0], Shape="Cube")) == ""
assert refusal(odd("rocks", Shape=1)) == "" and refusal(odd("rocks", PlaceOnGround=True)) == "" and refusal(odd(**{"$schema": "study.schema.json"})) == ""
told, message = run_script(SCRIPT, "--schema")
assert message == "" and json.loads(told) == schema.json_schema(), message
assert refusal(b"\xef\xbb\xbf" + json.dumps(study).encode()) == ""  # some editors begin a text so

for folder in ("folder-calm", "folder-full"):
    shutil.rmtree(folder, ignore_errors=True)
write_text("folder.json", json.dumps(study))
code, said = run("folder-calm")
assert code == 0, said
calm = files_of("folder-calm")
assert not [name for name in calm if name.startswith(".")], sorted(calm)

# Another one is at it.
lock = wholefile.Lock("folder-calm")
code, said = run("folder-calm")
assert code != 0 and "folder-calm is being written by another study (process " in said, said
lock.release()
assert files_of("folder-calm") == calm

# The disk is full when the table, the trajectories or the map is written: each is the largest once.
sizes = sorted({len(data) for name, data in calm.items() if not name.endswith(".json")})
for largest in (sizes[0] - 1, sizes[len(sizes) // 2] - 1, sizes[-1] - 1):
    code, said = run("folder-full", largest)
    assert code != 0, f"nothing was too large for {largest} bytes"
    assert "folder-full" in said and "Traceback" not in said, said
    for name, data in files_of("folder-full").items():
        assert name.startswith((wholefile.UNFINISHED, "manifest.json")) or data == calm[name], \
            f"{name} is not whole"
code, said = run("folder-full")
assert code == 0 and without_manifest("folder-full") == without_manifest("folder-calm"), said

# A table of many chunks takes the memory of one: 40 of them no more than 2.
def chunks_of(count):
    for k in range(count):
        yield {"Iteration": np.full(5000, k), "RunOut": np.arange(5000) / 3.0, "Fate": np.full(5000, "=stopped")}


peaks = []
for count in (2, 40):
    tracemalloc.start()
    wholefile.write_csv("many.csv", chunks_of(count))
    peaks.append(tracemalloc.get_traced_memory()[1])
    tracemalloc.stop()
    with open("many.csv", encoding="utf-8") as file:
        rows = file.read().split("\n")
    assert len(rows) == 5000 * count + 2 and rows[0] == "Iteration,RunOut,Fate"
    assert rows[1] == "0,0.0,'=stopped" and rows[-2] == f"{count - 1},{4999 / 3.0!r},'=stopped", (rows[1], rows[-2])
assert peaks[1] < 1.2 * peaks[0], peaks
print("a study's files are whole or not there")
