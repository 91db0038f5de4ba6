#!/usr/bin/env bash
# Regression of results: calibrates with fixed seeds and compares cost, error tables and evaluations with the files in
# tests/golden/ within the tolerances stated there. Prints what moved and exits 1 if anything did.
#
# usage: scripts/golden.sh [--update]      --update: write the present results to tests/golden/ instead
#
# The demo set is always checked; the real recordings only where they are (ODOBENCH_SHARED, default ../shared).
# Needs the release build (scripts/setup.sh release bench).
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
bench=$root/build/release/bench/bench
work=$root/build/golden
raw=${ODOBENCH_SHARED:-$root/../shared}/datasets/vitko2024
update=()
case ${1:-} in
  '') ;;
  --update) update=(--update) ;;
  *) echo "golden: unknown argument '$1': expected nothing or --update" >&2 && exit 2 ;;
esac

status=0
check() {  # check NAME SET.JSON [KERNEL]
  echo "golden: $1${3:+, kernel $3}"
  export ODOBENCH_KERNEL=${3:-auto}
  # Methods that converge by themselves, and population methods polished: both end in the optimum, whatever the
  # processor's rounding. What a swarm reaches unpolished depends on the last bit; the tests look at that over seeds.
  "$bench" --quiet --data="$2" --solver=lm,ceres,ip,nlopt:slsqp,nlopt:lbfgs,nlopt:bobyqa \
    --out="$work/$1/local" --overwrite --format=csv >/dev/null
  "$bench" --quiet --data="$2" --solver=ga,pso,cmaes --polish=lm --max-evals=5000 \
    --out="$work/$1/population" --overwrite --format=csv >/dev/null
  "$bench" check "${update[@]}" --baseline="$root/tests/golden/$1.json" "$work/$1/local" "$work/$1/population" || status=1
}

check demo "$root/datasets/demo/set.json"
# Every processor has this kernel: what it gives must lie within the same tolerances.
((${#update[@]})) || check demo "$root/datasets/demo/set.json" baseline
if [[ -d $raw ]]; then
  mkdir -p "$work/vitko2024"
  "$bench" import vitko2024 --quiet --overwrite --from="$raw" --out="$work/vitko2024/set.json"
  check vitko2024 "$work/vitko2024/set.json"
  ((${#update[@]})) || check vitko2024 "$work/vitko2024/set.json" baseline
else
  echo "golden: vitko2024 skipped: no $raw"
fi
exit $status
