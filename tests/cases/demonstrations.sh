# demonstrations TARGETS DEMOS SAMPLES: hand movements on quintic paths to holes on a line, a little apart in time and
# place, as CSV with six decimals.
demonstrations() {
  awk -v targets="$1" -v demos="$2" -v samples="$3" 'BEGIN {
    print "target,demo,t,x,y,z"
    for (g = 1; g <= targets; ++g) for (d = 1; d <= demos; ++d) for (k = 0; k < samples; ++k) {
      s = k / (samples - 1)
      m = s * s * s * (10 + s * (6 * s - 15))
      b = 64 * s * s * s * (1 - s) * (1 - s) * (1 - s)
      printf "%d,%d,%.6f,%.6f,%.6f,%.6f\n", g, d, (1 + 0.1 * d) * s, m * (0.2 + 0.1 * g), 0.3 * m + 0.02 * d * b,
             0.05 * g * b + 0.2 * m }
  }'
}
