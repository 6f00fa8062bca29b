#!/usr/bin/env bash
# Runs the tests, after doing all of the set-up that is still missing.
#
#   bash Testing/run.sh [ctest arguments]
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

setup all
# Two more than processors: a window waits for its events a third of the time, and a start for the disk.
exec ctest --test-dir "$rockfall_build" --output-on-failure --parallel "$(($(nproc) + 2))" "$@" </dev/null
