#!/usr/bin/env bash
# Fetches the 60 raw files that J. Vitko published with his thesis (they carry no licence and are not part of this
# repository): clones the pinned commit, checks every sum and puts the files and SHA256SUMS into a folder.
#
# Usage: scripts/fetch_vitko2024.sh [FOLDER]        default: data/vitko2024 in the checkout
# Then:  bench import vitko2024 --from=FOLDER --out=set.json
#
# ODOBENCH_VITKO2024_URL, ODOBENCH_VITKO2024_COMMIT: another place to clone from, e.g. a mirror.
# Exit codes: 0 the folder is complete (nothing is done when it was), 1 it is not, 2 wrong usage.
set -euo pipefail

url=${ODOBENCH_VITKO2024_URL:-https://github.com/JakVit/4WIS4WID_parameter_calibration.git}
commit=${ODOBENCH_VITKO2024_COMMIT:-862117d37862a74d15503cfe8810d5f61a00bbe6}
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
sums=$root/scripts/vitko2024.sha256

fail() {
  echo "fetch_vitko2024: $1" >&2
  exit "${2:-1}"
}

case ${1:-} in
  -h | --help) sed -n '2,/^set /{/^set /d;s/^# \{0,1\}//;p}' "$0"; exit 0 ;;
  -*) fail "unknown option $1, expected a folder (--help shows more)" 2 ;;
esac
[ $# -le 1 ] || fail "found $# arguments, expected at most one folder" 2
target=${1:-$root/data/vitko2024}
[ -n "$target" ] || fail "found an empty folder name" 2
command -v git >/dev/null || fail "git is missing: apt-get install git"

# Prints what differs; succeeds when all files are there and right.
check() { (cd "$1" && sha256sum --check --quiet --strict "$sums") 2>&1; }

if [ -e "$target" ]; then
  [ -d "$target" ] || fail "$target exists and is no folder"
  if check "$target" >/dev/null; then
    echo "$target: complete, nothing to do"
    exit 0
  fi
  [ -z "$(ls -A "$target")" ] || fail "$target exists, but its files are not the published ones ($(check "$target" | grep -c ': FAILED' || true) of $(wc -l <"$sums") differ or are missing): move it away and try again"
fi

# Everything happens beside the target, so that the last step is a rename.
mkdir -p "$(dirname "$target")"
work=$(mktemp -d "$(dirname "$target")/.fetch_vitko2024.XXXXXX")
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

echo "cloning $url (93 MB of text) ..."
# The pinned commit alone where the server hands out commits by name, else the whole history.
git init --quiet "$work/clone"
if ! git -C "$work/clone" fetch --quiet --depth=1 "$url" "$commit" 2>/dev/null; then
  git -C "$work/clone" fetch --quiet "$url" '+refs/heads/*:refs/remotes/origin/*' || fail "cannot clone $url"
fi
git -C "$work/clone" -c advice.detachedHead=false -c core.autocrlf=false checkout --quiet "$commit" -- dataset 2>/dev/null ||
  fail "$url has no folder dataset/ at commit $commit"

differences=$(check "$work/clone/dataset") || fail "the files at commit $commit are not the published ones:
$differences"
mkdir "$work/files"
while read -r _ name; do
  mv "$work/clone/dataset/$name" "$work/files/$name"
done <"$sums"
cp "$sums" "$work/files/SHA256SUMS"
chmod 755 "$work/files"
[ ! -d "$target" ] || rmdir "$target"
mv -T "$work/files" "$target"
echo "$target: $(wc -l <"$sums") files, all sums right"
