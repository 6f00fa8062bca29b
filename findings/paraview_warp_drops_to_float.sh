#!/usr/bin/env bash
# ParaView's Warp By Scalar makes points of single precision out of points of double precision: far from the
# origin, as in every national grid, they move by decimetres, also where the scalar is 0.
#
# Expected: points in double precision, unchanged where the scalar is 0. Happens: float, 0.2 m beside at 5,000,000 m.
set -eu
packages="paraview=5.11.0+dfsg-1+b1 python3-paraview=5.11.0+dfsg-1+b1"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir -p archives/partial
apt-get install -y -qq --reinstall --download-only --no-install-recommends -o Debug::NoLocking=1 \
  -o APT::Sandbox::User=root -o Dir::Cache::Archives="$folder/archives" $packages > /dev/null
for package in archives/*.deb; do
  dpkg -x "$package" root
done
export PATH="$folder/root/usr/bin:$PATH" PYTHONPATH="$folder/root/usr/lib/python3/dist-packages"
export LD_LIBRARY_PATH="$folder/root/usr/lib/$(uname -m)-linux-gnu"
echo "$packages"

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
