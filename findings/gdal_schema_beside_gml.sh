#!/usr/bin/env bash
# GDAL takes the fields of GML from a .gfs beside it, which it writes itself when it reads GML. After an
# edit within the same second, or a copy that makes the .gfs the newer one, fields are lost.
#
# Expected: a message that both disagree. Happens: the .gfs rules, without a message.
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

cat > rocks.gml <<'END'
<ogr:FeatureCollection xmlns:ogr="http://ogr.maptools.org/" xmlns:gml="http://www.opengis.net/gml">
<gml:featureMember><ogr:rocks fid="r.0"><ogr:geometryProperty><gml:Point><gml:coordinates>1,2</gml:coordinates>
</gml:Point></ogr:geometryProperty><ogr:volume>3.5</ogr:volume></ogr:rocks></gml:featureMember>
</ogr:FeatureCollection>
END
ogrinfo -al -q rocks.gml | grep 'volume (Real) = 3.5'
sed -i '/<PropertyDefn>/,/<\/PropertyDefn>/d' rocks.gfs
touch -d '+1 hour' rocks.gfs
ogrinfo -al -q rocks.gml > read 2> said
! grep -q volume read
[ ! -s said ]
