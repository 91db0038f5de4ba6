#!/usr/bin/env bash
# Verifies the rules of the house that no compiler checks. Prints each violation as file:line: what is wrong, exits 1.
#
# usage: scripts/check.sh [ROOT]        ROOT: the checkout to look at (default: this one)
#
#   includes   base/ includes nothing of ours, every other room may include base/; datasets/ and reports/ nothing else of ours;
#              problems/ only problems/ and the plain data of datasets/recording.hpp and datasets/entropy_window.hpp;
#              solvers/ only solvers/, problems/problem.hpp and problems/instruction_set.hpp; tests/ everything but bench/,
#              of which it may call bench/cli.hpp, the program as a function; paths from the root
#   headers    begin with `#pragma once` (after comments)
#   flags      no -march=native, no -ffast-math or its parts: results must not depend on the machine that built them
#   length     no source file above 450 lines
#   format     clang-format 14 (Debian 12's) has nothing to change; skipped, and said so, where it is not installed
set -euo pipefail
export LC_ALL=C.UTF-8

cd "${1:-$(dirname "${BASH_SOURCE[0]}")/..}"
rooms=(base bench datasets problems reports solvers tests)
mapfile -t sources < <(find "${rooms[@]}" \( -name '*.cpp' -o -name '*.hpp' \) -type f 2>/dev/null | sort)
if ((${#sources[@]} == 0)); then
  echo "check: no sources below $PWD" >&2
  exit 1
fi
# What decides how things are compiled: build files, scripts, and pragmas in the sources.
mapfile -t build_files < <(find CMakeLists.txt CMakePresets.json cmake .ci scripts "${rooms[@]}" -type f \
  \( -name CMakeLists.txt -o -name '*.cmake' -o -name '*.json' -o -name run -o -name '*.sh' \) \
  -not -name check.sh -not -path 'datasets/*.json' 2>/dev/null | sort)

check_includes() {
  awk '
    function bad(why) { printf "%s:%d: includes \"%s\": %s\n", FILENAME, FNR, path, why }
    /^[ \t]*#[ \t]*include[ \t]*[<"]/ {
      path = $0; sub(/^[^<"]*[<"]/, "", path); sub(/[>"].*$/, "", path)
      quoted = $0 ~ /include[ \t]*"/
      room = FILENAME; sub(/\/.*/, "", room)
      target = path; sub(/\/.*/, "", target)
      ours = target ~ /^(base|bench|datasets|problems|reports|solvers|tests)$/ && path ~ /\//
      if (quoted && !ours) { bad("write the path from the repository root, or <...> for a library"); next }
      if (!quoted && ours) { bad("write our own headers in quotes"); next }
      if (!ours || target == room) next
      if (path == "bench/cli.hpp" && room == "tests") next
      if (target == "bench") bad("nothing includes bench/")
      else if (target == "tests") bad("nothing but tests/ includes tests/")
      else if (room == "base") bad("base/ includes nothing of ours")
      else if (target == "base") next
      else if (room == "datasets" || room == "reports") bad(room "/ includes nothing of ours but base/")
      else if (room == "problems" && path !~ /^datasets\/(recording|entropy_window)\.hpp$/)
        bad("problems/ includes only base/, problems/, datasets/recording.hpp and datasets/entropy_window.hpp")
      else if (room == "solvers" && path !~ /^problems\/(problem|instruction_set)\.hpp$/)
        bad("solvers/ includes only base/, solvers/, problems/problem.hpp and problems/instruction_set.hpp")
    }' "${sources[@]}"
}

check_headers() {
  local header
  for header in "${sources[@]}"; do
    [[ $header == *.hpp ]] || continue
    # The first line that is neither empty nor a // comment.
    [[ $(sed -n -e '/^[[:space:]]*$/d' -e '/^[[:space:]]*\/\//d' -e p -e q "$header") == '#pragma once' ]] ||
      echo "$header:1: no #pragma once before the first declaration"
  done
}

check_flags() {
  local flags='-march=native|-mtune=native|-ffast-math|-Ofast|-funsafe-math-optimizations|-fassociative-math'
  flags+='|-ffinite-math-only|-freciprocal-math|-fno-signed-zeros'
  # Comments in CMake files and scripts may speak of them.
  awk -v flags="$flags" '{ line = $0; sub(/(^|[ \t])#.*/, "", line)
    if (match(line, flags)) printf "%s:%d: %s is not allowed\n", FILENAME, FNR, substr(line, RSTART, RLENGTH) }' \
    "${build_files[@]}" </dev/null
  awk '/^[ \t]*#[ \t]*pragma[ \t]+(GCC[ \t]+optimize|clang[ \t]+fp)/ || /__attribute__\(\(.*optimize/ {
    printf "%s:%d: changes optimisation for part of a file\n", FILENAME, FNR }' "${sources[@]}"
}

check_length() {
  awk -v most=450 'FNR == most + 1 { printf "%s:%d: longer than %d lines\n", FILENAME, FNR, most }' "${sources[@]}"
}

formatter() {
  local candidate
  for candidate in clang-format-14 clang-format; do
    if command -v "$candidate" >/dev/null && [[ $("$candidate" --version) == *'version 14.'* ]]; then
      echo "$candidate"
      return
    fi
  done
}

check_format() {
  "$format" --dry-run -Werror --style=file "${sources[@]}" 2>&1 | grep -E '^[^ ].*:[0-9]+:[0-9]+:' || true
}

status=0
report() {  # report NAME VIOLATIONS
  if [[ -z $2 ]]; then
    echo "check: $1 ok"
  else
    printf '%s\n' "$2"
    echo "check: $1 FAILED ($(wc -l <<<"$2") places)"
    status=1
  fi
}
report includes "$(check_includes)"
report headers "$(check_headers)"
report flags "$(check_flags)"
report length "$(check_length)"
format=$(formatter)
if [[ -n $format ]]; then
  report format "$(check_format)"
else
  echo "check: format skipped: clang-format 14 is not installed (apt-get install clang-format)"
fi
exit $status
