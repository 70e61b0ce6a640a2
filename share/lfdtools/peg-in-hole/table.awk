# A CSV as a readable table: columns as wide as their widest cell.
{ for (i = 1; i <= NF; ++i) { cell[NR, i] = $i; if (length($i) > width[i]) width[i] = length($i) } if (NF > columns) columns = NF }
END {
  for (row = 1; row <= NR; ++row) {
    line = ""
    for (i = 1; i <= columns; ++i) line = line sprintf("%-" (width[i] + 2) "s", cell[row, i])
    sub(/ +$/, "", line)
    print line
  }
  print ""
}
