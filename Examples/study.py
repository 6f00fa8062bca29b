"""A study of many iterations that can be stopped at any moment and started again.

    bash Examples/run.sh study.py FOLDER study.json [--threads N]
    mpiexec -n 4 pvbatch --sym Examples/study.py FOLDER study.json     (PV_PLUGIN_PATH set)

The study is simulated in chunks of iterations. Each chunk's files are written under another name and
renamed when they are whole, so that what is in FOLDER is good whenever the script was stopped: killed,
out of time, or by a power cut. Started again with the same study it goes on where it was, and the
final files are the same, bit for bit, as of a run that nobody disturbed, on any number of threads and
ranks. A changed study is refused, also when a file of a data set, or the program, is another one.

study.json, all paths from where it stands:

    {
      "terrain":    {"FileName": "dem.tif", "RoughnessDeviation": 0.1},
      "rocks":      {"FileName": "sources.csv"},
      "simulation": {"EndTime": 60, "Seed": 1, "TrajectoryOutput": "Thinned"},
      "map":        {"CellSize": 4},
      "lines":      {"FileName": "road.gpkg", "BarrierHeight": 3, "BarrierCapacity": 500},
      "trajectories": true,
      "iterations": 1000,
      "chunk":      50,
      "until":      {"quantity": "Share", "within": 0.02}
    }

"terrain", "rocks", "simulation" and "lines" are properties of DEM to CFE Mesh, Rock Blocks, Rockfall
Simulation and Trajectory Collector. "map", "lines" and "until" may be left out, and then there are none; with
"trajectories": false those are not kept. Files count by their content, not by their name. FOLDER gets

    manifest.json               what the study is: program, files, all values in force, and notes
    chunk-00000.npz             table of the first chunk, and so on
    chunk-00000.vtp             its trajectories
    chunk-00000.passages        what the map is made of
    chunk-00000-crossings.vtp   what passed the lines
    chunk-00000-structures.npz  what came to embankments, nets and stems

and when all chunks are there

    summary.csv                 the table of all rocks and iterations
    hazard.tif                  the hazard map
    crossings.csv, lines.csv, exceedance.csv     what passed the lines, and statistics of it
    design.csv, design_classes.csv, design_sources.csv, design_places.csv   what barriers on the lines have to hold
    structures.csv              what came to each embankment and net, and to the stems
    results.json                the state hash of every chunk and of the whole

More iterations of a finished study go on where it was, with the same files as of one that had them from the
start.
"""
import argparse
import json
import os
import sys
import time

here = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(here, "study_parts")]

import numpy as np
from paraview import servermanager
from paraview.simple import *

import enough
import schema
import standing
import wholefile
from combine import MANIFEST, RESULTS, chunk_iterations, columns_of, combine, input_notes, kept_notes
from identity import FILES, Inputs, differences, early, identity, told, values, version
from together import from_first_rank, make, output, ranks, refuse, say, write_by
from wholefile import write_npz, write_polydata, write_text

PARTS = tuple(schema.PROXIES)  # of a study: properties of proxies
OWN = "Iterations", "FirstIteration", "ShownIteration", "NumberOfThreads"  # of the simulation: this script's
LOOK = 0.05  # s: of a run as short as that no losses are told
lock = None  # of the folder, on the first rank
inputs = None  # the files, on the first rank


class Schema(argparse.Action):
    """Says what may stand in a study.json, and ends."""

    def __init__(self, *names, **more):
        super().__init__(*names, nargs=0, **more)

    def __call__(self, *_):
        say(json.dumps(schema.json_schema(), indent=1))
        raise SystemExit


def arguments():
    parser = argparse.ArgumentParser(description="A batch study that can be stopped and started again.")
    parser.add_argument("folder", help="folder for the results")
    parser.add_argument("study", help="JSON file that describes the study")
    parser.add_argument("--schema", action=Schema, help="write the JSON Schema of a study to stdout, and end")
    parser.add_argument("--threads", type=int, default=0, help="threads of each rank (0: all)")
    return parser.parse_args()


def read_study(path):
    """The study with full paths."""
    study = schema.load(path)
    schema.check(path, study)
    enough.check(path, study)
    for key in OWN:
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


class Pipeline:
    """Slope, rocks, simulation and what is made of its trajectories."""

    def __init__(self, study, threads):
        self.study = study
        self.slope = make(DEMtoCFEMesh, "terrain", study["terrain"])
        self.rocks = make(RockBlocks, "rocks", {"Terrain": self.slope, **study["rocks"]})
        self.standing = None
        self.notes = []  # on the inputs, on the first rank
        self.simulation = make(RockfallSimulation, "simulation", {
            "KeepImpacts": int(bool(study["terrain"].get("EmbankmentFile"))), **study["simulation"], "Terrain": self.slope,
            "Rocks": self.rocks, "NumberOfThreads": threads})
        lines = OutputPort(self.simulation, 1)
        self.passages = self.crossings = None
        if "map" in study:
            self.passages = make(servermanager.writers.HazardPassageWriter, "map", {
                **schema.shared_out("map", study["map"])[0], "Input": lines, "Terrain": self.slope})
        if "lines" in study:
            self.crossings = make(TrajectoryCollector, "lines", {
                **schema.shared_out("lines", study["lines"])[0], "Input": lines, "Terrain": self.slope})

    def values(self):
        """All values in force, those that the study leaves alone as well."""
        proxies = {"terrain": self.slope, "rocks": self.rocks, "simulation": self.simulation,
                   "map": self.passages, "lines": self.crossings}
        result = values({part: proxy for part, proxy in proxies.items() if proxy})
        for part, name in (*(("simulation", name) for name in OWN), ("simulation", "PrintNotes"),
                           ("lines", "PrintNotes"), ("map", "FileName")):  # this script's
            result.get(part, {}).pop(name, None)
        for part in filter(self.study.__contains__, schema.FURTHER):
            result[part].update(schema.shared_out(part, self.study[part])[1])
        return result

    def check(self, folder):
        """Reads every input and makes everything once, of one iteration's first moment: what is wrong
        with a file is told before the first chunk, not after it. Whom that moment loses is no loss of the study."""
        simulation = self.simulation
        before = simulation.EndTime, simulation.PrintProgress
        # Two: what makes iterations alike is told here.
        simulation.FirstIteration, simulation.Iterations = 0, min(2, self.study["iterations"])
        simulation.EndTime = min(simulation.EndTime, simulation.TimeStep, LOOK)
        simulation.PrintProgress = 0
        UpdatePipeline(0.0, simulation)
        told = kept_notes(output(simulation, 3))
        if self.passages:
            path = os.path.join(folder, ".unfinished-check.passages")
            write_by(self.passages, path)
            from_first_rank(lambda: os.remove(path))
        if self.crossings:
            UpdatePipeline(proxy=self.crossings)
            told += kept_notes(output(self.crossings))
        self.notes = from_first_rank(lambda: input_notes(told, self.study["iterations"]))
        if any(self.study["terrain"].get(kind + "File") for kind in ("Embankment", "Tree", "Barrier")):
            paths = simulation.TrajectoryOutput in ("Thinned", "Full")
            self.standing = standing.Standing(self.slope, simulation, paths, bool(simulation.KeepImpacts))
        simulation.EndTime, simulation.PrintProgress = before
        for proxy in (simulation, self.crossings):
            if proxy:
                proxy.PrintNotes = 0  # of each chunk: combine() tells them of all

    def ends(self):
        """Of the names of a chunk's files."""
        return [end for end, there in (
            (".npz", True), (".vtp", self.study["trajectories"]), (".passages", self.passages),
            ("-crossings.vtp", self.crossings), ("-structures.npz", self.standing)) if there]

    def write_chunk(self, stem, first, iterations):
        """Its table comes last: a chunk that was not written to its end has none."""
        from_first_rank(lambda: os.path.exists(stem + ".npz") and os.remove(stem + ".npz"))
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
        if self.standing:
            self.standing.write(stem)

        def write_table():
            inputs.check()
            columns = columns_of(table.GetRowData())
            state = table.GetFieldData().GetAbstractArray("StateHash").GetValue(0)
            notes = columns_of(table.GetFieldData()).get("Notes", [])
            write_npz(stem + ".npz", {
                **columns, "StateHash": state, "Iterations": iterations, "Notes": np.array(notes, dtype=str)})

        from_first_rank(write_table)


def manifest_of(chosen):
    return os.path.join(chosen.folder, MANIFEST)


def begin(chosen):
    """Checks what can be before a reader looks at the inputs; gives the study."""
    global lock, inputs
    if "RockfallSimulation" not in globals():
        refuse("The plugin RockfallDDA is not loaded: run this with bash Examples/run.sh, or set "
               "PV_PLUGIN_PATH.")
    study = read_study(chosen.study)
    try:
        os.makedirs(chosen.folder, exist_ok=True)
        lock = wholefile.Lock(chosen.folder)
        if not os.path.exists(manifest_of(chosen)):
            for name in sorted(os.listdir(chosen.folder)):
                if not name.startswith(wholefile.UNFINISHED):
                    refuse(f"{chosen.folder} has no manifest.json but a file {name} that is not of a "
                           "study. Take another folder.")
    except BlockingIOError as error:
        refuse(f"{chosen.folder} is being written by another study ({error.strerror}). Wait for it, or "
               "take another folder.")
    except OSError as error:
        refuse(f"{error.filename}: {error.strerror}")
    inputs = Inputs(study)
    if os.path.exists(manifest_of(chosen)):
        refuse_other(chosen, early(manifest_identity(chosen), study, inputs))
    return study


def manifest_identity(chosen):
    there = schema.load(manifest_of(chosen)).get("identity")
    if not isinstance(there, dict):
        refuse(f"{manifest_of(chosen)} is not of this version of the program, {version()}. Take another "
               "folder.")
    return there


def refuse_other(chosen, names):
    if names:
        refuse(f"{chosen.folder} has the results of another study: changed are {told(names, inputs)}. "
               "Take another folder, or remove this one.")


def claim(chosen, study, in_force, ends):
    """The folder is this study's from here on: its inputs are good. Gives how many iterations each
    chunk's files have."""
    manifest = manifest_of(chosen)
    this = identity(study, inputs)
    begun = time.strftime("%Y-%m-%d %H:%M:%S %z")
    there = schema.load(manifest) if os.path.exists(manifest) else {"identity": this, "begun": begun}
    refuse_other(chosen, differences(there["identity"], this))
    size, wanted = study["chunk"], study["iterations"]
    done = [chunk_iterations(stem_of(chosen, k), k * size, ends) for k in range(-(-wanted // size))]
    beyond = stem_of(chosen, len(done)) + ".npz"
    if os.path.exists(beyond) or done[-1] > wanted - size * (len(done) - 1):
        refuse(f"{chosen.folder} has more than {wanted} iterations already. Take another folder.")
    if there.get("iterations") != wanted:
        write_text(manifest, json.dumps({
            "program": f"RockfallDDA {version()}", "paraview": str(GetParaViewSourceVersion()),
            "begun": there.get("begun"), "sessions": there.get("sessions", []),
            "study": os.path.abspath(chosen.study), "iterations": wanted, "chunk": size,
            "files": inputs.names(), "values": in_force, "identity": this}, indent=1) + "\n")
    if done != expected(study) and os.path.exists(os.path.join(chosen.folder, RESULTS)):
        os.remove(os.path.join(chosen.folder, RESULTS))  # of fewer iterations, or of files that are gone
    return done


def expected(study):
    """Iterations of every chunk."""
    size, wanted = study["chunk"], study["iterations"]
    return [min(size, wanted - first) for first in range(0, wanted, size)]


def stem_of(chosen, number):
    return os.path.join(chosen.folder, f"chunk-{number:05d}")


class Progress:
    """A line for each tenth of a study, and every ten minutes: how far it is, and how long it takes."""

    def __init__(self, there, total):
        self.start = self.last = time.monotonic()
        self.first, self.told, self.total = there, there, total

    def __call__(self, done):
        now = time.monotonic()
        if done < self.total and now - self.last < 600 and \
                10 * done // self.total == 10 * self.told // self.total:
            return
        self.last, self.told = now, done
        left = (now - self.start) / (done - self.first) * (self.total - done)
        text = f"{done} of {self.total} iterations ({100 * done // self.total} %)"
        say(text + (f", about {duration(left)} left" if done < self.total else
                    f" in {duration(now - self.start)}"))


def duration(seconds):
    minutes, seconds = divmod(int(seconds + 0.999), 60)
    if minutes >= 60:
        return f"{minutes // 60} h {minutes % 60:02d} min"
    return f"{minutes} min {seconds:02d} s" if minutes else f"{seconds} s"


def precision(study, pipeline):
    """What the study goes on for, on the first rank; None if that is its iterations."""
    if "until" not in study:
        return None
    table = output(pipeline.crossings, 1) if pipeline.crossings else None

    def make_it():
        lines = columns_of(table.GetRowData())["LineName"] if table else []
        made.append(enough.Enough(study["until"], [str(name) for name in lines]))

    made = []
    from_first_rank(make_it)
    return made[0] if made else None


def is_enough(until, stem):
    if not until:
        return False
    until.add(stem)
    return all(one["known"] for one in until.state())


def tell_precision(chosen, until):
    """In the log and the manifest."""
    def write():
        manifest = schema.load(manifest_of(chosen))
        if not until and "until" not in manifest:
            return
        manifest.pop("until", None)  # that an earlier start had
        if until:
            known = all(one["known"] for one in until.state())
            say(("Enough" if known else "Not enough") + f" rocks, {until.total}: {until.text()}")
            manifest["until"] = {**until.until, "known": known, "lines": until.state()}
        write_text(manifest_of(chosen), json.dumps(manifest, indent=1) + "\n")

    from_first_rank(write)


def tell_session(chosen, begun, iterations):
    """In the manifest: what a run of this script simulated, and how long it took, if it came to its end."""
    def write():
        manifest = schema.load(manifest_of(chosen))
        manifest.setdefault("sessions", []).append({
            "ended": time.strftime("%Y-%m-%d %H:%M:%S %z"), "seconds": round(time.monotonic() - begun, 1),
            "iterations": iterations, "threads": chosen.threads or os.cpu_count(), "ranks": ranks})
        write_text(manifest_of(chosen), json.dumps(manifest, indent=1) + "\n")

    from_first_rank(write)


def main():
    begun = time.monotonic()
    chosen = arguments()
    study = from_first_rank(lambda: begin(chosen))
    pipeline = Pipeline(study, chosen.threads)
    pipeline.check(chosen.folder)
    from_first_rank(lambda: inputs.read())
    in_force = pipeline.values()
    done = from_first_rank(lambda: claim(chosen, study, in_force, pipeline.ends()))
    wanted = expected(study)
    whole = sum(one == kept for one, kept in zip(wanted, done))
    if whole:
        say(f"{whole} of {len(done)} chunks are there already")
    count = there = sum(one for one, kept in zip(wanted, done) if one == kept)
    progress = Progress(there, study["iterations"])
    stems = []
    until = precision(study, pipeline)
    for k, iterations in enumerate(wanted):
        stems.append(stem_of(chosen, k))
        if done[k] != iterations:
            pipeline.write_chunk(stems[-1], k * study["chunk"], iterations)
            count += iterations
            progress(count)
        if from_first_rank(lambda: is_enough(until, stems[-1])):
            break
    tell_precision(chosen, until)
    combine(study, chosen.folder, stems, sum(wanted[:len(stems)]), pipeline.standing and pipeline.standing.things,
            pipeline.notes)
    if count > there:
        tell_session(chosen, begun, count - there)
    say(f"Done: {chosen.folder}")


try:
    main()
finally:
    if lock:
        lock.release()
