#!/usr/bin/env bash
# Where the time of the relative-entropy filter's Hamiltonian core goes: runs one benchmark of bench_hamiltonian under a
# profiler and prints the functions, then the source lines, that take most.
#
# usage: scripts/profile_hamiltonian.sh [perf|callgrind] [BENCHMARK]
#   perf        samples the running program (Debian package linux-perf); the default where it is installed
#   callgrind   counts instructions exactly in a simulated processor, about 50 times slower (package valgrind)
#   BENCHMARK   regular expression; default run_200_rows/thesis (`bench_hamiltonian --benchmark_list_tests` shows all)
#
# Builds into build/profile: as the release build, with line numbers.
# Reports stay in build/profile/report (perf report -i ..., callgrind_annotate, kcachegrind).
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
tool=${1:-}
benchmark=${2:-run_200_rows/thesis}
fail() { echo "profile: error: $1" >&2; exit "${2:-3}"; }

if [[ -z $tool ]]; then
  if command -v perf >/dev/null; then tool=perf; else tool=callgrind; fi
fi
case $tool in
  perf) command -v perf >/dev/null || fail "perf is not installed: apt-get install linux-perf" ;;
  callgrind) command -v valgrind >/dev/null || fail "valgrind is not installed: apt-get install valgrind" ;;
  *) fail "found '$tool', expected perf or callgrind" 2 ;;
esac

"$root/scripts/setup.sh" profile bench_hamiltonian
report=$root/build/profile/report
mkdir -p "$report"
program=("$root/build/profile/bench/bench_hamiltonian" "--benchmark_filter=$benchmark")

if [[ $tool == perf ]]; then
  # The processor's clock where it can be had, the operating system's timer on virtual machines without it.
  perf record --quiet --output="$report/perf.data" -- "${program[@]}" --benchmark_min_time=2 >"$report/benchmark.txt"
  grep -E 'us|ms' "$report/benchmark.txt" | grep / || true
  echo; echo "functions:"
  perf report --input="$report/perf.data" --stdio --no-children --percent-limit=1 --sort=symbol 2>/dev/null |
    grep -vE '^(#|$)' | head -n 20
  echo; echo "lines:"
  perf report --input="$report/perf.data" --stdio --no-children --percent-limit=1 --sort=srcline 2>/dev/null |
    grep -vE '^(#|$)' | head -n 20
else
  # Wide instructions that the simulator does not know are not used: it reports a processor without them.
  valgrind --quiet --tool=callgrind --callgrind-out-file="$report/callgrind.out" --dump-instr=no \
    "${program[@]}" --benchmark_min_time=0.01 >"$report/benchmark.txt"
  callgrind_annotate --auto=no --threshold=95 "$report/callgrind.out" | grep -E 'PROGRAM TOTALS|odobench' | head -n 20 ||
    fail "callgrind_annotate found nothing; see $report"
fi
