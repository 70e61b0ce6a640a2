# An experiment (lfdtools.experiment) with a known nonlinear intention: awk -v layout=L -v seed=S -f layout.awk
# The layout decides everything but the noise, whose seed is S. 5 to 12 holes on a grid, scattered in a plane or
# scattered in space; the sizes of the bumps over the goals vary by 60 to 160 mm as a sine, two Gaussians, a quadratic
# form, or the sum of the first two; the teacher's noise half, once or twice the usual.
# The length over which sizes turn, a quarter of the wave or a Gaussian's width, is 0.4 to 1 times the extent of the holes
# (experiment A: 0.65 and 0.53). New holes lie between three demonstrated ones, none closer to a demonstrated one than a
# third of the holes' spacing. The member `name` says "HOLES ARRANGEMENT FIELD LENGTH NOISE", the length over the extent.

# Uniform in [a, b): the generator of Park and Miller, the same in every awk. One call a statement, for the order.
function u(a, b) { state = 16807 * state % 2147483647; return a + (b - a) * state / 2147483647 }
function below(k) { return int(u(0, k)) }
function vector(x, y, z) { return sprintf("[%.4f, %.4f, %.4f]", x, y, z) }
function least_distance(x, y, z, count,   i, d, least) {
  least = 1e9
  for (i = 1; i <= count; ++i) { d = sqrt((x - X[i]) ^ 2 + (y - Y[i]) ^ 2 + (z - Z[i]) ^ 2); if (d < least) least = d }
  return least
}
# A direction among the goals: in space all three axes, in a plane x and z.
function direction(   r) {
  dx = u(-1, 1); dy = arrangement == "space" ? u(-1, 1) : 0; dz = u(-1, 1)
  r = sqrt(dx ^ 2 + dy ^ 2 + dz ^ 2) + 1e-9
  dx /= r; dy /= r; dz /= r
}
function sign() { return u(0, 1) < 0.5 ? -1 : 1 }

# Terms of A(g), by kind of field, of the amplitude given; drawn anew for an amplitude of 0. What they are with an
# amplitude of 1 at the holes and new holes is left in value[].
function sine(scale,   i, k) {
  if (scale == 0) { direction(); drawn[9] = dx; drawn[10] = dy; drawn[11] = dz; drawn[12] = u(0, 6.28) }
  k = 1.5708 / (turn * extent)
  for (i = 1; i <= places; ++i) {
    value[i] += sin(k * (drawn[9] * X[i] + drawn[10] * (Y[i] - 0.8) + drawn[11] * (Z[i] - 0.3)) + drawn[12])
  }
  return sprintf("\"sines\": [{\"amplitude\": %.4f, \"rates\": %s, \"phase\": %.3f}]", scale,
                 vector(k * drawn[9], k * drawn[10], k * drawn[11]), drawn[12])
}
function gaussians(scale,   i, j, w, list) {
  w = turn * extent
  if (scale == 0) for (j = 0; j < 8; j += 4) {
    drawn[j + 1] = u(-0.5, 0.5) * width; drawn[j + 2] = 0.8 + u(-0.5, 0.5) * depth
    drawn[j + 3] = 0.3 + u(-0.5, 0.5) * height; drawn[j + 4] = sign()
  }
  for (j = 0; j < 8; j += 4) {
    for (i = 1; i <= places; ++i) {
      value[i] += drawn[j + 4] * exp(-((X[i] - drawn[j + 1]) ^ 2 + (Y[i] - drawn[j + 2]) ^ 2 + (Z[i] - drawn[j + 3]) ^ 2) / (2 * w * w))
    }
    list = list (j ? ", " : "") sprintf("{\"amplitude\": %.4f, \"center\": %s, \"width\": %.4f}", drawn[j + 4] * scale,
           vector(drawn[j + 1], drawn[j + 2], drawn[j + 3]), w)
  }
  return "\"gaussians\": [" list "]"
}
function quadratic(scale,   i, j, c, list) {
  if (scale == 0) for (j = 0; j < 8; j += 4) {
    direction()
    drawn[j + 1] = dx; drawn[j + 2] = dy; drawn[j + 3] = dz; drawn[j + 4] = sign() / extent ^ 2
  }
  for (j = 0; j < 8; j += 4) {
    for (i = 1; i <= places; ++i) {
      value[i] += drawn[j + 4] * (drawn[j + 1] * X[i] + drawn[j + 2] * (Y[i] - 0.8) + drawn[j + 3] * (Z[i] - 0.3)) ^ 2
    }
  }
  for (i = 1; i <= 3; ++i) {
    for (j = 1; j <= 3; ++j) c[j] = scale * (drawn[4] * drawn[i] * drawn[j] + drawn[8] * drawn[4 + i] * drawn[4 + j])
    list = list (i > 1 ? ", " : "") vector(c[1], c[2], c[3])
  }
  return "\"quadratic\": [" list "]"
}
function terms(scale,   i) {
  for (i = 1; i <= places; ++i) value[i] = 0
  if (field == "sum") return sine(scale) ", " gaussians(scale)
  return field == "gaussian" ? gaussians(scale) : field == "quadratic" ? quadratic(scale) : sine(scale)
}
# A bump whose size varies by `range` over the places, about a constant.
function bump(range,   i, low, high, scale, exponent, constant) {
  terms(0)
  low = high = value[1]
  for (i = 2; i <= places; ++i) { if (value[i] < low) low = value[i]; if (value[i] > high) high = value[i] }
  scale = range / (high - low)
  exponent = u(0.6, 1.5)
  constant = u(-0.04, 0.04)
  return sprintf("{\"exponent\": %.2f, \"constant\": %.4f, %s}", exponent, constant - scale * (low + high) / 2, terms(scale))
}

BEGIN {
  state = 1000 + 7919 * layout
  for (i = 0; i < 20; ++i) u(0, 1)
  n = 5 + int((layout - 1) / 3) % 8
  split("plane space grid", arrangements, " ")
  arrangement = arrangements[(layout + 1) % 3 + 1]
  split("sine gaussian quadratic sum", fields, " ")
  field = fields[layout % 4 + 1]
  turn = u(0.4, 1)
  noise = 2 ^ (below(3) - 1)
  width = u(0.25, 0.6); height = u(0.2, 0.5); depth = arrangement == "space" ? u(0.15, 0.35) : 0
  extent = sqrt((width ^ 2 + height ^ 2 + depth ^ 2) / 2)

  # Holes about (0, 0.8, 0.3).
  if (arrangement == "grid") {
    columns = int(sqrt(n) + 0.999)
    rows = int((n + columns - 1) / columns)
    for (i = 0; i < n; ++i) {
      row = int(i / columns)
      here = row < rows - 1 ? columns : n - columns * (rows - 1)  # the last row may be shorter: spread over the width
      X[i + 1] = here > 1 ? width * ((i - row * columns) / (here - 1) - 0.5) : 0
      Y[i + 1] = 0.8
      Z[i + 1] = 0.3 + height * (row / (rows - 1) - 0.5)
    }
    spacing = sqrt(width * height / n)
  } else {
    spacing = 0.7 * (depth > 0 ? (width * height * depth / n) ^ (1 / 3) : sqrt(width * height / n))
    holes = n; n = 0
    while (n < holes) {
      x = u(-0.5, 0.5) * width; y = 0.8 + u(-0.5, 0.5) * depth; z = 0.3 + u(-0.5, 0.5) * height
      if (least_distance(x, y, z, n) < spacing) { spacing *= 0.999; continue }
      ++n; X[n] = x; Y[n] = y; Z[n] = z
    }
  }
  for (i = 1; i <= n; ++i) list = list (i > 1 ? ", " : "") "{\"target\": \"" i "\", \"position\": " vector(X[i], Y[i], Z[i]) "}"
  room = spacing / 3
  places = n
  while (places < n + 6) {
    a = below(n) + 1; b = below(n) + 1; c = below(n) + 1
    if (a == b || b == c || a == c) continue
    p = u(0.1, 1); q = u(0.1, 1); r = u(0.1, 1); sum = p + q + r
    x = (p * X[a] + q * X[b] + r * X[c]) / sum
    y = (p * Y[a] + q * Y[b] + r * Y[c]) / sum
    z = (p * Z[a] + q * Z[b] + r * Z[c]) / sum
    if (least_distance(x, y, z, n) < room) { room *= 0.999; continue }
    ++places; X[places] = x; Y[places] = y; Z[places] = z
    new = new (places > n + 1 ? ", " : "") "{\"target\": \"n" places - n "\", \"position\": " vector(x, y, z) "}"
  }

  sx = u(-0.5, -0.2); sy = u(0.3, 0.5); sz = u(0.3, 0.7)
  for (i = 1; i <= 3; ++i) bumps = bumps (i > 1 ? ", " : "") bump(u(0.06, 0.16))
  duration = u(2, 4)
  late = u(1.2, 2.5)
  printf "{\"format\": \"lfdtools.experiment\", \"version\": 1, \"name\": \"%d %s %s %s %g\", \"start\": %s, \"seed\": %d, ", n, arrangement, field,
         field == "quadratic" ? "-" : sprintf("%.2f", turn), noise, vector(sx, sy, sz), seed
  printf "\"holes\": [%s], \"new_holes\": [%s], \"duration_mean\": %.2f, ", list, new, duration
  printf "\"noise\": {\"duration_sd\": %.2f, \"tempo_sd\": %.3f, \"wander_sd\": [%.4f, %.4f], \"tremor_sd\": 0.0005}, ", 0.4 * noise, 0.05 * noise, 0.006 * noise, 0.004 * noise
  printf "\"origin\": [0, 0.8, 0.3], \"bumps\": [%s], \"approach\": {\"offset\": %s, \"exponent\": %.2f}}\n", bumps, vector(0, -u(0, 0.15), 0), late
}
