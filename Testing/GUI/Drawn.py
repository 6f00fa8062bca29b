"""What the window's pipeline must have after each Check of Drawn.xml."""
from paraview import servermanager, simple


def values(data, name):
    array = data.GetArray(name)
    return [array.GetTuple1(k) for k in range(array.GetNumberOfTuples())]


def drawn():
    forest = simple.GetActiveSource()
    assert [x for k, x in enumerate(forest.Points) if k % 3 < 2] == [20, 20, 20, 80, 40, 50], list(forest.Points)
    built = servermanager.Fetch(forest, idx=1)
    kinds = values(built.GetCellData(), "StructureKind")
    assert len(set(kinds)) == 2, "an embankment and trees"
    assert len(set(values(built.GetCellData(), "StructureId"))) > 10, "a tree and an embankment is no forest"
    notes = servermanager.Fetch(forest).GetFieldData().GetAbstractArray("Notes")
    odd = [notes.GetValue(k) for k in range(notes.GetNumberOfValues()) if not notes.GetValue(k).startswith("The preset")]
    assert not odd, f"the defaults of a forest look odd: {odd}"


def hit():
    fall = simple.GetActiveSource()
    trees = servermanager.Fetch(fall, idx=4)
    assert trees.GetNumberOfPoints() > 0, "no tree was hit"
    paths = servermanager.Fetch(fall, idx=1)
    cells = [paths.GetCell(k) for k in range(paths.GetNumberOfCells())]
    ends = [cell.GetPoints().GetPoint(cell.GetNumberOfPoints() - 1)[0] for cell in cells]
    held = sum(end < 50.0 for end in ends)
    assert held > 0.8 * len(ends), f"the embankment at x = 50 m held {held} of {len(ends)} rocks"


[drawn, hit][number - 1]()
