# Words for cases; read by run-cases.sh.

# outcome LABEL COMMAND...: runs the command and prints one line: the label, the exit status, `output` if it wrote to
# standard output, and of every message the place and the id, without the text (which may be reworded).
outcome() {
  outcome_label=$1
  shift
  "$@" >outcome.out 2>outcome.err
  outcome_status=$?
  printf '%s: %s' "$outcome_label" "$outcome_status"
  [ ! -s outcome.out ] || printf ' output'
  awk -v program="$PROGRAM" '{
    if (index($0, program ":") != 1) { printf " {%s}", $0; next }
    id = match($0, /\[[^][]*\]$/) ? substr($0, RSTART) : "[?]"
    rest = substr($0, length(program) + 2)
    where = substr(rest, 1, 1) == " " ? "" : substr(rest, 1, index(rest, ": ") - 1)
    text = where == "" ? substr(rest, 2) : substr(rest, index(rest, ": ") + 2)
    kind = text ~ /^warning: / ? "warning " : text ~ /^note: / ? "note " : ""
    printf " %s%s%s", kind, where == "" ? "" : where " ", id
  }' outcome.err
  echo
}

# edit FROM TO: standard input with the first occurrence of FROM on each line replaced (plain text, no pattern).
edit() {
  awk -v from="$1" -v to="$2" '{
    at = index($0, from)
    print at ? substr($0, 1, at - 1) to substr($0, at + length(from)) : $0 }'
}

# Lines at the top of $GOOD, and one more with its last cell replaced: with_last CELL.
with_last() {
  awk -v cell="$1" -v last="$(wc -l <"$GOOD")" 'NR < last { print; next } { sub(/[^,]*$/, ""); print $0 cell }' "$GOOD"
}

# Standard input without the digests of inputs, which tell files apart that mean the same.
undigested() { sed 's/"input_sha256":"[0-9a-f]*"/"input_sha256":""/g'; }

# The examples of --help, run one after another on the files of README.md's first example: outcome of each.
examples() {
  experiment=$(dirname "$CASES")/../share/lfdtools/peg-in-hole/A.json
  demo-synth "$experiment" -o demos.csv && demo-synth "$experiment" --write new-holes -o goals.csv &&
    dmp-fit demos.csv | mvgpr-train -o skill.json &&
    skill-generate skill.json --goals goals.csv -o motions.csv &&
    ur10-ik -q --rpy -1.5708,0,0 motions.csv -o joints.csv || return
  $PROGRAM --help | sed -n '/^Examples:/,$s/^  \([^ ].*\)/\1/p' >examples
  while read -r example; do
    sh -c "$example" >example.out 2>example.err </dev/null
    echo "$?: $example"
    grep -v -e ' warning: ' -e ' note: ' example.err
  done <examples
  :
}
