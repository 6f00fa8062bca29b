"""The ranges and choices in the XML are what the classes take: beyond an end there is one error that
names the property and the value, at the end there is none."""

import glob
import os
import xml.etree.ElementTree as ElementTree

from helpers import errors_of, is_empty

import paraview.simple
from paraview import servermanager
from paraview.simple import (
    BarrierDesign, DEMtoCFEMesh, Delete, DispersionAngle, DrawnStructure, HazardPassageReader, JointedRockMass, OutputPort,
    PolyLineSource, RockBlocks, RockfallHazardMap, RockfallSimulation, RockRelease, TrajectoryCollector,
    TrajectoryProfile)

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ABOVE_ZERO = 1e-300  # how the XML says it

failures = []


def simulation():
    # In free flight: whatever the numbers are, there is little to compute.
    return RockfallSimulation(Terrain=DEMtoCFEMesh(), Rocks=RockBlocks(), EndTime=0.1)


def profile():
    return TrajectoryProfile(Input=OutputPort(simulation(), 1))


def dispersion():
    return DispersionAngle(Input=OutputPort(simulation(), 1))


def hazard():
    fall = simulation()
    return RockfallHazardMap(Input=OutputPort(fall, 1), Terrain=fall.Terrain)


def passages():
    fall = simulation()
    writer = servermanager.writers.HazardPassageWriter(
        Input=OutputPort(fall, 1), Terrain=fall.Terrain, FileName=os.path.abspath("ranges.passages"))
    writer.UpdatePipeline()
    return HazardPassageReader(FileNames=[os.path.abspath("ranges.passages")])


def collector():
    return TrajectoryCollector(Input=OutputPort(simulation(), 1), Lines=PolyLineSource())


def design():
    return BarrierDesign(Input=collector())


def release():
    return RockRelease(Terrain=DEMtoCFEMesh(), Points=CORNERS)


def structure():
    # A gentle bend, for an embankment, and an area.
    return DrawnStructure(Terrain=DEMtoCFEMesh(), Points=[110, 20, 0, 125, 50, 0, 110, 80, 0])


CORNERS = [5, 45, 58, 15, 45, 58, 10, 55, 58]  # of an area that is drawn

# Where a property counts only together with others.
MAKERS = {
    "DEMToCFEMesh": DEMtoCFEMesh,
    "RockBlocks": RockBlocks,
    "RockRelease": release,
    "DrawnStructure": structure,
    "JointedRockMass": JointedRockMass,
    "RockfallSimulation": simulation,
    "DispersionAngle": dispersion,
    "RockfallHazardMap": hazard,
    "HazardPassageReader": passages,
    "TrajectoryCollector": collector,
    "BarrierDesign": design,
    "TrajectoryProfile": profile,
}
TOGETHER_WITH = {
    ("DEMToCFEMesh", "Band"): None,  # only rasters have bands
    ("RockBlocks", "Lengths"): {"Shape": "Box"},
    ("RockBlocks", "Draw"): {"Points": CORNERS},
    ("RockBlocks", "SlopeThreshold"): None,  # needs a terrain as steep: TestBadInput
    ("JointedRockMass", "MaximumRocks"): None,  # a cut makes more than 1: TestRockMasses
    ("RockfallSimulation", "ShownIteration"): {"Iterations": 2},
}
# The least value is taken as such, but then makes too many samples, or a body too
# small to be one.
NOT_AT_LEAST = {"OutputInterval", "Lengths", "Volume"}

# So many are taken, but take a day: TestNumbers looks beyond.
NOT_AT_MOST = {"Iterations"}

NEED_A_FILE = {("RockBlocks", "Shape", 8), ("JointedRockMass", "MassShape", 1)}


def errors_with(name, values):
    """Errors of the proxy with these values of one property, and whether it made nothing."""
    proxy = MAKERS[name[0]](**(TOGETHER_WITH.get(name) or {})) if name[0] != "RockfallSimulation" \
        else simulation()
    if name[0] == "RockfallSimulation":
        for other, value in (TOGETHER_WITH.get(name) or {}).items():
            setattr(proxy, other, value)
    proxy.GetProperty(name[1]).SetData(values if len(values) > 1 else values[0])
    result = errors_of(proxy), is_empty(proxy)
    for source in list(paraview.simple.GetSources().values()):
        Delete(source)
    return result


def refused(name, values):
    errors, empty = errors_with(name, values)
    print(name, values, errors)
    if len(errors) != 1 or not empty:
        failures.append(f"{name} {values}: {errors}, empty: {empty}")
    elif name[1] not in errors[0] and name[1] != "Lengths":
        failures.append(f"{name} {values} is not named: {errors[0]}")


def taken(name, values):
    errors, _ = errors_with(name, values)
    print(name, values, errors)
    if errors:
        failures.append(f"{name} {values} is within the XML's range: {errors}")


count = 0
for path in sorted(glob.glob(os.path.join(ROOT, "Plugin", "xml", "*.xml"))):
    for proxy in ElementTree.parse(path).getroot().iter("SourceProxy"):
        for item in proxy:
            name = (proxy.get("name"), item.get("name"))
            if name in TOGETHER_WITH and TOGETHER_WITH[name] is None:
                continue
            if item.tag == "IdTypeVectorProperty":
                failures.append(f"{name}: ParaView 5.11 has no widget for an {item.tag}")
            whole = item.tag == "IntVectorProperty"
            number = int if whole else float
            elements = int(item.get("number_of_elements", "1"))
            step = 1 if whole else 1e-3
            domain = item.find("IntRangeDomain" if whole else "DoubleRangeDomain")
            if domain is not None and domain.get("min"):
                least = number(domain.get("min").split()[0])
                beyond = 0.0 if least == ABOVE_ZERO else least - step
                refused(name, [beyond] * elements)
                if name[1] not in NOT_AT_LEAST:
                    taken(name, [least] * elements)
                count += 1
            if domain is not None and domain.get("max"):
                most = number(domain.get("max").split()[0])
                refused(name, [most + max(step, number(1e-9 * most))] * elements)
                if name[1] not in NOT_AT_MOST:
                    taken(name, [most] * elements)
                count += 1
            entries = [int(e.get("value")) for e in item.iterfind("EnumerationDomain/Entry")]
            if entries:
                refused(name, [min(entries) - 1])
                refused(name, [max(entries) + 1])
                count += 1
                for entry in entries:
                    if (*name, entry) not in NEED_A_FILE:
                        taken(name, [entry])
if count < 25:
    failures.append(f"only {count} ranges were looked at")
if failures:
    raise SystemExit("\n".join(failures))
print(f"{count} ranges are those of the classes")
