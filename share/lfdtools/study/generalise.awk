# Scores of generalise.sh to its tables: awk -F, -v part=PART -v opponents=NAME,... -f generalise.awk PART.csv
# A unit is a layout (of A3, where there is one, a seed); what a unit says is a mean over its seeds and targets.

# Of bootstrap resamples of values v[1..n] the means' 2.5 and 97.5 % quantiles, in `low` and `high`.
function interval(v, n,   r, i, k, sum, means) {
  state = 1  # Park and Miller's generator, the same in every awk
  for (r = 1; r <= 2000; ++r) {
    sum = 0
    for (i = 1; i <= n; ++i) { state = 16807 * state % 2147483647; sum += v[int(state / 2147483647 * n) + 1] }
    for (k = r; k > 1 && means[k - 1] > sum / n; --k) means[k] = means[k - 1]
    means[k] = sum / n
  }
  low = means[50]; high = means[1951]
}
function mean_rmse(unit, count, method) { return 1e3 * rmse[unit, count, method] / rows[unit, count, method] }
# The opponent with the least mean rmse on this unit: chosen after the event.
function best_opponent(unit, count,   i, best) {
  best = opponent[1]
  for (i = 2; i <= O; ++i) if (mean_rmse(unit, count, opponent[i]) < mean_rmse(unit, count, best)) best = opponent[i]
  return best
}
function ratio(unit, count, against) {
  if (against == "best") against = best_opponent(unit, count)
  return mean_rmse(unit, count, "skill") / mean_rmse(unit, count, against)
}
# "0.61 (0.55 to 0.67)", the geometric mean of the ratios to one opponent.
function summary(count, against,   i, v, sum) {
  for (i = 1; i <= U; ++i) { v[i] = log(ratio(units[i], count, against)); sum += v[i] }
  interval(v, U)
  return sprintf("%.2f (%.2f to %.2f)", exp(sum / U), exp(low), exp(high))
}
# How many units the skill wins against an opponent.
function wins(count, against,   i, won) {
  for (i = 1; i <= U; ++i) won += ratio(units[i], count, against) < 1
  return won + 0
}
function coverage_line(words, test, from, to,   i, k, v, w, line, holes) {
  for (i = 1; i <= U; ++i) {
    split(named[units[i]], holes, " ")
    if (holes[1] < from || holes[1] > to) continue
    v[++k] = samples_inside[units[i], test] / judged[units[i], test]
    w[k] = paths_inside[units[i], test] / judged[units[i], test]
  }
  if (k == 0) return
  line = sprintf("%-34s%10d", words, k)
  line = line sprintf("  %s", share(v, k)) sprintf("  %s", share(w, k))
  print line
}
function share(v, n,   i, sum) {
  for (i = 1; i <= n; ++i) sum += v[i]
  interval(v, n)
  return sprintf("%5.1f %% (%.1f to %.1f)", 100 * sum / n, 100 * low, 100 * high)
}
FNR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; O = split(opponents, opponent, ","); next }
{
  unit = part == "A3" ? $at["seed"] : $at["layout"]
  count = $at["repetitions"]
  if (!(unit in named)) { units[++U] = unit; named[unit] = $at["name"] }
  if (!(count in counted)) { counts[++C] = count; counted[count] = 1 }
  rmse[unit, count, $at["method"]] += $at["rmse"]
  ++rows[unit, count, $at["method"]]
  samples_inside[unit, $at["test"]] += $at["coverage95"]
  paths_inside[unit, $at["test"]] += $at["path95"]
  ++judged[unit, $at["test"]]
}
END {
  if (part == "coverage") {
    printf "%-34s%10s  %-23s  %s\n", "95 % band of the default skill", "data sets", "samples inside", "whole paths inside"
    coverage_line("of the intention (latent)", "new-intentions", 0, 99)
    for (i = 5; i < 13; i += 2) coverage_line("  " i " or " i + 1 " holes", "new-intentions", i, i + 1)
    coverage_line("of one demonstration (predictive)", "new-demonstrations", 0, 99)
    for (i = 5; i < 13; i += 2) coverage_line("  " i " or " i + 1 " holes", "new-demonstrations", i, i + 1)
    exit
  }
  if (part != "repetitions") {
    printf "%-7s%-29s%8s  %-24s%6s%7s%11s\n", part == "A3" ? "seed" : "layout", "holes, field, length, noise", "skill", "best opponent [mm]", "ratio", "paper", "paper-full"
    for (i = 1; i <= U; ++i) {
      best = best_opponent(units[i], counts[1])
      printf "%-7s%-29s%8.1f  %-18s%6.1f%6.2f%7.2f%11.2f\n", units[i], named[units[i]], mean_rmse(units[i], counts[1], "skill"), best,
             mean_rmse(units[i], counts[1], best), ratio(units[i], counts[1], "best"), ratio(units[i], counts[1], "paper"),
             ratio(units[i], counts[1], "paper-full")
    }
    print ""
  }
  print "Geometric mean over " U (part == "A3" ? " seeds" : " layouts") " of the skill's mean rmse over the opponent's (95 % interval; wins)"
  line = sprintf("%-20s", "demonstrations")
  for (c = 1; c <= C; ++c) line = line sprintf("%-30s", counts[c])
  print line
  split("best," opponents ",paper,paper-full", shown, ",")
  for (i = 1; i in shown; ++i) {
    line = sprintf("%-20s", shown[i] == "best" ? "best in hindsight" : shown[i])
    for (c = 1; c <= C; ++c) line = line sprintf("%-30s", summary(counts[c], shown[i]) sprintf("; %d", wins(counts[c], shown[i])))
    sub(/ +$/, "", line)
    print line
  }
}
