#!/bin/sh
# Whether other people's demonstrations help with a person's own few: each target of each person is left out once; the
# skill learns from all targets of the others and two of the person's own (the next and the third next in the list), told
# apart by the column teacher. Beside it: the same from the two own targets alone, and the best simple opponent in
# hindsight that learns from all other targets of the person. Mean rmse in mm (6 min on two processors).
#
#   sh share/lfdtools/study/teachers.sh [PERSON.csv...]     default: hug_reach_S01 to S03 under LFD_DATA_DIR
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../.." && pwd)
bin=${LFD_BUILD_DIR:-$root/build/release}/tools
data=${LFD_DATA_DIR:-$root/../shared/data}
[ $# -gt 0 ] || set -- "$data/hug_reach_S01/demos.csv" "$data/hug_reach_S02/demos.csv" "$data/hug_reach_S03/demos.csv"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM
opponents=line,nearest,nearest-deviation,mean-deviation,affine-means,affine,affine-prior

# rows FILE PERSON TARGETS: rows of these targets (empty: all) as those of a person.
rows() {
  awk -F, -v OFS=, -v person="$2" -v wanted=",$3," '
    NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
    wanted == ",," || index(wanted, "," $at["target"] ",") {
      print person, $at["target"], $at["demo"], $at["t"], $at["x"], $at["y"], $at["z"] }' "$1"
}
header=teacher,target,demo,t,x,y,z
# mean METHOD FILE...: mean rmse in mm.
mean() {
  method=$1
  shift
  cat "$@" | awk -F, -v method="$method" '{ for (i = 1; i < NF; ++i) if ($i == method) { sum += $(i + 1); ++n } }
    END { printf "%.1f", 1000 * sum / n }'
}

printf '%-8s %8s %8s %8s  %s\n' person pooled alone ratio 'best opponent with all own targets'
person=0
for own in "$@"; do
  person=$((person + 1))
  targets=$(awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next } !seen[$at["target"]]++ { print $at["target"] }' "$own")
  for left in $targets; do
    two=$(echo $targets $targets | awk -v left="$left" '{ for (i = 1; $i != left; ++i); print $(i + 1) "," $(i + 3) }')
    { echo $header; rows "$own" p$person "$left"; } >"$work/test.csv"
    { echo $header; rows "$own" p$person "$two"; } >"$work/alone.csv"
    other=0
    cp "$work/alone.csv" "$work/pooled.csv"
    for file in "$@"; do
      other=$((other + 1))
      [ $other = $person ] || rows "$file" p$other '' >>"$work/pooled.csv"
    done
    for rows in pooled alone; do
      "$bin/skill-validate" -q --methods skill "$work/$rows.csv" --test "$work/test.csv" -o "$work/$rows-$person-$left"
    done
  done
  "$bin/skill-validate" -q --methods $opponents "$own" -o "$work/opponents"
  best=$(for method in $(echo $opponents | tr , ' '); do echo "$(mean "$method" "$work/opponents") $method"; done | sort -n | sed 1q)
  pooled=$(mean skill "$work"/pooled-$person-*)
  printf '%-8s %8s %8s %8s  %s\n' p$person "$pooled" "$(mean skill "$work"/alone-$person-*)" \
    "$(echo "$pooled $best" | awk '{ printf "%.2f", $1 / $2 }')" "$best"
done | tee "$work/table"
awk '{ sum += log($4); ++n } END { printf "geometric mean of the ratios: %.2f\n", exp(sum / n) }' "$work/table"
