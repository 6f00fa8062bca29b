"""What each Check of Film.xml prepares and asks for."""
import os
import shutil

from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

DATA = os.path.join(os.environ["ROCKFALL_PICTURES"], "..", "data")
MOVED = os.path.join(DATA, "moved")
FRAMES = range(100, 104)


def prepared():
    shutil.rmtree(MOVED, ignore_errors=True)
    os.makedirs(MOVED)
    shutil.copy(os.path.join(DATA, "hill.asc"), os.path.join(MOVED, "valley.asc"))


def strode():
    """As Play does in a fall of 36 s: a film has each frame nevertheless."""
    simple.GetAnimationScene().Stride = 3


def pixels(path):
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    image = reader.GetOutput()
    return list(image.GetDimensions()[:2]), vtk_to_numpy(image.GetPointData().GetScalars()).astype(int)


def filmed():
    assert len([name for name in os.listdir(MOVED) if name.startswith("film")]) == len(FRAMES), os.listdir(MOVED)
    fall, view, scene = simple.FindSource("Fall"), simple.GetRenderView(), simple.GetAnimationScene()
    with open(os.path.join(MOVED, "state hash"), "w") as file:
        file.write(servermanager.Fetch(fall, idx=3).GetFieldData().GetAbstractArray("StateHash").GetValue(0))
    options = servermanager.ProxyManager().NewProxy("misc", "SaveAnimation")
    servermanager.ParaViewPipelineController().InitializeProxy(options)
    assert scene.Stride == 3, scene.Stride
    rate, step = (options.GetProperty(name).GetElement(0) for name in ("FrameRate", "FrameStride"))
    assert abs(step / rate - (fall.TimestepValues[1] - fall.TimestepValues[0])) < 1e-9, "a film is in real time"
    before = None
    for frame in FRAMES:
        size, film = pixels(os.path.join(MOVED, f"film.{frame:04d}.png"))
        scene.AnimationTime = fall.TimestepValues[frame]
        path = os.path.join(MOVED, "view.png")
        simple.SaveScreenshot(path, view, ImageResolution=size)
        now = pixels(path)[1]
        assert (abs(film - now) > 8).mean() < 1e-3, f"frame {frame} is not the view at {scene.AnimationTime} s"
        assert before is None or (abs(film - before) > 8).any(), f"nothing moves to frame {frame}"
        before = film


[prepared, strode, filmed][number - 1]()
