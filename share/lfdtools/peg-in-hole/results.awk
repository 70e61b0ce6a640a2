# One row an experiment, variant and new hole: how the motion ends, how far it is from the intention behind the
# demonstrations, and what the arm makes of it. Lengths in millimetres, angles in degrees. end_error is
# where the motion rests (at rest_s), error_at_tau where it is when its duration is over, overshoot how far it goes
# beyond the hole along the direction of arrival. Direction and lateral deviation over the last 20 mm are against the line on which the intention arrives at that hole.
function columns(line,   i, names, n) {
  n = split(line, names, ",")
  delete at
  for (i = 1; i <= n; ++i) at[names[i]] = i
}
# Root mean square of the demonstrations' lateral deviation from the line on which their teacher meant to arrive.
function read_demonstrations(experiment,   file, line, cell, n, sum) {
  file = out "/" experiment "/demos.figures"
  getline line < file; columns(line)
  n = sum = 0
  while ((getline line < file) > 0) {
    split(line, cell, ",")
    sum += cell[at["lateral"]] ^ 2
    ++n
  }
  close(file)
  spread = sqrt(sum / n)
}
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
  print "experiment,variant,target,end_error_mm,error_at_tau_mm,overshoot_mm,rest_s,rmse_mm,arrival_deg,lateral_mm,demos_lateral_mm,joint_path,largest_step_deg,largest_speed_deg_s"
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
        printf "%s,%s,%s,%.4f,%.3f,%.2f,%.2f,%.2f,%.2f,%.3f,%.3f,%s,%s,%s\n", experiments[e], variant[v], cell[1],
          1e3 * cell[where["end_error"]], 1e3 * cell[where["error_at_duration"]], 1e3 * cell[where["overshoot"]],
          cell[where["duration"]], 1e3 * cell[where["rmse"]],
          cell[where["arrival_angle"]],
          1e3 * cell[where["lateral"]], 1e3 * spread, found,
          found == "yes" ? sprintf("%.2f", largest_step * 57.29577951308232) : "-",
          found == "yes" ? sprintf("%.1f", largest_speed * 57.29577951308232) : "-"
      }
    }
  }
}
