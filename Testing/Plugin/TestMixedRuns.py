"""What does not belong together, or has no effect, is told: runs of two slopes in one line or map, a slope
that is not that of the run, frequencies of two kinds, laws and layers that nothing takes."""

import os

from helpers import messages_of, write_grid, write_text

from paraview import servermanager
from paraview.simple import (
    AppendDatasets, BarrierDesign, DEMtoCFEMesh, DispersionAngle, GroupDatasets, HazardPassageReader, MergeCollectors,
    OutputPort, RockBlocks, RockfallHazardMap, RockfallSimulation, Threshold, TrajectoryCollector)


def notes_of(source):
    source.UpdatePipeline()
    data = servermanager.Fetch(source)
    error = data.GetFieldData().GetAbstractArray("Error")
    assert not error, error.GetValue(0)
    notes = data.GetFieldData().GetAbstractArray("Notes")
    return " ".join(notes.GetValue(k) for k in range(notes.GetNumberOfValues())) if notes else ""


def slope(name, drop):
    heights = [[60 - drop * 5 * c for c in range(31)] for _ in range(21)]
    return DEMtoCFEMesh(FileName=write_grid(name, heights, (0, 0), 5, None), Preset="Meadow (field data)")


def run(ground, first=1, end=20.0, step=0.005, **rocks):
    blocks = RockBlocks(Terrain=ground, Center=[10, 50, 0], PlaceOnGround=1, Amount=3, ClusterRadius=4, **rocks)
    return RockfallSimulation(Terrain=ground, Rocks=blocks, EndTime=end, Iterations=2, FirstIteration=first,
                              TimeStep=step)


def line(fall, **more):
    return TrajectoryCollector(Input=OutputPort(fall, 1), Points=[16, 0, 0, 16, 100, 0], **more)


def passages(fall, ground, name):
    writer = servermanager.writers.HazardPassageWriter(
        Input=OutputPort(fall, 1), Terrain=ground, FileName=os.path.abspath(name), CellSize=5)
    writer.UpdatePipeline()
    return os.path.abspath(name)


steep, flat = slope("steep.asc", 0.7), slope("flat.asc", 0.6)
one, next_one, other = run(steep), run(steep, 3), run(flat, 3)
coarse = run(steep, 3, step=0.01)

# --- Two slopes, or two time steps, in one statistic.
told = "1 of 2 runs, first part 2 of the Input, fell on another slope than part 1 of the Input"
assert told not in notes_of(MergeCollectors(Input=[line(one), line(next_one)]))
assert told in notes_of(MergeCollectors(Input=[line(one), line(other)]))
steps = "with other properties than {}: TimeStep 0.01 s, not 0.005 s. Do their rocks belong together?"
assert steps.format("part 1 of the Input") in notes_of(MergeCollectors(Input=[line(one), line(coarse)]))
files = [passages(fall, ground, f"{k}.passages")
         for k, (fall, ground) in enumerate(((one, steep), (next_one, steep), (other, flat), (coarse, steep)))]
assert "belong together" not in notes_of(HazardPassageReader(FileNames=files[:2]))
assert f"1 of 2 runs, first {files[2]}, fell on another slope" in notes_of(HazardPassageReader(FileNames=[files[0], files[2]]))
assert steps.format(files[0]) in notes_of(HazardPassageReader(FileNames=[files[0], files[3]]))

# --- Other rocks under the numbers of the first ones, in further iterations: each would be one with one of those.
larger, apart = run(steep, 3, Volume=5), run(steep, 3, Volume=5, FirstBlockId=100)
told = "1 of 2 runs released other rocks under the same block ids"
for fall, alike in (larger, True), (apart, False), (next_one, False):
    name = passages(fall, steep, "further.passages")
    for notes in (notes_of(MergeCollectors(Input=[line(one), line(fall)])), notes_of(HazardPassageReader(FileNames=[files[0], name])),
                  notes_of(TrajectoryCollector(Input=GroupDatasets(Input=[OutputPort(one, 1), OutputPort(fall, 1)]),
                                              Points=[16, 0, 0, 16, 100, 0]))):
        assert (told in notes) == alike, notes

# --- The same of runs that ParaView groups or appends, and of a part of one.
def made_of(given):
    """What each filter of statistics notes."""
    return [notes_of(TrajectoryCollector(Input=given, Points=[16, 0, 0, 16, 100, 0])),
            notes_of(RockfallHazardMap(Input=given, CellSize=5)), notes_of(DispersionAngle(Input=given))]


for two, told in (((one, other), "1 of 2 runs, first part 2 of the Input, fell on another slope than part 1"),
                  ((one, coarse), steps.format("part 1 of the Input"))):
    for notes in made_of(GroupDatasets(Input=[OutputPort(fall, 1) for fall in two])):
        assert told in notes, notes
for notes in made_of(GroupDatasets(Input=[OutputPort(one, 1), OutputPort(next_one, 1)])):
    assert "belong together" not in notes and "rocks of its run" not in notes, notes
for notes in made_of(AppendDatasets(Input=[OutputPort(one, 1), OutputPort(other, 1)])):
    assert "The Input has 12 rocks, its run 6: the slope and the properties" in notes, notes
for notes in made_of(OutputPort(one, 1)):
    assert "The Input has" not in notes, notes
again = run(steep, FirstBlockId=4)
for notes in made_of(GroupDatasets(Input=[OutputPort(one, 1), OutputPort(again, 1)])):
    assert " rocks fell exactly as another one of their iteration" in notes, notes
for notes in made_of(GroupDatasets(Input=[OutputPort(one, 1), OutputPort(next_one, 1)])):
    assert "fell exactly" not in notes, notes
slow = Threshold(Input=OutputPort(one, 1), Scalars=["CELLS", "BlockId"], LowerThreshold=1, UpperThreshold=2)
for notes in made_of(slow):
    assert "The Input has 4 of the 6 rocks of its run" in notes, notes

# --- A slope that is not that of the run.
told = "fell on another slope than the Terrain"
for ground in steep, flat:
    area = RockfallHazardMap(Input=OutputPort(one, 1), Terrain=ground, CellSize=5)
    assert (told in notes_of(area)) == (ground is flat), notes_of(area)
    assert (told in notes_of(line(one, Terrain=ground))) == (ground is flat)

# --- Frequencies of the rocks, and one of all of them.
often = run(steep, AnnualFrequency=0.1)
told = "the frequencies that they have of their own are not used"
for frequency in 0, 2:
    area = RockfallHazardMap(Input=OutputPort(often, 1), CellSize=5, AnnualFrequency=frequency)
    assert (told in notes_of(area)) == (frequency > 0), notes_of(area)
    design = BarrierDesign(Input=line(often), AnnualFrequency=frequency)
    assert (told in notes_of(design)) == (frequency > 0), notes_of(design)

# --- Layers of no file.
assert 'BarrierLayerName is "nets", but has no effect: there is no BarrierFile' in \
    notes_of(DEMtoCFEMesh(BarrierLayerName="nets"))
assert 'JointField is "soil", but has no effect: there is no JointLayer' in notes_of(DEMtoCFEMesh(JointField="soil"))
assert "no effect" not in notes_of(DEMtoCFEMesh())

# --- Properties that others replace, or that nothing takes.
assert "The Preset replaces what these properties say: RestitutionCoefficient, FrictionAngle" in \
    notes_of(DEMtoCFEMesh(Preset="Meadow (field data)", FrictionAngle=50, RestitutionCoefficient=0.2))
assert "Preset replaces" not in notes_of(steep)
assert "Preset replaces" not in notes_of(
    DEMtoCFEMesh(Preset="Soil (assumed)", FrictionAngle=30)), "the preset's own number"
one.PushRocksApart, one.RockCohesion = 1, 5.0
told = messages_of(one.UpdatePipeline)
assert "RockRockContact is off, without which these have no effect: PushRocksApart, RockCohesion" in told, told


# --- Rows of sources.
def heard(columns, *rows):
    name = write_text("sources.csv", f"WKT,{columns}\n" + "".join(f"{row}\n" for row in rows))
    return messages_of(lambda: RockBlocks(Terrain=steep, FileName=name).UpdatePipeline())


point, area = '"POINT(20 50)"', '"POLYGON((-50 20,30 20,30 40,-50 20))"'
told = heard("volume,vol_law,vol_dev", f"{point},1,normal,0.2", f'"POINT(20 60)",1,,0.5')
assert "1 of 2 sources have a deviation, bounds or an exponent" in told and "first row 2: fixed" in told, told
assert "deviation" not in heard("freq_a,volume,vol_min,vol_max,vol_exp", f"{point},0.5,1,1,2,0.6")
assert "1 of 2 sources have the frequency 0" in heard("frequency", f"{point},0", f"{area},2")
told = heard("volume,vol_law,vol_dev,vol_max", f"{point},1,normal,50,")
assert "first row 1" in told and "instead of 1" in told, told
told = heard("amount", f"{point},1", f"{area},3")
assert "1 of 2 sources reach beyond the ground of the slope" in told and "first row 2" in told, told
columns = "source,source_id"
assert 'Sources "a" and "b" have one number, 1' in heard(columns, f"{point},a,1", f'"POINT(20 60)",b,1')
assert "have one n" not in heard(columns, f"{point},a,1", f'"POINT(20 60)",a,1', f'"POINT(20 70)",b,2')
apart = 'have one name, "a": tables by source count them apart'
assert f"Sources 1 and 2 {apart}" in heard(columns, f"{point},a,1", f'"POINT(20 60)",a,2')
assert f"Sources 1 and 3 {apart}" in heard("source", f"{point},a", '"POINT(20 60)",b', '"POINT(20 70)",a')

# --- A table that says more than it is given for.
classes = write_text("classes.csv", 'WKT,class\n"POLYGON((0 0,90 0,90 90,0 90,0 0))",scree\n')
table = write_text("table.csv", "class,rv,phi\nscree,0.5,35\n")
told = 'its column "phi" is read where it is the JointTable, which is not given'
alone = {"RestitutionLayer": classes, "RestitutionTable": table}
assert told in notes_of(DEMtoCFEMesh(**alone))
assert "which is not given" not in notes_of(DEMtoCFEMesh(**alone, JointLayer=classes, JointTable=table))
print("what does not belong together is told")
