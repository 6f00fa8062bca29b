#!/usr/bin/env bash
# ParaView's Warp By Scalar makes points of single precision out of points of double precision: far from the
# origin, as in every national grid, they move by decimetres, also where the scalar is 0.
#
# Expected: points in double precision, unchanged where the scalar is 0. Happens: float, 0.2 m beside at 5,000,000 m.
set -eu
version=5.11.0+dfsg-1+b1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
installed=$(dpkg-query -W -f '${Version}' python3-paraview 2>/dev/null || true)
if [ "$installed" != "$version" ]; then
  apt-get install -y --no-install-recommends "paraview=$version" "python3-paraview=$version"
fi
echo "python3-paraview $(dpkg-query -W -f '${Version}' python3-paraview)"

cat > warp.py <<'PYTHON'
from paraview.simple import ProgrammableSource, WarpByScalar
from paraview import servermanager

points = ProgrammableSource(OutputDataSetType="vtkPolyData", Script="""
import vtk
places = vtk.vtkPoints()
places.SetDataTypeToDouble()
places.InsertNextPoint(600000.3, 5000000.3, 1000.1)
height = vtk.vtkDoubleArray()
height.SetName("height")
height.InsertNextValue(0.0)
output.SetPoints(places)
output.GetPointData().AddArray(height)
""")
warp = WarpByScalar(Input=points, Scalars=["POINTS", "height"])
before, after = servermanager.Fetch(points), servermanager.Fetch(warp)
print("before", before.GetPoints().GetData().GetDataTypeAsString(), before.GetPoint(0))
print("after", after.GetPoints().GetData().GetDataTypeAsString(), after.GetPoint(0))
moved = abs(after.GetPoint(0)[1] - before.GetPoint(0)[1])
print("moved by", moved, "m in y")
if after.GetPoints().GetData().GetDataTypeAsString() != "float" or not 0.1 < moved < 0.5:
    raise SystemExit(1)
PYTHON
env -u PV_PLUGIN_PATH pvpython warp.py
