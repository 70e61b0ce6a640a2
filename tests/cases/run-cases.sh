#!/bin/sh
# Runs the cases of one program: sh run-cases.sh PROGRAM [CASE...], with the programs on PATH.
#
# A case is a folder tests/cases/PROGRAM/CASE with
#   cmd      shell lines (exit 77: what the case needs is not to be had here), run in an empty temporary folder after those of PROGRAM/setup (in the same shell)
#   expout   expected standard output (none: anything, for a case with a check)
#   experr   expected standard error (none: nothing)
#   status   expected exit status (none: 0)
#   check    shell lines that look at the files `out` and `err` in the folder above; must exit 0
# In expout and experr, ... stands for any text within a line and PROGRAM for the program's name.
# The cases in every-program, and those in the folders that $KINDS of the setup names, are run for this program too;
# the setup says in $GOOD (a file that it has made) and $ARGS how to call the program so that it succeeds.
# In cmd and check: $CASE the case's folder, $CASES this one, $PROGRAM the name, outcome and the rest of outcome.sh.
set -u
LC_ALL=C
export LC_ALL
unset LANGUAGE NO_COLOR
CASES=$(cd "$(dirname "$0")" && pwd)
PROGRAM=${1:?usage: run-cases.sh PROGRAM [CASE...]}
shift
export CASES PROGRAM
command -v "$PROGRAM" >/dev/null || { echo "there is no $PROGRAM on PATH"; exit 1; }
scratch=$(mktemp -d) || exit 1
trap 'chmod -R u+w "$scratch"; rm -rf "$scratch"' EXIT
trap 'exit 1' HUP INT TERM

# Whether file $2 holds what file $1 expects; prints the lines that differ.
same_text() {
  awk -v program="$PROGRAM" '
    function fits(text, pattern,   at, rest, piece) {
      at = index(pattern, "...")
      if (at == 0) return text == pattern
      piece = substr(pattern, 1, at - 1)
      if (substr(text, 1, at - 1) != piece) return 0
      text = substr(text, at)
      rest = substr(pattern, at + 3)
      at = index(rest, "...")
      if (at == 0) return length(text) >= length(rest) && substr(text, length(text) - length(rest) + 1) == rest
      piece = substr(rest, 1, at - 1)
      at = index(text, piece)
      return at > 0 && fits(substr(text, at), rest)
    }
    FILENAME == ARGV[1] { gsub("PROGRAM", program); wanted[++n] = $0; next }
    { ++m
      if (m > n) { print "    unexpected: " $0; bad = 1 }
      else if (!fits($0, wanted[m])) { print "    expected:   " wanted[m]; print "    instead:    " $0; bad = 1 } }
    END { for (i = m + 1; i <= n; ++i) { print "    missing:    " wanted[i]; bad = 1 }
          exit bad }' "$1" "$2"
}

run_case() {
  CASE=$1
  export CASE
  room=$scratch/$2
  mkdir -p "$room/work"
  (
    cd "$room/work" || exit 99
    . "$CASES/outcome.sh"
    [ ! -f "$CASES/$PROGRAM/setup" ] || . "$CASES/$PROGRAM/setup"
    . "$CASE/cmd"
  ) </dev/null >"$room/out" 2>"$room/err"
  got=$?
  [ "$got" -ne 77 ] || { rm -rf "$room"; return 77; }
  fault=0
  wanted=0
  [ ! -f "$CASE/status" ] || read -r wanted <"$CASE/status"
  [ "$got" -eq "$wanted" ] || { echo "    exit status $got, expected $wanted"; fault=1; }
  if [ -f "$CASE/expout" ] || [ ! -f "$CASE/check" ]; then
    [ -f "$CASE/expout" ] && expected=$CASE/expout || expected=/dev/null
    same_text "$expected" "$room/out" || { echo "    (standard output)"; fault=1; }
  fi
  [ -f "$CASE/experr" ] && expected=$CASE/experr || expected=/dev/null
  same_text "$expected" "$room/err" || { echo "    (standard error)"; fault=1; }
  if [ -f "$CASE/check" ]; then
    (cd "$room/work" && . "$CASES/outcome.sh" && . "$CASE/check") >"$room/checked" 2>&1 ||
      { sed 's/^/    check: /' "$room/checked"; echo "    the check failed"; fault=1; }
  fi
  chmod -R u+w "$room"
  rm -rf "$room"
  return $fault
}

KINDS=
if [ -f "$CASES/$PROGRAM/setup" ]; then
  KINDS=$(mkdir "$scratch/kinds" && cd "$scratch/kinds" && . "$CASES/outcome.sh" && . "$CASES/$PROGRAM/setup" && echo "$KINDS")
fi
count=0
failed=0
skipped=0
for kind in every-program $KINDS "$PROGRAM"; do
  for folder in "$CASES/$kind"/*/; do
    folder=${folder%/}
    name=${folder##*/}
    [ -f "$folder/cmd" ] || continue
    if [ $# -gt 0 ]; then
      case " $* " in *" $name "*) ;; *) continue ;; esac
    fi
    count=$((count + 1))
    run_case "$folder" "$name" >"$scratch/report"
    case $? in
      0) ;;
      77)
        skipped=$((skipped + 1))
        echo "skipped: $kind/$name ($PROGRAM)"
        ;;
      *)
        failed=$((failed + 1))
        echo "DIFFERS: $kind/$name ($PROGRAM)"
        head -n 20 "$scratch/report" | cut -c 1-300
        ;;
    esac
  done
done
echo "$PROGRAM: $count cases, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ] && [ "$count" -gt 0 ]
