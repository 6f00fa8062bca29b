"""Rocks that break into pieces: books of mass and energy, maps and lines that count a rock once, blocks
that are shown, runs on ranks, and errors."""

import math
import os
import shutil
import subprocess
import sys

from helpers import columns_of, errors_of, messages_of, outside_mpi

from paraview import servermanager
from paraview.simple import (
    BarrierDesign, Delete, DEMtoCFEMesh, OutputPort, RockBlocks, RockfallHazardMap, RockfallSimulation,
    TrajectoryCollector, UpdatePipeline)

LAW = {"Fragmentation": 1, "FragmentationEnergy": 60e3, "FractalDimension": 2.0, "LeastFragment": 0.02,
       "FragmentSpread": 20, "FragmentationLoss": 0.1}


def fall_of(**law):
    slope = DEMtoCFEMesh(RestitutionCoefficient=0.6, FrictionAngle=25, RoughnessDeviation=0.1)
    rocks = RockBlocks(Terrain=slope, Center=[12, 50, 75], ClusterRadius=6, Amount=4, Volume=2.0,
                       KeepApart=1)
    return RockfallSimulation(Terrain=slope, Rocks=rocks, EndTime=15, Iterations=3, **law)


def check():
    fall = fall_of(**LAW)
    said = messages_of(lambda: UpdatePipeline(15.0, fall))
    assert "rocks broke in impacts of 60000 J/m³ or more" in said, said
    table = columns_of(servermanager.Fetch(fall, idx=3))
    rows = [dict(zip(table, row)) for row in zip(*table.values())]
    wholes = [row for row in rows if row["Piece"] == 0]
    assert len(wholes) == 12 and len(rows) > 24, len(rows)
    for whole in wholes:
        pieces = [row for row in rows if row["Piece"] > 0 and
                  (row["RockId"], row["Iteration"]) == (whole["RockId"], whole["Iteration"])]
        assert (whole["Fate"] == "broken") == bool(pieces)
        family = [whole] + pieces
        assert sum(row["Pieces"] for row in family) == len(pieces)
        # What does not break any more, and fines, are the rock.
        rest = sum(row["Mass"] for row in family if row["Fate"] != "broken") + sum(row["FinesMass"] for row in family)
        assert math.isclose(rest, whole["Mass"], rel_tol=1e-9), (rest, whole["Mass"])
        for row in family:
            parts = sum(row[name] for name in table if name.startswith("Energy") and name != "EnergyReleased")
            assert math.isclose(parts, row["EnergyReleased"], rel_tol=1e-9, abs_tol=1.0), row
            assert (row["EnergyBreaking"] > 0) == (row["Fate"] == "broken"), row
    assert any(row["Fate"] == "broken" for row in rows if row["Piece"] > 0), "no piece broke again"

    # At the end every piece that is there stands with the volume that it has; at the start only whole rocks.
    shown = servermanager.Fetch(fall, idx=0).GetCellData()
    volumes = {(shown.GetArray("RockId").GetValue(k), shown.GetArray("Piece").GetValue(k)):
               shown.GetArray("Volume").GetValue(k) for k in range(shown.GetNumberOfTuples())}
    left = {(row["RockId"], row["Piece"]): row["Volume"]
            for row in rows if row["Iteration"] == 0 and row["Fate"] != "broken"}
    assert volumes.keys() == left.keys() and all(math.isclose(volumes[k], left[k], rel_tol=1e-6) for k in left)
    UpdatePipeline(0.1, fall)  # of 0.0 ParaView makes no time
    at_start = servermanager.Fetch(fall, idx=0).GetCellData().GetArray("Piece")
    assert at_start.GetRange() == (0.0, 0.0), (at_start.GetRange(), at_start.GetNumberOfTuples())

    # A rock counts once in a cell and at a line, as often as its pieces come.
    paths = OutputPort(fall, 1)
    hazard = RockfallHazardMap(Input=paths, CellSize=10)
    UpdatePipeline(proxy=hazard)
    data = servermanager.Fetch(hazard)
    assert data.GetFieldData().GetArray("RocksReleased").GetValue(0) == 12
    cells = data.GetPointData() if data.GetPointData().GetArray("ReachProbability") else data.GetCellData()
    reach = cells.GetArray("ReachProbability")
    assert 0.5 < reach.GetRange()[1] <= 1.0, reach.GetRange()
    rocks_in = cells.GetArray("Rocks") or cells.GetArray("RockCount")
    assert rocks_in is None or rocks_in.GetRange()[1] <= 12
    collector = TrajectoryCollector(Input=paths, Points=[60, 0, 0, 60, 100, 0])
    UpdatePipeline(proxy=collector)
    lines = columns_of(servermanager.Fetch(collector, idx=1))
    crossings = servermanager.Fetch(collector, idx=0).GetPointData()
    first = [k for k in range(crossings.GetNumberOfTuples()) if crossings.GetArray("Passing").GetValue(k) == 0]
    passed = {(crossings.GetArray("RockId").GetValue(k), crossings.GetArray("Iteration").GetValue(k)) for k in first}
    assert lines["Rocks"][0] == len(passed) < len(first), (lines["Rocks"], len(passed), len(first))
    assert math.isclose(lines["Share"][0], len(passed) / 12) and lines["Share"][0] <= 1.0
    design = BarrierDesign(Input=collector)
    UpdatePipeline(proxy=design)
    designed = columns_of(servermanager.Fetch(design, idx=0))
    energies = [crossings.GetArray("KineticEnergy").GetValue(k) for k in first]
    assert designed["Rocks"][-1] == len(passed)
    assert math.isclose(designed["EnergyInKilojoules"][-1], max(energies) / 1e3)

    # On two ranks the same bits come together in the same order.
    fall.UpdatePropertyInformation()
    mpiexec = shutil.which("mpiexec")
    if mpiexec:
        done = subprocess.run([mpiexec, "-n", "2", "--oversubscribe", "--bind-to", "none", "pvbatch", "--sym",
                               os.path.abspath(__file__), "rank"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, timeout=200, env=outside_mpi())
        assert done.returncode == 0 and "HASH " + fall.GetPropertyValue("StateHash") in done.stdout, done.stdout

    # The three numbers must be typed; without the law a run is what it was, and has no further arrays.
    for name, word in (("FragmentationEnergy", "J/m³"), ("FractalDimension", "less than 3"), ("LeastFragment", "m³")):
        bad = fall_of(**{**LAW, name: 0})
        errors = errors_of(bad)
        assert len(errors) == 1 and name + " is 0" in errors[0] and word in errors[0], errors
        Delete(bad)
    plain = fall_of()
    UpdatePipeline(proxy=plain)
    table = columns_of(servermanager.Fetch(plain, idx=3))
    assert "Piece" not in table and "EnergyBreaking" not in table and len(table["Fate"]) == 12


if "rank" in sys.argv:  # one of several
    fall = fall_of(**LAW)
    UpdatePipeline(proxy=fall)
    fall.UpdatePropertyInformation()
    print("HASH", fall.GetPropertyValue("StateHash"), flush=True)
else:
    check()
