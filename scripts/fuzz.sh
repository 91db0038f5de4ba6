#!/usr/bin/env bash
# Fuzzes the readers of all formats, or of those named: builds with clang's address and undefined-behaviour sanitizers and libFuzzer
# (Debian packages clang-19 and libclang-rt-19-dev, installed when missing), runs each for a while, keeps what it found.
#
# usage: scripts/fuzz.sh [-k] [-t SECONDS] [FORMAT...]      SECONDS of each format (default: 60)
#
# Inputs that reach something new are collected in build/fuzz/corpus/FORMAT, findings in build/fuzz/findings/FORMAT-*. Exit code 1 when
# there is a finding. Inputs worth keeping go to tests/fuzz/corpus/FORMAT, which every test run goes through; -k puts forty there: of a
# smallest set that reaches what all inputs reach, those of at most 4 kB, as their check sums choose.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
seconds=60
keep=
while getopts kt: option; do
  case $option in
    t) seconds=$OPTARG ;;
    k) keep=1 ;;
    *) sed -n '2,/^set /{/^#/s/^# \{0,1\}//p}' "$0" >&2 && exit 2 ;;
  esac
done
shift $((OPTIND - 1))

build=$root/build/fuzz
ODOBENCH_EXTRA_PACKAGES='clang-19 libclang-rt-19-dev' CXX=clang++-19 "$root/scripts/setup.sh" fuzz fuzz_formats
target=$build/tests/fuzz_formats
if (($# == 0)); then
  mapfile -t formats < <("$target" --formats)
  set -- "${formats[@]}"
fi
# Where allocations came from takes a fifth of the time and is needed only once there is a finding.
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1:malloc_context_size=0
[[ -w /dev/shm ]] && export TMPDIR=/dev/shm

keep_some() {  # keep_some FORMAT CORPUS
  local smallest=$scratch/smallest kept=$root/tests/fuzz/corpus/$1
  rm -rf "$smallest" "$kept"
  mkdir -p "$smallest" "$kept"
  (cd "$scratch" && ODOBENCH_FUZZ=$1 "$target" -set_cover_merge=1 -timeout=25 -rss_limit_mb=4096 "$smallest" "$2" >/dev/null 2>&1) || true
  find "$smallest" -type f -size -9 -printf '%f\n' | sort | head -n 40 |
    while read -r name; do cp "$smallest/$name" "$kept/${name:0:12}"; done
}

status=0
mkdir -p "$build/findings"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
for format in "$@"; do
  corpus=$build/corpus/$format
  mkdir -p "$corpus"
  ODOBENCH_FUZZ=$format "$target" --examples="$corpus"
  kept=()
  [[ -d $root/tests/fuzz/corpus/$format ]] && kept=("$root/tests/fuzz/corpus/$format")
  log=$build/findings/$format.log
  # In a folder of its own, since a configuration may name any file. Reports of the sanitizers go to files beside the log: while the
  # program runs inside the target, its standard error is caught.
  report=log_path=$build/findings/$format.report
  if (cd "$scratch" && export ODOBENCH_FUZZ=$format TIMEFORMAT='processor time: %U s' \
      ASAN_OPTIONS=$ASAN_OPTIONS:$report UBSAN_OPTIONS=print_stacktrace=1:$report &&
      time "$target" "$corpus" "${kept[@]}" -max_total_time="$seconds" -timeout=25 -rss_limit_mb=4096 \
        -artifact_prefix="$build/findings/$format-" -print_final_stats=1) >"$log" 2>&1; then
    printf '%-14s %9s executions in %s of processor time, nothing found\n' "$format" \
      "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")" "$(sed -n 's/^processor time: //p' "$log")"
  else
    printf '%-14s a finding: %s\n' "$format" "$log"
    status=1
  fi
  if [[ -n $keep ]]; then keep_some "$format" "$corpus"; fi
done
exit $status
