"""Trajectories that are spread over ranks are refused by what would take a part of them for all."""
# Ranks: 2

import os

from helpers import messages_of

from paraview import servermanager
from paraview.simple import DEMtoCFEMesh
from vtkmodules.vtkFiltersSources import vtkLineSource
from vtkmodules.vtkParallelCore import vtkMultiProcessController

rank = vtkMultiProcessController.GetGlobalController().GetLocalProcessId()
part = vtkLineSource()
part.SetPoint1(50, 20 + 10 * rank, 40)
part.SetPoint2(90, 20 + 10 * rank, 20)
part.Update()
slope = DEMtoCFEMesh()
slope.UpdatePipeline()

failures = []
for name, settings in (("RockfallHazardMap", {"CellSize": 5}), ("TrajectoryCollector", {}),
                       ("DispersionAngle", {}), ("HazardPassageWriter", {"FileName": "part.passages"})):
    writes = name.endswith("Writer")
    proxy = getattr(servermanager.writers if writes else servermanager.filters, name)(**settings)
    proxy.UpdateVTKObjects()
    algorithm = proxy.GetClientSideObject()
    algorithm.SetInputDataObject(0, part.GetOutput())
    if writes:
        algorithm.SetInputDataObject(1, slope.GetClientSideObject().GetOutputDataObject(0))
    said = messages_of(algorithm.Write if writes else algorithm.Update)
    # One error, of the first rank.
    if said.count("The Input is spread over 2 ranks") != (rank == 0) or said.count("ERR|") != (rank == 0):
        failures.append(f"{name} on rank {rank} said: {said}")
    for port in range(0 if writes else algorithm.GetNumberOfOutputPorts()):
        data = algorithm.GetOutputDataObject(port)
        size = sum(data.GetNumberOfElements(kind) for kind in (0, 1, 6))  # points, cells, rows
        if size > 0:
            failures.append(f"rank {rank}: {name}, port {port} has {size} elements")
if os.path.exists("part.passages"):
    failures.append("a part of the passages was written")
if failures:
    raise SystemExit("\n".join(failures))
print(f"rank {rank} did as it should")
