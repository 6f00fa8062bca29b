"""Pieces of a picture in ParaView: colours, texts, bars, rocks and their shadows."""
import numpy as np
from paraview.simple import *
from vtkmodules.util.numpy_support import vtk_to_numpy

from rockfall_ground import cells, make_polydata

INK = [0.1, 0.1, 0.1]
RELEASED = [0.0, 0.62, 1.0]
SANDSTONE = [0.93, 0.62, 0.32]


def produce(polydata):
    """A source that gives this polydata."""
    source = TrivialProducer()
    source.GetClientSideObject().SetOutput(polydata)
    source.UpdatePipeline()
    return source


def new_view(size, background=(1.0, 1.0, 1.0)):
    view = CreateRenderView()
    view.ViewSize = list(size)
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = list(background)
    view.UseFXAA = 1
    return view


def move(display, by):
    """Shows something elsewhere, m. The property is Translation since ParaView 5.13, Position before."""
    setattr(display, "Translation" if "Translation" in display.ListProperties() else "Position", list(by))


def plain(source, view, colour, by=(0.0, 0.0, 0.0), **properties):
    display = Show(source, view)
    display.ColorArrayName = ["POINTS", ""]
    display.AmbientColor = display.DiffuseColor = list(colour)
    move(display, by)
    for name, value in properties.items():
        setattr(display, name, value)
    return display


def flat(source, view, colour, **properties):
    """In one colour whatever the light."""
    return plain(source, view, colour, Ambient=1.0, Diffuse=0.0, **properties)


def show_slope(source, view):
    display = Show(source, view)
    ColorBy(display, ("POINTS", "Shade"))
    display.MapScalars = 0
    display.Ambient, display.Diffuse = 1.0, 0.0
    return display


def show_speed(source, view, top):
    display = Show(source, view)
    ColorBy(display, ("POINTS", "Speed"))
    colours = GetColorTransferFunction("Speed")
    # ParaView 6 has the short name alone and raises at others, 5.11 ignores what it does not know.
    long_name = "Plasma (matplotlib)"
    colours.ApplyPreset(long_name if long_name in GetLookupTableNames() else "Plasma", True)
    colours.RescaleTransferFunction(0.0, top)
    display.Ambient, display.Diffuse = 0.55, 0.5
    return display


def number_format(usual, form):
    """A format in the language of this ParaView's default: printf's before 6.1, {} from then on."""
    return f"%{form}" if "%" in usual else f"{{:{form}}}"


def speed_bar(view, position, length, size=20):
    bar = GetScalarBar(GetColorTransferFunction("Speed"), view)
    bar.Title, bar.ComponentTitle = "Speed (m/s)", ""
    bar.TitleColor = bar.LabelColor = INK
    bar.TitleFontSize = bar.LabelFontSize = size
    bar.AutoOrient, bar.Orientation, bar.HorizontalTitle = 0, "Vertical", 1
    bar.WindowLocation = "Any Location"
    bar.Position, bar.ScalarBarLength, bar.ScalarBarThickness = list(position), length, size
    bar.LabelFormat = bar.RangeLabelFormat = number_format(bar.RangeLabelFormat, ".0f")
    bar.Visibility = 1


def write(view, text, position, size=22, colour=INK, bold=False, centred=False):
    """Text with its lower left corner, or about the middle of its lower edge, at a share of the
    picture's width and height. Returns the text's source."""
    source = Text(Text=str(text))
    display = Show(source, view)
    shift = 0.26 * size * len(str(text)) / view.ViewSize[0] if centred else 0.0
    display.WindowLocation, display.Position = "Any Location", [position[0] - shift, position[1]]
    display.FontSize, display.Color, display.Bold = size, list(colour), int(bold)
    display.Justification = "Left"
    return source


def write_lines(view, lines, position, size=18):
    """Lines of text one under the other, the last one with its lower left corner there."""
    for k, line in enumerate(reversed(lines)):
        write(view, line, (position[0], position[1] + 1.5 * k * size / view.ViewSize[1]), size)


def seen_at(view, point):
    """Share of the picture's width and height at which a point of the world is seen."""
    x, y, _, w = projection(view) @ [*point, 1.0]
    return [0.5 + 0.5 * x / w, 0.5 + 0.5 * y / w]


def projection(view):
    width, height = view.ViewSize
    matrix = view.GetActiveCamera().GetCompositeProjectionTransformMatrix(width / height, -1, 1)
    return np.array([[matrix.GetElement(i, k) for k in range(4)] for i in range(4)])


def points_source(points, radius):
    """Little spheres."""
    polydata = make_polydata(points)
    polydata.SetVerts(cells(np.arange(len(points))[:, None]))
    glyph = Glyph(Input=produce(polydata), GlyphType="Sphere", GlyphMode="All Points",
                  ScaleFactor=2 * radius)
    glyph.OrientationArray = ["POINTS", "No orientation array"]
    glyph.ScaleArray = ["POINTS", "No scale array"]
    return glyph


def round_length(most):
    """The largest of 1, 2, 5 times a power of ten that is not more."""
    power = 10.0 ** np.floor(np.log10(most))
    return max(step * power for step in (1, 2, 5) if step * power <= most)


def length_text(metres):
    return f"{metres / 1000:g} km" if metres >= 1000 else f"{metres:g} m"


def quads(corners):
    """Polygons of four corners each, (n, 4, 3)."""
    polydata = make_polydata(corners.reshape(-1, 3))
    polydata.SetPolys(cells(np.arange(4 * len(corners)).reshape(-1, 4)))
    return produce(polydata)


def rock_points(polydata):
    """Points of the rocks and the number of the rock that each belongs to."""
    points = vtk_to_numpy(polydata.GetPoints().GetData()).copy()
    polygons = polydata.GetPolys()
    sizes = np.diff(vtk_to_numpy(polygons.GetOffsetsArray()))
    owner = np.empty(len(points), int)
    owner[vtk_to_numpy(polygons.GetConnectivityArray())] = \
        np.repeat(vtk_to_numpy(polydata.GetCellData().GetArray("RockId")), sizes)
    return points, owner


def enlarge(polydata, times):
    """Points of rocks that are bigger by a factor, each about its lowest point."""
    points, owner = rock_points(polydata)
    for rock in np.unique(owner):
        own = points[owner == rock]
        foot = np.append(own[:, :2].mean(axis=0), own[:, 2].min())
        points[owner == rock] = foot + times * (own - foot)
    return points


def cast_shadows(polydata, ground, light=(-0.35, 0.25, 1.0)):
    """Points of rocks moved along the light onto the ground, a little over it."""
    points, _ = rock_points(polydata)
    fallen = points.copy()
    for _ in range(4):
        drop = points[:, 2] - ground.height(fallen[:, 0], fallen[:, 1])
        fallen[:, 0] = points[:, 0] - light[0] / light[2] * drop
        fallen[:, 1] = points[:, 1] - light[1] / light[2] * drop
    fallen[:, 2] = ground.height(fallen[:, 0], fallen[:, 1]) + 0.03
    return fallen


def python_filter(source, name, points_of):
    """A filter, registered as `name`, that moves the points of the rocks at any time. It has a
    function instead of a script: ParaView runs scripts among the caller's own names, and puts all
    of numpy's there."""
    filtered = ProgrammableFilter(registrationName=name, Input=source, CopyArrays=0)
    algorithm = filtered.GetClientSideObject()

    def run():
        given, made = algorithm.GetPolyDataInput(), algorithm.GetPolyDataOutput()
        made.ShallowCopy(given)
        if given.GetNumberOfPoints():
            made.SetPoints(make_polydata(points_of(given)).GetPoints())
    algorithm.SetExecuteMethod(run)
    return filtered
