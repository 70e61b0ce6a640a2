"""skill-generate: covariance, conditioning and moving goals, recomputed from the skill file alone."""
import json
import os
import tempfile

import numpy as np
from scipy.integrate import solve_ivp
from scipy.stats import t as student

from process import kernel, mean
from toolchain import Checks, documents, groups, positions, run, synthetic

AXES = ("x", "y", "z")


def row(skill, m, goal):
    """Mean weights, their latent and noise covariances, and degrees of freedom."""
    change = np.array(goal) - skill["start"]
    x = np.array([[change[skill["columns"].index(name)] for name in m["inputs"]]])
    X, Y = np.array(m["X"]), np.array(m["Y"])
    K = kernel(m, X, X) + np.diag(m.get("noise", np.full(len(X), m["noise_variance"])))
    k = kernel(m, x, X)
    latent = kernel(m, x, x)[0, 0] - (k @ np.linalg.solve(K, k.T))[0, 0]
    back = np.eye(Y.shape[1]) if m["output_transform"] is None else np.linalg.inv(m["output_transform"])
    omega = back.T @ m["omega"] @ back
    return (mean(m, x) + k @ np.linalg.solve(K, Y - mean(m, X)))[0] @ back, latent * omega, m["noise_variance"] * omega, m["nu"] + len(X) - Y.shape[1] + 1


def activations(d, x):
    e = -0.5 * ((x - np.array(d["centers"])) / d["widths"]) ** 2
    psi = np.exp(e - e.max())
    return psi / psi.sum() * x


def integrate(d, tau, times, start, force, speed=None, breaks=()):
    """y and y' of tau^2 y'' = alpha_z (-beta_z y - tau y') + force(t), started at every break anew."""
    size = len(start)
    speed = np.zeros(size) if speed is None else np.array(speed)
    state = np.concatenate([start, tau * speed])

    def slope(t, s):
        return np.concatenate([s[size:], d["alpha_z"] * (-d["beta_z"] * s[:size] - s[size:]) + force(t)]) / tau

    edges = [0.0] + [b for b in sorted(breaks) if 0 < b < times[-1]] + [times[-1]]
    found = np.empty((len(times), 2 * size))
    for low, high in zip(edges, edges[1:]):
        mine = (times >= low) & (times <= high)
        at = np.unique(np.concatenate([times[mine], [high]]))
        solution = solve_ivp(slope, (low, high), state, method="DOP853", t_eval=at, rtol=1e-11, atol=1e-13)
        assert solution.success
        found[mine] = solution.y.T[np.searchsorted(at, times[mine])]
        state = solution.y[:, -1]
    return found[:, :size], found[:, size:] / tau


def response(d, tau, times):
    """R and R' by the ODE."""
    N = len(d["centers"])
    return integrate(d, tau, times, np.zeros(N), lambda t: activations(d, np.exp(-d["alpha_x"] * t / tau)))


def scales(skill, m, goal):
    """s of the forcing term for the outputs of a model."""
    on = [skill["columns"].index(name) for name in m["outputs"]]
    change = (np.array(goal) - skill["start"])[on]
    return np.diag(change if skill["dmp"]["scaling"] == "goal" else np.ones(len(on)))


def text_of(numbers):
    return ",".join(repr(float(v)) for v in numbers)


def generated(skill, *options):
    return groups(run("skill-generate", "-q", *options, text=json.dumps(skill)))


def spread(checks, name, skill, goal):
    """--covariance and --sd against the weights' posterior, conditioned on the end."""
    tau = 2.5
    joint = len(skill["models"]) == 1
    skill = {key: value for key, value in skill.items() if key != "calibration"}  # the band of the process itself
    for kind in ("latent", "predictive"):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "covariance.json")
            out = generated(skill, "--goal", text_of(goal), "--duration", tau, "--dt", tau / 40, "--covariance", path,
                            f"--sd={kind}", "--band", "pointwise")[0]
            [document] = documents(open(path, encoding="utf-8").read())
        times = np.array(document["t"])
        _, y = positions(out)
        sd = positions(out, [f"sd_{a}" for a in AXES])[1]
        half = positions(out, [f"band_{a}" for a in AXES])[1]
        checks.below(f"{name}: the file's mean is the motion [m]", np.abs(document["mean"] - y).max(), 1e-15)
        T = len(times)
        R, _ = response(skill["dmp"], tau, np.union1d(times, [tau]))
        at = np.searchsorted(np.union1d(times, [tau]), times)
        end = R[np.searchsorted(np.union1d(times, [tau]), tau)]
        R = R[at]
        covariance = np.array(document["covariance"])
        for i, m in enumerate(skill["models"]):
            _, latent, noise, nu = row(skill, m, goal)
            D = len(m["outputs"])
            s = scales(skill, m, goal)
            H = np.kron(s, end)
            C = latent + noise if kind == "predictive" else latent
            c = (nu - 2) / (nu + D - 2)
            CH = C @ H.T
            C = c * (C - CH @ np.linalg.solve(H @ CH, CH.T))
            big = np.kron(s, R)
            expected = big @ C @ big.T
            found = covariance if joint else covariance[i]
            checks.below(f"{name}: covariance, share of the largest", np.abs(found - expected).max() / expected.max(), 1e-6)
            mine = sd.T.reshape(-1) if joint else sd[:, i]
            checks.below(f"{name}: sd is the diagonal's root [m]", np.abs(mine - np.sqrt(np.diag(found).clip(0))).max(), 1e-12)
            checks.below(f"{name}: degrees of freedom", np.abs(document["degrees_of_freedom"][i] - nu - D), 1e-9)
            if kind == "latent":
                factor = student.ppf(0.975, nu + D) * np.sqrt((nu + D - 2) / (nu + D))
                mine = half.T.reshape(-1) if joint else half[:, i]
                checks.below(f"{name}: band [m]", np.abs(mine - factor * np.sqrt(np.diag(found).clip(0))).max(), 1e-10)
        checks.below(f"{name}: spread on the goal [m]", sd[np.argmin(abs(times - tau))].max(), 1e-9)


def passing(checks, name, skill, goal, via):
    """--via against Gaussian conditioning of the weights."""
    tau = 2.5
    d = skill["dmp"]
    options = ("--goal", text_of(goal), "--duration", tau, "--dt", tau / 50)
    _, before = positions(generated(skill, *options)[0])
    for sd in (0, 0.004):
        point = [1.1, *via] + ([sd] if sd else [])
        out = generated(skill, *options, "--via", text_of(point))[0]
        times, y = positions(out)
        checks.below(f"{name}: via and end [m]", 0 if sd else np.abs(y[22] - via).max(), 1e-9)
        checks.below(f"{name}: end with a via [m]", np.abs(y[50] - goal).max(), 1e-9)
        R, _ = response(d, tau, times)
        for m in skill["models"]:
            _, C, _, _ = row(skill, m, goal)
            on = [skill["columns"].index(name) for name in m["outputs"]]
            s = scales(skill, m, goal)
            H = np.kron(s, R[[22, 50]])
            e = np.concatenate([[via[j] - before[22, j], goal[j] - before[50, j]] for j in on])
            S = np.diag([sd ** 2, 0] * len(on))
            w = C @ H.T @ np.linalg.solve(H @ C @ H.T + S, e)
            change = (s @ w.reshape(len(on), -1) @ R[:51].T).T
            off = np.abs(y[:51, on] - before[:51, on] - change).max() / np.abs(e).max()
            checks.below(f"{name}: change by a via, share", off, 1e-5)


def moving(checks, name, skill, goal, changes, speed):
    """--goal-at against the ODE with the goal and the weights blended."""
    tau, d = 2.0, skill["dmp"]
    goals = [np.array(goal)] + [np.array(c[1:]) for c in changes]
    weights = []
    for g in goals:
        W = np.zeros((3, len(d["centers"])))
        for m in skill["models"]:
            w = row(skill, m, g)[0].reshape(len(m["outputs"]), -1)
            for i, signal in enumerate(m["outputs"]):
                j = skill["columns"].index(signal)
                W[j] = w[i] * (g[j] - skill["start"][j] if d["scaling"] == "goal" else 1)
        weights.append(W)

    def blend(t, begin):
        r = min(1.0, max(0.0, (t - begin) / (0.2 * tau)))
        return r ** 3 * (10 - 15 * r + 6 * r * r)

    def force(t):
        g, W = goals[0].copy(), weights[0].copy()
        for k, change in enumerate(changes):
            g += blend(t, change[0]) * (goals[k + 1] - goals[k])
            W += blend(t, change[0]) * (weights[k + 1] - weights[k])
        return d["alpha_z"] * d["beta_z"] * g + W @ activations(d, np.exp(-d["alpha_x"] * t / tau))

    options = ["--goal", text_of(goal), "--duration", tau, "--dt", tau / 100, "--derivatives", "--no-gates"]
    for change in changes:
        options += ["--goal-at", text_of(change)]
    if speed is not None:
        options += ["--start-velocity", text_of(speed)]
    out = generated(skill, *options)[0]
    times, y = positions(out)
    _, v = positions(out, [f"v_{a}" for a in AXES])
    breaks = [c[0] for c in changes] + [c[0] + 0.2 * tau for c in changes]
    expected, rate = integrate(d, tau, times, np.array(skill["start"]), force, speed, breaks)
    checks.below(f"{name}: moving goal, position [m]", np.abs(y - expected).max(), 1e-6)
    checks.below(f"{name}: moving goal, velocity [m/s]", np.abs(v - rate).max(), 1e-5)
    checks.below(f"{name}: rests on the last goal [m]", np.linalg.norm(y[-1] - goals[-1]), 1e-4)
    checks.below(f"{name}: speed there [m/s]", np.linalg.norm(v[-1]), 2e-3)


checks = Checks()
rows = run("demo-align", "-q", text=synthetic("A", "--repetitions", 3))
goal, via = [0.05, 0.8, 0.3], [-0.12, 0.52, 0.55]
for name, fit, train in (("full", [], ["--model", "full"]), ("joint", [], ["--model", "joint"]),
                         ("scaled", ["--scaling", "goal", "--no-gates"], ["--model", "axis"])):
    [skill] = documents(run("mvgpr-train", "-q", *train, text=run("dmp-fit", "-q", "-n", 10, *fit, text=rows)))
    spread(checks, name, skill, goal)
    passing(checks, name, skill, goal, via)
    moving(checks, name, skill, goal, [[0.6, 0.0, 0.81, 0.25]], None)
    moving(checks, name, skill, goal, [[0.3, 0.0, 0.81, 0.25], [0.5, 0.02, 0.8, 0.32], [2.3, 0.03, 0.79, 0.3]], None)
    moving(checks, name, skill, goal, [[0.6, 0.0, 0.81, 0.25]], [0.1, -0.05, 0.1])
checks.finish()
