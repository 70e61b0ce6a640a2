# Aligned demonstrations (target,demo,t,x,y,z) to how many independent samples a target's pool is worth: N over the
# integrated autocorrelation 1 + 2 (rho_1 + rho_2 + ...), up to the first rho below 0, of the demonstrations less their
# mean.
function close_target(   i, j, m, lag, power, rho, total) {
  for (j = 4; j <= 6; ++j) {
    for (i = 1; i <= T; ++i) {
      mean = 0
      for (m = 1; m <= M; ++m) mean += y[m, i, j] / M
      for (m = 1; m <= M; ++m) { y[m, i, j] -= mean; power += y[m, i, j] ^ 2 }
    }
  }
  total = 1
  for (lag = 1; lag < T; ++lag) {
    rho = 0
    for (m = 1; m <= M; ++m) for (j = 4; j <= 6; ++j) for (i = 1; i + lag <= T; ++i) rho += y[m, i, j] * y[m, i + lag, j]
    if (rho < 0) break
    total += 2 * rho / power
  }
  printf "%s,%s,%d,%d,%.1f\n", set, target, M * T, M, M * T / total
}
NR == 1 { next }
$1 != target { if (NR > 2) close_target(); target = $1; demo = ""; M = 0 }
$2 != demo { demo = $2; ++M; T = 0 }
{ ++T; for (j = 4; j <= 6; ++j) y[M, T, j] = $j }
END { close_target() }
