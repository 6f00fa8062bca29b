#!/usr/bin/env bash
# Runs an example in pvbatch, after doing all of the set-up that is still missing.
#
#   bash Examples/run.sh [script.py [arguments]]
#
# Without arguments it runs the main job, jacksboro.py, which writes into output/. A script that is not
# found as named is looked for beside this file. The exit code is the script's.
source "$(dirname -- "${BASH_SOURCE[0]}")/../Testing/setup.sh"

script=${1:-jacksboro.py}
[ $# -eq 0 ] || shift
if [ ! -f "$script" ]; then
  [ -f "$rockfall_root/Examples/$script" ] ||
    fail "there is no script $script, neither here nor in $rockfall_root/Examples"
  script=$rockfall_root/Examples/$script
fi

setup plugin

# Rendering needs an X server; without -noreset a fresh one may vanish between two clients.
exec xvfb-run -a -s "-screen 0 1400x1000x24 -noreset" pvbatch "$script" "$@" </dev/null
