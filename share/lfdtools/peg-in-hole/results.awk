# One row an experiment, variant and new hole: how the motion ends, how far it is from the intention behind the
# demonstrations, and what the arm makes of it. Lengths in millimetres, angles in degrees.
function columns(line,   i, names, n) {
  n = split(line, names, ",")
  delete at
  for (i = 1; i <= n; ++i) at[names[i]] = i
}
# The demonstrations' mean direction of arrival, and the root mean square of their lateral deviation.
function read_demonstrations(experiment,   file, line, cell, n, length_, sum) {
  file = out "/" experiment "/demos.figures"
  getline line < file; columns(line)
  dx = dy = dz = n = sum = 0
  while ((getline line < file) > 0) {
    split(line, cell, ",")
    dx += cell[at["arrival_x"]]; dy += cell[at["arrival_y"]]; dz += cell[at["arrival_z"]]
    sum += cell[at["lateral"]] ^ 2
    ++n
  }
  close(file)
  length_ = sqrt(dx * dx + dy * dy + dz * dz)
  dx /= length_; dy /= length_; dz /= length_
  spread = sqrt(sum / n)
}
function angle(c) { if (c > 1) c = 1; if (c < -1) c = -1; return atan2(sqrt(1 - c * c), c) * 57.29577951308232 }
function joints(file,   line, cell, n, i, step, largest, previous, names) {
  largest_step = largest_speed = ""
  found = "no"
  if ((getline line < file) <= 0 || line == "target") { close(file); return }
  columns(line)
  largest_step = largest_speed = n = 0
  while ((getline line < file) > 0) {
    split(line, cell, ",")
    for (i = 1; i <= 6; ++i) {
      step = cell[at["q" i]] - previous[i]
      if (step < 0) step = -step
      if (n > 0 && step > largest_step) largest_step = step
      previous[i] = cell[at["q" i]]
      step = cell[at["qd" i]]
      if (step < 0) step = -step
      if (step > largest_speed) largest_speed = step
    }
    ++n
  }
  close(file)
  found = "yes"
}
BEGIN {
  print "experiment,variant,target,end_error_mm,rmse_mm,arrival_deg,lateral_mm,demos_lateral_mm,joint_path,largest_step_deg,largest_speed_deg_s"
  split("A B", experiments, " ")
  split(variants, variant, " ")
  for (e = 1; e <= 2; ++e) {
    read_demonstrations(experiments[e])
    for (v = 1; v in variant; ++v) {
      file = out "/" experiments[e] "/" variant[v] "/figures.csv"
      getline line < file; columns(line)
      delete rows
      n = 0
      while ((getline line < file) > 0) rows[++n] = line
      close(file)
      for (name in at) where[name] = at[name]
      for (i = 1; i <= n; ++i) {
        split(rows[i], cell, ",")
        joints(out "/" experiments[e] "/" variant[v] "/joints/" cell[1] ".csv")
        printf "%s,%s,%s,%.4f,%.2f,%.2f,%.3f,%.3f,%s,%s,%s\n", experiments[e], variant[v], cell[1],
          1e3 * cell[where["end_error"]], 1e3 * cell[where["rmse"]],
          angle(cell[where["arrival_x"]] * dx + cell[where["arrival_y"]] * dy + cell[where["arrival_z"]] * dz),
          1e3 * cell[where["lateral"]], 1e3 * spread, found,
          found == "yes" ? sprintf("%.2f", largest_step * 57.29577951308232) : "-",
          found == "yes" ? sprintf("%.1f", largest_speed * 57.29577951308232) : "-"
      }
    }
  }
}
