# Plain average of the aligned demonstrations of each target: sample k of all of them, in order.
BEGIN { FS = ","; OFS = "," }
$1 == "target" { if (!seen++) print "target", "t", "x", "y", "z"; next }
$1 != target { flush_target(); target = $1; demo = "" }
$2 != demo { demo = $2; k = 0 }
{ ++k; if (k > last) last = k; ++n[k]; t[k] = $3; x[k] += $4; y[k] += $5; z[k] += $6 }
END { flush_target() }
function flush_target(  i) {
  for (i = 1; i <= last; ++i) printf "%s,%.17g,%.17g,%.17g,%.17g\n", target, t[i], x[i] / n[i], y[i] / n[i], z[i] / n[i]
  last = 0
  delete n; delete t; delete x; delete y; delete z
}
