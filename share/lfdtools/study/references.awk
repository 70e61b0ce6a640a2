# A reference (target,t,x,y,z,...), then the aligned demonstrations (target,demo,t,x,y,z) on the same times: root mean
# square distance from the mean of the demonstrations [mm].
FNR == 1 { ++file; next }
file == 1 {
  if ($1 != target) { target = $1; i = 0 }
  ++i
  for (j = 3; j <= 5; ++j) reference[$1, i, j] = $j
  next
}
{
  if ($1 != target || $2 != demo) { target = $1; demo = $2; ++M[$1]; i = 0 }
  ++i
  T[$1] = i
  for (j = 4; j <= 6; ++j) sum[$1, i, j - 1] += $j
}
END {
  for (name in M) {
    for (i = 1; i <= T[name]; ++i) {
      for (j = 3; j <= 5; ++j) total += (reference[name, i, j] - sum[name, i, j] / M[name]) ^ 2
      ++count
    }
  }
  printf "%s,%.2f\n", row, 1e3 * sqrt(total / count)
}
