"""Data sets, polygons and lists that ParaView and cadastres give in another form than was thought of:
taken as they are meant, or one message."""

import os
import sys

from helpers import columns_of, delete_sources, errors_of, messages_of, write_text

from paraview import servermanager
from paraview.simple import (
    AppendDatasets, AppendGeometry, Box, DEMtoCFEMesh, DispersionAngle, DrawnStructure, GroupDatasets, GrowingPaths,
    MergeBlocks, OutputPort, Plane, RockBlocks, RockfallHazardMap, RockfallSimulation, RockRelease,
    SaveData, TemporalInterpolator, Threshold, TrajectoryCollector, TrajectoryProfile, UpdatePipeline, Wavelet)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Examples"))
import rockfall_view  # noqa: E402


def fetch(source, port=0):
    return servermanager.Fetch(source, idx=port)


def notes_of(data):
    notes = data.GetFieldData().GetAbstractArray("Notes")
    return [notes.GetValue(k) for k in range(notes.GetNumberOfValues())] if notes else []


def all_of(source, name):
    return Threshold(Input=source, Scalars=["CELLS", name], LowerThreshold=-1, UpperThreshold=1e9)


slope = DEMtoCFEMesh(RoughnessDeviation=0, FrictionAngle=25)
blocks = RockBlocks(Terrain=slope, Amount=2, ClusterRadius=5, PlaceOnGround=1, Center=[5, 50, 0])
fall = RockfallSimulation(Terrain=slope, Rocks=blocks, EndTime=18, Iterations=2)  # none has come to rest
paths = OutputPort(fall, 1)


# --- Unstructured grids of polylines, in every filter of trajectories.

def results(given):
    """What each filter makes of trajectories, as sizes and numbers."""
    made = []
    area = RockfallHazardMap(Input=given)
    area.UpdatePipeline()
    made.append(fetch(area).GetCellData().GetArray("Rocks").GetRange())
    made.append(fetch(area).GetNumberOfCells())
    line = TrajectoryCollector(Input=given, Points=[60, 0, 0, 60, 100, 0])
    line.UpdatePipeline()
    made.append(columns_of(fetch(line, 1)))
    for maker in DispersionAngle, TrajectoryProfile, GrowingPaths:
        source = maker(Input=given)
        source.UpdatePipeline()
        data = fetch(source)
        made.append(data.GetNumberOfRows() if data.IsA("vtkTable") else data.GetNumberOfCells())
    return repr(made)


expected = results(paths)
assert "nan" not in expected.split("}")[0].split("Share")[0], expected
for grid in all_of(paths, "Iteration"), MergeBlocks(Input=GroupDatasets(Input=[paths])), \
        AppendDatasets(Input=[paths]), GroupDatasets(Input=[all_of(paths, "Iteration")]):
    made = results(grid)
    assert made == expected, (made, expected)
SaveData("paths.gpkg", proxy=all_of(paths, "Iteration"))
assert os.path.getsize("paths.gpkg") > 0
some = TrajectoryCollector(Points=[60, 0, 0, 60, 100, 0], Input=Threshold(
    Input=paths, Scalars=["CELLS", "Iteration"], LowerThreshold=1, UpperThreshold=1))
some.UpdatePipeline()
assert columns_of(fetch(some, 1))["Rocks"] == [2], columns_of(fetch(some, 1))
# Blocks by a value of their cells, as polygons of a grid.
one = RockfallSimulation(Terrain=slope, EndTime=20, Rocks=Threshold(
    Input=blocks, Scalars=["CELLS", "BlockId"], LowerThreshold=2, UpperThreshold=2))
one.UpdatePipeline()
assert columns_of(fetch(one, 3))["BlockId"] == [2], columns_of(fetch(one, 3))
# Cells that are neither points, lines nor polygons.
solid = RockfallHazardMap(Input=AppendDatasets(Input=[Wavelet(WholeExtent=[0, 2] * 3)]))
errors = errors_of(solid)
assert len(errors) == 1 and "cell 0" in errors[0] and "vtkVoxel" in errors[0], errors

# A run that is there twice counts for two in nothing.
for maker in DispersionAngle, RockfallHazardMap, TrajectoryCollector:
    errors = errors_of(maker(Input=AppendDatasets(Input=[paths, paths])))
    assert len(errors) == 1 and "there twice" in errors[0], (maker, errors)

# --- Polygons for the line.

road = "60 -10,60 110,67 110,67 -10,60 -10"
write_text("road.csv", f'WKT,name\n"POLYGON(({road}))",road\n')
write_text("edges.csv", 'WKT,name\n"LINESTRING(60 -10,60 110)",in\n"LINESTRING(67 -10,67 110)",out\n')


def line_of(name):
    collector = TrajectoryCollector(Input=paths, FileName=name)
    collector.UpdatePipeline()
    # What few rocks can say, and that lines go on beyond the slope, is told as well, by other tests.
    notes = [note for note in notes_of(fetch(collector))
             if "Too few rocks" not in note and "lines go on where the slope has no ground" not in note]
    return columns_of(fetch(collector, 1)), notes


rows, notes = line_of("road.csv")
edges, none = line_of("edges.csv")
assert rows["Rocks"] == edges["Rocks"][:1] and edges["Rocks"][0] > 0, (rows, edges)
assert rows["Passings"] == [sum(edges["Passings"])], (rows, edges)
assert rows["KineticEnergyMean"] == edges["KineticEnergyMean"][:1], (rows, edges)
assert len(notes) == 1 and "road.csv: 1 polygon is taken as its outline" in notes[0], notes
assert none == [], none
# A courtyard is inside the house; both parts of a farm are lines of their own.
write_text("farm.csv", 'WKT,name\n"MULTIPOLYGON((({0}),(62 10,62 90,65 90,65 10,62 10)),'
           '((80 0,80 100,85 100,85 0,80 0)))",farm\n'.format(road))
farm, notes = line_of("farm.csv")
assert farm["LineName"] == ["farm", "farm (2)"] and farm["Passings"][0] == rows["Passings"][0], farm
assert "2 polygons" in notes[0], notes
# Lines and polygons in one layer; polygons of a source in the pipeline.
write_text("both.csv", f'WKT,name\n"POLYGON(({road}))",road\n"LINESTRING(60 -10,60 110)",in\n')
both, _ = line_of("both.csv")
assert both["LineName"] == ["road", "in"] and both["Rocks"] == rows["Rocks"] * 2, both
face = Plane(Origin=[60, -10, 0], Point1=[60, 110, 0], Point2=[67, -10, 0], XResolution=1, YResolution=1)
drawn = TrajectoryCollector(Input=paths, Lines=face)
drawn.UpdatePipeline()
assert columns_of(fetch(drawn, 1))["Passings"] == rows["Passings"], columns_of(fetch(drawn, 1))

# --- Lists of numbers that are no points.

for proxy, numbers in ((RockRelease(Terrain=slope, Points=[1, 2]), 2),
                       (RockRelease(Terrain=slope, Points=[5, 45, 58, 15]), 4),
                       (DrawnStructure(Terrain=slope, Points=[70, 1, 0, 70, 99]), 5),
                       (TrajectoryCollector(Input=paths, Points=[60, 0]), 2)):
    errors = errors_of(proxy)
    assert len(errors) == 1 and f"Points has {numbers} numbers" in errors[0], errors
proxy = RockRelease(Terrain=slope, Points=[5, 45, 58, 15, 45, 58])
proxy.UpdatePipeline()
placed = fetch(proxy).GetNumberOfCells()
assert placed == 60 and len(proxy.Points) == 6, (placed, proxy.Points)

# --- Names of a script that uses the filters of the examples.

source, e, any_of = fall, 0.8, any
before = set(globals())
halved = rockfall_view.python_filter(
    OutputPort(fall, 0), "halved", lambda data: rockfall_view.rock_points(data)[0] * 0.5)
for time in 0.0, 1.0:
    halved.UpdatePipeline(time)
    assert fetch(halved).GetBounds() == tuple(0.5 * x for x in fetch(fall).GetBounds()), time
assert source is fall and e == 0.8 and any is any_of, (source, e, any)
assert set(globals()) - before <= {"halved", "time", "before"}, set(globals()) - before

# --- A run that goes on from the time at which another one is shown.

first = RockfallSimulation(Terrain=slope, EndTime=20, OutputInterval=0.1, Rocks=RockBlocks(
    Terrain=slope, Center=[5, 50, 80], AttitudeLaw="As given", Velocity=[3, 1, 0]))
fallen = 80 - 4.905 * 0.6**2  # m, in free flight


def start_of(run):
    return columns_of(fetch(run, 3))["StartZ"][0]


first.UpdatePipeline(0.6)
on = RockfallSimulation(Terrain=slope, Rocks=OutputPort(first, 0), EndTime=20)
told = messages_of(lambda: on.UpdatePipeline(5))
assert abs(start_of(on) - fallen) < 1e-6 and "at 0.6 s" in told, (start_of(on), told)
first.UpdatePipeline(2.0)  # an animation that goes on
on.UpdatePipeline(7)
assert abs(start_of(on) - fallen) < 1e-6, start_of(on)
asked = RockfallSimulation(Terrain=slope, EndTime=20, Rocks=OutputPort(RockfallSimulation(
    Terrain=slope, EndTime=20, Rocks=first.Rocks), 0))
asked.UpdatePipeline(0.6)  # nothing was shown before
assert abs(start_of(asked) - fallen) < 1e-6, start_of(asked)

# --- Blocks without cell arrays: a note names what is taken.

told = messages_of(lambda: RockfallSimulation(
    Terrain=slope, Rocks=Box(Center=[5, 50, 60]), EndTime=1).UpdatePipeline())
assert "no cell arrays BlockId, Density" in told and "2500 kg/m³" in told, told
told = messages_of(lambda: RockfallSimulation(Terrain=slope, Rocks=first.Rocks, EndTime=1).UpdatePipeline())
assert "no cell arrays" not in told, told

# --- Moving rocks through ParaView's interpolator in time, which takes text on cells for numbers and
# ends ParaView; and back again with their names.

delete_sources()
slope = DEMtoCFEMesh(RoughnessDeviation=0, FrictionAngle=25)
named = RockBlocks(Center=[5, 50, 80], AttitudeLaw="As given", SourceName="cliff", MaterialName="slag")
fall = RockfallSimulation(Terrain=slope, Rocks=named, EndTime=2, OutputInterval=0.1)
between = TemporalInterpolator(Input=OutputPort(fall, 0))
for time in 0.1, 0.25, 0.3:
    UpdatePipeline(time, between)
    assert fetch(between).GetNumberOfCells() == 6, time
fall.UpdatePipeline(0.3)
rocks = fetch(fall)
height = rocks.GetBounds()[4]
UpdatePipeline(0.3, between)
assert abs(fetch(between).GetBounds()[4] - height) < 1e-9, (fetch(between).GetBounds(), height)
for data in rocks.GetCellData(), rocks.GetPointData():
    for k in range(data.GetNumberOfArrays()):
        assert data.GetArray(k), data.GetAbstractArray(k).GetName()
again = RockfallSimulation(Terrain=slope, Rocks=OutputPort(fall, 0), EndTime=2)
again.UpdatePipeline(0.3)
assert columns_of(fetch(again, 3))["SourceName"] == ["cliff"], columns_of(fetch(again, 3))
assert fetch(again).GetFieldData().GetAbstractArray("Material").GetValue(0) == "slag"
# Appended, only the first ones have names: a note tells.
more = RockBlocks(Center=[5, 60, 80], FirstBlockId=7, SourceName="scree")
both = AppendGeometry(Input=[OutputPort(fall, 0), more])
mixed = RockfallSimulation(Terrain=slope, Rocks=both, EndTime=2)
text = messages_of(lambda: mixed.UpdatePipeline(0.3))
assert "NamedBlock" in text and "1 of 2 blocks" in text, text
assert columns_of(fetch(mixed, 3))["SourceName"] == ["cliff", "source 1"], columns_of(fetch(mixed, 3))
