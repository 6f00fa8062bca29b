"""What the window must have after Undo.xml's second study: the first falls to the east, this one to the south."""
from paraview import simple

view = simple.GetRenderView()
assert simple.FindSource("Slope 2") and simple.FindSource("Fall 2")
away = [eye - focus for eye, focus in zip(view.CameraPosition, view.CameraFocalPoint)]
assert away[1] < -abs(away[0]), f"the slope is seen from {away}"
charts = simple.GetViews(viewtype="XYChartView")
assert len(charts) == 2 and all(view.ViewSize[1] > 1.5 * chart.ViewSize[1] for chart in charts), (
    view.ViewSize, [chart.ViewSize for chart in charts])
