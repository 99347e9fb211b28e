#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which tests see which planted bug. Builds a copy of the tree with one bug at a time and runs the
tests whose programs the bug changes; all others give what they gave before. Appends a line to the
table for each test that fails, and one without a test for a bug that none sees. Bugs that are in
the table already are passed over, so an interrupted run goes on where it was.

usage: planted_matrix.py COPY TABLE [BUG...]      COPY: a folder, kept for the next run
"""
import csv
import hashlib
import json
import os
import pathlib
import subprocess
import sys

SOURCE = pathlib.Path(__file__).resolve().parent.parent
LIMIT = 300  # seconds of a test
# Prints every row of the table of bugs, its texts ended by a zero byte each.
PRINTER = """#include <stdio.h>
#include "tests/planted_bugs.h"
int main(void)
{
    for (const struct planted_bug *b = planted_bugs; b < planted_bugs + PLANTED_BUGS; b++)
        printf("%s%c%s%c%s%c%s%c%s%c", b->name, 0, b->kind, 0, b->file, 0, b->text, 0, b->instead, 0);
}
"""


def output_of(*words, **more):
    return subprocess.run(words, capture_output=True, text=True, check=True, **more).stdout


def planted_bugs(folder):
    subprocess.run(["cc", "-I", SOURCE, "-x", "c", "-", "-o", folder / "bugs"], input=PRINTER, text=True,
                   check=True)
    texts = output_of(folder / "bugs").split("\0")
    return [texts[i:i + 5] for i in range(0, len(texts) - 1, 5)]


def fingerprint(build, test):
    """Of what a test runs: itself, and the programs that its words and environment name."""
    words = test["cmd"] + list(test["env"].values())
    names = sorted({w for w in words if w.startswith(str(build)) and os.path.isfile(w)})
    return [hashlib.sha256(pathlib.Path(name).read_bytes()).digest() for name in names]


def passes(test):
    """What the test has started ends with it."""
    words = ["timeout", "-s", "KILL", str(LIMIT), *test["cmd"]]
    return subprocess.run(words, env={**os.environ, **test["env"]}, cwd=test["workdir"],
                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode in (0, 77)


def seen_by(file, text, instead, tree, build, sound):
    """Plants, builds, runs; the tests that fail, or why there are none."""
    source = (tree / file).read_text()
    if source.count(text) != 1:
        return [["", "its text does not stand there once"]]
    (tree / file).write_text(source.replace(text, instead))
    try:
        if subprocess.run(["ninja", "-C", build], stdout=subprocess.DEVNULL).returncode:
            return [["", "does not build"]]
        changed = (t for t, was in sound if fingerprint(build, t) != was)
        return [[t["name"], "failed"] for t in changed if not passes(t)] or [["", "seen by none"]]
    finally:
        (tree / file).write_text(source)


def main(copy, table, *wanted):
    tree, build = copy / "tree", copy / "build"
    tree.mkdir(parents=True, exist_ok=True)
    output_of("sh", "-c", 'git ls-files -z | xargs -0 cp -u --preserve=timestamps --parents -t "$0"', tree,
              cwd=SOURCE)
    if not (build / "build.ninja").exists():
        output_of("meson", "setup", build, tree)
    output_of("ninja", "-C", build)
    tests = json.loads(output_of("meson", "introspect", "--tests", build))
    sound = [(t, fingerprint(build, t)) for t in tests if not t["name"].startswith("planted") and passes(t)]
    done = {row[0] for row in csv.reader(table.open())} if table.exists() else set()
    with table.open("a", newline="") as file:
        for name, kind, *bug in planted_bugs(copy):
            if name not in done and (not wanted or name in wanted):
                for line in seen_by(*bug, tree, build, sound):
                    csv.writer(file, lineterminator="\n").writerow([name, kind, bug[0], *line])
                file.flush()


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]), *sys.argv[3:])
