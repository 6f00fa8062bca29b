"""What the window's pipeline must have after each Check of Runs.xml."""
from paraview import simple, smtrace

ITERATIONS, ROCKS = 2000, 20


def begin_trace():
    smtrace.start_trace()


def end_trace():
    simple.trace_of_study = smtrace.stop_trace()  # kept between two checks
    slope = simple.FindSource("Slope")
    assert slope.GroundModulus > 0.0, "the panel does not have the numbers of the preset"
    simple.made_when_stopped = set()
    simple.GetRenderView().GetRenderWindow().AddObserver("EndEvent", note_drawn)


def note_drawn(_window, _event):
    """What the fall has made, each time that the window is drawn after Stop. It may be drawn more often."""
    fall = simple.FindSource("Fall")
    fall.UpdatePropertyInformation()
    if fall.GetProperty("RunStatus").GetElement(0).startswith("stopped"):
        simple.made_when_stopped.add(fall.GetClientSideObject().GetOutputDataObject(1).GetMTime())


def stopped():
    fall = simple.FindSource("Fall")
    fall.UpdatePropertyInformation()
    status = fall.GetProperty("RunStatus").GetElement(0)
    assert status.startswith("stopped"), status
    rows = fall[3].GetDataInformation().GetNumberOfRows()
    assert 0 < rows < ITERATIONS * ROCKS, rows
    paths = simple.FindSource("Paths").GetDataInformation().GetNumberOfCells()
    assert paths == rows, f"{paths} paths are drawn of {rows}"
    released = simple.FindSource("Line").FieldData
    notes = fall.GetClientSideObject().GetOutputDataObject(3).GetFieldData().GetAbstractArray("Notes")
    assert notes and any("was stopped" in notes.GetValue(k) for k in range(notes.GetNumberOfValues())), "nothing says so"
    # What was there when Stop was pressed, and the whole of it.
    made = len(simple.made_when_stopped)
    assert 0 < made <= 2, f"made {made} times after Stop"
    assert "RunGoesOn" not in [released[k].Name for k in range(len(released))], "the line has a part of the run"


def legend():
    falls = [source for source in simple.GetSources().values() if source.GetXMLName() == "RockfallSimulation"]
    assert len(falls) == 2, len(falls)
    fastest = max(fall[1].PointData["Speed"].GetRange()[1] for fall in falls)
    end = simple.GetColorTransferFunction("Speed").RGBPoints[-4]
    assert abs(end - fastest) < 1e-6 * fastest, f"the legend ends at {end}, the fastest rock has {fastest}"
    legends = [shown for shown in simple.GetRenderView().Representations if shown.GetXMLName() == "ScalarBarWidgetRepresentation"
               and shown.Visibility and shown.Title.startswith("Speed")]
    assert len(legends) == 1, f"{len(legends)} legends of speed"


def replayed():
    first = simple.FindSource("Fall")
    before = set(simple.GetSources().values())
    exec(simple.trace_of_study, {})
    made = {source.GetXMLName(): source for source in simple.GetSources().values() if source not in before}
    fall, release, line = (made[name] for name in ("RockfallSimulation", "RockRelease", "TrajectoryCollector"))
    assert fall != first and fall.Iterations == 10 and release.Amount == ROCKS, (fall.Iterations, release.Amount)
    assert len(line.Points) == 6, list(line.Points)
    simple.fall_of_trace = fall  # which goes on while the window waits


def finished():
    made = simple.fall_of_trace[1].GetDataInformation().GetNumberOfCells()
    assert made == 10 * ROCKS, made


[begin_trace, end_trace, stopped, legend, replayed, finished][number - 1]()
