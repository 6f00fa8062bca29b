#!/usr/bin/env bash
# Runs a script on several MPI ranks, each of which runs it (pvbatch --sym), with the plugin loaded.
#
#   bash Examples/mpi.sh RANKS script.py [arguments]
#
# MPIEXEC_OPTIONS go to mpiexec, e.g. "--hostfile hosts". Scripts that draw pictures need one rank:
# bash Examples/run.sh.
source "$(dirname -- "${BASH_SOURCE[0]}")/../Testing/setup.sh"

[ $# -ge 2 ] || fail "usage: bash Examples/mpi.sh RANKS script.py [arguments]"
ranks=$1
script=$2
shift 2
[ -f "$script" ] || fail "there is no script $script"

setup plugin
# Open MPI asks for this where everything is root's, as in a container.
[ "$(id -u)" -ne 0 ] || export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

# Threads are shared out by the plugin, so ranks are bound to no processor; more ranks than
# processors are the user's choice.
# shellcheck disable=SC2086
exec mpiexec -n "$ranks" --oversubscribe --bind-to none ${MPIEXEC_OPTIONS:-} \
  pvbatch --sym "$script" "$@" </dev/null
