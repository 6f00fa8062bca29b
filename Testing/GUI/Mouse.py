"""Where the first point of the release line must be after Mouse.xml: on the slope, not at 0, 0, 0."""
from paraview import simple

x, y, z = list(simple.FindSource("Release").Points)[:3]
low_x, high_x, low_y, high_y, low_z, high_z = simple.FindSource("Slope").GetDataInformation().GetBounds()
assert low_x < x < high_x and low_y < y < high_y and low_z < z < high_z, (x, y, z)
