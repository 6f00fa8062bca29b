"""What the window must have after each Check of Undo.xml."""
from paraview import simple


def second_study():
    """The first study falls to the east, this one to the south."""
    view = simple.GetRenderView()
    assert simple.FindSource("Slope 2") and simple.FindSource("Fall 2")
    away = [eye - focus for eye, focus in zip(view.CameraPosition, view.CameraFocalPoint)]
    assert away[1] < -abs(away[0]), f"the slope is seen from {away}"
    charts = simple.GetViews(viewtype="XYChartView")
    assert len(charts) == 2 and all(view.ViewSize[1] > 1.5 * chart.ViewSize[1] for chart in charts), (
        view.ViewSize, [chart.ViewSize for chart in charts])
    simple.view_beside = simple.CreateView("RenderView")  # kept between two checks
    simple.Show(simple.FindSource("Slope 2"), simple.view_beside)


def view_beside():
    """A second view is lit as the first, and looks from the valley."""
    view = simple.view_beside
    away = [eye - focus for eye, focus in zip(view.CameraPosition, view.CameraFocalPoint)]
    assert view.UseLight and away[1] < -abs(away[0]), f"the slope is seen from {away}"


[second_study, view_beside][number - 1]()
