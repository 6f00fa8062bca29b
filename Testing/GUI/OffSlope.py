"""What the Checks of OffSlope.xml ask for. When rocks end differs a little between compilers."""
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

fall, scene = simple.FindSource("Fall"), simple.GetAnimationScene()
table = servermanager.Fetch(fall, idx=3)


def at_end():
    end = vtk_to_numpy(table.GetRowData().GetArray("EndTime")).max()
    steps = list(fall.TimestepValues)
    first = next(index for index, step in enumerate(steps) if step >= end)
    # Play shows 240 frames at most. The scene's own stride is 1 after the first script of a session.
    stride = first // 240 + 1
    last = steps[min(-(-first // stride) * stride, len(steps) - 1)]
    assert scene.AnimationTime == last, f"{scene.AnimationTime} s, the last rock ends at {end} s"


def back():
    assert table.GetNumberOfRows() > 0, "no rocks fall"


[at_end, back][number - 1]()
