"""demo-align: costs by the textbook recursion; what must hold of aligned demonstrations; figures on recordings."""
import numpy as np
from scipy.interpolate import CubicSpline

from toolchain import Checks, groups, positions, recordings, run, synthetic


def dtw(a, b):
    local = np.sqrt(((a[:, None, :] - b[None, :, :]) ** 2).sum(2))
    total = np.full((len(a) + 1, len(b) + 1), np.inf)
    total[0, 0] = 0
    for i in range(len(a)):
        row, above = total[i + 1], total[i]
        for j in range(len(b)):
            row[j + 1] = local[i, j] + min(above[j], above[j + 1], row[j])
    return total[-1, -1]


def by_target(table):
    found = {}
    for group in groups(table):
        found.setdefault(group[0].get("target"), []).append(group)
    return found


def thin(table, keep):
    """The table with the first `keep` demonstrations of each target."""
    lines = table.splitlines(True)
    header = lines[0].strip().split(",")
    target, demo = header.index("target"), header.index("demo")
    seen, kept = {}, [lines[0]]
    for line in lines[1:]:
        cells = line.strip().split(",")
        demos = seen.setdefault(cells[target], [])
        if cells[demo] not in demos:
            demos.append(cells[demo])
        if demos.index(cells[demo]) < keep:
            kept.append(line)
    return "".join(kept)


def short_steps(path):
    """Steps under a thousandth of the mean step, between 1 % and 99 % of the way: hands rest before and after."""
    steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
    way = np.cumsum(steps) / steps.sum()
    return int(((steps < 1e-3 * steps.mean()) & (way > 0.01) & (way < 0.99)).sum())


def spread(paths):
    """Root mean square distance from the mean path."""
    stack = np.array(paths)
    return np.sqrt(((stack - stack.mean(0)) ** 2).sum(2).mean())


def check_costs(checks, table, name):
    raw = by_target(table)
    written = {}
    for line in run("demo-align", "-q", "--costs", "--columns", "x,y,z", text=table).splitlines()[1:]:
        target, a, b, cost = line.split(",")
        written[target, a, b] = float(cost)
    pairs = 0
    for target, demos in raw.items():
        for i, a in enumerate(demos):
            for b in demos[i + 1:]:
                cost = dtw(positions(a)[1], positions(b)[1])
                got = written.pop((target, a[0]["demo"], b[0]["demo"]))
                checks.below(f"{name}: DTW cost", abs(got - cost) / max(1, cost), 1e-9)
                pairs += 1
    checks.below(f"{name}: costs without a pair", len(written), 0)


def check_alignment(checks, table, name, gain_wanted=None):
    raw, aligned = by_target(table), by_target(run("demo-align", "-q", text=table))
    checks.below(f"{name}: targets lost", len(set(raw) ^ set(aligned)), 0)
    gains = []
    for target, demos in aligned.items():
        grid = positions(demos[0])[0]
        duration = np.mean([positions(group)[0][-1] - positions(group)[0][0] for group in raw[target]])
        checks.below(f"{name}: grid begins at 0", abs(grid[0]), 0)
        checks.below(f"{name}: grid ends at the mean duration", abs(grid[-1] - duration), 1e-9)
        warped, linear = [], []
        for group, recorded in zip(demos, raw[target]):
            assert group[0] == recorded[0], "demonstrations out of order"
            t, y = positions(group)
            checks.below(f"{name}: one grid a target", np.abs(t - grid).max(), 0)
            raw_t, raw_y = positions(recorded)
            keep = np.concatenate([[True], np.diff(raw_t) > 0])
            raw_t, raw_y = raw_t[keep], raw_y[keep]
            checks.below(f"{name}: start", np.abs(y[0] - raw_y[0]).max(), 1e-9)
            checks.below(f"{name}: end", np.abs(y[-1] - raw_y[-1]).max(), 1e-9)
            scaled = CubicSpline(raw_t, raw_y)(raw_t[0] + (raw_t[-1] - raw_t[0]) * grid / grid[-1])
            # panda_peg: recorded to 0.01 mm, with rests on the way where a step of noise may fall short by chance.
            checks.below(f"{name}: staircases (short steps beyond those of the recording)",
                         short_steps(y) - short_steps(scaled), 0 if name != "panda_peg" else 1)
            warped.append(y)
            linear.append(scaled)
        gains.append(1 - spread(warped) / spread(linear))
        print(f"{name} target {target}: spread {1e3 * spread(linear):.1f} mm after linear time scaling, "
              f"{1e3 * spread(warped):.1f} mm aligned ({100 * gains[-1]:.0f} % closer)")
    if gain_wanted is not None:
        checks.below(f"{name}: closeness missing", gain_wanted - np.min(gains), 0)


checks = Checks()
made = synthetic("A", "--repetitions", 4)
check_costs(checks, thin(synthetic("A", "--target", 5), 3), "synthetic")
check_alignment(checks, made, "synthetic")
for name, path in recordings():
    table = open(path, encoding="utf-8").read()
    check_alignment(checks, table, name, 0.05 if name == "hug_reach_S01" else None)
    check_costs(checks, thin(table, 2), name)
checks.finish()
