#!/usr/bin/env bash
# Opens ParaView with the plugin and its menu Rockfall, after doing all of the set-up that is still missing.
#
#   bash Examples/window.sh [arguments of paraview]
source "$(dirname -- "${BASH_SOURCE[0]}")/../Testing/setup.sh"

setup plugin

exec env PV_PLUGIN_PATH="$PV_PLUGIN_PATH:$rockfall_window" paraview "$@"
