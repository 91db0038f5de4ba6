#!/usr/bin/env bash
# Verifies the rules of the house that no compiler checks. Prints each violation as file:line: what is wrong, exits 1.
#
# usage: scripts/check.sh [ROOT]        ROOT: the checkout to look at (default: this one)
#
#   includes   a room includes itself and what the table below gives it; paths from the root
#   rooms      no circle of headers or rooms, no arrow upward; docs/figures/rooms.svg is that of the sources (scripts/rooms_figure.py;
#              skipped, and said so, without python3)
#   headers    begin with `#pragma once` (after comments)
#   types      no two types of one name in one namespace
#   flags      no -march=native, no -ffast-math or its parts: results must not depend on the machine that built them
#   length     no source file above 450 lines
#   comments   at most 110 columns
#   functions  at most 60 lines without comments, of what begins in the first column (tests, kernels: no limit)
#   format     clang-format 14 (Debian 12's) has nothing to change; skipped, and said so, where it is not installed
set -euo pipefail
export LC_ALL=C.UTF-8

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "${1:-$here/..}"
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

# Who may include what: a folder or file with all below it, then what it may include besides itself. `folder` means the files that
# lie in it, `folder/` those of its sub-folders, too. The longest name that fits a file decides; base may be included by all.
arrows='
base
datasets                      datasets/robots
datasets/csv
datasets/entropy              datasets/csv
datasets/logs                 datasets/csv
datasets/logs/arrays          datasets/logs datasets/csv
datasets/logs/ros             datasets/logs datasets/logs/ros/messages
datasets/logs/ros/messages    datasets/logs
datasets/logs/tables          datasets/logs datasets/logs/arrays datasets/csv
datasets/logs/formats.cpp     datasets/
datasets/native               datasets datasets/robots
datasets/robots
datasets/import               datasets datasets/csv
datasets/import/csv           datasets datasets/csv datasets/native datasets/robots
datasets/import/logs          datasets datasets/csv datasets/entropy datasets/import/csv datasets/logs datasets/native datasets/robots
datasets/import/optiodom      datasets datasets/csv datasets/robots
reports/records
reports/statistics            reports/records
reports/statistics/optimisers  reports/records reports/statistics
reports/render
reports/regression            reports/records reports/statistics reports/render
reports/figures               reports/render
reports/kinds                 reports/records reports/statistics reports/render reports/figures
reports/kinds/optimisers      reports/records reports/statistics reports/statistics/optimisers reports/render reports/figures reports/kinds
reports/kinds/calibration     reports/records reports/statistics reports/render reports/figures reports/kinds reports/kinds/optimisers reports/kinds/trust
reports/kinds/fusion          reports/records reports/statistics reports/render reports/figures reports/kinds reports/kinds/calibration
reports/kinds/kinds.cpp       reports/
reports/page                  reports/
problems
problems/calibration          problems problems/calibration/kernel problems/calibration/losses problems/calibration/models problems/robots datasets datasets/robots
problems/calibration/losses
problems/calibration/models   problems problems/calibration/kernel problems/robots datasets datasets/robots
problems/calibration/kernel   problems
problems/calibration/classical  problems problems/calibration problems/robots datasets datasets/robots
problems/classic              problems
problems/entropy              problems datasets/entropy/entropy_window.hpp
problems/kalman               problems problems/entropy datasets/entropy/entropy_window.hpp
problems/fusion               problems problems/kalman problems/calibration problems/robots problems/trust datasets
problems/information          problems problems/calibration problems/robots datasets
problems/inspection           problems problems/robots problems/calibration datasets datasets/robots
problems/trust                problems problems/calibration problems/calibration/losses problems/information problems/robots datasets datasets/robots
problems/robots               datasets datasets/robots problems/matrices.hpp
problems/simulation           datasets/ problems/robots
problems/simulation/motors    problems/simulation
problems/suites               problems problems/classic problems/calibration problems/robots problems/simulation datasets datasets/robots
solvers                       solvers/box solvers/certificate problems/problem.hpp problems/instruction_set.hpp
solvers/box                   problems/problem.hpp
solvers/certificate           solvers/box solvers/solver.hpp problems/problem.hpp problems/instruction_set.hpp
solvers/registry.cpp          solvers/
solvers/local                 solvers solvers/box solvers/certificate problems/problem.hpp
solvers/population            solvers solvers/box solvers/certificate problems/problem.hpp
solvers/lattice               solvers solvers/box solvers/certificate problems/problem.hpp problems/block_quadratic.hpp problems/lattice.hpp problems/instruction_set.hpp
solvers/libraries             solvers solvers/box solvers/certificate problems/problem.hpp
bench/console                 solvers/run.hpp reports/render bench/studies/watcher.hpp
bench/catalogue               datasets/ problems/ solvers/
bench/studies                 datasets/ problems/ solvers/ reports/ bench/catalogue
bench/studies/calibration     datasets/ problems/ solvers/ reports/ bench/catalogue bench/studies bench/studies/inspection
bench/studies/campaign        datasets/ problems/ solvers/ reports/ bench/catalogue bench/studies bench/studies/inspection
bench/studies/entropy         datasets/ problems/ solvers/ reports/ bench/catalogue bench/studies
bench/studies/exporting       datasets/ problems/ solvers/ reports/ bench/catalogue bench/studies
bench/studies/fusion          datasets/ problems/ solvers/ reports/ bench/catalogue bench/studies bench/studies/calibration bench/studies/inspection
bench/studies/importing       datasets/ problems/ solvers/ reports/ bench/catalogue bench/studies bench/studies/calibration bench/studies/exporting bench/studies/trust bench/studies/planning
bench/studies/inspection      datasets/ problems/ solvers/ reports/ bench/catalogue bench/studies
bench/studies/simulation      datasets/ problems/ reports/ bench/catalogue bench/studies
bench/studies/trust           datasets/ problems/ solvers/ reports/ bench/catalogue bench/studies bench/studies/calibration
bench/studies/planning        datasets/ problems/ solvers/ reports/ bench/catalogue bench/studies bench/studies/trust
bench                         datasets/ problems/ solvers/ reports/ bench/
tests                         datasets/ problems/ solvers/ reports/ tests/ bench/cli.hpp bench/catalogue bench/studies/
'

check_includes() {
  awk -v arrows="$arrows" '
    BEGIN {
      count = split(arrows, row, "\n")
      for (i = 1; i <= count; i++) {
        name = row[i]; sub(/ .*/, "", name)
        if (name == "") continue
        rest = row[i]; sub(/^[^ ]* */, "", rest)
        allowed[name] = rest
      }
    }
    function bad(why) { printf "%s:%d: includes \"%s\": %s\n", FILENAME, FNR, path, why }
    function folder_of(file) { sub(/\/[^\/]*$/, "", file); return file }
    function place_of(file) {  # the row of the table that speaks of it
      while (!(file in allowed) && file ~ /\//) file = folder_of(file)
      return file
    }
    function may(place, target,   list, n, i) {
      n = split(allowed[place], list, " ")
      for (i = 1; i <= n; i++)
        if (target == list[i] || folder_of(target) == list[i] || (list[i] ~ /\/$/ && index(target, list[i]) == 1)) return 1
      return 0
    }
    /^[ \t]*#[ \t]*include[ \t]*[<"]/ {
      path = $0; sub(/^[^<"]*[<"]/, "", path); sub(/[>"].*$/, "", path)
      quoted = $0 ~ /include[ \t]*"/
      ours = path ~ /^(base|bench|datasets|problems|reports|solvers|tests)\//
      if (quoted && !ours) { bad("write the path from the repository root, or <...> for a library"); next }
      if (!quoted && ours) { bad("write our own headers in quotes"); next }
      place = place_of(FILENAME)
      if (!ours || folder_of(path) == "base" || place_of(path) == place || may(place, path)) next
      bad(place " includes " (allowed[place] == "" ? "nothing of ours but base" : "only base " allowed[place]))
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

# Two types of one name in one namespace are one to the linker, whichever it meets first: a crash far away from both.
check_types() {
  awk '
    FNR == 1 { space = "" }
    /^namespace [a-z_:0-9]+ \{/ { space = $2 }
    /^(struct|class|enum class) [A-Za-z0-9_]+( final)?( : .*)? \{/ {
      name = space "::" ($1 == "enum" ? $3 : $2)
      if (name in places && places[name] != FILENAME) printf "%s:%d: %s is defined in %s, too\n", FILENAME, FNR, name, places[name]
      places[name] = FILENAME
    }' $(printf '%s\n' "${sources[@]}" | grep '\.hpp$' | grep -v '^tests/')
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

check_comments() {
  awk 'length($0) > 110 && /^ *\/\// { printf "%s:%d: a comment of %d columns, expected at most 110\n", FILENAME, FNR, length($0) }' "${sources[@]}"
}

check_functions() {
  awk '
    FNR == 1 { begin = 0 }
    begin && (/^ *\/\// || /^$/) { comments++ }
    # A kernel is one loop whose variables stay in registers.
    FILENAME ~ /^tests\/|_kernel_impl|\/kernel_impl/ { nextfile }
    /^[^ \t\/#}].*\{$/ && !/^(namespace|struct|class|enum|union|extern|constexpr|const |static const )/ { begin = FNR; comments = 0 }
    /^[^ \t\/#}].*[,(]$/ && !/^(namespace|struct|class|enum|union|extern|constexpr|const |static const )/ { if (!begin) { begin = FNR; comments = 0 } }
    /^[^ \t\/#}].*;$/ { begin = 0 }
    /^}/ {
      lines = FNR - begin + 1 - comments
      if (begin && lines > 60) printf "%s:%d: a function of %d lines, expected at most 60\n", FILENAME, begin, lines
      begin = 0
    }' "${sources[@]}"
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
if command -v python3 >/dev/null; then
  report rooms "$(python3 "$here/rooms_figure.py" --check . 2>&1 || true)"
else
  echo "check: rooms skipped: python3 is not installed"
fi
report headers "$(check_headers)"
report types "$(check_types)"
report flags "$(check_flags)"
report length "$(check_length)"
report comments "$(check_comments)"
report functions "$(check_functions)"
format=$(formatter)
if [[ -n $format ]]; then
  report format "$(check_format)"
else
  echo "check: format skipped: clang-format 14 is not installed (apt-get install clang-format)"
fi
exit $status
