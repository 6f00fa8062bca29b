#!/usr/bin/env bash
# VTK's XML writers put the ranges that an array remembers into the file, as keys, in the order in which
# they were asked for. The same data gives a file of other bytes after somebody has looked at its ranges, as
# ParaView does before it draws.
#
# Expected: the same data gives the same file. Happens: three files of the same data are three different files.
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

cat > write.py <<'PYTHON'
import hashlib
import re
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter


def written(ask):
    """The file of the same three velocities after somebody has asked for some of their ranges."""
    velocities = vtkDoubleArray()
    velocities.SetName("velocity")
    velocities.SetNumberOfComponents(3)
    points = vtkPoints()
    for k in range(3):
        velocities.InsertNextTuple3(k, 0.0, -k)
        points.InsertNextPoint(k, 0.0, 0.0)
    for name in ask:
        getattr(velocities, name)(-1)
    data = vtkPolyData()
    data.SetPoints(points)
    data.GetPointData().AddArray(velocities)
    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(data)
    writer.WriteToOutputStringOn()
    writer.Write()
    return writer.GetOutputString()


files = set()
for ask in ((), ("GetRange", "GetFiniteRange"), ("GetFiniteRange", "GetRange")):
    text = written(ask)
    keys = re.findall('InformationKey name="(L2[A-Z0-9_]*)"', text)
    files.add(hashlib.sha256(text.encode()).hexdigest())
    print(f"asked {ask}: keys {keys}")
print(len(files), "different files of the same data")
if len(files) != 3:
    raise SystemExit(1)
PYTHON
env -u PV_PLUGIN_PATH pvpython write.py
