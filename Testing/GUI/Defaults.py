"""What the source or filter that is chosen at each Check of Defaults.xml has made."""
from paraview import simple

cells = simple.GetActiveSource().GetDataInformation().GetNumberOfCells()
assert cells == [7200, 60, 10, 7200, 6, 162][number - 1], (number, cells)
