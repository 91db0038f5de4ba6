#!/usr/bin/env bash
# Makes the checkout ready: installs the Debian packages that are missing, configures, builds.
# Takes about a second when there is nothing to do. Writes to standard error only, and only when it does something.
#
# usage: scripts/setup.sh [PRESET [TARGET...]]      PRESET: release (default), dev, sanitize, fuzz, profile, coverage; TARGET: default is everything
#
# ODOBENCH_SKIP_PACKAGES=1        do not look for packages (another system, or dependencies installed by other means)
# ODOBENCH_EXTRA_PACKAGES="a b"   install these as well (CI: the tools of its checks)
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
preset=${1:-release}
targets=("${@:2}")
build=$root/build/$preset
exec 1>&2

say() { printf 'setup: %s\n' "$*"; }
fail() { say "error: $*"; exit 1; }

listed_packages() {
  local name command
  { sed 's/#.*//' "$root/scripts/packages.txt" && echo "${ODOBENCH_EXTRA_PACKAGES:-}"; } | xargs -n 1 |
    while IFS='[]' read -r name command; do
      if [[ -z $command ]] || ! command -v "$command" >/dev/null; then echo "$name"; fi
    done
}

missing_packages() {
  local installed
  installed=$(dpkg-query --show --showformat='${db:Status-Status} ${Package}\n' | sed -n 's/^installed //p')
  listed_packages | grep --line-regexp --fixed-strings --invert-match --file=<(printf '%s\n' "$installed") || true
}

# apt "$@" as root, its output to the log; the log's end is shown if it fails.
as_root=()
apt() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 \
    apt-get --quiet --yes -o DPkg::Lock::Timeout=300 "$@" >>"$apt_log" 2>&1 </dev/null
}

install_missing_packages() {
  [[ ${ODOBENCH_SKIP_PACKAGES:-} == 1 ]] && return
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    fail "this is not Debian (no apt-get): install the like of these, then set ODOBENCH_SKIP_PACKAGES=1:" \
         "$(listed_packages | xargs)"
  fi
  local missing
  mapfile -t missing < <(missing_packages)
  ((${#missing[@]})) || return 0
  if ((EUID != 0)); then
    command -v sudo >/dev/null ||
      fail "neither root nor sudo; as root run: apt-get install --no-install-recommends ${missing[*]}"
    say "installing needs root: using sudo"
    sudo --validate || fail "sudo refused; as root run: apt-get install --no-install-recommends ${missing[*]}"
    as_root=(sudo)
  fi
  mkdir -p "$root/build"
  apt_log=$root/build/apt.log
  : >"$apt_log"
  say "installing ${#missing[@]} packages: ${missing[*]}"
  apt update || say "apt-get update failed (see $apt_log); trying with the package lists at hand"
  if ! apt install --no-install-recommends "${missing[@]}"; then
    tail -n 15 "$apt_log"
    fail "apt-get install failed; the whole log is $apt_log"
  fi
}

# What the configuration depends on beyond the files that CMake itself watches.
configuration_key() {
  printf '%s\n' "$root" "$(cksum <"$root/CMakePresets.json")" "$(command -v ccache || true)" "$(command -v npm || true)" "${CXX:-}"
}

configure() {
  local key
  key=$(configuration_key)
  [[ -f $build/build.ninja && -f $build/.configured && $(<"$build/.configured") == "$key" ]] && return
  local options=()
  command -v ccache >/dev/null && options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  say "configuring build/$preset"
  mkdir -p "$build"
  if ! (cd "$root" && cmake --fresh --preset "$preset" "${options[@]}" >"$build/configure.log" 2>&1); then
    cat "$build/configure.log"
    fail "cmake could not configure preset '$preset'"
  fi
  printf '%s\n' "$key" >"$build/.configured"
}

# Ninja's output without the lines that say that nothing happened; on a terminal the progress stays on one line.
show_progress() {
  local line shown=
  while IFS= read -r line; do
    case $line in
      *'Re-checking globbed directories'* | *git_revision.cmake* | 'ninja: no work to do.' | '-- '*) ;;
      '['*/*']'*)
        if [[ -t 1 ]]; then printf '\r\033[K%.100s' "$line" && shown=1; else printf '%s\n' "$line"; fi ;;
      *)
        if [[ -n $shown ]]; then printf '\n' && shown=; fi
        printf '%s\n' "$line" ;;
    esac
  done
  if [[ -n $shown ]]; then printf '\r\033[K'; fi
}

build() {
  local options=()
  ((${#targets[@]})) && options=(--target "${targets[@]}")
  (cd "$root" && cmake --build --preset "$preset" "${options[@]}" 2>&1) | show_progress ||
    fail "the build of preset '$preset' failed"
  # A build of everything says so itself.
  if ((${#targets[@]})) && [[ -s $build/charts/missing.txt ]]; then
    say "HTML reports will have no charts: $(<"$build/charts/missing.txt")"
  fi
}

[[ $preset =~ ^[a-z]+$ ]] && grep --quiet "\"configurePreset\": \"$preset\"" "$root/CMakePresets.json" ||
  fail "unknown preset '$preset': expected release, dev, sanitize, profile or coverage"
install_missing_packages
configure
build
