# Table of run.sh. Intervals are Wilson's, 95 %, over scenes where a scene counts whole, and over motions, of which the
# four of a scene are not independent, elsewhere.
BEGIN { FS = ","; z = 1.959964 }
NR == 1 { next }
$13 != "" {
  motion = $3 "," $1 "," $2 "," $4
  if (!(motion in drawn)) bin_of[motion] = $13 < 0.001 ? 1 : $13 < 0.01 ? 2 : $13 < 0.1 ? 3 : 4
  drawn[motion]++
  hit[motion] += $5 == "collided"
  lost[$3] += $5 == "refused"
  told_of[motion] = $13
  next
}
$5 == "set_aside" { aside[$2 "," $6]++; asides[$6] = 1; next }
{
  key = $2 "," $3
  if (!(($3) in known)) { known[$3] = 1; methods[++count] = $3 }
  motions[key]++
  outcome[key "," $5]++
  hand[key] += $9
  jerk[key] += $11
  outside[key] += $8 > 0.001
  if ($5 != "refused") { joint[key] += $10; judged[key]++ }
  seconds[key] += $12
  scene = key "," $1
  if (!(scene in of_scene)) scenes[key]++
  of_scene[scene] += $5 == "clear"
  if (of_scene[scene] == 4) whole[key]++
  motion = $2 "," $1 "," $4
  clear[motion "," $3] = $5 == "clear"
  if ($3 == "skill") { all_motions[++motion_count] = motion; ways_of[motion] = $2; scene_of[motion] = $1 }
}
function wilson(k, n,   p, middle, half) {
  if (n == 0) return "-"
  p = k / n
  middle = (p + z * z / (2 * n)) / (1 + z * z / n)
  half = z / (1 + z * z / n) * sqrt(p * (1 - p) / n + z * z / (4 * n * n))
  return sprintf("%5.1f (%.1f to %.1f)", 100 * p, 100 * (middle - half < 0 ? 0 : middle - half), 100 * (middle + half > 1 ? 1 : middle + half))
}
# @param without  names left aside besides skills and planners   @param parted  of the others take those with +ways too
function gain_over(words, without, parted,   m, name, best, gain, n, i, motion, sum, squares, s, mean, sd) {
  best = ""
  for (m = 1; m <= count; ++m) {
    name = methods[m]
    if (name ~ /^skill/ || name == "rrt-connect" || name == "prm" || index(" " without " ", " " name " ")) continue
    if ((name ~ /[+]ways$/) != parted) continue
    if (best == "" || outcome[ways "," name ",clear"] > outcome[ways "," best ",clear"]) best = name
  }
  if (best == "" || motions[ways "," best] == 0) return
  for (i = 1; i <= motion_count; ++i) {
    motion = all_motions[i]
    if (ways_of[motion] != ways || !((motion "," best) in clear)) continue
    if (!(scene_of[motion] in gain)) { ++n; gain[scene_of[motion]] = 0 }
    gain[scene_of[motion]] += (clear[motion ",skill"] - clear[motion "," best]) / 4
  }
  for (s in gain) { sum += gain[s]; squares += gain[s] ^ 2 }
  mean = sum / n
  sd = n > 1 ? sqrt((squares - n * mean * mean) / (n - 1)) : 0
  printf "motions that the skill clears less those of the best of %s (%s): %.1f points (%.1f to %.1f)\n", words, best, 100 * mean, 100 * (mean - z * sd / sqrt(n)), 100 * (mean + z * sd / sqrt(n))
}
END {
  for (ways = 1; ways <= 2; ++ways) {
    if (scenes[ways ",skill"] == 0) continue
    printf "%s: %d scenes; set aside:", ways == 1 ? "one way round" : "two ways round", scenes[ways ",skill"]
    for (reason in asides) printf " %d %s", aside[ways "," reason], reason
    printf "\n%-22s %-22s %-22s %-22s %7s %7s %7s %7s %8s\n", "percent", "all four clear", "collided", "refused", "outside", "hand m", "rad", "jerk", "s"
    for (m = 1; m <= count; ++m) {
      key = ways "," methods[m]
      n = motions[key]
      if (n == 0) continue
      printf "%-22s %-22s %-22s %-22s %7.1f %7.2f %7.2f %7.1f %8.4f\n", methods[m], wilson(whole[key], scenes[key]), wilson(outcome[key ",collided"], n), wilson(outcome[key ",refused"], n), 100 * outside[key] / n, hand[key] / n, judged[key] ? joint[key] / judged[key] : 0, jerk[key] / n, seconds[key] / n
    }
    # The opponent that clears most motions, and by what share of a scene's four the skill clears more: mean and normal
    # interval over scenes. Of all, and of those that learn; the last have the ways parted as the skill has.
    gain_over("every opponent", "teacher largest-detour", 0)
    gain_over("every opponent and the largest detour", "teacher", 0)
    gain_over("opponents with the ways parted", "teacher largest-detour", 1)
    print ""
  }
  # A motion counts once, by the share of its draws that touch, and a scene's four are not told apart: the interval is
  # the normal one over motions.
  bins = split("under 0.001,0.001 to 0.01,0.01 to 0.1,over 0.1,all", names, ",")
  kinds = split("skill-drawn,skill-goal-off,skill-itself", kind, ",")
  about["skill-drawn"] = "paths drawn from the covariance of the skill"
  about["skill-goal-off"] = "the same about its way to goals that are off by 2 cm an axis"
  about["skill-itself"] = "the mean of the skill, in the middle of what is drawn"
  for (m = 1; m <= kinds; ++m) {
    printf "probability of touching, told and seen, percent: %s; %d out of reach\n", about[kind[m]], lost[kind[m]]
    for (bin = 1; bin <= bins; ++bin) {
      n = sum = squares = seen = 0
      for (motion in drawn) {
        if (index(motion, kind[m] ",") != 1 || (bin < bins && bin_of[motion] != bin)) continue
        ++n
        share = hit[motion] / drawn[motion]
        seen += share
        sum += share - told_of[motion]
        squares += (share - told_of[motion]) ^ 2
      }
      if (n == 0) continue
      mean = sum / n
      sd = n > 1 ? sqrt((squares - n * mean * mean) / (n - 1)) : 0
      printf "%-14s %4d motions: told %6.2f, seen %6.2f, seen less told %6.2f (%.2f to %.2f)\n", names[bin], n, 100 * (seen - sum) / n, 100 * seen / n, 100 * mean, 100 * (mean - z * sd / sqrt(n)), 100 * (mean + z * sd / sqrt(n))
    }
  }
}
