#!/usr/bin/env bash
# GDAL's MEM driver opens a name as an address: MEM:::DATAPOINTER=… reads there, also where a virtual raster
# names it. GDAL 3.10 and later are said to ask for GDAL_MEM_ENABLE_OPEN first; not tried here.
#
# Expected: an error. Happens: a segmentation fault, or the program's own memory as heights.
set -eu
packages="gdal-bin=3.6.2+dfsg-1+b2 libgdal32=3.6.2+dfsg-1+b2 gdal-data=3.6.2+dfsg-1
  libproj25=9.1.1-1+b1 proj-data=9.1.1-1"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir -p archives/partial
apt-get install -y -qq --reinstall --download-only --no-install-recommends -o Debug::NoLocking=1 \
  -o APT::Sandbox::User=root -o Dir::Cache::Archives="$folder/archives" $packages > /dev/null
for package in archives/*.deb; do
  dpkg -x "$package" root
done
export PATH="$folder/root/usr/bin:$PATH" LD_LIBRARY_PATH="$folder/root/usr/lib/$(uname -m)-linux-gnu"
export GDAL_DATA="$folder/root/usr/share/gdal" PROJ_DATA="$folder/root/usr/share/proj"
echo $packages
gdalinfo --version

printf '%s' '<VRTDataset rasterXSize="2" rasterYSize="2"><VRTRasterBand dataType="Byte" band="1"><SimpleSource>' \
  '<SourceFilename>MEM:::DATAPOINTER=1,PIXELS=2,LINES=2</SourceFilename><SourceBand>1</SourceBand>' \
  '</SimpleSource></VRTRasterBand></VRTDataset>' > memory.vrt
for name in MEM:::DATAPOINTER=1,PIXELS=2,LINES=2 memory.vrt; do
  code=0
  bash -c 'gdalinfo -stats "$0" > /dev/null 2>&1' "$name" 2> /dev/null || code=$?
  echo "$name: ended with $code"
  [ "$code" -eq 139 ]
done
