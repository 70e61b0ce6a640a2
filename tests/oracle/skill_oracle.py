"""mvgpr-train and skill-generate --weights: prediction, spread and evidence recomputed from the file's own fields."""
import csv
import io
import json
import os

import numpy as np
from scipy.special import multigammaln

from process import kernel, mean
from toolchain import SHARE, Checks, groups, recordings, run, synthetic


def predict(m, x):
    """Weights in the space of the DMP, and their latent standard deviations."""
    X, Y, omega = np.array(m["X"]), np.array(m["Y"]), np.array(m["omega"])
    x = np.array([[x[name] for name in m["inputs"]]])
    K = kernel(m, X, X) + np.diag(m["noise_variance"] + np.array(m.get("noise", np.zeros(len(X)))))
    k = kernel(m, x, X)
    row = mean(m, x) + k @ np.linalg.solve(K, Y - mean(m, X))
    latent = kernel(m, x, x)[0, 0] - (k @ np.linalg.solve(K, k.T))[0, 0]
    A = np.eye(len(omega)) if m["output_transform"] is None else np.array(m["output_transform"])
    back = np.linalg.inv(A)
    return (row @ back)[0], np.sqrt(latent * np.diag(back.T @ omega @ back))


def evidence(m, K):
    """log p(Y | X), Omega ~ inverse-Wishart(Psi, nu) integrated out, with d x d determinants."""
    R = np.array(m["Y"]) - mean(m, np.array(m["X"]))
    n, d = R.shape
    nu = m["nu"]
    Psi = np.array(m["psi"]) if isinstance(m["psi"], list) else m["psi"] * np.eye(d)
    S = R.T @ np.linalg.solve(K, R)
    log_det = lambda M: np.linalg.slogdet(M)[1]
    return -(n * d / 2 * np.log(np.pi) + d / 2 * log_det(K) + (n + nu) / 2 * log_det(Psi + S) - nu / 2 * log_det(Psi)
             - multigammaln((n + nu) / 2, d) + multigammaln(nu / 2, d))


def weights_table(skill, goal):
    text = run("skill-generate", "-q", "--weights", "--no-gates", "--goal", ",".join(map(repr, goal)), text=json.dumps(skill))
    found = {}
    for row in csv.DictReader(io.StringIO(text)):
        found.setdefault(row["signal"], []).append((float(row["mean"]), float(row["sd"])))
    return {signal: np.array(rows) for signal, rows in found.items()}


def check(checks, name, skill, goals, paper):
    columns = skill["columns"]
    for goal in goals:
        change = {c: g - s for c, g, s in zip(columns, goal, skill["start"])}
        change.update({"start_" + c: 0.0 for c in columns})  # the goal has no start of its own, so it starts as usual
        got = weights_table(skill, goal)
        largest = max(np.abs(rows[:, 0]).max() for rows in got.values())
        widest = max(rows[:, 1].max() for rows in got.values())
        for m in skill["models"]:
            w, sd = predict(m, change)
            N = len(w) // len(m["outputs"])
            for i, signal in enumerate(m["outputs"]):
                part = slice(i * N, (i + 1) * N)
                checks.below(f"{name}: weights", np.abs(got[signal][:, 0] - w[part]).max() / largest, 1e-8)
                checks.below(f"{name}: their sd", np.abs(got[signal][:, 1] - sd[part]).max() / widest, 1e-6)
    random = np.random.default_rng(1)
    for m in skill["models"]:
        X, Y = np.array(m["X"]), np.array(m["Y"])
        n, d = Y.shape
        noise = np.array(m.get("noise", np.zeros(n)))
        K = kernel(m, X, X) + np.diag(m["noise_variance"] + noise)
        E = evidence(m, K)
        checks.below(f"{name}: evidence", abs(m["log_marginal_likelihood"] - E) / max(1, abs(E)), 1e-8)
        R = Y - mean(m, X)
        Psi = np.array(m["psi"]) if isinstance(m["psi"], list) else m["psi"] * np.eye(d)
        expected = (Psi + R.T @ np.linalg.solve(K, R)) / (n + m["nu"] - d - 1)
        checks.below(f"{name}: omega", np.abs(m["omega"] - expected).max() / np.abs(expected).max(), 1e-8)
        if not paper:
            continue
        assert m["kernel"]["type"] == "se-ard" and m["kernel"]["variance"] == 1 and m["output_transform"] is None
        span = max(0.1, np.ptp(X, axis=0).max())
        best = -np.inf
        for draw in range(200):
            # Half anywhere, half near the file's own, where a maximum not quite reached would show.
            if draw % 2:
                l = np.array(m["kernel"]["length_scales"]) * np.exp(random.normal(0, 0.2, X.shape[1]))
                noise_variance = m["noise_variance"] * np.exp(random.normal(0, 0.2))
            else:
                l = span * 10 ** random.uniform(-1.5, 1.5, X.shape[1])
                noise_variance = 10 ** random.uniform(-6, 0.5)
            other = {**m, "kernel": {**m["kernel"], "length_scales": list(l)}}
            best = max(best, evidence(m, kernel(other, X, X) + np.diag(noise_variance + noise)))
        checks.below(f"{name}: random hyperparameters beat it by [nats]", best - E, 0.05)


def train(table, fit, *options):
    return json.loads(run("mvgpr-train", "-q", *options, text=run("dmp-fit", "-q", *fit, text=table)))


checks = Checks()
demos = synthetic("A", "--repetitions", 3)
aligned = run("demo-align", "-q", text=demos)
reference = run("gmr-regress", "-n", 80, text=run("gmm-fit", "-q", "-k", 4, "--restarts", 2, text=aligned))
goals = [[-0.025, 0.80, 0.345], [0.125, 0.80, 0.215], [0.05, 0.80, 0.28], [0.2, 0.8, 0.42]]
check(checks, "paper", train(reference, ["--fit", "lwr"], "--paper"), goals, True)
check(checks, "paper, full", train(reference, ["--fit", "lwr"], "--paper", "--model", "full"), goals, True)
check(checks, "paper, joint", train(reference, ["--fit", "lwr", "-n", 8], "--paper", "--model", "joint"), goals, True)
check(checks, "default", train(reference, []), goals, False)
check(checks, "student-t", train(reference, [], "--process", "student-t"), goals, False)
check(checks, "default, demonstrations", train(aligned, []), goals, False)
# Holes off the plane, as an explicit linear mean needs rows that span every direction.
experiment = json.load(open(os.path.join(SHARE, "peg-in-hole", "A.json")))
for i, hole in enumerate(experiment["holes"]):
    hole["position"][1] += 0.03 * (i * i % 5)
tilted = run("demo-align", "-q", text=run("demo-synth", "--repetitions", 2, text=json.dumps(experiment)))
for options in (["--kernel", "matern32", "--mean", "linear"], ["--kernel", "matern52", "--mean", "constant", "--model", "joint"]):
    check(checks, " ".join(options), train(tilted, ["-n", 8], *options, "--starts", 2), goals, False)
for name, path in recordings():
    text = run("demo-align", "-q", text=open(path, encoding="utf-8").read())
    ends = {}
    for labels, columns, values in groups(text):
        ends.setdefault(labels["target"], []).append(values[-1, [columns.index(c) for c in "xyz"]])
    middle = [list(map(float, np.mean(ends[target], 0))) for target in list(ends)[:3]]
    text = run("gmr-regress", "-n", 80, text=run("gmm-fit", "-q", "-k", 5, "--restarts", 1, text=text))
    check(checks, name + ", paper", train(text, ["--paper", "--no-gates"], "--paper"), middle, True)
    check(checks, name + ", default", train(text, []), middle, False)
checks.finish()
