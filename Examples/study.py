"""A study of many iterations that can be stopped at any moment and started again.

    bash Examples/run.sh study.py FOLDER study.json [--threads N]
    mpiexec -n 4 pvbatch --sym Examples/study.py FOLDER study.json     (PV_PLUGIN_PATH set)

The study is simulated in chunks of iterations. Each chunk's files are written under another name and
renamed when they are whole, so that what is in FOLDER is good whenever the script was stopped: killed,
out of time, or by a power cut. Started again with the same study it goes on where it was, and the
final files are the same, bit for bit, as of a run that nobody disturbed, on any number of threads and
ranks. A changed study is refused.

study.json, all paths from where it stands:

    {
      "terrain":    {"FileName": "dem.tif", "RoughnessDeviation": 0.1},
      "rocks":      {"FileName": "sources.csv"},
      "simulation": {"EndTime": 60, "Seed": 1, "TrajectoryOutput": "Thinned"},
      "iterations": 1000,
      "chunk":      50
    }

"terrain", "rocks" and "simulation" are properties of DEM to CFE Mesh, Rock Blocks and Rockfall
Simulation. Files named in them count by their content, not by their name. FOLDER gets

    manifest.json               what the study is
    chunk-00000.vtp, .npz       trajectories and table of the first chunk, and so on
    summary.csv                 the table of all chunks, once they are there
    study.json                  the state hash of every chunk and of the whole
"""
import argparse
import hashlib
import io
import json
import os
import zipfile

import numpy as np
from paraview import servermanager
from paraview.simple import *
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter
from vtkmodules.vtkParallelCore import vtkMultiProcessController

FORMAT = 1  # of the files here: another one is another study
controller = vtkMultiProcessController.GetGlobalController()
# Without --sym the first rank alone runs the script.
symmetric = controller is not None and controller.GetNumberOfProcesses() > 1 and \
    servermanager.vtkProcessModule.GetProcessModule().GetSymmetricMPIMode()
first_rank = not symmetric or controller.GetLocalProcessId() == 0


class Refused(Exception):
    """The study cannot be done; the text says why."""


def say(text):
    if first_rank:
        print(text, flush=True)


def arguments():
    parser = argparse.ArgumentParser(description="A batch study that can be stopped and started again.")
    parser.add_argument("folder", help="folder for the results")
    parser.add_argument("study", help="JSON file that describes the study")
    parser.add_argument("--threads", type=int, default=0, help="threads of each rank (0: all)")
    return parser.parse_args()


def refuse(text):
    raise Refused(text)


def read_study(path):
    """The study with full paths."""
    try:
        with open(path, encoding="utf-8") as file:
            study = json.load(file)
    except OSError as error:
        refuse(f"{path}: {error.strerror}")
    except ValueError as error:
        refuse(f"{path} is not JSON: {error}")
    if not isinstance(study, dict):
        refuse(f"{path} must be an object with terrain, rocks, simulation, iterations and chunk")
    known = {"terrain": dict, "rocks": dict, "simulation": dict, "iterations": int, "chunk": int}
    for key, value in study.items():
        if key not in known:
            refuse(f"{path}: there is no \"{key}\" in a study, it knows {', '.join(known)}")
        if not isinstance(value, known[key]) or isinstance(value, bool):
            kind = "an object" if known[key] is dict else "a whole number"
            refuse(f"{path}: \"{key}\" is {json.dumps(value)}, it must be {kind}")
    for key in ("iterations", "chunk"):
        if study.get(key, 0) < 1:
            refuse(f"{path}: \"{key}\" is {study.get(key, 'missing')}, it must be at least 1")
    for key in ("Iterations", "FirstIteration", "ShownIteration", "NumberOfThreads"):
        if key in study.get("simulation", {}):
            refuse(f"{path}: \"{key}\" of simulation is this script's; use \"iterations\", \"chunk\" "
                   "and --threads")
    base = os.path.dirname(os.path.abspath(path))
    for part in ("terrain", "rocks", "simulation"):
        study.setdefault(part, {})
        for name, value in study[part].items():
            if name.endswith("FileName") and value:
                study[part][name] = os.path.join(base, value)
                if not os.path.isfile(study[part][name]):
                    refuse(f"{path}: {part} {name}: there is no file {study[part][name]}")
    return study


def content(path):
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


def identity(study):
    """What makes a study this one: all that its results depend on, files by their content."""
    result = {"format": FORMAT, "iterations": study["iterations"], "chunk": study["chunk"]}
    for part in ("terrain", "rocks", "simulation"):
        result[part] = {
            name: "sha256 " + content(value) if name.endswith("FileName") and value else value
            for name, value in sorted(study[part].items())}
    return result


def differences(old, new, where=""):
    """Names of what two identities differ in."""
    names = []
    for key in sorted(set(old) | set(new)):
        if old.get(key) != new.get(key):
            if isinstance(old.get(key), dict) and isinstance(new.get(key), dict):
                names += differences(old[key], new[key], f"{where}{key} ")
            else:
                names.append(where + key)
    return names


def whole(path, write):
    """Calls write(other name), then renames: there is never half a file of this name."""
    head, tail = os.path.split(os.path.abspath(path))
    other = os.path.join(head, ".unfinished-" + tail)
    write(other)
    with open(other, "rb") as file:
        os.fsync(file.fileno())
    os.replace(other, path)
    folder = os.open(head, os.O_RDONLY)  # the new name, too, has to be on the disk
    try:
        os.fsync(folder)
    finally:
        os.close(folder)


def write_text(path, text):
    def write(other):
        with open(other, "w", encoding="utf-8") as file:
            file.write(text)
    whole(path, write)


def from_first_rank(work):
    """What work() gives there, on every rank: no other one looks at files. A refusal ends all."""
    answer = ""
    if first_rank:
        try:
            answer = json.dumps([None, work()])
        except (Refused, OSError) as refusal:
            answer = json.dumps([str(refusal), None])
    if symmetric:
        array = vtkUnsignedCharArray()
        for byte in answer.encode():
            array.InsertNextValue(byte)
        controller.Broadcast(array, 0)
        answer = bytes(array.GetValue(k) for k in range(array.GetNumberOfValues())).decode()
    refusal, result = json.loads(answer)
    if refusal:
        raise SystemExit(refusal if first_rank else 1)
    return result


def table_of(simulation):
    table = simulation.GetClientSideObject().GetOutputDataObject(3)
    columns = {}
    for c in range(table.GetNumberOfColumns()):
        column = table.GetColumn(c)
        if column.IsNumeric():
            columns[table.GetColumnName(c)] = vtk_to_numpy(column).copy()
        else:
            columns[table.GetColumnName(c)] = np.array(
                [column.GetValue(k) for k in range(column.GetNumberOfValues())])
    return columns


def write_npz(path, columns):
    """np.savez puts the time of day into its file; this does not."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, values in columns.items():
            data = io.BytesIO()
            np.save(data, values)
            archive.writestr(zipfile.ZipInfo(name + ".npy", (1980, 1, 1, 0, 0, 0)), data.getvalue(),
                             compress_type=zipfile.ZIP_DEFLATED)


def write_chunk(simulation, stem):
    """Trajectories first, table last: a chunk is there when its table is."""
    if simulation.GetClientSideObject().GetOutputDataObject(3).GetNumberOfRows() == 0:
        refuse("The simulation made nothing; the message above says why.")
    lines = simulation.GetClientSideObject().GetOutputDataObject(1)

    def write_lines(other):
        writer = vtkXMLPolyDataWriter()
        writer.SetInputData(lines)
        writer.SetFileName(other)
        writer.SetDataModeToBinary()
        if writer.Write() != 1:
            raise OSError(f"{other} could not be written")

    whole(stem + ".vtp", write_lines)
    columns = table_of(simulation)
    field = simulation.GetClientSideObject().GetOutputDataObject(3).GetFieldData()
    columns["StateHash"] = np.array(field.GetAbstractArray("StateHash").GetValue(0))
    whole(stem + ".npz", lambda other: write_npz(other, columns))


def combine(folder, stems):
    """The results of the whole study, from its chunks alone."""
    hashes = []
    tables = []
    for stem in stems:
        with np.load(stem + ".npz") as chunk:
            tables.append({name: chunk[name] for name in chunk.files if name != "StateHash"})
            hashes.append(str(chunk["StateHash"]))
    names = list(tables[0])

    def write_summary(other):
        with open(other, "w", encoding="utf-8") as file:
            file.write(",".join(names) + "\n")
            for table in tables:
                for row in zip(*(table[name].tolist() for name in names)):
                    file.write(",".join(v if isinstance(v, str) else repr(v) for v in row) + "\n")

    whole(os.path.join(folder, "summary.csv"), write_summary)

    # Maps and collectors of the whole study are made here, from the trajectories of all chunks:
    # lines = AppendDatasets(Input=[XMLPolyDataReader(FileName=[stem + ".vtp"]) for stem in stems])

    write_text(os.path.join(folder, "study.json"), json.dumps(
        {"chunks": hashes, "whole": hashlib.sha256("".join(hashes).encode()).hexdigest()}, indent=1)
        + "\n")
    for name in os.listdir(folder):  # what a killed run left
        if name.startswith(".unfinished-"):
            os.remove(os.path.join(folder, name))


def begin(chosen):
    """Checks everything; gives the study, and which chunks are there."""
    if "RockfallSimulation" not in globals():
        refuse("The plugin RockfallDDA is not loaded: run this with bash Examples/run.sh, or set "
               "PV_PLUGIN_PATH.")
    study = read_study(chosen.study)
    this = identity(study)
    manifest = os.path.join(chosen.folder, "manifest.json")
    try:
        os.makedirs(chosen.folder, exist_ok=True)
        if not os.path.exists(manifest):
            for name in sorted(os.listdir(chosen.folder)):
                if not name.startswith(".unfinished-"):
                    refuse(f"{chosen.folder} has no manifest.json but a file {name} that is not of a "
                           "study. Take another folder.")
            write_text(manifest, json.dumps(this, indent=1) + "\n")
    except OSError as error:
        refuse(f"{error.filename}: {error.strerror}")
    with open(manifest, encoding="utf-8") as file:
        there = json.load(file)
    if there != this:
        refuse(f"{chosen.folder} has the results of another study: changed are "
               f"{', '.join(differences(there, this))}. Take another folder, or remove this one.")
    chunks = -(-study["iterations"] // study["chunk"])
    return study, [os.path.exists(stem_of(chosen, k) + ".npz") for k in range(chunks)]


def stem_of(chosen, number):
    return os.path.join(chosen.folder, f"chunk-{number:05d}")


def make(source, label, properties):
    try:
        return source(**properties)
    except (AttributeError, ValueError, TypeError, RuntimeError) as error:
        # The same on every rank.
        raise SystemExit(f"{label}: {error}" if first_rank else 1)


def main():
    chosen = arguments()
    study, done = from_first_rank(lambda: begin(chosen))
    if any(done):
        say(f"{sum(done)} of {len(done)} chunks are there already")
    simulation = None
    for k, there in enumerate(done):
        if there:
            continue
        if simulation is None:
            slope = make(DEMtoCFEMesh, "terrain", study["terrain"])
            rocks = make(RockBlocks, "rocks", study["rocks"])
            simulation = make(RockfallSimulation, "simulation", {
                "PrintProgress": 1, **study["simulation"], "Terrain": slope, "Rocks": rocks,
                "NumberOfThreads": chosen.threads})
        simulation.FirstIteration = k * study["chunk"]
        simulation.Iterations = min(study["chunk"], study["iterations"] - k * study["chunk"])
        UpdatePipeline(0.0, simulation)
        from_first_rank(lambda: write_chunk(simulation, stem_of(chosen, k)))
        say(f"chunk {k + 1} of {len(done)}: {simulation.Iterations} iterations from "
            f"{simulation.FirstIteration}")
    stems = [stem_of(chosen, k) for k in range(len(done))]
    from_first_rank(lambda: combine(chosen.folder, stems))
    say(f"Done: {os.path.join(chosen.folder, 'summary.csv')}")


main()
