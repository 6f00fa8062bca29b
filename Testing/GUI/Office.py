"""What the window's legends must have after each Check of Office.xml."""
from paraview import simple


def classes():
    table = simple.GetColorTransferFunction("Intensity100a")
    assert table.InterpretValuesAsCategories
    named = dict(zip(table.Annotations[::2], table.Annotations[1::2]))
    expected = {"0": "none", "1": "weak, below 30 kJ", "2": "medium, 30 to 300 kJ", "3": "strong, from 300 kJ"}
    assert named == expected, named
    assert len(set(zip(*[iter(table.IndexedColors)] * 3))) == 4, list(table.IndexedColors)
    bar = simple.GetScalarBar(table, simple.GetRenderView())
    assert bar.Visibility and bar.Title == "Intensity, 100 a", bar.Title


[classes][number - 1]()
