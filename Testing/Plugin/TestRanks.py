"""On several ranks the first one computes; the others have empty outputs and no errors."""
# Ranks: 2

from helpers import messages_of

from paraview import servermanager
from paraview.simple import (
    DEMtoCFEMesh, DispersionAngle, HazardPassageReader, MergeCollectors, OutputPort,
    PolyLineSource, RockBlocks, RockfallHazardMap, RockfallSimulation, SaveData,
    TrajectoryCollector, UpdatePipeline)
from vtkmodules.vtkParallelCore import vtkMultiProcessController

controller = vtkMultiProcessController.GetGlobalController()
rank = controller.GetLocalProcessId()
assert controller.GetNumberOfProcesses() == 2, controller.GetNumberOfProcesses()

dem = DEMtoCFEMesh()
rocks = RockBlocks()
simulation = RockfallSimulation(Terrain=dem, Rocks=rocks, EndTime=2.0)
dispersion = DispersionAngle(Input=OutputPort(simulation, 1))
hazard = RockfallHazardMap(Input=OutputPort(simulation, 1), Terrain=dem)
collector = TrajectoryCollector(
    Input=OutputPort(simulation, 1), Lines=PolyLineSource(Points=[8, 0, 0, 8, 100, 0]))
merged = MergeCollectors(Input=[collector])
writer = servermanager.writers.HazardPassageWriter(
    Input=OutputPort(simulation, 1), Terrain=dem, FileName="run.passages")
passages = HazardPassageReader(FileNames=["run.passages"])
proxies = {"terrain": (dem, 1), "rocks": (rocks, 1), "simulation": (simulation, 4),
           "dispersion": (dispersion, 2), "hazard map": (hazard, 1), "collector": (collector, 3),
           "merged collectors": (merged, 3)}


def update():
    for proxy, _ in proxies.values():
        UpdatePipeline(proxy=proxy)
    UpdatePipeline(1.0, simulation)
    simulation.Seed = 2
    UpdatePipeline(2.0, simulation)
    # Before there are files: only the first rank writes.
    SaveData("map.tif", proxy=hazard)
    SaveData("paths.gpkg", proxy=OutputPort(simulation, 1))
    writer.UpdatePipeline()
    controller.Barrier()
    UpdatePipeline(proxy=passages)
    SaveData("merged.tif", proxy=passages)


said = messages_of(update)
failures = [f"said on rank {rank}: {said}"] if said.strip() else []
proxies["passages"] = (passages, 1)
for name, (proxy, ports) in proxies.items():
    for port in range(ports):
        data = proxy.GetClientSideObject().GetOutputDataObject(port)
        size = sum(data.GetNumberOfElements(kind) for kind in (0, 1, 6))  # points, cells, rows
        if (size > 0) != (rank == 0):
            failures.append(f"rank {rank}: {name}, port {port} has {size} elements")
        if data.GetFieldData().GetAbstractArray("Error"):
            failures.append(f"rank {rank}: {name}, port {port} has an error")
if rank == 0:
    with open("map.tif", "rb") as one, open("merged.tif", "rb") as other:
        if one.read() != other.read():
            failures.append("the map of the passages is not that of the trajectories")
if failures:
    raise SystemExit("\n".join(failures))
print(f"rank {rank} did as it should")
