"""Runs the programs and reads what they write. Every oracle is called: X_oracle.py PROGRAMS DATA SHARE."""
import csv
import io
import json
import os
import subprocess
import sys

import numpy as np

PROGRAMS, DATA, SHARE = sys.argv[1:4]
LABELS = ("target", "teacher", "demo", "sample", "signal", "method")


def run(program, *arguments, text=None):
    """Standard output of a program; a failure ends the test with its message."""
    done = subprocess.run([os.path.join(PROGRAMS, program), *map(str, arguments)], input=text, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if done.returncode != 0:
        sys.exit(f"{program} {' '.join(map(str, arguments))}: exit status {done.returncode}: {done.stderr}")
    return done.stdout


def documents(text):
    return [json.loads(line) for line in text.splitlines()]


def groups(text):
    """A list of (labels, columns, rows) for each run of rows with the same labels."""
    rows = list(csv.reader(io.StringIO(text)))
    header = rows[0]
    named = [i for i, name in enumerate(header) if name in LABELS[:4]]
    numeric = [i for i, name in enumerate(header) if name not in LABELS]
    columns = [header[i] for i in numeric]
    found = []
    for row in rows[1:]:
        labels = {header[i]: row[i] for i in named}
        if not found or found[-1][0] != labels:
            found.append((labels, columns, []))
        found[-1][2].append([float(row[i]) for i in numeric])
    return [(labels, columns, np.array(values)) for labels, columns, values in found]


def positions(group, names=("x", "y", "z")):
    """Times and the named columns of a group."""
    _, columns, values = group
    return values[:, columns.index("t")], values[:, [columns.index(name) for name in names]]


def recordings():
    """Names and tables of the recordings that are there."""
    for name in ("hug_reach_S01", "panda_peg"):
        path = os.path.join(DATA, name, "demos.csv")
        if os.path.exists(path):
            yield name, path
        else:
            print(f"{name}: not there, left out")


def synthetic(experiment="A", *options):
    return run("demo-synth", os.path.join(SHARE, "peg-in-hole", experiment + ".json"), *options)


class Checks:
    """Counts comparisons; the worst of each is printed, the test fails if one is over its bound."""

    def __init__(self):
        self.worst = {}

    def below(self, name, value, bound):
        value = float(value)
        old = self.worst.get(name)
        if old is None or not value <= old[0]:
            self.worst[name] = (value, bound, (old[2] if old else 0) + 1)
        else:
            self.worst[name] = (old[0], bound, old[2] + 1)

    def finish(self):
        failed = not self.worst
        for name, (value, bound, count) in self.worst.items():
            good = value <= bound
            failed |= not good
            print(f"{'ok  ' if good else 'FAIL'} {name}: worst {value:.3g}, bound {bound:.3g} ({count} comparisons)")
        sys.exit(1 if failed else 0)
