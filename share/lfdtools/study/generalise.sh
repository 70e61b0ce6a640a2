#!/bin/sh
# How well skills generalise where the truth is known: synthetic teachers with nonlinear intentions (layout.awk says
# which), learnt from noisy demonstrations of 5 to 12 holes and judged on the noise-free intentions of six new holes.
#
#   sh share/lfdtools/study/generalise.sh layouts       24 layouts, 2 seeds of the noise each, 10 demonstrations a hole:
#                                                       mean rmse of the default skill and of the best simple opponent in
#                                                       hindsight, their ratio, the ratios to paper and paper-full (2 min)
#   sh share/lfdtools/study/generalise.sh repetitions   the same layouts, 1 seed, with 3, 5 and 10 demonstrations (4 min)
#   sh share/lfdtools/study/generalise.sh A3            experiment A with 3 demonstrations a hole, 20 seeds (1 min)
#   sh share/lfdtools/study/generalise.sh coverage      100 layouts: how much the default skill's 95 % bands hold, of the
#                                                       intention itself (latent) and of single demonstrations of the new
#                                                       holes (predictive); of samples, and of whole paths (4 min)
#
# Times are those of two processors. LFD_LAYOUTS and LFD_SEEDS set how many layouts and seeds; seeds are numbers from 1 and
# there is no other chance in it, so that every run gives the same figures. Results under build/study/generalise:
# PART.csv, every score of skill-validate with its layout before it, and PART.txt, the table, which is printed too.
# Intervals are the percentile bootstrap's over layouts (A3: over seeds).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../.." && pwd)
bin=${LFD_BUILD_DIR:-$root/build/release}/tools
out=${LFD_OUT_DIR:-$root/build/study}/generalise
part=${1-}
opponents=line,nearest,nearest-deviation,mean-deviation,affine-means,affine,affine-prior
everyone=skill,$opponents,paper,paper-full
case $part in
  layouts) layouts=${LFD_LAYOUTS:-24} seeds=${LFD_SEEDS:-2} repetitions=10 methods=$everyone tests=new-intentions ;;
  repetitions) layouts=${LFD_LAYOUTS:-24} seeds=${LFD_SEEDS:-1} repetitions="3 5 10" methods=$everyone tests=new-intentions ;;
  A3) layouts=A seeds=${LFD_SEEDS:-20} repetitions=3 methods=$everyone tests=new-intentions ;;
  coverage) layouts=${LFD_LAYOUTS:-100} seeds=${LFD_SEEDS:-1} repetitions=10 methods=skill tests="new-intentions new-demonstrations" ;;
  *) echo "usage: generalise.sh layouts | repetitions | A3 | coverage" >&2; exit 64 ;;
esac
[ -x "$bin/skill-validate" ] || sh "$root/share/lfdtools/setup.sh"
jobs=$(nproc 2>/dev/null || echo 2)
mkdir -p "$out"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM

# judge LAYOUT SEED REPETITIONS: scores of one data set, in the file that $work/order names.
judge() {
  base=$work/$1-$2-$3
  if [ "$1" = A ]; then
    cp "$root/share/lfdtools/peg-in-hole/A.json" "$base.json"
  else
    awk -v layout="$1" -v seed="$2" -f "$here/layout.awk" >"$base.json"
  fi
  name=$(sed -n 's/.*"name": *"\([^"]*\)".*/\1/p' "$base.json")
  "$bin/demo-synth" --seed "$2" --repetitions "$3" "$base.json" -o "$base.demos.csv"
  for test in $tests; do
    truth=--noise-free
    [ "$test" = new-intentions ] || truth=
    "$bin/demo-synth" --seed "$2" --repetitions 1 --write "$test" "$base.json" -o "$base.test.csv"
    "$bin/skill-validate" -q -j 1 --methods "$methods" "$base.demos.csv" --test "$base.test.csv" $truth -o "$base.scores.csv"
    sed "1d; s/^/$1,$name,$2,$3,$test,/" "$base.scores.csv" >>"$base.rows.csv"
  done
  mv "$base.rows.csv" "$base.csv"  # there only if all went well
}
[ "$layouts" = A ] || layouts=$(awk -v n="$layouts" 'BEGIN { for (i = 1; i <= n; ++i) print i }')
seeds=$(awk -v n="$seeds" 'BEGIN { for (i = 1; i <= n; ++i) print i }')
running=0
: >"$work/order"
for count in $repetitions; do
  for layout in $layouts; do
    for seed in $seeds; do
      echo "$work/$layout-$seed-$count.csv" >>"$work/order"
      judge "$layout" "$seed" "$count" &
      running=$((running + 1))
      [ $((running % jobs)) -ne 0 ] || wait
    done
  done
done
wait
echo "layout,name,seed,repetitions,test,target,method,rmse,end_error,dtw,outside,coverage95,path95" >"$work/scores"
xargs cat <"$work/order" >>"$work/scores"
mv "$work/scores" "$out/$part.csv"
awk -F, -v part="$part" -v opponents="$opponents" -f "$here/generalise.awk" "$out/$part.csv" >"$work/table"
mv "$work/table" "$out/$part.txt"
cat "$out/$part.txt"
echo "results: $out"
