"""ur10-fk against Denavit-Hartenberg in numpy; ur10-ik by the same: its joints give the poses again."""
import json
import os

import numpy as np

from toolchain import SHARE, Checks, groups, run, synthetic


def pose(rows, q):
    T = np.eye(4)
    for row, angle in zip(rows, q):
        a, alpha, d, theta = row["a"], row["alpha"], row["d"], angle + row.get("theta", 0)
        c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
        T = T @ np.array([[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d], [0, 0, 0, 1]])
    return T


def rotation(w, x, y, z):
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def table(columns, rows):
    return "\n".join([",".join(columns)] + [",".join(repr(float(v)) for v in row) for row in rows]) + "\n"


MEASURES = {"ur10": (.1273, -.612, -.5723, .163941, .1157, .0922), "ur10e": (.1807, -.6127, -.57155, .17415, .11985, .11655),
            "ur3": (.1519, -.24365, -.21325, .11235, .08535, .0819), "ur5": (.089159, -.425, -.39225, .10915, .09465, .0823),
            "ur3e": (.15185, -.24355, -.2132, .13105, .08535, .0921), "ur5e": (.1625, -.425, -.3922, .1333, .0997, .0996),
            "ur16e": (.1807, -.4784, -.36, .17415, .11985, .11655)}
LARGE = ("ur10", "ur10e")  # the others do not reach the holes
checks = Checks()
random = np.random.default_rng(1)
joints = ["q%d" % i for i in range(1, 7)]
for robot, (d1, a2, a3, d4, d5, d6) in MEASURES.items():
    half = np.pi / 2
    rows = [dict(a=a, alpha=alpha, d=d) for a, alpha, d in
            zip((0, a2, a3, 0, 0, 0), (half, 0, 0, half, -half, 0), (d1, 0, 0, d4, d5, d6))]
    q = random.uniform(-np.pi, np.pi, (400, 6))
    text = table(["t"] + joints, np.column_stack([np.arange(400), q]))
    tool = np.array([0.01, -0.02, 0.15])
    for options, offset in ((["--robot", robot], np.zeros(3)), (["--robot", robot, "--tool", "0.01,-0.02,0.15"], tool)):
        _, columns, values = groups(run("ur10-fk", "-q", *options, text=text))[0]
        for angles, row in zip(q, values):
            T = pose(rows, angles)
            at = dict(zip(columns, row))
            checks.below(f"{robot}: position", np.abs(T[:3, 3] + T[:3, :3] @ offset - [at["x"], at["y"], at["z"]]).max(), 1e-12)
            R = rotation(at["qw"], at["qx"], at["qy"], at["qz"])
            checks.below(f"{robot}: orientation", np.abs(R - T[:3, :3]).max(), 1e-12)

    # Every solution of a pose gives the pose again; among them the joints that it came from.
    some = q[:60]
    poses = run("ur10-fk", "-q", "--robot", robot, text=table(["t"] + joints, np.column_stack([np.arange(60), some])))
    _, columns, values = groups(run("ur10-ik", "-q", "--all", "--robot", robot, text=poses))[0]
    found = {}
    for row in values:
        at = dict(zip(columns, row))
        found.setdefault(int(at["t"]), []).append([at[name] for name in joints])
    for k, angles in enumerate(some):
        T = pose(rows, angles)
        for solution in found[k]:
            checks.below(f"{robot}: every solution's pose", np.abs(pose(rows, solution) - T).max(), 1e-9)
        away = min(np.abs(np.angle(np.exp(1j * (np.array(s) - angles)))).max() for s in found[k])
        checks.below(f"{robot}: the joints among the solutions", away, 1e-6)
        checks.below(f"{robot}: no more than 8 solutions", len(found[k]), 8)

    if robot not in LARGE:
        continue

    # Paths: the intentions of an experiment, the tool in a fixed orientation.
    paths = run("demo-synth", os.path.join(SHARE, "peg-in-hole", "A.json"), "--write", "intentions")
    quaternion = (0.7071067811865476, -0.7071067811865476, 0, 0)
    solved = groups(run("ur10-ik", "-q", "--robot", robot, "--orientation", ",".join(map(str, quaternion)), "--no-gates", "--diagnostics", text=paths))
    wanted = {labels["target"]: values for labels, _, values in groups(paths)}
    assert len(solved) == len(wanted) > 9
    for labels, columns, values in solved:
        path = wanted[labels["target"]]
        angles = values[:, [columns.index(name) for name in joints]]
        checks.below(f"{robot}: samples lost", abs(len(path) - len(values)), 0)
        for row, q_k in zip(path, angles):
            T = pose(rows, q_k)
            checks.below(f"{robot}: position along a path", np.abs(T[:3, 3] - row[1:4]).max(), 1e-9)
            checks.below(f"{robot}: orientation along a path", np.abs(T[:3, :3] - rotation(*quaternion)).max(), 1e-9)
        step = np.abs(np.diff(angles, axis=0))
        checks.below(f"{robot}: joint step along a path [rad]", step.max(), 0.1)
        checks.below(f"{robot}: joint step against its neighbours'", (np.abs(np.diff(step, axis=0)).max()), 0.02)
        checks.below(f"{robot}: branches along a path", len(set(values[:, columns.index("branch")])), 1)

# Retimed: the same joints, their speeds and accelerations, by differences over the new times, within the limits and at
# one of them nearly all the time; the columns are the derivatives.
limits, acceleration = np.radians([120, 120, 180, 180, 180, 180]), 1.4
common = ("-q", "--orientation", "0.7071067811865476,-0.7071067811865476,0,0", "--no-gates")
plain = groups(run("ur10-ik", *common, text=paths))
for (_, columns, slow), (_, _, fast) in zip(plain, groups(run("ur10-ik", *common, "--retime", "--speeds", "--accelerations", text=paths))):
    t, q, speed, bend = fast[:, 0], fast[:, 1:7], fast[:, 7:13], fast[:, 13:19]
    # Rows at rest are left out: the others are to the bit among those of the plain path, in their order.
    kept = [i for i, row in enumerate(slow[:, 1:7]) if (row == q).all(1).any()]
    checks.below("retimed: joints changed", len(q) - len(kept), 0)
    checks.below("retimed: joints out of order", np.abs(slow[kept, 1:7] - q).max() if len(kept) == len(q) else 1, 0)
    dt = np.diff(t)
    chord = np.diff(q, axis=0) / dt[:, None]
    second = 2 * np.diff(chord, axis=0) / (dt[1:] + dt[:-1])[:, None]
    checks.below("retimed: share of a speed limit", (np.abs(chord) / limits).max(), 1 + 1e-6)
    checks.below("retimed: share of an acceleration limit", np.abs(second).max() / acceleration, 1 + 1e-4)
    checks.below("retimed: speed column", np.abs(0.5 * (speed[1:] + speed[:-1]) - chord).max(), 0.02)
    used = np.maximum((np.abs(speed) / limits).max(1), np.abs(bend).max(1) / acceleration)
    checks.below("retimed: share of a limit left unused, median", 1 - np.median(used), 0.01)
    checks.below("retimed: rest at both ends", max(np.abs(speed[0]).max(), np.abs(speed[-1]).max()), 1e-3)
checks.finish()
