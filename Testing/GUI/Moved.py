"""What each Check of Moved.xml prepares and asks for."""
import os
import time

from paraview import servermanager, simple

MOVED = os.path.realpath(os.path.join(os.environ["ROCKFALL_PICTURES"], "..", "data", "moved"))
ELSEWHERE = os.path.join(MOVED, "elsewhere", "valley.asc")


def moved():
    os.makedirs(os.path.dirname(ELSEWHERE))
    os.rename(os.path.join(MOVED, "valley.asc"), ELSEWHERE)


def table_of_ended():
    fall = simple.FindSource("Fall")
    for _ in range(300):
        fall.UpdatePipeline()
        fall.UpdatePropertyInformation()
        if not fall.GetProperty("RunStatus").GetElement(0).startswith("running"):
            break
        time.sleep(0.1)
        fall.SMProxy.InvokeCommand("Watch")
    return servermanager.Fetch(fall, idx=3)


def missed():
    assert os.path.realpath(simple.FindSource("Slope").FileName) == os.path.join(MOVED, "valley.asc")
    assert table_of_ended().GetNumberOfRows() == 0, "rocks fall on a slope that is not there"


def found():
    assert os.path.realpath(simple.FindSource("Slope").FileName) == ELSEWHERE, simple.FindSource("Slope").FileName
    table = table_of_ended()
    with open(os.path.join(MOVED, "state hash")) as file:
        saved = file.read()
    assert table.GetNumberOfRows() > 0 and table.GetFieldData().GetAbstractArray("StateHash").GetValue(0) == saved
    view = simple.GetRenderView()
    low, high = simple.FindSource("Slope").GetDataInformation().GetBounds()[:2]
    assert low < view.CameraFocalPoint[0] < high, f"the camera looks at {view.CameraFocalPoint}"


[moved, missed, found, simple.ResetSession, found, simple.ResetSession, missed][number - 1]()
