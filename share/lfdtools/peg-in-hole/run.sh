#!/bin/sh
# Installs what is missing, builds, runs experiments A and B, prints the result table. Everything it makes is under build/.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../.." && pwd)
sh "$root/share/lfdtools/setup.sh"
bin=${LFD_BUILD_DIR:-$root/build/release}/tools
out=${LFD_OUT_DIR:-$root/build/peg-in-hole}
mkdir -p "$out"
make --no-print-directory -f "$here/Makefile" -j2 BIN="$bin" OUT="$out" "$@" >"$out/make.log" 2>&1 || {
  tail -n 20 "$out/make.log" >&2
  echo "run.sh: an experiment failed; the whole log is $out/make.log" >&2
  exit 1
}
cat "$out/results.txt"
echo "results: $out/results.txt, results.csv, claims.csv"
echo "figures: $out/A/fig3.svg, fig4.svg, fig5.svg; the same in $out/B, and fig8.svg"
echo "stages:  $out/A and $out/B: demos, aligned, gmm, reference, dmp, skill.json, motion, joints"
