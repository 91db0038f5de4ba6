#!/usr/bin/env bash
# Opens a report in Debian's chromium and looks at what a reader would: charts, controls, keyboard, contrast, print.
#
# usage: tests/browser/run.sh BUILD_FOLDER SAMPLE_REPORT BENCH
#
# First at a page of all kinds of charts (SAMPLE_REPORT), then at one that BENCH makes of runs, a filter, windows and a fusion.
#
# At the second it does not look for what the first has shown already and dozens of charts make slow: themes, sorting, every
# choice, menus, keyboard, print. ODOBENCH_BROWSER=all does so.
#
# REPORT=FILE   looks at that page instead of these two, for everything
# Screenshots, PDF and timings are in BUILD_FOLDER/browser/output. Exit code 77: left out, the line says why.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$(realpath "$1")
work=$build/browser
skip() { echo "browser tests skipped: $*"; exit 77; }

for tool in node npm chromium; do
  command -v "$tool" >/dev/null || skip "$tool is not installed (apt-get install nodejs npm chromium)"
done
(($(node -p 'process.versions.node.split(".")[0]') >= 18)) || skip "node is older than 18: $(node --version)"

mkdir -p "$work/output"
if [[ ! -f $work/.installed ]] || ! cmp --silent "$here/package-lock.json" "$work/.installed"; then
  rm -rf "$work/node_modules"
  cp "$here/package.json" "$here/package-lock.json" "$work/"
  (cd "$work" && npm ci --ignore-scripts --no-audit --no-fund --fetch-retries=1 >npm.log 2>&1) ||
    skip "npm could not fetch the packages of the tests (see $work/npm.log)"
  cp "$here/package-lock.json" "$work/.installed"
fi
cp "$here"/*.mjs "$work/"  # where the packages are
export CHARTS=$build/charts WEB=$here/../../reports/web

# A browser that hangs answers no call and no time limit of a test; it is ended, said so, and begun once more.
# What the page does wrong is a failure at once.
limit=${ODOBENCH_BROWSER_SECONDS:-400}
look_at() {  # look_at PAGE FOLDER NAMES FILE
  local attempt status=0
  for attempt in 1 2; do
    status=0
    (cd "$work" && REPORT=$(realpath "$1") OUTPUT=$work/output/$2 \
      timeout --kill-after=10 "$limit" node --test-name-pattern="$3" "$4.test.mjs") || status=$?
    ((status == 124 || status == 137)) || return "$status"
    echo "browser: no end of $4.test.mjs within $limit s (attempt $attempt of 2)"
  done
  return "$status"
}

look() {  # look PAGE FOLDER [NAMES]      NAMES: of the tests of the page to run, a regular expression
  local status=0 file
  mkdir -p "$work/output/$2"
  for file in schema svg page; do
    look_at "$1" "$2" "${3:-.}" "$file" || status=1
  done
  return "$status"
}

if [[ -n ${REPORT:-} ]]; then
  look "$REPORT" given
  exit
fi

export FIGURES=$work/figures.json TABLES=$work/tables.json
status=0
"$2" "$work/sample.html" "$FIGURES" "$TABLES" || status=$?
((status == 77)) && skip 'this build has no chart library (npm was not there, or could not fetch it)'
((status == 0)) || exit "$status"
look "$work/sample.html" sample || status=1

root=$(cd "$here/../.." && pwd)
runs=$work/runs
rm -rf "$runs"
mkdir -p "$runs"
"$3" --quiet --solver=lm,pso --repeat=3 --max-evals=1500 --out="$runs/run" >/dev/null
"$3" fuse --parameters=nominal,truth --filter=none,ekf --sensors="$root/datasets/sensors/heading_only.json" --out="$runs/fusion" >/dev/null
"$3" simulate --scenario=filter_turns --quiet --out="$runs/drive"
"$3" filter --quiet --data="$runs/drive/sensors.csv" --truth="$runs/drive/truth.csv" --wheel-order=left-first --gap \
  --records="$runs/filter" >/dev/null
"$3" report "$runs/run" "$runs/filter" "$runs/fusion" --overwrite --out="$work/report.html"
"$3" report "$runs/run" "$runs/filter" "$runs/fusion" --json >"$TABLES"
unset FIGURES
some='^(the page has|the schema|figure |data sets|opens|every section|every chart|tables)'
[[ ${ODOBENCH_BROWSER:-} == all ]] && some=.
look "$work/report.html" report "$some" || status=1
exit "$status"
