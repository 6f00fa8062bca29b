#!/usr/bin/env bash
# GDAL's AAIGrid reader takes a word among the numbers for 0: a hole in a DEM, class 0 in a map of classes.
#
# Expected: an error, or no data, as for numbers that are missing. Happens: 0, without a message.
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

printf 'ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n100 rock 102\n103 104 105\n' > word.asc
gdal_translate -q -of XYZ word.asc word.xyz 2> said
heights=$(cut -d ' ' -f 3 word.xyz | xargs)
echo "heights: $heights, messages: $(wc -l < said)"
[ "$heights" = "100 0 102 103 104 105" ]
[ ! -s said ]
