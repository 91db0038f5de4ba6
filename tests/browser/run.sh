#!/usr/bin/env bash
# Opens a report in Debian's chromium and looks at what a reader would: charts, controls, keyboard, contrast, print.
#
# usage: tests/browser/run.sh BUILD_FOLDER SAMPLE_REPORT
#
# REPORT=FILE   looks at that page instead of the one that SAMPLE_REPORT writes
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
if [[ -z ${REPORT:-} ]]; then
  REPORT=$work/report.html FIGURES=$work/figures.json TABLES=$work/tables.json
  status=0
  "$2" "$REPORT" "$FIGURES" "$TABLES" || status=$?
  ((status == 77)) && skip 'this build has no chart library (npm was not there, or could not fetch it)'
  ((status == 0)) || exit "$status"
  export FIGURES TABLES
fi
REPORT=$(realpath "$REPORT")
export REPORT OUTPUT=$work/output CHARTS=$build/charts WEB=$here/../../reports/web

if [[ ! -f $work/.installed ]] || ! cmp --silent "$here/package-lock.json" "$work/.installed"; then
  rm -rf "$work/node_modules"
  cp "$here/package.json" "$here/package-lock.json" "$work/"
  (cd "$work" && npm ci --ignore-scripts --no-audit --no-fund --fetch-retries=1 >npm.log 2>&1) ||
    skip "npm could not fetch the packages of the tests (see $work/npm.log)"
  cp "$here/package-lock.json" "$work/.installed"
fi
cp "$here"/*.mjs "$work/"  # where the packages are
cd "$work"
status=0
for file in schema svg page; do node "$file.test.mjs" || status=1; done
exit "$status"
