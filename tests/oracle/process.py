"""Covariance and mean functions of the processes in a skill file."""
import numpy as np


def term(k, a, b):
    """One covariance function between the rows of a and b; `columns` of the term count from 0."""
    a, b, l = a[:, k["columns"]], b[:, k["columns"]], np.array(k["length_scales"])
    if k["type"] == "constant":
        return np.full((len(a), len(b)), k["variance"])
    if k["type"] == "linear":
        return k["variance"] * (a / l) @ (b / l).T
    r = np.sqrt((((a[:, None, :] - b[None, :, :]) / l) ** 2).sum(2))
    if k["type"] == "se-ard":
        return k["variance"] * np.exp(-0.5 * r ** 2)
    if k["type"] == "matern32":
        return k["variance"] * (1 + np.sqrt(3) * r) * np.exp(-np.sqrt(3) * r)
    assert k["type"] == "matern52", k["type"]
    return k["variance"] * (1 + np.sqrt(5) * r + 5 / 3 * r ** 2) * np.exp(-np.sqrt(5) * r)


def kernel(m, a, b):
    terms = m["kernel"]["terms"] if m["kernel"]["type"] == "sum" else [m["kernel"]]
    total = 0
    for k in terms:
        names = k.get("inputs", m["inputs"])
        part = term({**k, "columns": [m["inputs"].index(name) for name in names]}, a, b)
        if "within" in k:
            j = m["inputs"].index(k["within"])
            part = part * np.equal.outer(a[:, j], b[:, j])
        total = total + part
    return total


def mean(m, X):
    c = np.array(m["mean"]["coefficients"])
    if m["mean"]["type"] == "zero":
        return np.zeros((len(X), len(m["omega"])))
    if m["mean"]["type"] == "constant":
        return np.tile(c[0], (len(X), 1))
    return np.column_stack([np.ones(len(X)), X]) @ c
