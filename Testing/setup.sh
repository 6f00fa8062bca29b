# shellcheck shell=bash
# Sourced by Examples/run.sh, Examples/window.sh and Testing/run.sh: whatever is still missing of
# packages, configuration and build. Quick when nothing is. Defines rockfall_root, rockfall_build and
# the functions below.

set -euo pipefail

rockfall_root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd -P)
rockfall_build=$rockfall_root/build
rockfall_log=$rockfall_build/setup.log

rockfall_packages=(
  g++ cmake ninja-build
  paraview paraview-dev python3-paraview libopenmpi-dev libdouble-conversion-dev
  libeigen3-dev libgdal-dev libhdf5-dev gdal-bin libicu-dev libtbb-dev librandom123-dev libqhull-dev libboost-dev
  xvfb xauth locales python3-matplotlib python-matplotlib-data python3-jinja2 python3-gdal)
rockfall_test_packages=(libgtest-dev python3-jsonschema)

fail() {
  echo "RockfallDDA: $*" >&2
  exit 1
}

# Runs a command with its output in the log, whose end is shown if it fails.
logged() {
  mkdir -p -- "$rockfall_build"
  if ! "$@" >"$rockfall_log" 2>&1 </dev/null; then
    tail -n 40 -- "$rockfall_log" >&2
    return 1
  fi
}

# What apt or dpkg says that a package depends on; fetches package lists where there are none.
depends_on() {
  dpkg-query -W -f='${Depends}' "$1" 2>/dev/null && return
  command -v apt-cache >/dev/null || return 0
  if ! apt-cache show "$1" >/dev/null 2>&1 && [ "$(id -u)" -eq 0 ]; then
    logged apt-get -q -y -o DPkg::Lock::Timeout=600 update || true
  fi
  apt-cache depends "$1" 2>/dev/null || true
}

# The packages that hang on this release's ParaView: its Qt and, where it is built on Debian's own VTK,
# that VTK. Of Qt: icons, without which ParaView's window has no eyes and no Play; what the Rockfall menu
# is built with; and for the tests the pages behind ?.
choose_packages() {
  local paraview
  paraview=$(depends_on paraview)
  if [[ $paraview == *libqt6* ]]; then
    rockfall_packages+=(qt6-svg-plugins qt6-base-dev libpython3-dev)
    rockfall_test_packages+=(qt6-documentation-tools qt6-tools-dev)
  else
    rockfall_packages+=(libqt5svg5 qtbase5-dev)
    rockfall_test_packages+=(qttools5-dev-tools)
  fi
  if [[ $paraview == *libvtk9* ]]; then
    rockfall_packages+=(libvtk9-dev libvtk9-qt-dev)
  fi
}

# install_packages <package>...: those of them that are missing.
install_packages() {
  local missing=() package
  for package in "$@"; do
    if [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" != installed ]; then
      missing+=("$package")
    fi
  done
  [ ${#missing[@]} -gt 0 ] || return 0

  command -v apt-get >/dev/null ||
    fail "these packages of Debian 12 are missing and there is no apt-get to install them: ${missing[*]}"
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    as_root=(sudo -n)
    { command -v sudo && sudo -n true; } >/dev/null 2>&1 ||
      fail "these packages are missing and installing them takes root or passwordless sudo: ${missing[*]}"
  fi
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y
    -o DPkg::Lock::Timeout=600)
  local install=("${apt[@]}" install --no-install-recommends "${missing[@]}")

  echo "Installing ${#missing[@]} packages: ${missing[*]}"
  local known=yes
  for package in "${missing[@]}"; do
    apt-cache show "$package" >/dev/null 2>&1 || known=no
  done
  # Package lists that lack something or are too old to install from are fetched again.
  if [ $known = no ] || ! logged "${install[@]}" 2>/dev/null; then
    logged "${apt[@]}" update || fail "apt-get update failed; the packages ${missing[*]} are needed"
    logged "${install[@]}" || fail "installing these packages failed: ${missing[*]}"
  fi
}

# What the cache of a configured build says of a variable.
cached() {
  sed -n "s/^$1:[A-Z]*=//p" "$rockfall_build/CMakeCache.txt" 2>/dev/null || true
}

# configure_and_build plugin|all: configures (with ROCKFALL_CMAKE_ARGS, if any) and builds the plugin
# alone, or all that is tested too. A folder that has been configured for the tests stays so.
configure_and_build() {
  local fresh=() testing=OFF
  if [ "$1" = all ] || [ "$(cached ROCKFALL_TESTING)" = ON ]; then
    testing=ON
  fi
  if [ -n "$(cached CMAKE_HOME_DIRECTORY)" ] &&
    [ "$(cached CMAKE_HOME_DIRECTORY)" != "$rockfall_root" ]; then
    fresh=(--fresh) # the folder was moved or copied
  fi
  # shellcheck disable=SC2206
  local arguments=(${ROCKFALL_CMAKE_ARGS:-})
  if [ ! -f "$rockfall_build/build.ninja" ] || [ ${#fresh[@]} -gt 0 ] ||
    [ ${#arguments[@]} -gt 0 ] || [ "$(cached ROCKFALL_PLUGIN)" != ON ] ||
    [ "$(cached ROCKFALL_TESTING)" != "$testing" ]; then
    echo "Configuring in $rockfall_build"
    logged cmake -S "$rockfall_root" -B "$rockfall_build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
      -DROCKFALL_PLUGIN=ON -DROCKFALL_TESTING=$testing -DROCKFALL_BENCHMARKS=OFF \
      "${fresh[@]}" "${arguments[@]}" ||
      fail "configuring failed; all of it is in $rockfall_log"
  fi
  echo "Building"
  build "$1" || fail "the build failed; all of it is in $rockfall_log"
}

# build plugin|all: builds, says at every tenth how far it is, and shows the end of the log if it
# fails.
build() {
  local target=all
  [ "$1" = all ] || target=RockfallPlugins
  NINJA_STATUS='[%p] ' cmake --build "$rockfall_build" --target $target --parallel "$(nproc)" \
    2>&1 </dev/null |
    tee -- "$rockfall_log" |
    awk '/^\[ *[0-9]+%\]/ {
      tenth = int(substr($0, 2) / 10)
      if (tenth > last) { last = tenth; printf "  %d %% built\n", 10 * tenth; fflush() }
    }' || { tail -n 40 -- "$rockfall_log" >&2; return 1; }
}

# setup plugin|all: packages and build, and where ParaView finds the plugin; rockfall_window is the
# folder of what only a window loads.
setup() {
  local packages=("${rockfall_packages[@]}")
  [ "$1" = plugin ] || packages+=("${rockfall_test_packages[@]}")
  install_packages "${packages[@]}"
  configure_and_build "$1"
  local plugin
  plugin=$(find "$rockfall_build/lib" -name RockfallDDA.so -print -quit)
  [ -n "$plugin" ] || fail "the build made no RockfallDDA.so in $rockfall_build/lib"
  export PV_PLUGIN_PATH="${plugin%/*}${PV_PLUGIN_PATH:+:$PV_PLUGIN_PATH}"
  rockfall_window=${plugin%/*/*}/RockfallWindow
}

choose_packages
