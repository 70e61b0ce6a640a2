#!/bin/sh
# Recordings: leave-one-target-out table with every opponent, skills by both roads, and the motions that they generate.
#
#   sh share/lfdtools/real/run.sh                        the recordings under $LFD_DATA_DIR (default: ../shared/data)
#   sh share/lfdtools/real/run.sh demos.csv more.csv     your own, columns target,demo,t,x,y,z
#
# Results under build/real/NAME: leave-one-target-out.csv and .svg (bars), table.txt, reliability.csv
# and .svg (how often bands hold) with --trim, untrimmed-*.csv and untrimmed-table.txt without it, aligned.csv,
# skill-demonstrations.json, skill-references.json, motions-*.csv (to each target's own mean goal, from its own mean start), goals.csv.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../.." && pwd)
sh "$root/share/lfdtools/setup.sh"
bin=${LFD_BUILD_DIR:-$root/build/release}/tools
data=${LFD_DATA_DIR:-$root/../shared/data}
if [ $# -eq 0 ]; then
  for name in hug_reach_S01 hug_reach_S02 hug_reach_S03 panda_peg; do
    [ -f "$data/$name/demos.csv" ] && set -- "$@" "$data/$name/demos.csv"
  done
  [ $# -gt 0 ] || { echo "run.sh: no recordings under $data; give files, or set LFD_DATA_DIR" >&2; exit 66; }
fi
for demos in "$@"; do
  name=$(basename "$demos" .csv)
  [ "$name" = demos ] && name=$(basename "$(dirname "$demos")")
  out=${LFD_OUT_DIR:-$root/build/real}/$name
  mkdir -p "$out"
  "$bin/skill-validate" -q --trim "$demos" -o "$out/leave-one-target-out.csv" --table="$out/table.txt" \
    --reliability "$out/reliability.csv"
  "$bin/skill-validate" -q "$demos" -o "$out/untrimmed-leave-one-target-out.csv" --table="$out/untrimmed-table.txt" \
    --reliability "$out/untrimmed-reliability.csv"
  "$bin/skill-plot" -q "$out/leave-one-target-out.csv" -o "$out/leave-one-target-out.svg"
  "$bin/skill-plot" -q "$out/reliability.csv" -o "$out/reliability.svg"
  "$bin/demo-align" -q --trim --columns x,y,z "$demos" -o "$out/aligned.csv"
  "$bin/dmp-fit" "$out/aligned.csv" | "$bin/mvgpr-train" -o "$out/skill-demonstrations.json"
  "$bin/gmm-fit" -q "$out/aligned.csv" | "$bin/gmr-regress" -o "$out/reference.csv"
  "$bin/dmp-fit" "$out/reference.csv" | "$bin/mvgpr-train" -o "$out/skill-references.json"
  # Goals: the means of the measured ends, which each reference carries.
  awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; print "target,x,y,z,start_x,start_y,start_z"; next }
           $at["target"] != last { last = $at["target"]
             print last "," $at["goal_x"] "," $at["goal_y"] "," $at["goal_z"] "," $at["start_x"] "," $at["start_y"] "," $at["start_z"] }' \
    "$out/reference.csv" > "$out/goals.csv"
  for road in demonstrations references; do
    "$bin/skill-generate" "$out/skill-$road.json" --goals "$out/goals.csv" -o "$out/motions-$road.csv"
  done
  for trim in "" untrimmed-; do
    [ "$trim" = "" ] && echo "$name, --trim" || echo "$name, untrimmed"
    cat "$out/${trim}table.txt"
    echo "95 % bands hold samples, whole paths:"
    awk -F, '$2 == 0.95 { printf "%-20s %5.1f %% %5.1f %%\n", $1, 100 * $3, 100 * $4 }' "$out/${trim}reliability.csv"
    echo
  done
done
echo "results: ${LFD_OUT_DIR:-$root/build/real}"
