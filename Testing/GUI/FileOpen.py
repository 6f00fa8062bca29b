"""What the window's pipeline must have at the Check of FileOpen.xml: a slope of all cells of the file."""
from paraview import simple

cells = simple.GetActiveSource().GetDataInformation().GetNumberOfCells()
assert cells == 274072, cells
