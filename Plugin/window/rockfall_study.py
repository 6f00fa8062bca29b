"""Studies in a few clicks: the whole pipeline of a slope, with views set up.

ParaView's menu Rockfall runs these functions; so can a script or ParaView's Python shell.
"""

import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
import webbrowser

import numpy as np
from paraview import servermanager, simple

ROCKS = 20  # of the release line
ITERATIONS = 10
GROUND = "Meadow (field data)"  # until another Preset is chosen


def new_study(file_name=""):
    """A slope, a release line across its highest steep place, the fall of its rocks, a map and what passes
    a line; without a file on the test slope. Returns its parts by name."""
    name = _numbered()
    slope = simple.DEMtoCFEMesh(registrationName=name("Slope"), FileName=file_name, Preset=GROUND)
    slope.UpdatePipeline()
    if slope.GetDataInformation().GetNumberOfCells() == 0:
        return {}  # the message says why
    view = _render_view()
    simple.HideAll(view)  # of an earlier study, its notes as well
    shown = simple.Show(slope, view)
    shown.Visibility = 0  # views that are moved are drawn at each step: before there is much to draw
    chart = _chart_beside(view)
    shown.Visibility = 1
    view.StillRender()
    with _undrawn(view):
        parts = _study_on(slope, view, chart, name)
    view.StillRender()
    return parts


def _study_on(slope, view, chart, name):
    """All of a study but its slope, in these views."""
    # What is given where a part is made is in a trace of ParaView, what is set afterwards is not.
    release = simple.RockRelease(registrationName=name("Release"), Terrain=slope, Amount=ROCKS)
    _draw_placed(release)
    simple.Show(release, view)

    fall = simple.RockfallSimulation(registrationName=name("Fall"), Rocks=release, Iterations=ITERATIONS)
    fall.SMProxy.InvokeCommand("Watch")  # a window is not kept waiting
    paths = simple.OutputPort(fall, 1)
    simple.Show(simple.OutputPort(fall, 0), view)
    _await_paths(fall)

    line = simple.TrajectoryCollector(registrationName=name("Line"), Input=paths)
    _draw_placed(line)
    hazard = simple.RockfallHazardMap(registrationName=name("Map"), Input=paths, CellSize=_cell_of_map(fall))
    growing = simple.GrowingPaths(registrationName=name("Paths"), Input=paths)
    simple.Show(growing, view)
    simple.Show(simple.OutputPort(line, 3), view)
    simple.Show(simple.OutputPort(hazard, 1), view)
    _show_curve(line, chart, name("Energy at the line"))
    clock(view, name("Clock"))
    ground(slope, view, name("Ground"))
    simple.SetActiveView(view)
    simple.SetActiveSource(release)
    _look_at_paths(fall, view)
    scene = simple.GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()  # or Play and films have ten frames
    scene.GoToLast()  # the paths as a whole; Play begins anew from there
    return {"slope": slope, "release": release, "fall": fall, "paths": growing, "map": hazard, "line": line}


@contextlib.contextmanager
def _undrawn(view):
    """A view that is not drawn for a while: each part that comes would draw a million points anew."""
    view.SuppressRendering = 1
    try:
        yield
    finally:
        view.SuppressRendering = 0


def frame(fall=None, view=None):
    """Looks at the paths from where the view looks at the slope: on slopes of many kilometres they are small."""
    view = view or _render_view()
    fall = fall or simple.FindSource("Fall")
    if fall:
        _look_at_paths(fall, view)
        simple.Render(view)


def _look_at_paths(fall, view):
    low_x, high_x, low_y, high_y, low_z, high_z = fall[1].GetDataInformation().GetBounds()
    if low_x > high_x:
        return
    centre = [0.5 * (low_x + high_x), 0.5 * (low_y + high_y), 0.5 * (low_z + high_z)]
    away = [p - f for p, f in zip(view.CameraPosition, view.CameraFocalPoint)]
    if abs(away[0]) + abs(away[1]) < 1e-6 * abs(away[2]):
        away = [0.0, -0.82, 0.57]  # straight from above, as before the first look: from the south
    length = sum(d * d for d in away) ** 0.5
    reach = max(2.5 * ((high_x - low_x) ** 2 + (high_y - low_y) ** 2 + (high_z - low_z) ** 2) ** 0.5, 50.0)
    view.CameraPosition = [c + reach * d / length for c, d in zip(centre, away)]
    view.CameraFocalPoint = centre
    view.CameraViewUp = [0.0, 0.0, 1.0]
    view.CenterOfRotation = centre


def profile(source_name, port, trajectory):
    """A chart of one trajectory of this output, or the chart that is there with this one."""
    source = simple.FindSource(source_name)
    if source.GetXMLName() == "GrowingPaths":  # the whole path, not as far as the rock is now
        source, port = source.Input, source.Input.Port
    made = next((s for s in simple.GetSources().values()
                 if s.GetXMLName() == "TrajectoryProfile" and s.Input.SMProxy == source.SMProxy), None)
    if made:
        made.Trajectory = trajectory
    else:
        view = simple.GetActiveView()
        made = simple.TrajectoryProfile(registrationName="Profile", Input=simple.OutputPort(source, port),
                                        Trajectory=trajectory)
        empty = (chart for chart in simple.GetViews(viewtype="XYChartView") if not len(chart.Representations))
        chart = next(empty, None) or _chart_beside(view)
        simple.Show(made, chart)
        simple.Show(simple.OutputPort(made, 1), view)
        simple.SetActiveView(view)
    made.UpdatePipeline()
    field = servermanager.Fetch(made).GetFieldData()
    if field.GetArray("RockId"):
        title = (f"Rock {int(field.GetArray('RockId').GetTuple1(0))}, "
                 f"iteration {int(field.GetArray('Iteration').GetTuple1(0))}")
        for chart in simple.GetViews(viewtype="XYChartView"):
            if any(shown.Input.SMProxy == made.SMProxy for shown in chart.Representations):
                chart.ChartTitle = title
    simple.RenderAllViews()
    return made


def clock(view=None, name="Clock"):
    """The time of the animation in a corner of the view."""
    view = view or _render_view()
    annotation = simple.FindSource(name) or simple.AnnotateTime(registrationName=name, Format="Time: {time:.1f} s")
    display = simple.Show(annotation, view)
    display.WindowLocation = "Upper Left Corner"
    display.FontSize = 12
    return annotation


def ground(slope, view=None, name="Ground"):
    """The ground of a slope in words, in a corner of the view."""
    view = view or _render_view()
    annotation = simple.PythonAnnotation(registrationName=name, Input=slope, ArrayAssociation="Field Data",
                                         Expression="'Ground: ' + input.FieldData['Ground'].GetValue(0) "
                                                    "if 'Ground' in input.FieldData.keys() else ''")
    display = simple.Show(annotation, view)
    display.WindowLocation = "Lower Left Corner"
    display.FontSize = 12
    return annotation


def report(manifest, show=True):
    """Makes the report of the finished batch study with this manifest.json, and opens it in the browser; gives
    its name. In a process of its own: the slope that it reads is none of the window's."""
    here = os.path.dirname(os.path.abspath(__file__))
    plugins = os.path.join(here, "..", "RockfallDDA")
    folder = os.path.dirname(os.path.abspath(manifest))
    python = shutil.which("pvbatch", path=os.pathsep.join([os.path.dirname(sys.executable), os.environ.get("PATH", "")]))
    if not python:
        raise RuntimeError("There is no pvbatch beside ParaView, which makes reports")
    made = subprocess.run([python, os.path.join(here, "report", "report.py"), folder], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, stdin=subprocess.DEVNULL,
                          env={**os.environ, "PV_PLUGIN_PATH": plugins})
    lines = made.stdout.strip().splitlines() or ["nothing was said"]
    if made.returncode:
        raise RuntimeError(lines[-1])
    path = os.path.join(folder, "report.html")
    print(f"Report: {path}")
    if show:
        webbrowser.open("file://" + path)
    return path


def sheet(view=None):
    """What a picture for others needs: a bar of a round length across the middle of the view, an arrow to the
    north, the date. Called again it puts them where the view is then."""
    view = view or _render_view()
    for name in ("Scale", "North", "North Letter", "Date"):
        old = simple.FindSource(name)
        if old:
            simple.Delete(old)
    eye, focus = (np.array(place) for place in (view.CameraPosition, view.CameraFocalPoint))
    ahead = (focus - eye) / np.linalg.norm(focus - eye)
    right = np.cross(ahead, view.CameraViewUp)
    right /= np.linalg.norm(right)
    up = np.cross(right, ahead)
    high = (2.0 * view.CameraParallelScale if view.CameraParallelProjection else
            2.0 * np.linalg.norm(focus - eye) * np.tan(0.5 * np.radians(view.CameraViewAngle)))
    power = 10.0 ** np.floor(np.log10(0.25 * high))
    length = max(step * power for step in (1, 2, 5) if step * power <= 0.25 * high)
    ink = _text_colour()
    start = focus - 0.36 * high * up - 0.5 * length * right
    bar = simple.Ruler(registrationName="Scale", Point1=list(start), Point2=list(start + length * right))
    display = simple.Show(bar, view)
    display.LabelFormat = f"{length:g} m" if length < 1000.0 else f"{length / 1000.0:g} km"
    display.NumberOfTicks, display.AxisColor, display.AxisLineWidth = 5, ink, 2.0
    _palette().AddLink("TextAnnotationColor", display.SMProxy, "AxisColor", True)  # as its text
    # Before the slope, where nothing hides it.
    near, size = 0.6, 0.04 * high
    foot = eye + near * (focus - eye - 0.36 * high * up + (0.5 * length + 0.06 * high) * right)
    arrow = simple.Arrow(registrationName="North", TipLength=0.4, TipRadius=0.16, ShaftRadius=0.05, TipResolution=24)
    display = simple.Show(arrow, view)
    display.Orientation, display.Scale = [0.0, 0.0, 90.0], 3 * [size]
    move = "Translation" if "Translation" in display.ListProperties() else "Position"
    setattr(display, move, list(foot))
    display.AmbientColor = display.DiffuseColor = ink
    display.Ambient, display.Diffuse = 1.0, 0.0
    letter = simple.Text(registrationName="North Letter", Text="N")
    display = simple.Show(letter, view)
    display.TextPropMode = "Billboard 3D Text"
    display.BillboardPosition = list(foot + size * np.array([0.0, 1.2, 0.0]))
    display.FontSize, display.Bold, display.Color = 24, 1, ink
    date = simple.Text(registrationName="Date", Text=time.strftime("%Y-%m-%d"))
    display = simple.Show(date, view)
    display.WindowLocation = "Upper Center"
    display.FontSize = 12
    for _ in range(2):  # the first cuts off what is nearer than all was before it
        simple.Render(view)


def _palette():
    palette = simple.GetSettingsProxy("ColorPalette")
    return getattr(palette, "SMProxy", palette)


def _text_colour():
    """That of ParaView's palette: white on a white background would not be seen."""
    colour = _palette().GetProperty("TextAnnotationColor")
    return [colour.GetElement(k) for k in range(3)]


def jacksboro():
    """A study of the Jacksboro fault, Tennessee, whose elevations come with matplotlib."""
    import sample_dem
    path = os.path.join(_own_folder(), "jacksboro.tif")
    sample_dem.write_geotiff(sample_dem.find_sample("jacksboro_fault_dem.npz"), path)
    return new_study(path)


def _numbered():
    """Gives the parts of a study their names: of a second study with a 2."""
    taken = {key[0] for key in simple.GetSources()}
    number = 1
    while ("Slope" if number == 1 else f"Slope {number}") in taken:
        number += 1
    return lambda part: part if number == 1 else f"{part} {number}"


def _own_folder():
    """A folder of the user's that stays, or saved states would miss their files."""
    data = os.environ.get("XDG_DATA_HOME") or os.path.join(os.path.expanduser("~"), ".local", "share")
    folder = os.path.join(data, "rockfall-dda")
    try:
        os.makedirs(folder, exist_ok=True)
        return folder
    except OSError:
        return tempfile.mkdtemp(prefix="rockfall-")


def _cell_of_map(fall):
    """Cells of a map as wide as its rocks, a whole number of those of the slope: finer ones show threads. 0: as
    the slope's."""
    grid, width = fall[1].FieldData["TerrainGrid"], fall[1].CellData["Width"]
    if grid and width:
        cell, widest = grid.GetRange(2)[0], width.GetRange(0)[1]
        if widest > 1.5 * cell:
            return round(widest / cell) * cell
    return 0.0


def _render_view():
    view = simple.GetActiveView()
    return view if view and view.GetXMLName() == "RenderView" else simple.GetActiveViewOrCreate("RenderView")


def _await_paths(fall, patience=30.0):
    """Until all are made, or some after a while: a line is put across them, and the view looks at them."""
    start = time.time()
    over = False
    while True:
        fall.UpdatePipeline()
        some = fall[1].GetDataInformation().GetNumberOfCells() > 0
        if over or (some and time.time() - start > patience) or time.time() - start > 10 * patience:
            return
        time.sleep(0.1)
        fall.UpdatePropertyInformation()
        over = not fall.GetProperty("RunStatus").GetElement(0).startswith("running")
        fall.SMProxy.InvokeCommand("Watch")


def _draw_placed(proxy):
    """Makes the line that the filter takes before anything is drawn the drawn one."""
    proxy.UpdatePipeline()
    proxy.UpdatePropertyInformation()
    placed = list(proxy.GetProperty("PlacedLine"))
    if len(proxy.Points) == 0 and any(placed):
        proxy.Points = [round(x, 2) for x in placed]  # cm: nobody draws finer
        proxy.UpdatePipeline()


def _chart_beside(view):
    """A chart right of this view, or under the charts that are there: the slope stays as large as it is."""
    chart = simple.CreateView("XYChartView")
    layout = simple.GetLayout(view) if view else None
    if layout:
        charts = [layout.GetViewLocation(other.SMProxy) for other in simple.GetViewsInLayout(layout)
                  if other.GetXMLName() == "XYChartView"]
        simple.AssignViewToLayout(view=chart, layout=layout, hint=max([0, *charts]))
    return chart


def _show_curve(line, chart, title):
    curve = simple.Show(simple.OutputPort(line, 2), chart)
    curve.UseIndexForXAxis = 0
    curve.XArrayName = "EnergyInKilojoules"
    curve.SeriesVisibility = ["ShareOfPassing"]
    curve.SeriesLabel = ["ShareOfPassing", "Share of the rocks that pass"]
    chart.ChartTitle = title
    chart.BottomAxisTitle = "Kinetic energy (kJ)"
    chart.LeftAxisTitle = "Share with this or more"
