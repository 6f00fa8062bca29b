"""Sources of many rocks in ParaView: clusters and rock masses cut by joint sets, and their bad input."""

import math

from helpers import columns_of, errors_of, is_empty, messages_of, write_text

from paraview import servermanager
from paraview.simple import (AppendGeometry, DEMtoCFEMesh, Delete, JointedRockMass, Plane, PLYReader, RockBlocks,
                             RockfallSimulation, UpdatePipeline)


def fetch(proxy, port=0):
    UpdatePipeline(proxy=proxy)
    return servermanager.Fetch(proxy, idx=port)


def per_block(data, name):
    """{BlockId: value} of a cell array."""
    ids, values = data.GetCellData().GetArray("BlockId"), data.GetCellData().GetArray(name)
    return {int(ids.GetValue(k)): values.GetTuple(k) for k in range(data.GetNumberOfCells())}


def expect_error(what, words, proxy):
    errors = errors_of(proxy)
    assert len(errors) == 1, (what, errors)
    for word in words:
        assert word in errors[0], (what, word, errors[0])
    assert is_empty(proxy), what
    print(f"{what}: {errors[0]}")
    Delete(proxy)


# The default mass: 27 cubes of 1 m³, in world coordinates.
mass = JointedRockMass(Density=2600, FirstBlockId=5, SourceName="cliff", SourceId=3)
blocks = fetch(mass)
volumes = per_block(blocks, "Volume")
assert sorted(volumes) == list(range(5, 32)), sorted(volumes)
assert all(abs(v[0] - 1.0) < 1e-12 for v in volumes.values()), volumes
assert set(per_block(blocks, "Density").values()) == {(2600.0,)}
assert set(per_block(blocks, "SourceId").values()) == {(3.0,)}
names = blocks.GetCellData().GetAbstractArray("SourceName")
assert {names.GetValue(k) for k in range(names.GetNumberOfValues())} == {"cliff"}
assert max(abs(a - b) for a, b in zip(blocks.GetBounds(), (3.5, 6.5, 48.5, 51.5, 56.5, 59.5))) < 1e-12
Delete(mass)

# A surface from a file, on the ground; slivers are left out, with their number and volume.
octahedron = """ply
format ascii 1.0
element vertex 6
property float x
property float y
property float z
element face 8
property list uchar int vertex_indices
end_header
2 0 0
-2 0 0
0 2 0
0 -2 0
0 0 2
0 0 -2
3 0 2 4
3 2 1 4
3 1 3 4
3 3 0 4
3 2 0 5
3 1 2 5
3 3 1 5
3 0 3 5
"""
name = write_text("octahedron.ply", octahedron)
sets = [35, 120, 0.9, 0, 0, 0, 80, 215, 1.1, 0.2, 0.2, 3]
mass = JointedRockMass(MassShape="From File", MassFileName=name, JointSets=sets, Slivers="Keep")
whole = 4 / 3 * 2**3
kept = fetch(mass)
assert abs(sum(v[0] for v in per_block(kept, "Volume").values()) - whole) < 1e-6 * whole
# By pipeline it is the same mass.
reader = PLYReader(FileNames=[name])
piped = fetch(JointedRockMass(MassShape="From File", ShapeInput=reader, JointSets=sets, Slivers="Keep"))
assert per_block(piped, "Volume") == per_block(kept, "Volume")
mass.Slivers, mass.MinimumVolume = "Drop", 0.1
note = messages_of(lambda: UpdatePipeline(proxy=mass))
dropped = fetch(mass)
count = int(dropped.GetFieldData().GetArray("SliverCount").GetValue(0))
left_out = dropped.GetFieldData().GetArray("SliverVolume").GetValue(0)
assert count > 0 and f"{count} slivers" in note and "left out" in note, note
total = sum(v[0] for v in per_block(dropped, "Volume").values())
assert abs(total + left_out - whole) < 1e-6 * whole, (total, left_out)  # single precision in the file
Delete(mass)

# The whole as it stands on the slope: all blocks fall together, and none is refused as overlapping.
slope = DEMtoCFEMesh(FrictionAngle=20, RestitutionDeviation=0, RoughnessMean=0, RoughnessDeviation=0)
mass = JointedRockMass(Terrain=slope, PlaceOnGround=1, Center=[40, 50, 0], Orientation=[0, 30, 0],
                       JointSets=[30, 90, 1.0, 0.5, 0, 0, 60, 270, 1.0, 0.5, 0, 0])
assert len(per_block(fetch(mass), "Volume")) == 9
fall = RockfallSimulation(Terrain=slope, Rocks=mass, RockRockContact=1, EndTime=0.5)
table = columns_of(fetch(fall, 3))
assert len(table["BlockId"]) == 9 and max(table["RunOut"]) > 0.05, table["RunOut"]
for proxy in (fall, mass):
    Delete(proxy)

expect_error("no set", ["JointSets is empty"], JointedRockMass(JointSets=[]))
expect_error("cuts nothing", ["joint set 1", "spacing 9 m", "cuts nothing", "3 m wide"],
             JointedRockMass(JointSets=[0, 0, 9, 4, 0, 0]))
expect_error("slivers", ["slivers", "0.005", "(5, 50, 59.4975)", "Slivers"],
             JointedRockMass(JointSets=[0, 0, 2, 1.495, 0, 0]))
expect_error("parallel", ["joint set 1", "joint set 2", "parallel"],
             JointedRockMass(JointSets=[40, 30, 1, 0, 0, 0, 40.1, 30, 0.7, 0, 0, 0]))
expect_error("zero spacing", ["joint set 1", "spacing is 0 m"], JointedRockMass(JointSets=[0, 0, 0, 0, 0, 0]))
expect_error("NaN", ["joint set 1", "dip is nan"], JointedRockMass(JointSets=[math.nan, 0, 1, 0, 0, 0]))
expect_error("a million by mistake", ["1030301 blocks", "MaximumRocks", "8.3 GB"],
             JointedRockMass(JointSets=[0, 0, 0.03, 0, 0, 0, 90, 0, 0.03, 0, 0, 0, 90, 90, 0.03, 0, 0, 0]))
expect_error("no file", ["MassFileName is empty"], JointedRockMass(MassShape="From File"))
expect_error("missing file", ["/no/such.ply"], JointedRockMass(MassShape="From File", MassFileName="/no/such.ply"))
# The tip of the octahedron pushed in.
dent = write_text("dent.ply", octahedron.replace("0 0 2\n", "0 0 -0.5\n", 1))
expect_error("not convex", [dent, "not convex", "must be convex"],
             JointedRockMass(MassShape="From File", MassFileName=dent))
expect_error("length", ["box", "-1"], JointedRockMass(Lengths=[3, -1, 3]))
expect_error("no terrain", ["PlaceOnGround", "Terrain"], JointedRockMass(PlaceOnGround=1))
expect_error("off the terrain", ["outside the slope"],
             JointedRockMass(Terrain=slope, PlaceOnGround=1, Center=[-50, 50, 0]))
expect_error("not a terrain", ["Terrain"], JointedRockMass(Terrain=Plane()))
expect_error("material", ["Material is 9"], JointedRockMass(Material=9))
expect_error("density", ["Density is -1"], JointedRockMass(Density=-1))

# A cluster: of a total volume, in a disc over the ground, each in its attitude, none in another one.
rocks = RockBlocks(Terrain=slope, PlaceOnGround=1, Center=[20, 50, 0], ClusterRadius=6, TotalVolume=12,
                   VolumeLaw="Power law", VolumeMinimum=0.1, VolumeMaximum=1.5, RandomOrientation=1,
                   KeepApart=1, Seed=3)
cluster = fetch(rocks)
volumes = [v[0] for v in per_block(cluster, "Volume").values()]
assert len(volumes) > 10 and abs(sum(volumes) - 12) < 0.75, (len(volumes), sum(volumes))  # half of the largest
fall = RockfallSimulation(Terrain=slope, Rocks=rocks, RockRockContact=1, EndTime=0.2)
table = columns_of(fetch(fall, 3))
away = [math.hypot(x - 20, y - 50) for x, y in zip(table["StartX"], table["StartY"])]
assert len(away) == len(volumes) and 3 < max(away) <= 6, max(away)
# Without keeping them apart the same are in each other; pushing tells how many it moved.
rocks.KeepApart = 0
expect_error("overlap", ["overlap at the start, by", "PushRocksApart"], fall)
fall = RockfallSimulation(Terrain=slope, Rocks=rocks, RockRockContact=1, PushRocksApart=1, EndTime=0.2)
note = messages_of(lambda: UpdatePipeline(proxy=fall))
assert "PushRocksApart moved" in note and f"of {len(volumes)} blocks" in note, note
assert "in 1 of 1 iterations" in note, note
Delete(fall)
Delete(rocks)
# Drawn anew in each iteration: the note is about all of them, also if nothing is moved in the first one.
rocks = RockBlocks(Terrain=slope, PlaceOnGround=1, Center=[20, 50, 0], ClusterRadius=2, Amount=4, KeepApart=1,
                   Volume=0.5, HorizontalDeviation=1, Seed=3)
fall = RockfallSimulation(Terrain=slope, Rocks=rocks, RockRockContact=1, PushRocksApart=1, EndTime=0.05, Iterations=30)
note = messages_of(lambda: UpdatePipeline(proxy=fall))
assert "PushRocksApart moved up to " in note and "of 4 blocks" in note and "of 30 iterations" in note, note
assert "in 0 of" not in note, note
Delete(fall)
Delete(rocks)

expect_error("no room", ["KeepApart", "no room for block", "ClusterRadius above 1 m"],
             RockBlocks(Amount=30, ClusterRadius=1, KeepApart=1))
expect_error("one place", ["KeepApart", "ClusterRadius is 0"], RockBlocks(Amount=2, KeepApart=1))
expect_error("cluster radius", ["ClusterRadius is -1"], RockBlocks(ClusterRadius=-1))
expect_error("total volume", ["TotalVolume is nan"], RockBlocks(TotalVolume=math.nan))
expect_error("both", ["TotalVolume", "Intensity"], RockBlocks(TotalVolume=1, Intensity=1))
expect_error("too many", ["TotalVolume is 50 m³", "10 rocks"], RockBlocks(TotalVolume=50, MaximumRocks=10))
expect_error("steep", ["KeepApart", "SlopeThreshold"], RockBlocks(Terrain=slope, SlopeThreshold=20, KeepApart=1))

# The same rock twice.
twice = AppendGeometry(Input=[RockBlocks(FirstBlockId=1, AttitudeLaw="As given"),
                              RockBlocks(FirstBlockId=2, AttitudeLaw="As given")])
expect_error("the same rock twice", ["block 1 at", "block 2", "the same rock twice"],
             RockfallSimulation(Terrain=slope, Rocks=twice, RockRockContact=1, EndTime=0.1))
print("clusters and rock masses are as they should be")
