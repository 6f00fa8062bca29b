#!/usr/bin/env bash
# Swiss LV03 to LV95: the official way needs the grid CHENyx06a. Where it is not installed, as with Debian's
# proj-data, GDAL's tools add whole millions and say nothing: up to 1.5 m beside. PROJ itself knows (projinfo).
#
# Expected: a warning, as the way is a "ballpark" one of unknown accuracy. Happens: 720000 80000 becomes
# 2720000 1080000, where the official grid has 2720000.114 1079998.548, and not a word.
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

echo "720000 80000" | PROJ_NETWORK=OFF gdaltransform -s_srs EPSG:21781 -t_srs EPSG:2056 -output_xy > place 2> said
echo "$(cat place), messages: $(wc -l < said)"
[ "$(cat place)" = "2720000 1080000" ]
[ ! -s said ]
