#!/usr/bin/env bash
# Swiss LV03 to LV95: the official way needs the grid CHENyx06a. Where it is not installed, as with Debian's
# proj-data, GDAL's tools add whole millions and say nothing: up to 1.5 m beside. PROJ itself knows (projinfo).
#
# Expected: a warning, as the way is a "ballpark" one of unknown accuracy. Happens: 720000 80000 becomes
# 2720000 1080000, where the official grid has 2720000.114 1079998.548, and not a word.
set -eu
version=3.6.2+dfsg-1+b2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
installed=$(dpkg-query -W -f '${Version}' gdal-bin 2>/dev/null || true)
if [ "$installed" != "$version" ]; then
  apt-get install -y --no-install-recommends "gdal-bin=$version" "libgdal32=$version"
fi
echo "gdal-bin $(dpkg-query -W -f '${Version}' gdal-bin), libproj25 $(dpkg-query -W -f '${Version}' libproj25)"

echo "720000 80000" | PROJ_NETWORK=OFF gdaltransform -s_srs EPSG:21781 -t_srs EPSG:2056 -output_xy > place 2> said
echo "$(cat place), messages: $(wc -l < said)"
[ "$(cat place)" = "2720000 1080000" ]
[ ! -s said ]
