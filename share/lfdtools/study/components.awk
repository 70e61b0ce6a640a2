# From lines "SET RATE <lfdtools.gmm document>": the K that each criterion takes, and what one component more gains.
function value(entry, key) {
  if (!match(entry, "\"" key "\":[-0-9.e+]+")) return 0
  return substr(entry, RSTART + length(key) + 3, RLENGTH - length(key) - 3) + 0
}
# Criterion c of a row of the table. bic_n: n of its own in the penalty; effective: in the likelihood too.
function criterion(c, L, q, E, N) {
  if (c == "bic") return -2 * L + q * log(N)
  if (c == "aic") return -2 * L + 2 * q
  if (c == "icl") return -2 * L + q * log(N) + 2 * E
  if (c == "bic_n") return -2 * L + q * log(n)
  if (c == "effective_bic") return -2 * L * n / N + q * log(n)
  if (c == "effective_aic") return -2 * L * n / N + 2 * q
  return (-2 * L + 2 * E) * n / N + q * log(n)
}
BEGIN {
  C = split("bic aic icl bic_n effective_bic effective_aic effective_icl", names, " ")
  header = "samples"
  for (c = 1; c <= C; ++c) header = header "," names[c]
  print "set,target,rate," header >chosen
  print "set,target,rate,samples,k,nats_per_sample,gain,penalty,penalty_effective" >gains
}
{
  name = $1; rate = $2
  target = $0; sub(/.*"target":"?/, "", target); sub(/[",].*/, "", target)
  N = value($0, "samples")
  table = $0; sub(/.*"selection":\[/, "", table); sub(/\].*/, "", table)
  rows_count = split(table, rows, "}") - 1
  line = name "," target "," rate "," N
  group = name "," rate
  if (!(group in count)) order[++groups] = group
  ++count[group]
  sum[group, 0] += N
  for (c = 1; c <= C; ++c) {
    least = ""
    for (i = 1; i <= rows_count; ++i) {
      v = criterion(names[c], value(rows[i], "log_likelihood"), value(rows[i], "parameters"), value(rows[i], "entropy"), N)
      if (least == "" || v < least) { least = v; best = value(rows[i], "k") }
    }
    line = line "," best
    sum[group, c] += best
  }
  print line >chosen
  # A component more has q' - q parameters and pays when its gain per sample exceeds (q' - q) ln n / (2 n).
  for (i = 1; i < rows_count; ++i) {
    L = value(rows[i], "log_likelihood") / N
    more = value(rows[i + 1], "parameters") - value(rows[i], "parameters")
    printf "%s,%s,%s,%d,%d,%.4f,%.4f,%.4f,%.4f\n", name, target, rate, N, value(rows[i], "k"), L,
           value(rows[i + 1], "log_likelihood") / N - L, more * log(N) / 2 / N, more * log(n) / 2 / n >gains
  }
}
END {
  print "set,rate," header
  for (g = 1; g <= groups; ++g) {
    line = order[g] "," sprintf("%.0f", sum[order[g], 0] / count[order[g]])
    for (c = 1; c <= C; ++c) line = line "," sprintf("%.1f", sum[order[g], c] / count[order[g]])
    print line
  }
}
