"""What the Checks of OffSlope.xml ask for. When rocks end differs a little between compilers."""
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

fall, scene = simple.FindSource("Fall"), simple.GetAnimationScene()
table = servermanager.Fetch(fall, idx=3)


def at_end():
    end = vtk_to_numpy(table.GetRowData().GetArray("EndTime")).max()
    later = [step for step in fall.TimestepValues if step >= end]
    assert scene.AnimationTime in later[:scene.Stride], f"{scene.AnimationTime} s, the last rock ends at {end} s"


def back():
    assert table.GetNumberOfRows() > 0, "no rocks fall"


[at_end, back][number - 1]()
