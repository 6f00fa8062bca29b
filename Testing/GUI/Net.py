"""What the window's pipeline must have after each Check of Net.xml."""
from paraview import servermanager, simple


def drawn():
    net = simple.GetActiveSource()
    assert net.GetXMLName() == "DrawnStructure", net.GetXMLName()
    line, release = simple.FindSource("Line").Points, simple.FindSource("Release")
    low_x, high_x, low_y, high_y = release.GetDataInformation().GetBounds()[:4]
    above = (0.5 * (low_x + high_x), 0.5 * (low_y + high_y))
    for k in (0, 3):
        net_away, line_away = (sum((end[k + axis] - above[axis]) ** 2 for axis in (0, 1)) ** 0.5
                               for end in (net.Points, line))
        assert 1.0 < line_away - net_away < 25.0, f"the net is at {list(net.Points)}, the line at {list(line)}"


def met():
    release, fall = simple.FindSource("Release"), simple.FindSource("Fall")
    assert release.Terrain.GetXMLName() == "DrawnStructure"
    rocks = servermanager.Fetch(fall, idx=4)
    assert rocks.GetNumberOfPoints() > 0.5 * 200, f"{rocks.GetNumberOfPoints()} of 200 rocks met the net"
    simple.ColorBy(simple.Show(simple.OutputPort(fall, 4), simple.GetRenderView()), ("POINTS", "Outcome"))


def further():
    net, first = simple.GetActiveSource(), simple.GetActiveSource().Terrain
    assert first.GetXMLName() == "DrawnStructure", first.GetXMLName()
    away = min(abs(net.Points[k] - first.Points[k]) for k in (0, 3))  # the test slope falls along x
    assert away > 3.0, f"a second net stands {away} m from the first"
    named(simple.GetColorTransferFunction("Outcome"))


def named(table):
    """Met rocks are coloured by words, not by numbers."""
    words = dict(zip(table.Annotations[::2], table.Annotations[1::2]))
    assert table.InterpretValuesAsCategories and words["0"] == "barrier held" and words["1"] == "barrier broke", words
    bar = simple.GetScalarBar(table, simple.GetRenderView())
    assert bar.Visibility and bar.Title == "Outcome", bar.Title


[drawn, met, further][number - 1]()
