"""Ground that yields in ParaView: a preset and its numbers typed, scars of impacts, and their books."""

from helpers import columns_of, incline, write_grid, write_text

from paraview import servermanager
from paraview.simple import DEMtoCFEMesh, RockBlocks, RockfallSimulation, UpdatePipeline
from vtkmodules.util.numpy_support import vtk_to_numpy

EAST, NORTH = 700000, 4000000
terrain = write_grid("incline.asc", incline(), corner=(EAST, NORTH))
rocks = RockBlocks(FileName=write_text(
    "sources.csv", "x,y,z,shape,volume\n" +
    "\n".join(f"{EAST + 25},{NORTH + 60 + 10 * k},{145 + k},{shape},{0.5 + 0.25 * k}"
              for k, shape in enumerate(["cube", "icosahedron", "eota111", "eota221"])) + "\n"))
SINKS = ("Strain", "Friction", "Restitution", "Vibration", "Damping", "Structures", "Scars", "Rolling",
         "Exchanged", "Numerical")


def fall_on(**ground):
    """Samples, impacts and summary of a fall."""
    slope = DEMtoCFEMesh(FileName=terrain, **ground)
    fall = RockfallSimulation(Terrain=slope, Rocks=rocks, EndTime=20.0, Iterations=2)
    UpdatePipeline(proxy=fall)
    samples, impacts = (servermanager.Fetch(fall, idx=port).GetPointData() for port in (1, 2))
    return samples, impacts, columns_of(servermanager.Fetch(fall, idx=3))


def column(data, name):
    return vtk_to_numpy(data.GetArray(name))


samples, impacts, summary = fall_on(Preset="Meadow (field data)")
depths, lengths = column(impacts, "ScarDepth"), column(impacts, "ScarLength")
assert (depths > 0.0).mean() > 0.5 and depths.max() < 1.0, depths
assert all(lengths[depths > 0.0] > 0.0) and not lengths[depths == 0.0].any(), lengths
for loss, total in (("ScarLoss", "EnergyScars"), ("RollingLoss", "EnergyRolling")):
    assert all(value > 0.0 for value in summary[total]), summary[total]
    assert column(samples, loss).max() == max(summary[total]), loss
for row, released in enumerate(summary["EnergyReleased"]):
    booked = sum(summary[f"Energy{sink}"][row] for sink in ("Kinetic", *SINKS))
    assert abs(booked - released) < 1e-9 * released, (booked, released)
    assert abs(summary["EnergyNumerical"][row]) < 1e-3 * released, summary["EnergyNumerical"]

# The preset's numbers, typed.
_, _, typed = fall_on(
    RestitutionModel="Speed-dependent", RestitutionCoefficient=0.73, RestitutionDeviation=0.34,
    RestitutionSpeed=7, FrictionAngle=30, FrictionAngleDeviation=3, DeviationPer="Impact",
    RoughnessMean=0, RoughnessDeviation=0.1, RoughnessLength=2, GroundModulus=13,
    ScarDepthFactor=0.125, ScarCompaction=0.45,
    SlipFrictionMin=0.98, SlipFrictionMax=2, SlipFrictionGrowth=3, SlipFrictionDecay=185,
    RollingResistance=0.18, GroundDeviation=0.1, GroundDeviationLength=30)
assert typed == summary, (typed, summary)

# Hard ground digs nothing.
_, impacts, hard = fall_on(RestitutionCoefficient=0.7)
assert not column(impacts, "ScarDepth").any() and not any(hard["EnergyScars"] + hard["EnergyRolling"])
