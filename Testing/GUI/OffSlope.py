"""The time that Check of OffSlope.xml finds. When rocks end differs a little between compilers."""
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

fall, scene = simple.FindSource("Fall"), simple.GetAnimationScene()
end = vtk_to_numpy(servermanager.Fetch(fall, idx=3).GetRowData().GetArray("EndTime")).max()
later = [step for step in fall.TimestepValues if step >= end]
assert scene.AnimationTime in later[:scene.Stride], f"{scene.AnimationTime} s, the last rock ends at {end} s"
