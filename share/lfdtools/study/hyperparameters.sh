#!/bin/sh
# Whether the search for hyperparameters ends where many more starts end: skills learnt with the defaults, each target of a
# recording left out once, beside the best of 200 descents from log-uniform draws over four decades.
#
#   sh share/lfdtools/study/hyperparameters.sh                      the recordings under $LFD_DATA_DIR
#   sh share/lfdtools/study/hyperparameters.sh demos.csv more.csv   your own, columns target,demo,t,x,y,z
#
# Printed, and left in build/study/hyperparameters.txt: the objective (negative, in nats) that training found and the best
# of the descents, a line a skill; how many are within 1e-3 nats, status 1 if under 95 %; and what an evaluation of the
# evidence costs by number of outputs. LFD_STARTS sets the number of descents, LFD_FOLDS how many targets of a recording
# are left out (default: each). The four recordings take about a minute.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../.." && pwd)
build=${LFD_BUILD_DIR:-$root/build/release}
[ -x "$build/tests/hyperparameter_check" ] || sh "$root/share/lfdtools/setup.sh" --tests
data=${LFD_DATA_DIR:-$root/../shared/data}
out=${LFD_OUT_DIR:-$root/build/study}
if [ $# -eq 0 ]; then
  for name in hug_reach_S01 hug_reach_S02 hug_reach_S03 panda_peg; do
    [ -f "$data/$name/demos.csv" ] && set -- "$@" "$data/$name/demos.csv"
  done
  [ $# -gt 0 ] || { echo "hyperparameters.sh: no recordings under $data; give files, or set LFD_DATA_DIR" >&2; exit 66; }
fi
mkdir -p "$out"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM
for demos in "$@"; do
  name=$(basename "$demos" .csv)
  [ "$name" = demos ] && name=$(basename "$(dirname "$demos")")
  awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "target") at = i; next } !seen[$at]++ { print $at }' "$demos" |
    head -n "${LFD_FOLDS:-1000}" >"$work/targets"
  while read -r target; do
    awk -F, -v target="$target" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "target") at = i } $at != target' "$demos" |
      "$build/tools/dmp-fit" -q | "$build/tools/mvgpr-train" -q --calibration none -o "$work/$name-without-$target.json"
  done <"$work/targets"
done
status=0
"$build/tests/hyperparameter_check" "${LFD_STARTS:-200}" "$work"/*.json >"$out/hyperparameters.txt" || status=$?
"$build/tests/hyperparameter_check" 0 >>"$out/hyperparameters.txt"
cat "$out/hyperparameters.txt"
echo "results: $out/hyperparameters.txt"
exit "$status"
