#!/bin/sh
# How many components a mixture is given, by criterion and sampling rate: the figures of gmm-fit(1), CHOICE OF K.
#
#   sh share/lfdtools/study/components.sh                      experiment A, and a recording if there is one
#   sh share/lfdtools/study/components.sh demos.csv more.csv   experiment A, and your own, columns target,demo,t,x,y,z
#
# Experiment A is demonstrated at each rate (its white tremor is new in every sample); a recording is only resampled, so
# that it says the same at every rate. Results under build/study: components.csv (the K that each criterion takes, a row
# a target and rate), gains.csv (what one component more gains, a row a target, rate and K). Standard output: their means
# over the targets, as CSV.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../.." && pwd)
sh "$root/share/lfdtools/setup.sh"
bin=${LFD_BUILD_DIR:-$root/build/release}/tools
data=${LFD_DATA_DIR:-$root/../shared/data}
out=${LFD_OUT_DIR:-$root/build/study}
rates=${LFD_RATES:-25 50 100 200 500}
range=${LFD_RANGE:-1:30}
if [ $# -eq 0 ] && [ -f "$data/hug_reach_S01/demos.csv" ]; then set -- "$data/hug_reach_S01/demos.csv"; fi
mkdir -p "$out"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM

: >"$work/tables"
# fit SET RATE: the tables of all targets of $work/aligned.csv
fit() {
  "$bin/gmm-fit" -q -k "$range" "$work/aligned.csv" | sed "s|^|$1 $2 |" >>"$work/tables"
}
for rate in $rates; do
  sed 's/"rate": *[0-9.]*/"rate": '"$rate"'/' "$root/share/lfdtools/peg-in-hole/A.json" >"$work/experiment.json"
  "$bin/demo-synth" -q "$work/experiment.json" | "$bin/demo-align" -q -o "$work/aligned.csv"
  fit A "$rate"
done
for demos in "$@"; do
  name=$(basename "$demos" .csv)
  [ "$name" = demos ] && name=$(basename "$(dirname "$demos")")
  "$bin/demo-align" -q --trim --columns x,y,z "$demos" |
    awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
             $at["t"] > end[$at["target"]] { end[$at["target"]] = $at["t"] }
             END { for (target in end) print target, end[target] }' | sort -n >"$work/durations"
  for rate in $rates; do
    while read -r target duration; do
      awk -F, -v target="$target" 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i } NR == 1 || $at["target"] == target' \
        "$demos" >"$work/target.csv"
      samples=$(awk -v T="$duration" -v rate="$rate" 'BEGIN { print int(T * rate + 1.5) }')
      "$bin/demo-align" -q --trim --columns x,y,z --samples "$samples" "$work/target.csv" -o "$work/aligned.csv"
      fit "$name" "$rate"
    done <"$work/durations"
  done
done
awk -v chosen="$out/components.csv" -v gains="$out/gains.csv" -f "$here/components.awk" "$work/tables"
