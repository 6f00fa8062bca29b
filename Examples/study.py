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
      "map":        {"CellSize": 4},
      "lines":      {"FileName": "road.gpkg", "BarrierHeight": 3, "BarrierCapacity": 500},
      "trajectories": true,
      "iterations": 1000,
      "chunk":      50
    }

"terrain", "rocks", "simulation" and "lines" are properties of DEM to CFE Mesh, Rock Blocks, Rockfall
Simulation and Trajectory Collector. "map" and "lines" may be left out, and then there are none; with
"trajectories": false those are not kept. Files count by their content, not by their name. FOLDER gets

    manifest.json               what the study is
    chunk-00000.npz             table of the first chunk, and so on
    chunk-00000.vtp             its trajectories
    chunk-00000.passages        what the map is made of
    chunk-00000-crossings.vtp   what passed the lines

and when all chunks are there

    summary.csv                 the table of all rocks and iterations
    hazard.tif                  the hazard map
    crossings.csv, lines.csv, exceedance.csv     what passed the lines, and statistics of it
    study.json                  the state hash of every chunk and of the whole
"""
import argparse
import hashlib
import json
import os
import sys

here = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(here, "study_parts")]

import numpy as np
from paraview import servermanager
from paraview.simple import *
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
from vtkmodules.vtkParallelCore import vtkMultiProcessController

import schema
import wholefile
from wholefile import write_csv, write_npz, write_polydata, write_text

FILES = ("FileName", "File", "Layer", "Table")  # a property whose name ends so is a file
# Companions of a file: with their ending instead of the file's own, or behind it.
COMPANIONS = (".dbf", ".shx", ".prj", ".cpg", ".csvt", ".tfw", ".wld"), (".aux.xml", ".msk")
FORMAT = 2  # of the files here: another one is another study
controller = vtkMultiProcessController.GetGlobalController()
# Without --sym the first rank alone runs the script.
symmetric = controller is not None and controller.GetNumberOfProcesses() > 1 and \
    servermanager.vtkProcessModule.GetProcessModule().GetSymmetricMPIMode()
PARTS = tuple(schema.PROXIES)  # of a study: properties of proxies
lock = None  # of the folder, on the first rank
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
    study = schema.load(path)
    schema.check(path, study)
    for key in ("Iterations", "FirstIteration", "ShownIteration", "NumberOfThreads"):
        if key in study.get("simulation", {}):
            refuse(f"{path}: \"{key}\" of simulation is this script's; use \"iterations\", \"chunk\" "
                   "and --threads")
    if "map" in study or "lines" in study:
        kept = study.get("simulation", {}).get("TrajectoryOutput", "Full")
        if kept not in ("Thinned", "Full", 3, 4):
            refuse(f"{path}: TrajectoryOutput of simulation is {json.dumps(kept)}, but \"map\" and "
                   "\"lines\" need \"Thinned\" or \"Full\"")
    if "lines" in study and not study["lines"].get("FileName"):
        refuse(f"{path}: \"lines\" has no FileName")
    base = os.path.dirname(os.path.abspath(path))
    study.setdefault("trajectories", True)
    for part in ("terrain", "rocks", "simulation"):
        study.setdefault(part, {})
    for part in PARTS:
        for name, value in study.get(part, {}).items():
            if name.endswith(FILES) and value:
                study[part][name] = os.path.join(base, value)
                if not os.path.isfile(study[part][name]):
                    refuse(f"{path}: {part} {name}: there is no file {study[part][name]}")
    return study


def content(path):
    stem = os.path.splitext(path)[0]
    companions = [stem + end for end in COMPANIONS[0]] + [path + end for end in COMPANIONS[1]]
    digest = hashlib.sha256()
    for one in [path] + [c for c in companions if c != path and os.path.isfile(c)]:
        with open(one, "rb") as file:
            while block := file.read(1 << 20):
                digest.update(block)
    return digest.hexdigest()


def identity(study):
    """What makes a study this one: all that its results depend on, files by their content."""
    result = {"format": FORMAT}
    result.update((key, study[key]) for key in ("trajectories", "iterations", "chunk"))
    for part in filter(study.__contains__, PARTS):
        result[part] = {
            name: "sha256 " + content(value) if name.endswith(FILES) and value else value
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


def from_first_rank(work):
    """What work() gives there, on every rank: no other one looks at files. A refusal ends all."""
    answer = ""
    if first_rank:
        try:
            answer = json.dumps([None, work()])
        except (Refused, schema.Bad) as refusal:
            answer = json.dumps([str(refusal), None])
        except OSError as error:
            answer = json.dumps([f"{error.filename}: {error.strerror or type(error).__name__}", None])
        except MemoryError:
            answer = json.dumps(["There is not enough memory for this chunk: take a smaller one", None])
    if symmetric:
        array = vtkUnsignedCharArray()
        for byte in answer.encode():
            array.InsertNextValue(byte)
        controller.Broadcast(array, 0)
        answer = bytes(array.GetValue(k) for k in range(array.GetNumberOfValues())).decode()
    refusal, result = json.loads(answer)
    if refusal is not None:
        raise SystemExit(refusal if first_rank else 1)
    return result


def output(proxy, port=0):
    """What a proxy made on this rank. Ends all ranks if the first has nothing but an error."""
    data = proxy.GetClientSideObject().GetOutputDataObject(port)

    def check():
        error = data.GetFieldData().GetAbstractArray("Error")
        if error:
            refuse(f"The study cannot be done: {error.GetValue(0)}")

    from_first_rank(check)
    return data


def columns_of(fields):
    """Arrays as {name: numbers or texts}, a vector as three columns that end in X, Y and Z."""
    columns = {}
    for k in range(fields.GetNumberOfArrays()):
        array = fields.GetAbstractArray(k)
        if not array.IsNumeric():
            columns[array.GetName()] = np.array(
                [array.GetValue(n) for n in range(array.GetNumberOfValues())], dtype=str)
        elif array.GetNumberOfComponents() == 1:
            columns[array.GetName()] = vtk_to_numpy(array).copy()
        else:
            for n, values in enumerate(vtk_to_numpy(array).T):
                columns[array.GetName() + "XYZ"[n]] = values.copy()
    return columns


def write_by(writer, path):
    """Has a writer's proxy write its file, on the first rank; the other ranks take part."""
    unfinished = wholefile.unfinished(path)

    def remove():
        if os.path.exists(unfinished):
            os.remove(unfinished)

    def keep():
        if not os.path.exists(unfinished):
            refuse(f"{path} could not be made; the message above says why.")
        wholefile.keep(path)

    from_first_rank(remove)
    writer.FileName = unfinished
    writer.UpdatePipeline()
    from_first_rank(keep)


class Pipeline:
    """Slope, rocks, simulation and what is made of its trajectories."""

    def __init__(self, study, threads):
        self.study = study
        self.slope = make(DEMtoCFEMesh, "terrain", study["terrain"])
        rocks = make(RockBlocks, "rocks", {"Terrain": self.slope, **study["rocks"]})
        self.simulation = make(RockfallSimulation, "simulation", {
            "PrintProgress": 1, "KeepImpacts": 0, **study["simulation"], "Terrain": self.slope,
            "Rocks": rocks, "NumberOfThreads": threads})
        lines = OutputPort(self.simulation, 1)
        self.passages = self.crossings = None
        if "map" in study:
            self.passages = make(servermanager.writers.HazardPassageWriter, "map", {
                **study["map"], "Input": lines, "Terrain": self.slope})
        if "lines" in study:
            self.crossings = make(TrajectoryCollector, "lines", {
                **study["lines"], "Input": lines, "Terrain": self.slope})

    def check(self, folder):
        """Reads every input and makes everything once, of one iteration's first moment: what is wrong
        with a file is told before the first chunk, not after it."""
        simulation = self.simulation
        kept = simulation.EndTime, simulation.PrintProgress
        simulation.FirstIteration, simulation.Iterations = 0, 1
        simulation.EndTime = min(simulation.EndTime, simulation.TimeStep)
        simulation.PrintProgress = 0
        UpdatePipeline(0.0, simulation)
        output(simulation, 3)
        if self.passages:
            path = os.path.join(folder, ".unfinished-check.passages")
            write_by(self.passages, path)
            from_first_rank(lambda: os.remove(path))
        if self.crossings:
            UpdatePipeline(proxy=self.crossings)
            output(self.crossings)
        simulation.EndTime, simulation.PrintProgress = kept

    def write_chunk(self, stem, first, iterations):
        """A chunk is there when its table is, so that comes last."""
        self.simulation.FirstIteration = first
        self.simulation.Iterations = iterations
        UpdatePipeline(0.0, self.simulation)
        table = output(self.simulation, 3)
        lines = output(self.simulation, 1)
        if self.study["trajectories"]:
            from_first_rank(lambda: write_polydata(stem + ".vtp", lines))
        if self.passages:
            write_by(self.passages, stem + ".passages")
        if self.crossings:
            UpdatePipeline(proxy=self.crossings)
            crossings = output(self.crossings)
            from_first_rank(lambda: write_polydata(stem + "-crossings.vtp", crossings))

        def write_table():
            columns = columns_of(table.GetRowData())
            state = table.GetFieldData().GetAbstractArray("StateHash").GetValue(0)
            write_npz(stem + ".npz", {**columns, "StateHash": state})

        from_first_rank(write_table)


def combine_tables(folder, stems):
    """The table of the whole study, from its chunks alone; gives their state hashes."""
    hashes = []
    tables = []
    for stem in stems:
        with np.load(stem + ".npz") as chunk:
            tables.append({name: chunk[name] for name in chunk.files if name != "StateHash"})
            hashes.append(str(chunk["StateHash"]))
    write_csv(os.path.join(folder, "summary.csv"), tables)
    return hashes


def combine_crossings(folder, stems, merge):
    """Crossings, and the tables of all of them. `merge` is the filter itself: no other rank takes
    part, and its inputs have no proxies."""
    for stem in stems:
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(stem + "-crossings.vtp")
        reader.Update()
        merge.AddInputDataObject(0, reader.GetOutput())
    merge.Update()
    points = merge.GetOutputDataObject(0)
    if points.GetFieldData().GetAbstractArray("Error"):
        refuse("The crossings cannot be merged; the message above says why.")
    places = vtk_to_numpy(points.GetPoints().GetData()).reshape(-1, 3)
    write_csv(os.path.join(folder, "crossings.csv"),
              [{**dict(zip("XYZ", places.T)), **columns_of(points.GetPointData())}])
    for port, name in ((1, "lines.csv"), (2, "exceedance.csv")):
        write_csv(os.path.join(folder, name),
                  [columns_of(merge.GetOutputDataObject(port).GetRowData())])


def combine(study, folder, stems):
    """The results of the whole study, from the files of its chunks alone."""
    hashes = from_first_rank(lambda: combine_tables(folder, stems))
    if "lines" in study:
        merge = servermanager.filters.MergeCollectors().GetClientSideObject()
        from_first_rank(lambda: combine_crossings(folder, stems, merge))
    if "map" in study:
        hazard = HazardPassageReader(FileNames=[stem + ".passages" for stem in stems])
        writer = servermanager.writers.HazardMapWriter(Input=hazard)
        write_by(writer, os.path.join(folder, "hazard.tif"))

    def finish():
        write_text(os.path.join(folder, "study.json"), json.dumps(
            {"chunks": hashes, "whole": hashlib.sha256("".join(hashes).encode()).hexdigest()},
            indent=1) + "\n")
        for name in os.listdir(folder):  # what a killed run left
            if name.startswith(wholefile.UNFINISHED) and name != wholefile.LOCK:
                os.remove(os.path.join(folder, name))

    from_first_rank(finish)


def manifest_of(chosen):
    return os.path.join(chosen.folder, "manifest.json")


def begin(chosen):
    """Checks what can be without reading the inputs; gives the study, and which chunks are there."""
    global lock
    if "RockfallSimulation" not in globals():
        refuse("The plugin RockfallDDA is not loaded: run this with bash Examples/run.sh, or set "
               "PV_PLUGIN_PATH.")
    study = read_study(chosen.study)
    this = identity(study)
    manifest = manifest_of(chosen)
    chunks = -(-study["iterations"] // study["chunk"])
    try:
        os.makedirs(chosen.folder, exist_ok=True)
        lock = wholefile.Lock(chosen.folder)
        if not os.path.exists(manifest):
            for name in sorted(os.listdir(chosen.folder)):
                if not name.startswith(wholefile.UNFINISHED):
                    refuse(f"{chosen.folder} has no manifest.json but a file {name} that is not of a "
                           "study. Take another folder.")
            return study, [False] * chunks
    except BlockingIOError as error:
        refuse(f"{chosen.folder} is being written by another study ({error.strerror}). Wait for it, or "
               "take another folder.")
    except OSError as error:
        refuse(f"{error.filename}: {error.strerror}")
    there = schema.load(manifest)
    if there != this:
        refuse(f"{chosen.folder} has the results of another study: changed are "
               f"{', '.join(differences(there, this))}. Take another folder, or remove this one.")
    return study, [os.path.exists(stem_of(chosen, k) + ".npz") for k in range(chunks)]


def claim(chosen, study):
    """The folder is this study's from here on: its inputs are good."""
    if not os.path.exists(manifest_of(chosen)):
        write_text(manifest_of(chosen), json.dumps(identity(study), indent=1) + "\n")


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
    pipeline = None
    for k, there in enumerate(done):
        if there:
            continue
        if not pipeline:
            pipeline = Pipeline(study, chosen.threads)
            pipeline.check(chosen.folder)
            from_first_rank(lambda: claim(chosen, study))
        first = k * study["chunk"]
        iterations = min(study["chunk"], study["iterations"] - first)
        pipeline.write_chunk(stem_of(chosen, k), first, iterations)
        say(f"chunk {k + 1} of {len(done)}: {iterations} iterations from {first}")
    combine(study, chosen.folder, [stem_of(chosen, k) for k in range(len(done))])
    say(f"Done: {chosen.folder}")


try:
    main()
finally:
    if lock:
        lock.release()
