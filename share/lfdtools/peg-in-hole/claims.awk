# The paper's claims, each with the figure measured here and whether it holds.
function row(claim, figure, limit, holds) {
  gsub(/,/, ";", figure); gsub(/,/, ";", limit)
  printf "%s,%s,%s,%s\n", claim, figure, limit, holds ? "holds" : "does not hold"
}
function columns(line,   i, names, n) {
  n = split(line, names, ",")
  delete at
  for (i = 1; i <= n; ++i) at[names[i]] = i
}
# K of least BIC in the selection table of a mixture.
function chosen(file,   line, entries, n, i, k, bic, best, best_bic) {
  getline line < file
  close(file)
  sub(/.*"selection":\[/, "", line)
  sub(/\].*/, "", line)
  n = split(line, entries, "}")
  best_bic = 1e300
  for (i = 1; i <= n; ++i) {
    if (!match(entries[i], /"k":[0-9]+/)) continue
    k = substr(entries[i], RSTART + 4, RLENGTH - 4)
    match(entries[i], /"bic":[-0-9.e+]+/)
    bic = substr(entries[i], RSTART + 6, RLENGTH - 6) + 0
    if (bic < best_bic) { best_bic = bic; best = k }
  }
  return best + 0
}
function mean_jerk(file,   line, cell, sum, n) {
  getline line < file; columns(line)
  sum = n = 0
  while ((getline line < file) > 0) { split(line, cell, ","); sum += cell[at["jerk"]]; ++n }
  close(file)
  return sum / n
}
function read_weights(experiment,   file, line, cell) {
  file = out "/" experiment "/weights.csv"
  getline line < file
  while ((getline line < file) > 0) { split(line, cell, ","); w[experiment, cell[1], cell[2], cell[3]] = cell[4]; if (cell[3] > bases) bases = cell[3] + 0 }
  close(file)
}
function distance(experiment, signal, a, b,   i, sum) {
  sum = 0
  for (i = 1; i <= bases; ++i) sum += (w[experiment, a, signal, i] - w[experiment, b, signal, i]) ^ 2
  return sqrt(sum)
}
function size(experiment, signal,   i, t, sum) {
  sum = 0
  for (t = 1; t <= 4; ++t) for (i = 1; i <= bases; ++i) sum += w[experiment, "n" t, signal, i] ^ 2
  return sqrt(sum / 4)
}
# Mean distance between weights of a signal within the two pairs {a b}, {c d}, over that between the pairs.
function grouping(signal, a, b, c, d) {
  within_pairs = (distance("A", signal, a, b) + distance("A", signal, c, d)) / 2
  between = (distance("A", signal, a, c) + distance("A", signal, a, d) + distance("A", signal, b, c) + distance("A", signal, b, d)) / 4
  return within_pairs / between
}
# Positions of the first motion of a file after subtracting the straight line from start to goal, at 51 samples.
function shape(file, key,   line, cell, n, k, j, s) {
  getline line < file; columns(line)
  n = 0
  while ((getline line < file) > 0) { split(line, cell, ","); ++n; px[n] = cell[at["x"]]; py[n] = cell[at["y"]]; pz[n] = cell[at["z"]] }
  close(file)
  for (k = 0; k <= 50; ++k) {
    j = 1 + int(k * (n - 1) / 50 + 0.5)
    s = (j - 1) / (n - 1)
    s = s * s * s * (10 - s * (15 - 6 * s))
    sx[key, k] = px[j] - px[1] - s * (px[n] - px[1])
    sy[key, k] = py[j] - py[1] - s * (py[n] - py[1])
    sz[key, k] = pz[j] - pz[1] - s * (pz[n] - pz[1])
  }
}
function shape_distance(a, b,   k, sum) {
  sum = 0
  for (k = 0; k <= 50; ++k) sum += (sx[a, k] - sx[b, k]) ^ 2 + (sy[a, k] - sy[b, k]) ^ 2 + (sz[a, k] - sz[b, k]) ^ 2
  return sqrt(sum / 51)
}
# Largest curvature [1/m] of the middle of a motion (a tenth at each end left out, where the hand is slow), and where.
function curvature(file, target,   line, cell, n, k, first, last, ax, ay, az, bx, by, bz, cx, cy, cz, a, b, c, area, value) {
  getline line < file; columns(line)
  n = 0
  while ((getline line < file) > 0) {
    split(line, cell, ",")
    if (target != "" && cell[at["target"]] != target) continue
    ++n; px[n] = cell[at["x"]]; py[n] = cell[at["y"]]; pz[n] = cell[at["z"]]; pt[n] = cell[at["t"]]
  }
  close(file)
  while (n > 1 && pt[n] > 3.0001) --n
  largest = 0
  for (k = int(n / 10) + 6; k <= n - int(n / 10) - 6; ++k) {
    ax = px[k] - px[k - 5]; ay = py[k] - py[k - 5]; az = pz[k] - pz[k - 5]
    bx = px[k + 5] - px[k]; by = py[k + 5] - py[k]; bz = pz[k + 5] - pz[k]
    cx = ay * bz - az * by; cy = az * bx - ax * bz; cz = ax * by - ay * bx
    a = sqrt(ax * ax + ay * ay + az * az); b = sqrt(bx * bx + by * by + bz * bz)
    c = sqrt((ax + bx) ^ 2 + (ay + by) ^ 2 + (az + bz) ^ 2)
    area = sqrt(cx * cx + cy * cy + cz * cz)
    value = a * b * c > 0 ? 2 * area / (a * b * c) : 0   # circle through three points
    if (value > largest) { largest = value; peak_x = px[k]; peak_y = py[k]; peak_z = pz[k] }
  }
  return largest
}
# Least distance of the links to B's rod over the new holes, and at how many it is positive (arms_clear).
function arms(variant,   i, file, cells, least, of_all) {
  arms_clear = 0
  of_all = 1e9
  for (i = 1; i in new_hole; ++i) {
    file = out "/B/" variant "/clearance/" new_hole[i] ".csv"
    least = 1e9
    while ((getline line < file) > 0) {
      split(line, cells, ",")
      if (cells[4] == "rod" && cells[5] < least) least = cells[5]
    }
    close(file)
    if (least < 1e9) arms_clear += least > 0
    if (least < of_all) of_all = least
  }
  return sprintf("%d of 4 clear, least distance %.0f mm", arms_clear, 1e3 * of_all)
}
# Least distance [m] of the hand to the obstacle's surface over all motions of a file; negative inside.
function clearance(file,   line, cell, x, y, z, along, d, least, length_) {
  getline line < file; columns(line)
  least = 1e9
  length_ = sqrt(axis[1] ^ 2 + axis[2] ^ 2 + axis[3] ^ 2)
  while ((getline line < file) > 0) {
    split(line, cell, ",")
    x = cell[at["x"]] - center[1]; y = cell[at["y"]] - center[2]; z = cell[at["z"]] - center[3]
    along = length_ > 0 ? (x * axis[1] + y * axis[2] + z * axis[3]) / length_ : 0
    d = sqrt(x * x + y * y + z * z - along * along) - radius
    if (d < least) least = d
  }
  close(file)
  return least
}
function corner_rmse(method) { return v[method, "corner"] / m[method, "corner"] }
function better(method) { return corner_rmse(method) < corner_rmse("nearest") && corner_rmse(method) < corner_rmse("affine") }
function rmse_of(experiment, variant,   i) { return total[experiment, variant] / count[experiment, variant] }
BEGIN {
  FS = ","
  print "claim,measured,holds_if,verdict"
  split("A B", experiments, " ")
  nA = split(holes_A, hole_A, " "); nB = split(holes_B, hole_B, " ")

  for (i = 1; i <= nA + nB; ++i) {
    where = i <= nA ? "A/sweep" : "B/sweep"
    hole = i <= nA ? hole_A[i] : hole_B[i - nA]
    k = chosen(out "/" (i <= nA ? "A" : "B") "/sweep/" hole ".json"); ks = ks " " k; four += k == 4
    k = chosen(out "/" (i <= nA ? "A" : "B") "/sweep200/" hole ".json"); k200 = k200 " " k
  }
  row("BIC chooses 4 components", "of 1..12 with n = samples:" ks " (12 is the edge); with n = 200:" k200, "4 at every hole", four == nA + nB)

  for (e = 1; e <= 2; ++e) {
    gmr = mean_jerk(out "/" experiments[e] "/reference.figures"); average = mean_jerk(out "/" experiments[e] "/average.figures")
    row("GMR is smoother than the average (" experiments[e] ")", sprintf("rms jerk %.3g against %.3g m/s^3", gmr, average), "less", gmr < average)
  }

  read_weights("A"); read_weights("B"); read_weights("C")
  x = grouping("x", "n1", "n3", "n2", "n4"); z = grouping("z", "n1", "n2", "n3", "n4")
  row("weights of x group by column", sprintf("distance within over between columns %.2f", x), "under 0.5", x < 0.5)
  row("weights of z group by row", sprintf("distance within over between rows %.2f", z), "under 0.5", z < 0.5)
  y = (distance("A", "y", "n1", "n2") + distance("A", "y", "n1", "n3") + distance("A", "y", "n1", "n4") + distance("A", "y", "n2", "n3") + distance("A", "y", "n2", "n4") + distance("A", "y", "n3", "n4")) / 6 / size("A", "y")
  row("weights of y are alike", sprintf("mean distance over mean size %.3f", y), "under 0.1", y < 0.1)
  gx = size("B", "x") / size("C", "x"); gz = size("B", "z") / size("C", "z"); gy = size("B", "y") / size("C", "y")
  row("with the obstacle the weights of x and z grow strongly", sprintf("with over without it at the same holes: x %.2f; y %.2f; z %.2f", gx, gy, gz), "x and z over 1.5", gx > 1.5 && gz > 1.5)

  getline_file = source "B.json"
  while ((getline line < getline_file) > 0) {
    if (line ~ /"obstacle"/) inside = 1
    if (inside && line ~ /"center"/) { gsub(/[^-0-9.,]/, "", line); split(line, center, ",") }
    if (inside && line ~ /"axis"/) { gsub(/[^-0-9.,]/, "", line); split(line, axis, ",") }
    if (inside && line ~ /"radius"/) { gsub(/[^-0-9.]/, "", line); radius = line + 0 }
  }
  close(getline_file)
  largest_meant = 0
  for (i = 1; i <= nB; ++i) { c = curvature(out "/B/intentions.csv", hole_B[i]); if (c > largest_meant) largest_meant = c }
  split(new, new_hole, " ")
  within = beside = 0
  for (i = 1; i in new_hole; ++i) {
    c = curvature(out "/B/default/motion/" new_hole[i] ".csv", "")
    d = sqrt((peak_x - center[1]) ^ 2 + (peak_y - center[2]) ^ 2 + (peak_z - center[3]) ^ 2)
    text = text sprintf(" %.1f/m at %.0f mm", c, 1e3 * d)
    within += c <= largest_meant; beside += d < 0.25
  }
  row("curvature peaks beside the obstacle", "peak and its distance from the obstacle's middle:" text, "under 250 mm at 4 of 4", beside == 4)
  row("curvature stays within the demonstrations' range", sprintf("%d of 4 under %.1f/m", within, largest_meant), "4 of 4 under the largest that the teacher meant at a demonstrated hole", within == 4)

  text = ""
  least = 1e9
  for (i = 1; i in new_hole; ++i) { d = clearance(out "/B/default/motion/" new_hole[i] ".csv"); if (d < least) least = d }
  least_paper = 1e9
  for (i = 1; i in new_hole; ++i) { d = clearance(out "/B/paper-full/motion/" new_hole[i] ".csv"); if (d < least_paper) least_paper = d }
  control = clearance(out "/B/control.csv")
  row("it avoids the obstacle without knowing it (hand path alone)", sprintf("least distance: default %.0f mm; paper-full %.0f mm; control: A's skill %.0f mm", 1e3 * least, 1e3 * least_paper, 1e3 * control), "over 0 for the skills; the control collides", least > 0 && least_paper > 0 && control < 0)

  text = arms("default")
  clear_arms = arms_clear
  row("its whole arm avoids it as well", "default " text "; paper-full " arms("paper-full"), "every link clear of the rod at 4 of 4 (default)", clear_arms == 4)

  for (i = 1; i <= nA; ++i) shape(out "/A/reference/" hole_A[i] ".csv", i)
  for (i = 1; i <= 9; ++i) for (j = i + 1; j <= 9; ++j) {
    same = int((i - 1) / 3) == int((j - 1) / 3) || (i - 1) % 3 == (j - 1) % 3
    shapes[same] += shape_distance(i, j); pairs[same]++
  }
  row("holes on one axis have similar shapes", sprintf("mean distance of shapes %.1f mm on one axis; %.1f mm otherwise", 1e3 * shapes[1] / pairs[1], 1e3 * shapes[0] / pairs[0]), "under 0.75 of the others", shapes[1] / pairs[1] < 0.75 * shapes[0] / pairs[0])

  file = out "/A/validation.csv"
  getline line < file; columns(line)
  while ((getline line < file) > 0) {
    split(line, cell, ",")
    corner = cell[at["target"]] ~ /^[1379]$/ ? "corner" : "inner"
    v[cell[at["method"]], corner] += cell[at["rmse"]]; m[cell[at["method"]], corner]++
  }
  close(file)
  text = ""
  split("skill paper paper-full nearest affine", methods, " ")
  for (i = 1; i <= 5; ++i) text = text sprintf(" %s %.1f", methods[i], 1e3 * v[methods[i], "corner"] / m[methods[i], "corner"])
  row("it extrapolates (corner holes left out; mm)", substr(text, 2), "both readings of the paper under nearest and affine", better("paper") && better("paper-full"))

  file = out "/results.csv"
  getline line < file; columns(line)
  while ((getline line < file) > 0) {
    split(line, cell, ",")
    id = cell[at["experiment"]] SUBSEP cell[at["variant"]]
    total[id] += cell[at["rmse_mm"]]; count[id]++
    reached[id] += cell[at["end_error_mm"]] <= 0.1 && cell[at["arrival_deg"]] < 5 && cell[at["overshoot_mm"]] < 1 && cell[at["lateral_mm"]] < cell[at["demos_lateral_mm"]] && cell[at["joint_path"]] == "yes"
  }
  close(file)
  for (e = 1; e <= 2; ++e) {
    id = experiments[e]
    row("new holes are reached (" id ")", sprintf("paper %d; paper-full %d; default %d of 4", reached[id, "paper"], reached[id, "paper-full"], reached[id, "default"]), "4 of 4 by the paper: rests on the hole; arrives within 5 deg; under 1 mm beyond it; lateral under the demonstrations'; joint path", reached[id, "paper"] == 4 && reached[id, "paper-full"] == 4)
    row("the defaults halve the paper's error (" id "; mm)", sprintf("paper %.1f; paper-full %.1f; default %.1f", rmse_of(id, "paper"), rmse_of(id, "paper-full"), rmse_of(id, "default")), "under half of both readings", rmse_of(id, "default") < 0.5 * rmse_of(id, "paper") && rmse_of(id, "default") < 0.5 * rmse_of(id, "paper-full"))
  }
}
