#!/bin/sh
# Experiment B as a rate over many scenes: boxes between start and holes, round which there is one way or two. In each, a
# teacher who knows the scene demonstrates six holes with the whole arm clear; every method learns from the demonstrations
# alone; FCL judges what the arm does on the way to four new holes (tests/scenes, man lfdtools(7)). A quarter of a minute
# a scene and processor, half an hour in all on two.
#
#   sh share/lfdtools/peg-in-hole/scenes/run.sh
#
# LFD_ONE_WAY and LFD_TWO_WAYS: how many scenes of each kind (134, 66); LFD_FIRST: number of the first (1001; smaller ones
# served to write the study). Scenes that the teacher cannot show, or whose straight way is clear to two new holes or
# more, are set aside and counted. Results under build/scenes: scenes.csv, every motion; table.txt, which is printed too.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../../.." && pwd)
build=${LFD_BUILD_DIR:-$root/build/release}
out=${LFD_OUT_DIR:-$root/build}/scenes
[ -x "$build/tests/scene-study" ] || sh "$root/share/lfdtools/setup.sh" --tests
export LFD_STUDY="$build/tests/scene-study"
first=${LFD_FIRST:-1001}
jobs=$(nproc 2>/dev/null || echo 2)
mkdir -p "$out"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM
export work

# scenes KIND COUNT: the first COUNT scenes of a kind that are not set aside, whatever the number of processors.
scenes() {
  next=$first
  kept=0
  while [ "$kept" -lt "$2" ]; do
    last=$((next + 3 + 4 * ($2 - kept)))  # a scene in six or seven is kept
    for number in $(seq $next $last); do echo "$1 $number"; done |
      xargs -P "$jobs" -L 1 sh -c '"$LFD_STUDY" $0 $1 >"$work/$0-$1.new" && mv "$work/$0-$1.new" "$work/$0-$1"'
    kept=0
    for number in $(seq "$first" $last); do
      [ "$kept" -lt "$2" ] || break
      cat "$work/$1-$number" >>"$work/$1.csv.new"
      grep -q ',set_aside,' "$work/$1-$number" || kept=$((kept + 1))
    done
    mv "$work/$1.csv.new" "$work/$1.csv"
    next=$((last + 1))
  done
}
touch "$work/one.csv" "$work/two.csv"  # a kind of which none is wanted
scenes one "${LFD_ONE_WAY:-134}"
scenes two "${LFD_TWO_WAYS:-66}"
{
  echo scene,ways,method,target,outcome,reason,clearance,outside,hand_length,joint_length,jerk,seconds,probability
  cat "$work/one.csv" "$work/two.csv"
} >"$work/scenes.csv"
mv "$work/scenes.csv" "$out/scenes.csv"
awk -f "$here/scenes.awk" "$out/scenes.csv" >"$work/table.txt"
mv "$work/table.txt" "$out/table.txt"
cat "$out/table.txt"
echo "results: $out"
