"""gmr-regress: mean and covariance by the definition (paper eq. (4)-(7)), derivative by differences."""
import numpy as np

from toolchain import Checks, documents, groups, run, synthetic


def regression(m, t):
    """Mean and covariance of the signals given the time, one Gaussian by moment matching."""
    priors, means, covariances = (np.array(m[key]) for key in ("priors", "means", "covariances"))
    var = covariances[:, 0, 0]
    logs = np.log(priors) - 0.5 * np.log(2 * np.pi * var) - 0.5 * (t - means[:, 0]) ** 2 / var
    h = np.exp(logs - logs.max())
    h /= h.sum()
    xi = means[:, 1:] + (covariances[:, 1:, 0] / var[:, None]) * (t - means[:, 0])[:, None]
    mean = h @ xi
    covariance = -np.outer(mean, mean)
    for k in range(len(h)):
        conditional = covariances[k, 1:, 1:] - np.outer(covariances[k, 1:, 0], covariances[k, 0, 1:]) / var[k]
        covariance = covariance + h[k] * (conditional + np.outer(xi[k], xi[k]))
    return mean, covariance


checks = Checks()
aligned = run("demo-align", "-q", text=synthetic("B", "--repetitions", 5))
text = run("gmm-fit", "-q", "-k", "4:6", "--restarts", 2, text=aligned)
models = documents(text)
written = groups(run("gmr-regress", "-n", 101, "--sd", "--covariance", "--derivatives", text=text))
assert len(models) == len(written) > 3
signals = ["x", "y", "z"]
for m, (labels, columns, values) in zip(models, written):
    at = {name: i for i, name in enumerate(columns)}
    assert labels == {"target": str(m["target"])} and len(values) == 101
    checks.below("time range", max(abs(values[0, 0] - m["time_range"][0]), abs(values[-1, 0] - m["time_range"][1])), 1e-12)
    for row in values:
        mean, covariance = regression(m, row[at["t"]])
        checks.below("mean", np.abs(row[[at[s] for s in signals]] - mean).max(), 1e-10)
        upper = [row[at[f"cov_{signals[a]}_{signals[b]}"]] for a in range(3) for b in range(a, 3)]
        checks.below("covariance", np.abs(upper - covariance[np.triu_indices(3)]).max(), 1e-10)
        checks.below("sd", np.abs(row[[at["sd_" + s] for s in signals]] - np.sqrt(np.diag(covariance))).max(), 1e-9)
        step = 1e-4
        f = {k: regression(m, row[at["t"]] + k * step)[0] for k in (-2, -1, 1, 2)}
        difference = (f[-2] - 8 * f[-1] + 8 * f[1] - f[2]) / (12 * step)
        checks.below("derivative", np.abs(row[[at["d_" + s] for s in signals]] - difference).max(), 1e-7)
        for ends in ("start", "goal"):
            checks.below(ends, np.abs(row[[at[f"{ends}_{s}"] for s in signals]] - m[ends]).max(), 0)
checks.finish()
