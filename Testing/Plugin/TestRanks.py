"""On several ranks the first one computes; the others have empty outputs and no errors."""
# Ranks: 2

from helpers import messages_of, write_text

from paraview import servermanager
from paraview.simple import (
    BarrierDesign, DEMtoCFEMesh, DispersionAngle, HazardPassageReader, MergeCollectors, OutputPort,
    PolyLineSource, RockBlocks, RockfallHazardMap, RockfallSimulation, SaveData,
    TrajectoryCollector, UpdatePipeline)
from vtkmodules.vtkParallelCore import vtkMultiProcessController

controller = vtkMultiProcessController.GetGlobalController()
rank = controller.GetLocalProcessId()
assert controller.GetNumberOfProcesses() == 2, controller.GetNumberOfProcesses()

# A path that is known: nothing is drawn.
dem = DEMtoCFEMesh(RoughnessMean=0, RoughnessDeviation=0, RestitutionDeviation=0)
rocks = RockBlocks(AttitudeLaw="As given")
simulation = RockfallSimulation(Terrain=dem, Rocks=rocks, EndTime=2.0)
dispersion = DispersionAngle(Input=OutputPort(simulation, 1))
hazard = RockfallHazardMap(Input=OutputPort(simulation, 1), CropToTrajectories=0)
collector = TrajectoryCollector(
    Input=OutputPort(simulation, 1), Lines=PolyLineSource(Points=[8, 0, 0, 8, 100, 0]))
merged = MergeCollectors(Input=[collector])
design = BarrierDesign(Input=merged)
writer = servermanager.writers.HazardPassageWriter(
    Input=OutputPort(simulation, 1), Terrain=dem, FileName="run.passages")
passages = HazardPassageReader(FileNames=["run.passages"])
# Two rocks that meet in each iteration; the table of what they do to each other is on the first rank only.
if rank == 0:
    write_text("meeting.csv", "x,y,z,vx,material\n40,50,60,5,granite\n44,50,60,-3,shale\n")
    write_text("contacts.csv", "material_a,material_b,restitution,phi\nshale,granite,0.9,10\n")
meeting = RockfallSimulation(
    Terrain=dem, Rocks=RockBlocks(FileName="meeting.csv"), RockRockContact=1, Iterations=2, EndTime=1.0,
    RockContactFile="contacts.csv" if rank == 0 else "elsewhere.csv")
proxies = {"terrain": (dem, 1), "rocks": (rocks, 1), "simulation": (simulation, 4),
           "dispersion": (dispersion, 2), "hazard map": (hazard, 2), "collector": (collector, 4),
           "merged collectors": (merged, 3), "design": (design, 4),
           "meeting": (meeting, 4)}


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


# Notes of one rock on bare ground belong to the first rank; all else is an error.
NOTES = ("The ground is bare rock", "still moving at EndTime", "too few for a", "too few trajectories", "Too few rocks",
         "heights of rocks over the ground look implausible")
said = [line for line in messages_of(update).splitlines()
        if line.strip() and not (rank == 0 and any(note in line for note in NOTES))]
failures = [f"said on rank {rank}: {said}"] if said else []
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
    impacts = meeting.GetClientSideObject().GetOutputDataObject(2).GetPointData()
    rows = zip(*([impacts.GetArray(name).GetValue(k) for k in range(impacts.GetNumberOfTuples())]
                 for name in ("Iteration", "OtherBlockId", "Restitution")))
    met = sorted({(iteration, e) for iteration, other, e in rows if other > 0})
    if met != [(0, 0.9), (1, 0.9)]:
        failures.append(f"the rocks met with {met}")
    with open("map.tif", "rb") as one, open("merged.tif", "rb") as other:
        if one.read() != other.read():
            failures.append("the map of the passages is not that of the trajectories")
if failures:
    raise SystemExit("\n".join(failures))
print(f"rank {rank} did as it should")
