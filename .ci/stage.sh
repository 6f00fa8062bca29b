# shellcheck shell=bash
# Sourced by run and release, after Testing/setup.sh: stages that say how long they took by the clock
# and of all processors.

times_file=$(mktemp)
trap 'rm -f -- "$times_file"' EXIT

# Seconds that ended children have had of all processors.
take_processor_seconds() {
  times >"$times_file" # in this shell: a subshell has times of its own
  processor_seconds=$(awk 'NR == 2 { split($1, u, /[ms]/); split($2, s, /[ms]/)
    print int(60 * (u[1] + s[1]) + u[2] + s[2]) }' "$times_file")
}

# stage <name> <command>...
stage() {
  local name=$1 since=$SECONDS before
  shift
  take_processor_seconds
  before=$processor_seconds
  echo "== $name"
  "$@"
  take_processor_seconds
  echo "== $name took $((SECONDS - since)) s, $((processor_seconds - before)) s of processors"
}
