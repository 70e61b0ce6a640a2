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
    covariances = constrained(np.array(covariances), n / n.sum(), m["covariance_type"], rows.std(0))
    return {**m, "priors": n / n.sum(), "means": means, "covariances": covariances}


def log_likelihood(m, rows):
    return logsumexp(log_densities(m, rows), axis=1).sum()


def entropy(m, rows):
    logs = log_densities(m, rows)
    logs -= logsumexp(logs, axis=1, keepdims=True)
    return -(np.exp(logs) * logs).sum()


def free_parameters(K, D, kind):
    entries = {"full": K * D * (D + 1) // 2, "tied": D * (D + 1) // 2, "diagonal": K * D, "spherical": K}
    return K - 1 + K * D + entries[kind]


def constrained(covariances, priors, kind, scale):
    """Of unconstrained ones, those of the type that the M step takes; scale: of the columns."""
    if kind == "tied":
        return np.array([np.tensordot(priors, covariances, 1)] * len(priors))
    if kind == "diagonal":
        return np.array([np.diag(np.diag(S)) for S in covariances])
    if kind == "spherical":
        return np.array([np.diag(np.mean(np.diag(S) / scale ** 2) * scale ** 2) for S in covariances])
    return covariances


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
        kind = m["covariance_type"]
        q = free_parameters(K, columns, kind)
        L = log_likelihood(m, rows)
        E = entropy(m, rows)
        f = m["bic_n"] / len(rows) if m["bic_likelihood"] == "effective" else 1
        checks.below(f"{name}: parameters", abs(m["parameters"] - q), 0)
        checks.below(f"{name}: entropy", abs(m["entropy"] - E) / max(E, 1), 1e-6)
        scales = np.outer(rows.std(0), rows.std(0))
        off = np.array(m["covariances"]) - constrained(np.array(m["covariances"]), np.array(m["priors"]), kind, rows.std(0))
        checks.below(f"{name}: covariances of the type", np.abs(off / scales).max(), 1e-12)
        checks.below(f"{name}: log likelihood", abs(m["log_likelihood"] - L) / abs(L), 1e-8)
        bic = -2 * f * L + q * np.log(m["bic_n"])
        checks.below(f"{name}: BIC", abs(m["bic"] - bic) / abs(bic), 1e-8)
        checks.below(f"{name}: AIC", abs(m["aic"] - (2 * q - 2 * f * L)) / abs(2 * q - 2 * f * L), 1e-8)
        checks.below(f"{name}: ICL", abs(m["icl"] - bic - 2 * f * E) / abs(bic), 1e-8)
        checks.below(f"{name}: samples", abs(m["samples"] - len(rows)), 0)
        by = m["criterion"]
        checks.below(f"{name}: choice by {by}", m[by] - min(s[by] for s in m["selection"]), 0)
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
for kind in ("tied", "diagonal", "spherical"):
    check(checks, f"synthetic, {kind}", synthetic("A", "--repetitions", 3, "--target", 4), "-k", "1:9", "--covariance-type", kind)
check(checks, "synthetic, effective", synthetic("A", "--repetitions", 3, "--target", 7), "-k", "1:9", "--bic-n", 60,
      "--bic-likelihood", "effective", "--select", "icl")
check(checks, "synthetic, AIC", synthetic("A", "--repetitions", 3, "--target", 7), "-k", "1:5", "--select", "aic")
for name, path in recordings():
    check(checks, name, open(path, encoding="utf-8").read(), "-k", "2:7", "--restarts", 2)
checks.finish()
