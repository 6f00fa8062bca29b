#!/usr/bin/env bash
# Runs the tests, after doing all of the set-up that is still missing.
#
#   bash Testing/run.sh [ctest arguments]
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

setup all
exec ctest --test-dir "$rockfall_build" --output-on-failure --parallel "$(nproc)" "$@" </dev/null
