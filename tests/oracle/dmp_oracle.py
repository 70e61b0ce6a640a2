"""dmp-fit and skill-generate on its files: the motion against an ODE solver, ends, what was fitted."""
import json

import numpy as np
from scipy.integrate import solve_ivp

from toolchain import Checks, documents, groups, positions, recordings, run, synthetic


def solve(m, times):
    """tau z' = alpha_z (beta_z (g - y) - z) + f, tau y' = z, tau x' = -alpha_x x (paper eq. (8)-(12))."""
    start, goal, weights = (np.array(m[key]) for key in ("start", "goal", "weights"))
    centers, widths = np.array(m["centers"]), np.array(m["widths"])
    scale = goal - start if m["scaling"] == "goal" else np.ones(len(start))
    D = len(start)

    def slope(t, state):
        y, z = state[:D], state[D:]
        x = np.exp(-m["alpha_x"] * t / m["tau"])
        e = -0.5 * ((x - centers) / widths) ** 2
        psi = np.exp(e - e.max())
        f = weights @ psi / psi.sum() * x * scale
        return np.concatenate([z, m["alpha_z"] * (m["beta_z"] * (goal - y) - z) + f]) / m["tau"]

    state = np.concatenate([start, np.zeros(D)])
    solution = solve_ivp(slope, (0, times[-1]), state, method="DOP853", t_eval=times, rtol=1e-10, atol=1e-12)
    return solution.y[:D].T, solution.y[D:].T / m["tau"]


checks = Checks()
reference = run("gmr-regress", "-n", 100, text=run("gmm-fit", "-q", "-k", 4, text=run("demo-align", "-q", text=synthetic("A", "--repetitions", 4))))
tables = [("trajectory", reference, []), ("lwr, goal", reference, ["--paper", "--no-gates"]), ("ls", reference, ["--fit", "ls", "-n", 10]),
          ("other spring", reference, ["--alpha-z", 40, "--alpha-x", 3])]
for name, path in recordings():
    lines = open(path, encoding="utf-8").read().splitlines(True)
    tables.append((name, lines[0] + "".join(line for line in lines[1:] if line.split(",")[1] == "1"), []))
for name, table, options in tables:
    if not table:
        continue
    inputs = groups(table)
    for index, m in enumerate(documents(run("dmp-fit", "-q", *options, text=table))):
        recorded_t, recorded = positions(inputs[index])
        if index % 3 == 0:
            out = groups(run("skill-generate", "-q", "--dt", m["tau"] / 400, "--derivatives", text=json.dumps(m)))
            t, y = positions(out[0])
            end = np.array(m["goal"])
            inside = t <= m["tau"] * (1 + 1e-12)
            expected, speed = solve(m, t[inside])
            v = positions(out[0], ("v_x", "v_y", "v_z"))[1]
            span = max(1.0, np.abs(expected).max())
            checks.below(f"{name}: rollout within tau [m]", np.abs(y[inside] - expected).max() / span, 1e-6)
            checks.below(f"{name}: speed within tau [m/s]", np.abs(v[inside] - speed).max() / span, 1e-5)
            checks.below(f"{name}: end error [m]", np.linalg.norm(y[-1] - end), 1e-4)
            checks.below(f"{name}: speed at the end [m/s]", np.linalg.norm(v[-1]), 1e-2)
        keep = np.concatenate([[True], np.diff(recorded_t) > 0])
        times = recorded_t[keep] - recorded_t[0]
        again, _ = solve(m, times)
        rmse = np.sqrt(((again - recorded[keep]) ** 2).mean(0))
        checks.below(f"{name}: rmse of the file", np.abs(rmse - m["rmse"]).max() / max(1e-3, rmse.max()), 1e-3)

# A bump of 10 cm beside a reach, at 500 Hz, clean and with tremor of 0.5 mm: least squares on positions needs no
# derivatives, so tremor does not matter to it (0.4 mm remain because it holds the goal after tau); lwr is 1 cm off.
s = np.arange(1501) / 1500
noise = np.random.default_rng(1).normal(0, 0.0005, len(s))
reach = 0.3 * s ** 3 * (10 + s * (6 * s - 15)) + 0.1 * np.sin(np.pi * s) ** 2
for word, path in (("clean", reach), ("noisy", reach + noise)):
    table = "t,x\n" + "".join(f"{3 * a:.17g},{b:.17g}\n" for a, b in zip(s, path))
    error = {}
    for fit in ("trajectory", "ls", "lwr"):
        m, = documents(run("dmp-fit", "-q", "--fit", fit, text=table))
        again, _ = solve(m, 3 * s)
        error[fit] = np.sqrt(((again[:, 0] - reach) ** 2).mean())
    print(f"bump, {word}: " + ", ".join(f"{fit} {1e3 * e:.3f} mm" for fit, e in error.items()))
    checks.below(f"bump, {word}: trajectory [m]", error["trajectory"], 5e-4)
    checks.below(f"bump, {word}: trajectory / lwr", error["trajectory"] / error["lwr"], 0.2)
    checks.below(f"bump, {word}: ls / lwr", error["ls"] / error["lwr"], 1)
checks.finish()
