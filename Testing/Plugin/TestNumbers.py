"""Numbers that no property should take: each run ends, with a result or with one message."""

import glob
import os
import re
import resource
import sys
import time
import xml.etree.ElementTree as ElementTree

from helpers import delete_sources, errors_of, is_empty, messages_of, write_text

from paraview import servermanager
from paraview.simple import (
    BarrierDesign, DEMtoCFEMesh, DispersionAngle, DrawnStructure, GrowingPaths, HazardPassageReader, JointedRockMass,
    MergeCollectors, OutputPort, PolyLineSource, RockBlocks, RockfallHazardMap, RockfallSimulation,
    RockRelease, TrajectoryCollector, TrajectoryProfile)

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
NUMBERS = [float("nan"), float("inf"), float("-inf"), 1e308, -1e308, 1e-308]
COUNTS = [2**31 - 1, -2**31, 0, -1]
SLOWEST = 20.0  # s of processors that one of them may take

release = [5, 45, 58, 15, 45, 58, 10, 55, 58]


def fall(rocks=None, **others):
    # A rock that strikes the slope within a few steps.
    dem = DEMtoCFEMesh(RoughnessDeviation=0.05)
    rocks = rocks or RockBlocks(Center=[5, 50, 60], Velocity=[0, 0, -10])
    return RockfallSimulation(Terrain=dem, Rocks=rocks, **{"EndTime": 0.5, **others})


def paths():
    return OutputPort(fall(), 1)


def across():
    return PolyLineSource(Points=[5.2, 0, 0, 5.2, 100, 0])


def passages():
    name = os.path.abspath("numbers.passages")
    run = fall()
    servermanager.writers.HazardPassageWriter(
        Input=OutputPort(run, 1), Terrain=run.Terrain, FileName=name).UpdatePipeline()
    return HazardPassageReader(FileNames=[name])


def together(change):
    """Rocks that hit each other."""
    rocks = RockBlocks(Amount=3, ClusterRadius=3, Center=[10, 50, 60], Velocity=[0, 0, -10], KeepApart=1)
    return change(fall(rocks, RockRockContact=1))


# What is changed, and the filter whose run is looked at.
def itself(proxy):
    return proxy, proxy


def with_fall(proxy):
    return proxy, fall(proxy)


def of_slope():
    dem = DEMtoCFEMesh()
    rocks = RockBlocks(Center=[5, 50, 60], Velocity=[0, 0, -10])
    return dem, RockfallSimulation(Terrain=dem, Rocks=rocks, EndTime=0.5)


MAKERS = {
    "DEMToCFEMesh": [of_slope],
    "RockBlocks": [
        lambda: with_fall(RockBlocks(Center=[5, 50, 60], Velocity=[0, 0, -10])),
        lambda: with_fall(RockBlocks(Center=[5, 50, 60], Velocity=[0, 0, -10], Shape="Box", Amount=2,
                                     VolumeLaw="Normal", RedrawVolume=1, AttitudeLaw="Deviating"))],
    "RockRelease": [lambda: with_fall(RockRelease(Terrain=DEMtoCFEMesh(), Points=release))],
    "DrawnStructure": [
        lambda: itself(DrawnStructure(Terrain=DEMtoCFEMesh(), Kind=kind,
                                      Points=[110, 20, 0, 125, 50, 0, 110, 80, 0]))
        for kind in (0, 1, 2)],
    "JointedRockMass": [lambda: itself(JointedRockMass())],
    "RockfallSimulation": [lambda: itself(fall()), lambda: together(itself)],
    "DispersionAngle": [lambda: itself(DispersionAngle(Input=paths()))],
    "RockfallHazardMap": [lambda: itself(RockfallHazardMap(Input=paths()))],
    "HazardPassageReader": [lambda: itself(passages())],
    "GrowingPaths": [lambda: itself(GrowingPaths(Input=paths()))],
    "TrajectoryCollector": [lambda: itself(TrajectoryCollector(Input=paths(), Lines=across()))],
    "BarrierDesign": [
        lambda: itself(BarrierDesign(Input=TrajectoryCollector(Input=paths(), Lines=across())))],
    "TrajectoryProfile": [lambda: itself(TrajectoryProfile(Input=paths()))],
}

READERS = {"SlopeReader", "RockSourceReader"}  # others under another name
failures, count = [], 0
only = os.environ.get("NUMBERS_OF")


def look(name, proxy, run, value, only_last=False):
    """Sets a property as a state file does, past Python's own checks, runs, and sets it back."""
    global count
    sm = proxy.SMProxy.GetProperty(name[1])
    before = [sm.GetElement(k) for k in range(sm.GetNumberOfElements())]
    if sm.GetRepeatable():
        sm.SetNumberOfElements(max(3, sm.GetNumberOfElementsPerCommand()))
    elements = sm.GetNumberOfElements()
    if only_last and elements < 2:
        return
    for k in range(elements - 1 if only_last else 0, elements):
        sm.SetElement(k, value)
    what = f"{name[0]} {name[1]} {value}"
    print(what, end=" ", flush=True)

    def update():
        proxy.SMProxy.UpdateVTKObjects()
        run.UpdatePipeline(0.3)

    begun = time.process_time()
    text = messages_of(update)
    took = time.process_time() - begun
    errors = re.findall(r"ERR\| (.*?)(?:\x1b|$)", text, re.MULTILINE)
    print(f"{took:.2f} s", errors, flush=True)
    if len(errors) > 1 or (errors and not is_empty(run)):
        failures.append(f"{what}: {errors}, empty: {is_empty(run)}")
    if took > SLOWEST:
        failures.append(f"{what}: took {took:.0f} s")
    if sm.GetRepeatable():
        sm.SetNumberOfElements(len(before))
    for k, value in enumerate(before):
        sm.SetElement(k, value)
    count += 1


def is_switch(item):
    return item.find("BooleanDomain") is not None


def values_of(item):
    """Of a switch one that is neither 0 nor 1."""
    if is_switch(item):
        return [-2**31]
    return COUNTS if item.tag == "IntVectorProperty" else NUMBERS


XML = sorted(glob.glob(os.path.join(ROOT, "Plugin", "xml", "*.xml")))
for path in XML:
    for proxy in ElementTree.parse(path).getroot().iter("SourceProxy"):
        items = list(proxy)
        if proxy.get("name") == "RockRelease":  # only what it has of its own
            items = [item for item in items if item.get("name") in ("Amount", "Draw")]
        items = [item for item in items if item.tag in ("IntVectorProperty", "DoubleVectorProperty") and
                 not item.get("information_only") and (not only or only in (proxy.get("name"), item.get("name")))]
        if not items or proxy.get("name") in READERS:
            continue
        # One pipeline of each maker for all numbers: to make its proxies takes ten times as long as a run.
        for k, make in enumerate(MAKERS[proxy.get("name")]):  # a proxy that is not there has to come in
            changed, run = make()
            for item in items:
                if k and is_switch(item):
                    continue
                name = (proxy.get("name"), item.get("name"))
                for value in values_of(item):
                    look(name, changed, run, value)
                if item.tag == "DoubleVectorProperty":  # the others are good
                    look(name, changed, run, float("nan"), True)
            changed.SMProxy.UpdateVTKObjects()
            told = re.findall(r"ERR\| .*", messages_of(lambda: run.UpdatePipeline(0.3)))
            if told or is_empty(run):
                failures.append(f"{proxy.get('name')}: no result of good numbers after bad ones: {told}")
            delete_sources()

# Writers: a file, or one message that names the property and none.
for path in XML:
    for proxy in ElementTree.parse(path).getroot().iter("WriterProxy"):
        for item in proxy:
            if item.tag not in ("IntVectorProperty", "DoubleVectorProperty") or \
                    (only and only not in (proxy.get("name"), item.get("name"))):
                continue
            for value in values_of(item):
                ground = fall()
                name = os.path.abspath("written." + {"HazardPassageWriter": "passages", "TrajectoryLayerWriter": "gpkg"}[
                    proxy.get("name")])
                inputs = {"Input": OutputPort(ground, 1)}
                if proxy.find("InputProperty[@name='Terrain']") is not None:
                    inputs["Terrain"] = ground.Terrain
                writer = getattr(servermanager.writers, proxy.get("name"))(FileName=name, **inputs)
                writer.SMProxy.GetProperty(item.get("name")).SetElement(0, value)
                writer.SMProxy.UpdateVTKObjects()
                if os.path.exists(name):
                    os.remove(name)
                begun = time.process_time()
                errors = re.findall(r"ERR\| (.*?)(?:\x1b|$)", messages_of(writer.UpdatePipeline), re.MULTILINE)
                what = f"{proxy.get('name')} {item.get('name')} {value}: {errors}, {time.process_time() - begun:.0f} s"
                print(what)
                words = len(errors) == 1 and item.get("name").lower() in errors[0].lower().replace(" ", "")
                if (errors if is_switch(item) else not words) or os.path.exists(name) != (not errors) or \
                        time.process_time() - begun > SLOWEST:
                    failures.append(what)
                delete_sources()
                count += 1

# --- More than a machine has, and a run without an end: one message, soon.


def soon(proxy, *words):
    begun = time.process_time()
    errors = errors_of(proxy)
    if len(errors) != 1 or not all(word in errors[0] for word in words) or time.process_time() - begun > SLOWEST:
        failures.append(f"{words}: {errors}, {time.process_time() - begun:.0f} s")
    delete_sources()


if not only:
    for name, value in (("Iterations", 10**9), ("EndTime", 1e9), ("TimeStep", 1e-9), ("TimeStep", 10.0),
                        ("NumberOfThreads", 2**31 - 1)):
        soon(fall(**{name: value}), name)
    soon(fall(RockBlocks(Amount=20, ClusterRadius=5, Center=[15, 50, 70]), Iterations=10**7),
         "Iterations", "20 rocks")
    soon(RockBlocks(Amount=2 * 10**6, ClusterRadius=5), "1000000")
    # Of two numbers each is one that somebody may take.
    soon(RockfallHazardMap(Input=OutputPort(fall(EndTime=60), 1), CellSize=0.01, Terrain=DEMtoCFEMesh(),
                           CropToTrajectories=0), "cells", "CellSize")
    soon(DEMtoCFEMesh(CellSize=1e-4), "cell size")
    soon(fall(EndTime=1e5, OutputInterval=1e-3), "OutputInterval")
    soon(fall(RockBlocks(Amount=1000, ClusterRadius=5, Center=[15, 50, 70]), Iterations=10**6), "Iterations")
    soon(RockBlocks(Amount=10**5, ClusterRadius=1e-3, KeepApart=1, Center=[15, 50, 70]), "KeepApart")
    soon(RockBlocks(TotalVolume=1e6, Volume=1e-6, ClusterRadius=5), "TotalVolume")
    soon(JointedRockMass(Lengths=[1e3, 1e3, 1e3]), "MaximumRocks")
    soon(TrajectoryCollector(Input=paths(), Lines=across(), ParallelLines=10**9, ParallelSpacing=1e-6),
         "ParallelLines")
    # 20,000² heights take 3.2 GB. The file has no blocks on the disk.
    size = 20000
    write_text("wide.hdr", f"nrows {size}\nncols {size}\nnbands 1\nnbits 32\npixeltype FLOAT\n"
               "byteorder I\nlayout BIL\nulxmap 600000\nulymap 5000000\nxdim 1\nydim 1\n")
    with open("wide.bil", "wb") as file:
        file.truncate(4 * size * size)
    with open("/proc/self/statm") as file:
        taken = int(file.read().split()[0]) * resource.getpagesize()
    limits = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (taken + 1_500_000_000, limits[1]))
    soon(DEMtoCFEMesh(FileName=os.path.abspath("wide.bil")), "memory")
    resource.setrlimit(resource.RLIMIT_AS, limits)
    # ParaView goes on.
    run = fall()
    assert not errors_of(run) and not is_empty(run)
    os.remove("wide.bil")
if failures:
    sys.exit("\n".join(failures))
assert only or count > 400, count
print(f"{count} runs ended")
