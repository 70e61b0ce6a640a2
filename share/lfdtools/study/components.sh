#!/bin/sh
# How many components a mixture is given, by criterion and sampling rate: the figures of gmm-fit(1), CHOICE OF K.
#
#   sh share/lfdtools/study/components.sh                      experiment A, and a recording if there is one
#   sh share/lfdtools/study/components.sh demos.csv more.csv   experiment A, and your own, columns target,demo,t,x,y,z
#
# Experiment A is demonstrated at each rate (its white tremor is new in every sample); a recording is only resampled, so
# that it says the same at every rate. Results under build/study:
#   components.csv    the K that each criterion takes, a row a target and rate
#   gains.csv         what one component more gains a sample, and what it costs, a row a target, rate and K
#   independence.csv  how many independent samples the pools are worth, by the autocorrelation of what is left of the
#                     demonstrations without their mean, a row a target
#   effective.csv     the K of the effective BIC against n, a row a set and n
#   references.csv    how far the regression is from the mean of the demonstrations, a row a set, covariance type and K
# Standard output: the means of components.csv over the targets, then the other tables, and gains.csv of one target drawn.
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
n=${LFD_N:-200}
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
awk -v n="$n" -v chosen="$out/components.csv" -v gains="$out/gains.csv" -f "$here/components.awk" "$work/tables"

# What the samples are worth, and what K costs in accuracy: aligned as they come.
echo "set,target,samples,demonstrations,independent" >"$out/independence.csv"
echo "set,n,components" >"$out/effective.csv"
echo "set,covariance_type,components,rmse_mm" >"$out/references.csv"
judge() {
  awk -F, -v set="$1" -f "$here/independence.awk" "$2" >>"$out/independence.csv"
  for effective in 20 50 100 200 400 800; do
    "$bin/gmm-fit" -q -k "$range" --bic-n "$effective" --bic-likelihood effective "$2" |
      sed 's/.*"priors":\[\([^]]*\)\].*/\1/' |
      awk -F, -v row="$1,$effective" '{ sum += NF } END { printf "%s,%.1f\n", row, sum / NR }' >>"$out/effective.csv"
  done
  samples=$(awk -F, 'NR > 1 && $2 != last { if (last != "") exit; last = $2 } END { print NR - 2 }' "$2")
  for type in full tied diagonal spherical; do
    for k in 4 6 8 12 20 30; do
      "$bin/gmm-fit" -q -k "$k" --covariance-type "$type" "$2" | "$bin/gmr-regress" -n "$samples" |
        awk -F, -v row="$1,$type,$k" -f "$here/references.awk" - "$2" >>"$out/references.csv"
    done
  done
}
"$bin/demo-synth" -q "$root/share/lfdtools/peg-in-hole/A.json" --target 5 | "$bin/demo-align" -q -o "$work/aligned.csv"
judge A/5 "$work/aligned.csv"
for demos in "$@"; do
  name=$(basename "$demos" .csv)
  [ "$name" = demos ] && name=$(basename "$(dirname "$demos")")
  "$bin/demo-align" -q --trim --columns x,y,z --samples 200 "$demos" -o "$work/aligned.csv"
  judge "$name" "$work/aligned.csv"
done
for table in independence effective references; do
  echo
  cat "$out/$table.csv"
done
echo
awk -F, -v set=A -v target=5 -v n="$n" -f "$here/gains.awk" "$out/gains.csv"
