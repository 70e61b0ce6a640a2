#!/bin/sh
# Sets the machine up, builds and runs every test. Closes with ctest's own summary.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
build=${LFD_BUILD_DIR:-$root/build/release}
sh "$root/share/lfdtools/setup.sh" --tests
jobs=$(nproc 2>/dev/null || echo 2)
status=0
ctest --test-dir "$build" --output-on-failure -j "$jobs" || status=$?
echo "results: $build/Testing/Temporary/LastTest.log"
exit $status
