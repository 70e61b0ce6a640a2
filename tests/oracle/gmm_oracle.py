"""gmm-fit: the figures of the file from its own mixture, and whether EM has converged."""
import numpy as np
from scipy.special import logsumexp

from toolchain import Checks, documents, groups, positions, recordings, run, synthetic


def log_densities(m, rows):
    """Of every row under every component, priors included."""
    columns = []
    for prior, mean, covariance in zip(m["priors"], m["means"], m["covariances"]):
        L = np.linalg.cholesky(np.array(covariance))
        z = np.linalg.solve(L, (rows - mean).T)
        columns.append(np.log(prior) - 0.5 * (z ** 2).sum(0) - np.log(np.diag(L)).sum() - 0.5 * rows.shape[1] * np.log(2 * np.pi))
    return np.array(columns).T


def em_step(m, rows):
    logs = log_densities(m, rows)
    h = np.exp(logs - logsumexp(logs, axis=1, keepdims=True))
    n = h.sum(0)
    means = (h.T @ rows) / n[:, None]
    covariances = []
    for k in range(len(n)):
        off = rows - means[k]
        covariances.append((h[:, k, None] * off).T @ off / n[k] + np.diag(m["regularization"]))
    return {**m, "priors": n / n.sum(), "means": means, "covariances": np.array(covariances)}


def log_likelihood(m, rows):
    return logsumexp(log_densities(m, rows), axis=1).sum()


def check(checks, name, table, *options):
    pools = {}
    aligned = run("demo-align", "-q", text=table)
    for group in groups(aligned):
        t, y = positions(group)
        pools.setdefault(group[0]["target"], []).append(np.column_stack([t, y]))
    files = documents(run("gmm-fit", "-q", *options, text=aligned))
    assert len(files) == len(pools)
    for m in files:
        demos = pools[str(m["target"])]
        rows = np.concatenate(demos)
        K, columns = len(m["priors"]), rows.shape[1]
        q = (K - 1) + K * columns + K * columns * (columns + 1) // 2
        L = log_likelihood(m, rows)
        checks.below(f"{name}: log likelihood", abs(m["log_likelihood"] - L) / abs(L), 1e-8)
        bic = -2 * L + q * np.log(m["bic_n"])
        checks.below(f"{name}: BIC", abs(m["bic"] - bic) / abs(bic), 1e-8)
        checks.below(f"{name}: AIC", abs(m["aic"] - (2 * q - 2 * L)) / abs(2 * q - 2 * L), 1e-8)
        checks.below(f"{name}: samples", abs(m["samples"] - len(rows)), 0)
        checks.below(f"{name}: choice by BIC", m["bic"] - min(s["bic"] for s in m["selection"]), 0)
        checks.below(f"{name}: priors", abs(sum(m["priors"]) - 1), 1e-9)
        checks.below(f"{name}: start", np.abs(m["start"] - np.mean([d[0, 1:] for d in demos], 0)).max(), 1e-12)
        checks.below(f"{name}: goal", np.abs(m["goal"] - np.mean([d[-1, 1:] for d in demos], 0)).max(), 1e-12)
        checks.below(f"{name}: regularization", np.abs(np.array(m["regularization"]) / (1e-6 * rows.var(0)) - 1).max(), 1e-9)
        further = m
        for _ in range(60):
            further = em_step(further, rows)
        checks.below(f"{name}: gain of 60 more steps of EM [nats a sample]", (log_likelihood(further, rows) - L) / len(rows), 0.02)


checks = Checks()
check(checks, "synthetic", synthetic("A", "--repetitions", 5), "-k", 4)
check(checks, "synthetic, --bic-n", synthetic("B", "--repetitions", 3, "--target", 2), "-k", "1:8", "--bic-n", 200)
for name, path in recordings():
    check(checks, name, open(path, encoding="utf-8").read(), "-k", "2:7", "--restarts", 2)
checks.finish()
