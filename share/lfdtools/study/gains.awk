# Draws gains.csv for one target: bars of what a component more gains a sample, marks where that pays, log scale.
function column(nats) { return int((log(nats) - log(low)) / (log(3) - log(low)) * width + 0.5) }
BEGIN { low = 0.004; width = 46 }
NR == 1 || $1 != set || $2 != target { next }
{
  if (!($3 in price)) rates[++R] = $3
  price[$3] = $8
  if ($5 == 1) samples[$3] = $4
  effective = $9
  gain[$3, $5] = $7
  if ($5 > K) K = $5
}
END {
  if (K > 14) K = 14
  fast = rates[R]; slow = rates[1]; middle = rates[int((R + 1) / 2)]
  mark[column(price[fast])] = "a"; mark[column(price[middle])] = "b"; mark[column(price[slow])] = "c"
  mark[column(effective)] = "d"
  printf "             nats a sample at    bars: at %d Hz, log scale\n K to K+1   %3d  %3d  %3d Hz\n", middle, slow, middle, fast
  for (k = 1; k <= K; ++k) {
    line = ""
    for (i = 1; i <= width; ++i) {
      filled = gain[middle, k] > 0 && i <= column(gain[middle, k])
      line = line (i in mark ? "|" : filled ? "#" : " ")
      if (filled || i in mark) last = i
    }
    sub(/ +$/, "", line)
    printf "%3d to %2d  %.2f %.2f %.2f  %s\n", k, k + 1, gain[slow, k], gain[middle, k], gain[fast, k], line
  }
  line = ""
  for (i = 1; i <= width; ++i) line = line (i in mark ? mark[i] : " ")
  sub(/ +$/, "", line)
  printf "%-26s%s\n\nA component more pays where its bar goes beyond the mark:\n", "", line
  printf "a  %.4f = 15/2 ln(%d)/%d, all samples at %d Hz\n", price[fast], samples[fast], samples[fast], fast
  printf "b  %.4f = 15/2 ln(%d)/%d, at %d Hz (the bars)\n", price[middle], samples[middle], samples[middle], middle
  printf "c  %.4f = 15/2 ln(%d)/%d, at %d Hz\n", price[slow], samples[slow], samples[slow], slow
  printf "d  %.4f = 15/2 ln(%d)/%d, effective, at any rate\n", effective, n, n
}
