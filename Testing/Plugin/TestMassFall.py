"""The mass fall of Examples/mass_fall.py in one iteration: the paper's rocks, more of them on the road
where they collide than where they do not, and fewer with the embankment."""

import os
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path[:0] = [os.path.join(ROOT, "Examples", "mass_fall_parts")]

import scenario
from counts import interval
from helpers import columns_of

from paraview import servermanager
from paraview.simple import DEMtoCFEMesh, RockBlocks, RockfallSimulation, UpdatePipeline

# The rocks: number, volumes, mass, as published.
volumes = scenario.volumes()
assert len(volumes) == scenario.ROCKS == 41
assert abs(volumes.sum() - 25.6) < 1e-9 and abs(volumes.min() - 0.17) < 1e-12 and abs(volumes.max() - 1.33) < 1e-12
assert abs(volumes.sum() * scenario.DENSITY - 63957.0) < 1e-6

# Counts of one value have no width, those of two iterations the width between them.
assert interval([3, 3, 3]) == (3.0, 3.0, 3.0)
assert interval([0, 2]) == (1.0, 0.0, 2.0)

# The rocks of one iteration push each other: their number on the road differs by 6 from one to the next.
# More of them on it if they collide: that takes the 20 of the full form.
FULL = os.environ.get("ROCKFALL_VERIFICATION") == "full"
ITERATIONS = 20 if FULL else 3


def run(slope, rocks, collide):
    fall = RockfallSimulation(Terrain=slope, Rocks=rocks, RockRockContact=collide, TimeStep=0.01, EndTime=30.0,
                              Iterations=ITERATIONS, Seed=20143, TrajectoryOutput="Stopping points",
                              OutputInterval=1.0)
    UpdatePipeline(proxy=fall)
    table = columns_of(servermanager.Fetch(fall, idx=3))
    others = servermanager.Fetch(fall, idx=2).GetPointData().GetArray("OtherRockId")
    met = sum(others.GetValue(k) >= 0 for k in range(others.GetNumberOfTuples()))
    # Nothing comes from nowhere: damping and numerics give no more than a thousandth.
    given = -sum(table["EnergyDamping"]) - sum(table["EnergyNumerical"])
    assert given < 1e-3 * sum(table["EnergyReleased"]), given
    road = sum(x >= scenario.ROAD[0] for x in table["StopX"]) / ITERATIONS
    print(f"collide {collide}: {road} on the road, {met} impacts between rocks")
    return table, road, met


def slope_of(name, bank):
    return DEMtoCFEMesh(FileName=scenario.write_grid(os.path.abspath(name), bank),
                        RestitutionCoefficient=scenario.RESTITUTION,
                        RestitutionDeviation=scenario.RESTITUTION_DEVIATION, FrictionAngle=scenario.FRICTION,
                        FrictionAngleDeviation=scenario.FRICTION_DEVIATION, RoughnessMean=0, RoughnessDeviation=0)


slope = slope_of("slope.asc", False)
rocks = RockBlocks(Terrain=slope, AttitudeLaw="As given", FileName=scenario.write_rocks(os.path.abspath("rocks.csv")))
table, alone, met = run(slope, rocks, 0)
assert len(table["Volume"]) == 41 * ITERATIONS and met == 0
assert abs(sum(table["Mass"][:41]) - 63957.0) < 0.1 and abs(sum(table["Volume"][:41]) - 25.6) < 1e-4
table, together, met = run(slope, rocks, 1)
assert met > 5 * ITERATIONS, met
assert together != alone and (together > alone or not FULL), (together, alone)
_, stopped, _ = run(slope_of("bank.asc", True), rocks, 0)
assert stopped < alone - 20, (stopped, alone)
print("the mass fall is as it should be")
