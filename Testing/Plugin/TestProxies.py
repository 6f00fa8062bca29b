"""The plugin loads, and has the names that scripts rely on."""

import pydoc

from paraview import servermanager, simple

# label, name in Python, group, properties that scripts rely on
PROXIES = [
    ("DEM to CFE Mesh", "DEMtoCFEMesh", "sources",
     "FileName CellSize RestitutionModel RestitutionCoefficient RestitutionDeviation "
     "TangentialRestitution RestitutionSpeed FrictionAngle "
     "FrictionAngleDeviation Cohesion RoughnessMean RoughnessDeviation GroundModulus "
     "ScarDepthFactor ScarRadius GroundDensity ScarCompaction ScarSpinDrag SlipFrictionMin SlipFrictionMax "
     "SlipFrictionGrowth SlipFrictionDecay RollingResistance GroundDeviation GroundDeviationLength"),
    ("Rock Blocks", "RockBlocks", "sources",
     "Shape Volume Center Orientation Velocity AngularVelocity Density YoungModulus PoissonRatio "
     "FileName Terrain Amount Intensity SlopeThreshold ShapeMix VolumeLaw Material TotalVolume "
     "ClusterRadius KeepApart RandomOrientation MaterialName AnnualFrequency FrequencyPerHectare "
     "PowerLawFrequency"),
    ("Rock Release", "RockRelease", "filters", "Terrain Draw Points Amount Shape Volume"),
    ("Drawn Structure", "DrawnStructure", "filters", "Terrain Kind Points Height Capacity"),
    ("Jointed Rock Mass", "JointedRockMass", "sources",
     "Terrain MassShape Center Lengths Orientation MassFileName JointSets Slivers MinimumThickness "
     "MinimumVolume MaximumRocks Seed PlaceOnGround Density"),
    ("Rockfall Simulation", "RockfallSimulation", "filters",
     "Terrain Rocks TimeStep EndTime NormalPenalty Iterations Seed OutputInterval RockRockContact "
     "PushRocksApart RockContactFile"),
    ("Dispersion Angle", "DispersionAngle", "filters",
     "Input Direction Length GroupBy ClassLimits"),
    ("Rockfall Hazard Map", "RockfallHazardMap", "filters", "Input Terrain CellSize"),
    ("Trajectory Collector", "TrajectoryCollector", "filters",
     "Input Lines FileName Points BarrierHeight BarrierCapacity"),
    ("Growing Paths", "GrowingPaths", "filters", "Input"),
    ("Trajectory Profile", "TrajectoryProfile", "filters", "Input Trajectory"),
    ("Hazard Passage Reader", "HazardPassageReader", "sources", "FileNames"),
    ("Merge Collectors", "MergeCollectors", "filters", "Input"),
    ("Barrier Design", "BarrierDesign", "filters",
     "Input AnnualFrequency FactorSet TrajectoryFactor BarrierFactor Freeboard DesignMass"),
]

dem = simple.DEMtoCFEMesh()
rocks = simple.RockBlocks()
release = simple.RockRelease(Terrain=dem)
structure = simple.DrawnStructure(Terrain=dem)
mass = simple.JointedRockMass()
simulation = simple.RockfallSimulation(Terrain=dem, Rocks=rocks)
simulation.EndTime = 1.0
dispersion = simple.DispersionAngle(Input=simple.OutputPort(simulation, 1))
hazard = simple.RockfallHazardMap(Input=simple.OutputPort(simulation, 1), Terrain=dem)
collector = simple.TrajectoryCollector(Input=simple.OutputPort(simulation, 1))
growing = simple.GrowingPaths(Input=simple.OutputPort(simulation, 1))
profile = simple.TrajectoryProfile(Input=simple.OutputPort(simulation, 1))
passages = simple.HazardPassageReader()
merged = simple.MergeCollectors(Input=[collector])
design = simple.BarrierDesign(Input=collector)

for (label, name, group, properties), proxy in zip(
        PROXIES, (dem, rocks, release, structure, mass, simulation, dispersion, hazard, collector, growing, profile,
                  passages, merged, design)):
    assert hasattr(simple, name), name
    assert proxy.GetXMLGroup() == group, (name, proxy.GetXMLGroup())
    assert proxy.GetXMLLabel() == label, (name, proxy.GetXMLLabel())
    have = proxy.ListProperties()
    for wanted in properties.split():
        assert wanted in have, f"{name} has no property {wanted}, only {have}"
    # Every proxy and every property explains itself.
    documentation = proxy.SMProxy.GetDocumentation()
    for text in (documentation.GetShortHelp(), documentation.GetLongHelp(),
                 documentation.GetDescription()):
        assert text and text.strip(), f"{name} has no documentation"
    menu = proxy.GetHints().FindNestedElementByName("ShowInMenu")
    assert menu.GetAttribute("category") == "Rockfall", name
    for wanted in have:
        text = proxy.GetProperty(wanted).SMProperty.GetDocumentation()
        assert text and text.GetDescription().strip(), f"{name}.{wanted} has no documentation"
        # A name in Python comes from the label, one in a state file from the XML: they are one.
        assert proxy.SMProxy.GetProperty(wanted), f"{name}.{wanted} bears another name in the XML"
    # help() of the function leads to that of its class, which has all properties and what they are.
    where = f"servermanager.{group}.{name}"
    assert f"help({where})" in getattr(simple, name).__doc__, name
    told = pydoc.render_doc(getattr(getattr(servermanager, group), name), renderer=pydoc.plaintext)
    for wanted in have:
        if proxy.GetProperty(wanted).SMProperty.GetInformationOnly():
            continue  # which is no attribute in Python
        text = proxy.GetProperty(wanted).SMProperty.GetDocumentation().GetDescription()
        assert f"|  {wanted}\n" in told and text.split()[0] in told, f"help({where}) says nothing of {wanted}"

# Rock Blocks needs no terrain, and does not take what happens to be active for one.
for active in (dem, rocks, None):
    simple.SetActiveSource(active)
    alone = simple.RockBlocks()
    assert alone.Terrain is None, active
    alone.UpdatePipeline()
    assert alone.GetDataInformation().GetNumberOfCells() == 6, active
    simple.Delete(alone)
standing = simple.RockBlocks(Terrain=dem, PlaceOnGround=1)
standing.UpdatePipeline()
low, high = standing.GetDataInformation().GetBounds()[4:]
# On its upper edge, at x = 4.5 m.
assert abs(high - low - 1.0) < 1e-9 and abs(low - 57.7 * (1 - 0.045)) < 1e-9, (low, high)
standing.Terrain = None
standing.PlaceOnGround = 0
standing.UpdatePipeline()
assert abs(standing.GetDataInformation().GetBounds()[4] - 57.5) < 1e-9
simple.Delete(standing)

# What a restitution model has no use for is not shown with it.
def decorators(proxy, name, mode):
    """Of each decorator the property and the values that decide, and whether they do so inversely."""
    hints = proxy.GetProperty(name).SMProperty.GetHints()
    nested = [hints.GetNestedElement(k) for k in range(hints.GetNumberOfNestedElements())] if hints else []
    found = [d for d in nested if d.GetName() == "PropertyWidgetDecorator"]
    assert all(d.GetAttribute("type") == "GenericDecorator" for d in found), name
    return [(d.GetAttribute("property"), d.GetAttribute("value") or d.GetAttribute("values"),
             d.GetAttribute("inverse") or "0") for d in found if d.GetAttribute("mode") == mode]


assert dem.GetProperty("RestitutionModel").Available == \
    ["Whole velocity", "Normal and tangential", "Speed-dependent"]
assert decorators(dem, "TangentialRestitution", "visibility") == [("RestitutionModel", "0", "1")]
assert decorators(dem, "RestitutionSpeed", "visibility") == [("RestitutionModel", "2", "0")]
# What a preset replaces is grey beside one.
replaced = ["RestitutionModel", "RestitutionCoefficient", "RestitutionDeviation", "TangentialRestitution",
            "RestitutionSpeed", "FrictionAngle", "FrictionAngleDeviation", "GroundModulus",
            "ScarDepthFactor", "ScarRadius", "GroundDensity", "ScarCompaction", "ScarSpinDrag", "SlipFrictionMin",
            "SlipFrictionMax", "SlipFrictionGrowth", "SlipFrictionDecay", "RollingResistance", "GroundDeviation",
            "GroundDeviationLength", "DeviationPer", "RoughnessMean", "RoughnessDeviation", "RoughnessLength"]
stones = ["ObstacleHeight70", "ObstacleHeight20", "ObstacleHeight10"]
for name in replaced + ["Cohesion"]:
    wanted = [("Preset", "0", "0")] if name in replaced else []
    assert decorators(dem, name, "enabled_state") == wanted, name
for name in stones:
    wanted = [("Preset", "0", "0"), ("RoughnessLength", "0", "1")]
    assert decorators(dem, name, "enabled_state") == wanted, name
# Only some laws have a deviation.
assert rocks.GetProperty("VolumeLaw").Available[2:4] == ["Normal", "Log-normal"]
assert decorators(rocks, "VolumeDeviation", "visibility") == [("VolumeLaw", "2 3", "0")]
# Bounds and exponent are those of a frequency by a power law, too.
for name, laws in (("VolumeMinimum", ("0", "1")), ("VolumeMaximum", ("0", "1")), ("VolumeExponent", ("4", "0"))):
    composite = rocks.GetProperty(name).SMProperty.GetHints().FindNestedElementByName("PropertyWidgetDecorator")
    either = composite.FindNestedElementByName("Expression")
    assert composite.GetAttribute("type") == "CompositeDecorator" and either.GetAttribute("type") == "or", name
    assert [(d.GetAttribute("property"), d.GetAttribute("value"), d.GetAttribute("inverse") or "0", d.GetAttribute("mode"))
            for d in map(either.GetNestedElement, range(either.GetNumberOfNestedElements()))] == [
                ("VolumeLaw", *laws, "visibility"), ("PowerLawFrequency", "0", "1", "visibility")], name
assert decorators(collector, "ParallelSpacing", "enabled_state") == [("ParallelLines", "0", "1")]
# Tables open no view of their own, but for charts and the one that is all there is to see of its filter;
# impacts hide the paths, and the raster of a map lies under the slope.
for proxy, ports in ((simulation, {"2", "3"}), (hazard, {"0"}), (collector, {"1"}), (merged, {"1", "2"})):
    hints = proxy.SMProxy.GetHints()
    views = [hints.GetNestedElement(k) for k in range(hints.GetNumberOfNestedElements())]
    silent = {v.GetAttribute("port") for v in views
              if v.GetName() == "View" and v.GetAttribute("type") == "None"}
    assert silent == ports, (proxy, silent)

# Defaults run as they stand, also of maps and collectors that nothing but trajectories is given to.
for proxy, port in ((simple.RockfallHazardMap(Input=simple.OutputPort(simulation, 1)), 1),
                    (simple.TrajectoryCollector(Input=simple.OutputPort(simulation, 1)), 3)):
    proxy.UpdatePipeline()
    assert proxy[port].GetDataInformation().GetNumberOfCells() > 0, proxy
release.UpdatePipeline()
assert release[0].GetDataInformation().GetNumberOfCells() == 60  # ten cubes
# Rocks of a slope bring it to the simulation.
alone = simple.RockfallSimulation(Rocks=release, EndTime=0.2)
alone.UpdatePipeline()
assert alone[1].GetDataInformation().GetNumberOfCells() == 10
assert not alone.Terrain
assert rocks.Shape == "Cube" and rocks.Volume == 1.0 and list(rocks.Orientation) == [0, 0, 0]
assert dispersion.GroupBy == "Shape", dispersion.GroupBy
dispersion.UpdatePipeline()
table = servermanager.Fetch(dispersion)
assert table.GetNumberOfRows() == 1 and table.GetValueByName(0, "Group").ToString() == "cube"

# What File > Open makes of a file has all the properties of its source, and no entry in a menu.
for reader, source in ((simple.RockfallSlopeReader, dem), (simple.RockfallSourceReader, rocks)):
    made = reader()
    assert made.ListProperties() == source.ListProperties(), reader
    assert made.GetHints().FindNestedElementByName("ReaderFactory"), reader
    assert made.SMProxy.GetVTKClassName() == source.SMProxy.GetVTKClassName()

names = [simulation.SMProxy.GetOutputPortName(k) for k in range(4)]
assert names == ["Rocks", "Trajectories", "Impacts", "Summary"], names
print("names and defaults are as they should be")
