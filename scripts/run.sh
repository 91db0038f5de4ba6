#!/usr/bin/env bash
# Does all set-up (scripts/setup.sh), then runs `bench` with the given arguments.
# Without arguments: calibrates the robot of the demo set with four solvers and shows the comparison table.
# Standard output carries only what bench writes.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
preset=${ODOBENCH_PRESET:-release}

"$root/scripts/setup.sh" "$preset" bench
if (($# == 0)); then
  set -- --solver=lm,ip,ga,pso
fi
exec "$root/build/$preset/bench/bench" "$@"
