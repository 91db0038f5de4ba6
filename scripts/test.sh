#!/usr/bin/env bash
# Does all set-up (scripts/setup.sh), then runs the tests with ctest; arguments go to ctest, e.g. -R calibration.
#
# ODOBENCH_PRESET=dev     the build with sanitizers instead of the release build; sanitize: without what takes long
# ODOBENCH_SHARED=FOLDER  where the real recordings and reference vectors lie (default: ../shared beside the checkout);
#                         without them the tests that need them are reported as skipped, by name
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
preset=${ODOBENCH_PRESET:-release}

"$root/scripts/setup.sh" "$preset"
cd "$root"
exec ctest --preset "$preset" --no-tests=error --parallel "$(nproc)" "$@"
