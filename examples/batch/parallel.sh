#!/usr/bin/env bash
# A batch by GNU parallel: on this machine, or on those that PARALLEL_SSHLOGIN names (as --sshloginfile takes them), which see the
# same folders. Plain `servoid batch` uses all cores of one machine by itself: this is for several.
#
#   examples/batch/parallel.sh PARTS RECORDINGS RESULTS [OPTION...]
#
# Given again, the same command does what is not there yet. SERVOID names the program if it is not on the PATH.
set -euo pipefail

if (($# < 3)); then
  echo "usage: parallel.sh PARTS RECORDINGS RESULTS [OPTION of servoid batch...]" >&2
  exit 2
fi
parts=$1
recordings=$2
results=$3
shift 3
machines=()
[[ -z ${PARALLEL_SSHLOGIN:-} ]] || machines=(--sshloginfile "$PARALLEL_SSHLOGIN")
seq "$parts" | parallel --halt soon,fail=1 "${machines[@]}" \
  "${SERVOID:-servoid}" batch "$recordings" --out "$results" --shard "{}/$parts" --workers 1 --quiet "$@"
