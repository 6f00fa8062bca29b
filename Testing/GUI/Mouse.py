"""What the window must show after each Check of Mouse.xml."""
from paraview import simple


def picked():
    """The first point of the release line is on the slope, not at 0, 0, 0; the paths do not hide the picked one."""
    x, y, z = list(simple.FindSource("Release").Points)[:3]
    low_x, high_x, low_y, high_y, low_z, high_z = simple.FindSource("Slope").GetDataInformation().GetBounds()
    assert low_x < x < high_x and low_y < y < high_y and low_z < z < high_z, (x, y, z)
    view = simple.GetRenderView()
    assert simple.GetDisplayProperties(simple.FindSource("Paths"), view).Opacity < 0.5, "paths hide the picked one"


def unpicked():
    """Paths are as they were before one was picked, when the last of their profiles is gone."""
    view = simple.GetRenderView()
    first = simple.FindSource("Profile")
    second = simple.TrajectoryProfile(Input=first.Input, Trajectory=1)
    simple.Delete(first)
    assert simple.GetDisplayProperties(simple.FindSource("Paths"), view).Opacity < 0.5, "paths hide the other picked one"
    simple.Delete(second)
    assert simple.GetDisplayProperties(simple.FindSource("Paths"), view).Opacity == 1.0, "paths stay pale"


def drawn_up():
    """The arrow to the north is not cut off, and the bar has the colour of texts, also when another palette is taken."""
    view = simple.GetRenderView()
    camera = view.GetActiveCamera()
    arrow = simple.GetDisplayProperties(simple.FindSource("North"), view)
    place = arrow.Translation if "Translation" in arrow.ListProperties() else arrow.Position
    ahead = sum(d * (p - e) for d, p, e in zip(camera.GetDirectionOfProjection(), place, camera.GetPosition()))
    near, far = camera.GetClippingRange()
    assert near < ahead < far, f"the arrow, {ahead} m away, is not between {near} and {far} m"
    simple.LoadPalette("WhiteBackground")
    bar = simple.GetDisplayProperties(simple.FindSource("Scale"), view)
    assert list(bar.AxisColor) == [0.0, 0.0, 0.0], list(bar.AxisColor)


[picked, drawn_up, unpicked][number - 1]()
