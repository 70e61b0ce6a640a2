#!/bin/sh
# Keeps the layers of the sources: sh layers.sh SOURCE_TREE. Includes go downward or stay within a layer, never from one
# column to another, never around in a circle; every file is in a layer; nlohmann stays in lib/io, CLI11 in lib/cli.
set -u
LC_ALL=C
export LC_ALL
table=$(cd "$(dirname "$0")" && pwd)/layers.txt
cd "${1:?usage: layers.sh SOURCE_TREE}" || exit 1
lines=$(mktemp) || exit 1
trap 'rm -f "$lines" "$lines.pairs"' EXIT

# file<TAB>what it includes, brackets or quotes kept
find include/lfdtools lib tools -type f \( -name '*.hpp' -o -name '*.cpp' -o -name '*.inc' -o -name '*.h' \) |
  while read -r file; do
    printf '%s\t\n' "$file"
    sed -n 's/^[ \t]*#[ \t]*include[ \t]*\([<"][^">]*[">]\).*/\1/p' "$file" | sed "s|^|$file\t|"
  done >"$lines"
[ -s "$lines" ] || { echo "no sources found"; exit 1; }

awk -F '\t' -v pairs="$lines.pairs" '
  # The layer of a path, or nothing.
  function layer_of(path,   name) {
    if (path ~ /^tools\//) return "tools"
    if (path ~ /(^|\/)cli\//) return "cli"
    if (path ~ /(^|\/)plot\//) return "plot"
    if (path ~ /(^|\/)io\//) return "io"
    name = path
    sub(/.*\//, "", name)
    sub(/\.[a-z]*$/, "", name)
    return layer[name]
  }
  function fault(text) { print text; bad = 1 }
  FILENAME == ARGV[1] {
    if ($0 ~ /^#/) next
    n = split($0, word, " ")
    rank[word[2]] = word[1]
    for (i = 3; i <= n; ++i) layer[word[i]] = word[2]
    next
  }
  {
    own = layer_of($1)
    if (own == "") { if ($2 == "") fault($1 ": in no layer (tests/layers.txt)"); next }
    if ($2 == "") { ++files; next }
    what = substr($2, 2, length($2) - 2)
    if (what ~ /nlohmann/ && $1 !~ /^lib\/io\//) fault($1 ": includes " $2 ", which is for lib/io alone")
    if (what ~ /^CLI(11)?(\/|\.)/ && $1 !~ /^lib\/cli\//) fault($1 ": includes " $2 ", which is for lib/cli alone")
    if ($2 ~ /^</) {
      if (what ~ /^lfdtools\//) fault($1 ": includes " $2 " with angle brackets")
      next
    }
    target = what
    if (what !~ /^lfdtools\//) { target = $1; sub(/[^\/]*$/, "", target); target = target what }
    other = layer_of(target)
    if (other == "") { fault($1 ": includes " what ", which is in no layer"); next }
    ++includes
    if (rank[other] > rank[own]) fault($1 ": " own " includes " what " of the layer " other " above it")
    else if (rank[other] == rank[own] && other != own) fault($1 ": " own " includes " what " of the column " other " beside it")
    from = $1
    sub(/^include\//, "", from)
    if (from != target) print from, target >pairs
  }
  END {
    printf "%d files, %d includes of our own\n", files, includes
    exit bad || files < 50 || includes < 100
  }' "$table" "$lines"
status=$?
if ! tsort "$lines.pairs" >/dev/null 2>"$lines"; then
  echo "includes go around in a circle:"
  sed 's/^tsort: */  /' "$lines"
  status=1
fi
exit $status
