#!/usr/bin/env bash
# GDAL's AAIGrid reader drops the place of a grid whose header gives a corner along one axis and the centre of
# a cell along the other. Each axis has its own keyword, so each can be read by itself.
#
# Expected: lower left corner at 600000, 4999995. Happens: the grid lies at 0, 0, without a message.
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

printf 'ncols 3\nnrows 2\nxllcorner 600000\nyllcenter 5000000\ncellsize 10\n1 2 3\n4 5 6\n' > mixed.asc
printf 'ncols 3\nnrows 2\nxllcorner 600000\nyllcorner 4999995\ncellsize 10\n1 2 3\n4 5 6\n' > corners.asc
for grid in corners mixed; do
  echo "$grid.asc: $(gdalinfo "$grid.asc" 2>&1 | grep -E '^Lower Left')"
done
gdalinfo corners.asc | grep -q '^Lower Left *( *600000.000, *4999995.000)'
gdalinfo mixed.asc 2> said | grep -q '^Lower Left *( *0.0000000, *-20.0000000)'
[ ! -s said ]
