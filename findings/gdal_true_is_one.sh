#!/usr/bin/env bash
# GDAL's GeoJSON reader makes 1 of true where the other features have numbers.
#
# Expected: a column of text, or a message. Happens: a column of numbers, without a message.
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

point='"type":"Feature","geometry":{"type":"Point","coordinates":[1,2]}'
cat > rocks.geojson <<END
{"type":"FeatureCollection","features":[
{$point,"properties":{"volume":0.5}},
{$point,"properties":{"volume":true}}]}
END
ogrinfo -al -q rocks.geojson 2> said | grep 'volume (Real) = 1$'
[ ! -s said ]
