"""The results of the whole study, from the files of its chunks alone."""
import hashlib
import json
import os
import re
import zipfile
import zlib

import numpy as np
from paraview import servermanager
from paraview.simple import *
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

import schema
import standing
import wholefile
from gis import write_map_styles, write_table
from together import from_first_rank, make, output, refuse, say, write_by
from wholefile import write_text

OF_CHUNK = ("StateHash", "Iterations", "Notes")  # beside the columns of its table
COUNTED = re.compile(r"(\d+) of (\d+) rocks (.*)", re.DOTALL)  # how the Core says how many it lost
BROKE = re.compile(r"\d+ of \d+ rocks (broke in impacts of \S+ J/m³ or more)"
                   r"(?:, into \d+ pieces in all; \S+ %( .*)|:.*)", re.DOTALL)
STILL = re.compile(r"(None of )\d+( rocks .*)", re.DOTALL)
PUSHED = re.compile(r"PushRocksApart moved (?:up to )?(\d+) of (\d+) blocks, by up to (\S+) m, in (\d+) of \d+ iterations")
ALIKE = re.compile(r"^All \d+ iterations are alike")
ORDER = ("Iteration", "RockId", "BlockId", "Piece", "Line", "Passing")  # of crossings; Piece where rocks break
# All that the tables of lines and the design of barriers are made of; of millions of crossings no more is in memory.
COUNTED_BY = (*ORDER, "KineticEnergy", "HeightOverGround", "Velocity", "TopHeight", "SourceId", "Frequency")
MANIFEST = "manifest.json"  # what a study is
RESULTS = "results.json"  # not study.json, which is what a study is called that goes in


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


def kept_notes(data):
    """The field array Notes of what a filter made."""
    notes = data.GetFieldData().GetAbstractArray("Notes")
    return [notes.GetValue(k) for k in range(notes.GetNumberOfValues())] if notes else []


def refuse_damaged(path, why=""):
    """A file of a chunk, without which the study is not finished."""
    results = os.path.join(os.path.dirname(path), RESULTS)
    if os.path.exists(results):
        os.remove(results)
    refuse(f"{path} {why}is damaged. Remove it, and it is made again.")


def check_whole(path):
    """Whether a chunk's file was cut; their reader tells of passages."""
    good = True
    if path.endswith(".npz"):
        try:
            with zipfile.ZipFile(path) as archive:
                good = archive.testzip() is None
        except (ValueError, EOFError, RuntimeError, zipfile.BadZipFile, zlib.error):
            good = False
    elif path.endswith(".vtp"):
        good = wholefile.ends_as_xml(path)
    if not good:
        refuse_damaged(path)


def chunk_iterations(stem, first, ends):
    """How many iterations a chunk has, from `first` on, whose files of these ends are all there; 0 if one is not."""
    if not all(os.path.exists(stem + end) for end in ends):
        return 0
    for end in ends:
        check_whole(stem + end)
    path = stem + ".npz"
    try:
        with np.load(path) as chunk:
            count = int(chunk["Iterations"])
            if np.any((chunk["Iteration"] < first) | (chunk["Iteration"] >= first + count)):
                refuse_damaged(path, "has iterations of another chunk and ")
            return count
    except (ValueError, KeyError):
        refuse_damaged(path)


def combine_tables(folder, stems):
    """The table of the whole study, from its chunks alone; gives their state hashes."""
    hashes = []
    notes = []
    rocks = 0
    broken = np.zeros(5)  # rocks, those that broke, pieces, mass of those that broke and of what is not followed

    def tables():
        nonlocal rocks, broken
        for stem in stems:
            with np.load(stem + ".npz") as chunk:
                table = {name: chunk[name] for name in chunk.files if name not in OF_CHUNK}
                hashes.append(str(chunk["StateHash"]))
                notes.append([str(note) for note in chunk["Notes"]])
            rocks += np.count_nonzero(table["Piece"] == 0) if "Piece" in table else len(table["FateCode"])
            if "Piece" in table:
                whole = table["Piece"] == 0
                first = whole & (table["Fate"] == "broken")
                broken += (whole.sum(), first.sum(), table["Pieces"].sum(), table["Mass"][first].sum(),
                           table["FinesMass"].sum())
            yield table

    write_table(os.path.join(folder, "summary.csv"), tables())
    return hashes, notes_of_all(notes, rocks, broken)


def input_notes(told, iterations):
    """Of what a look at the inputs tells, the notes on these and on properties, as of a study of so many iterations."""
    return [ALIKE.sub(f"All {iterations} iterations are alike", note) for note in told
            if not any(of_run.fullmatch(note) for of_run in (COUNTED, BROKE, STILL, PUSHED))]


def notes_of_all(notes, rocks, broken=()):
    """The runs' notes on whom they lost, of each chunk, as those of one run of so many rocks."""
    counts, broke, lost = {}, "", ""
    for note in (note for of_chunk in notes for note in of_chunk):
        if found := BROKE.fullmatch(note):
            broke, lost = found.group(1), found.group(2) or lost
            continue
        found = COUNTED.fullmatch(note)
        how = found.group(3) if found else note
        counts[how] = counts.get(how, 0) + int(found.group(1) if found else 0)
    texts = [f"{count} of {rocks} rocks {how}" for how, count in counts.items() if count]
    if broke:
        released, count, pieces, mass, fines = broken
        texts.append(f"{count:.0f} of {released:.0f} rocks {broke}" + (
            f", into {pieces:.0f} pieces in all; {100.0 * fines / mass:.3g} %{lost}" if count else ""))
    # Nothing moved, if that is so of each chunk.
    still = [found.groups() for of_chunk in notes for note in of_chunk if (found := STILL.fullmatch(note))]
    if still and len(still) == len(notes):
        texts.append(f"{still[0][0]}{rocks}{still[0][1]}")
    pushed = [found.groups() for of_chunk in notes for note in of_chunk if (found := PUSHED.fullmatch(note))]
    if pushed:
        moved, blocks, _, _ = max(pushed, key=lambda one: int(one[0]))
        farthest = max((one[2] for one in pushed), key=float)
        texts.append(f"PushRocksApart moved up to {moved} of {blocks} blocks, by up to {farthest} m, "
                     f"in {sum(int(one[3]) for one in pushed)} iterations")
    return texts


def crossings_of(stem):
    reader, errors = vtkXMLPolyDataReader(), []
    reader.AddObserver("ErrorEvent", lambda *_: errors.append(True))
    reader.SetFileName(stem + "-crossings.vtp")
    reader.Update()
    if errors:  # the output is empty, as of a chunk that passed no line
        refuse_damaged(stem + "-crossings.vtp")
    return reader.GetOutput()


def crossing_tables(stems):
    """Every passing with all that is known of it, chunk by chunk, in the order of Merge Collectors; that of a
    chunk without any only if no other one is there."""
    names = empty = None
    for stem in stems:
        points = crossings_of(stem)
        places = points.GetPoints()
        table = dict(zip("XYZ", vtk_to_numpy(places.GetData()).T if places else np.empty((3, 0))))
        table.update(columns_of(points.GetPointData()))
        if not points.GetNumberOfPoints():
            empty = empty or table
            continue
        names = names or list(table)
        if list(table) != names:
            refuse(f"{stem}-crossings.vtp: its columns are not those of the chunks before it")
        order = np.lexsort([table[name] for name in reversed(ORDER) if name in table])
        yield {name: column[order] for name, column in table.items()}
    if not names:
        yield empty


def columns_of_no_use(points):
    """Names of the columns that no statistics of lines need."""
    data = points.GetPointData()
    return [name for name in map(data.GetArrayName, range(data.GetNumberOfArrays())) if name not in COUNTED_BY]


def combine_crossings(folder, stems, merge, design):
    """Crossings, and the tables of all of them; gives the notes on these. `merge` and `design` are the filters themselves: no
    other rank takes part, and their inputs have no proxies."""
    for stem in stems:
        points = crossings_of(stem)
        for name in columns_of_no_use(points):
            points.GetPointData().RemoveArray(name)
        merge.AddInputDataObject(0, points)
    merge.Update()
    merge.RemoveAllInputConnections(0)  # the chunks' crossings go
    points = merge.GetOutputDataObject(0)
    if points.GetFieldData().GetAbstractArray("Error"):
        refuse("The crossings cannot be merged; the message above says why.")
    crs = points.GetFieldData().GetAbstractArray("TerrainCRS")
    write_table(os.path.join(folder, "crossings.csv"), crossing_tables(stems),
                crs.GetValue(0) if crs else None, "KineticEnergy")
    for port, name in ((1, "lines.csv"), (2, "exceedance.csv")):
        write_table(os.path.join(folder, name),
                    [columns_of(merge.GetOutputDataObject(port).GetRowData())])
    design.SetInputDataObject(0, points)
    design.Update()
    for port, name in enumerate(
            ("design.csv", "design_classes.csv", "design_sources.csv", "design_places.csv")):
        write_table(os.path.join(folder, name),
                    [columns_of(design.GetOutputDataObject(port).GetRowData())])
    return kept_notes(design.GetOutputDataObject(0))


def refuse_passages(stems, error):
    """Of the file that an error is about, if it is about one."""
    for stem in stems:
        if error.startswith(f"{stem}.passages:"):
            refuse_damaged(stem + ".passages")


def tell(notes, told):
    """The study's notes, but for those that its map has told of the same rocks."""
    for note in notes:
        if note not in told:
            say(note)


def combine(study, folder, stems, iterations, structures=None, of_inputs=()):
    """The results of the whole study, from the files of its chunks alone; `structures` are what stands on the slope,
    `of_inputs` notes on the inputs. The manifest gets all notes, for who reads the results later."""
    hashes, notes = from_first_rank(lambda: combine_tables(folder, stems))
    further = []
    if "map" not in study:
        tell(notes, ())
    if "lines" in study:
        merge = servermanager.filters.MergeCollectors().GetClientSideObject()
        design = make(servermanager.filters.BarrierDesign, "lines", schema.shared_out("lines", study["lines"])[1])
        further += from_first_rank(lambda: combine_crossings(folder, stems, merge, design.GetClientSideObject()))
    if "map" in study:
        hazard = make(HazardPassageReader, "map", {
            **schema.shared_out("map", study["map"])[1], "FileNames": [stem + ".passages" for stem in stems]})
        UpdatePipeline(proxy=hazard)
        made = hazard.GetClientSideObject().GetOutputDataObject(0)
        error = made.GetFieldData().GetAbstractArray("Error")
        from_first_rank(lambda: error and refuse_passages(stems, error.GetValue(0)))
        tell(notes, kept_notes(made))
        further += kept_notes(made)
        writer = servermanager.writers.HazardMapWriter(Input=hazard)
        write_by(writer, os.path.join(folder, "hazard.tif"))
        cells = output(hazard).GetCellData()
        from_first_rank(lambda: write_map_styles(os.path.join(folder, "hazard.tif"), [
            cells.GetArrayName(k) for k in range(cells.GetNumberOfArrays())
            if cells.GetArray(k) and cells.GetArray(k).GetNumberOfComponents() == 1]))
    if structures:
        from_first_rank(lambda: standing.combine(study, folder, stems, structures))

    def finish():
        manifest = os.path.join(folder, MANIFEST)
        write_text(manifest, json.dumps({
            **schema.load(manifest), "notes": list(dict.fromkeys([*of_inputs, *notes, *further]))}, indent=1) + "\n")
        write_text(os.path.join(folder, RESULTS), json.dumps(
            {"iterations": iterations, "chunks": hashes,
             "whole": hashlib.sha256("".join(hashes).encode()).hexdigest()}, indent=1) + "\n")
        for name in os.listdir(folder):  # what a killed run left
            if name.startswith(wholefile.UNFINISHED) and name != wholefile.LOCK:
                os.remove(os.path.join(folder, name))

    from_first_rank(finish)
