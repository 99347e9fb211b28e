#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which tests see which planted bug. Builds a copy of the tree with one bug at a time and runs the
tests whose programs the bug changes; all others give what they gave before. Appends a line to the
table for each test that fails, and one without a test for a bug that none sees. Bugs that are in
the table already are passed over, so an interrupted run goes on where it was.

usage: planted_matrix.py COPY TABLE [--bugs NAME,...] [--tests NAME,...] [--limit SECONDS]
"""
import argparse
import csv
import hashlib
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

SOURCE = pathlib.Path(__file__).resolve().parent.parent
HEADING = ["bug", "kind", "file", "test", "outcome", "seconds"]
# Prints every row of the table of bugs, its texts ended by a zero byte each.
PRINTER = """#include <stdio.h>
#include "tests/planted_bugs.h"
int main(void)
{
    for (size_t i = 0; i < PLANTED_BUGS; i++) {
        const struct planted_bug *b = &planted_bugs[i];
        printf("%s%c%s%c%s%c%s%c%s%c", b->name, 0, b->kind, 0, b->file, 0, b->text, 0, b->instead, 0);
    }
}
"""


def planted_bugs(folder):
    program = folder / "print_bugs"
    subprocess.run(["cc", "-I", SOURCE, "-x", "c", "-", "-o", program], input=PRINTER, text=True,
                   check=True)
    texts = subprocess.run([program], capture_output=True, text=True, check=True).stdout.split("\0")
    keys = ["name", "kind", "file", "text", "instead"]
    return [dict(zip(keys, texts[i:i + 5])) for i in range(0, len(texts) - 1, 5)]


def copy_tree(tree):
    """The files that git knows, as they are."""
    listed = subprocess.run(["git", "-C", SOURCE, "ls-files", "-z"], capture_output=True, text=True,
                            check=True).stdout
    for name in filter(None, listed.split("\0")):
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        if not (tree / name).exists() or (tree / name).read_bytes() != (SOURCE / name).read_bytes():
            shutil.copy(SOURCE / name, tree / name)


def ninja(build):
    return subprocess.run(["ninja", "-C", build, "-j", "2"], capture_output=True, text=True)


def known_tests(build, wanted):
    out = subprocess.run(["meson", "introspect", "--tests", build], capture_output=True, text=True,
                         check=True).stdout
    return [t for t in json.loads(out) if not t["name"].startswith("planted")
            and (not wanted or t["name"] in wanted)]


def programs(build, test):
    """What a test runs: itself, and the programs that its words and environment name."""
    words = test["cmd"] + list(test["env"].values())
    return sorted({w for w in words if w.startswith(str(build)) and os.path.isfile(w)})


def fingerprint(build, test):
    digest = hashlib.sha256()
    for name in programs(build, test):
        digest.update(pathlib.Path(name).read_bytes())
    return digest.hexdigest()


def outcome(test, limit):
    """passed, failed or timeout; what the test has started ends with it."""
    process = subprocess.Popen(test["cmd"], env={**os.environ, **test["env"]}, cwd=test["workdir"],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               start_new_session=True)
    try:
        return "passed" if process.wait(limit) in (0, 77) else "failed"
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        return "timeout"


def sound_tests(build, tests, limit):
    """Those that pass without a bug, with the fingerprints of their programs."""
    sound = {}
    for test in tests:
        if (found := outcome(test, limit)) == "passed":
            sound[test["name"]] = fingerprint(build, test)
        else:
            print(f"{test['name']}: {found} without a bug, left out", file=sys.stderr)
    return [t for t in tests if t["name"] in sound], sound


def lines_of(bug, tree, build, tests, sound, limit):
    """Plants, builds, runs; the lines of the table."""
    begin = [bug["name"], bug["kind"], bug["file"]]
    path = tree / bug["file"]
    source = path.read_text()
    if source.count(bug["text"]) != 1:
        return [begin + ["", "its text does not stand there once", 0]]
    path.write_text(source.replace(bug["text"], bug["instead"]))
    try:
        if ninja(build).returncode:
            return [begin + ["", "does not build", 0]]
        lines = []
        for test in tests:
            if fingerprint(build, test) == sound[test["name"]]:
                continue
            start = time.monotonic()
            found = outcome(test, limit)
            if found != "passed":
                lines.append(begin + [test["name"], found, f"{time.monotonic() - start:.1f}"])
        return lines or [begin + ["", "seen by none", 0]]
    finally:
        path.write_text(source)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("copy", type=pathlib.Path, help="folder of the copy, kept for the next run")
    parser.add_argument("table", type=pathlib.Path, help="CSV that lines are appended to")
    parser.add_argument("--bugs", help="names, by default all")
    parser.add_argument("--tests", help="names, by default all")
    parser.add_argument("--limit", type=float, default=300, help="seconds of a test, at most")
    options = parser.parse_args()
    tree, build = options.copy.resolve() / "tree", options.copy.resolve() / "build"
    tree.mkdir(parents=True, exist_ok=True)
    copy_tree(tree)
    if not (build / "build.ninja").exists():
        subprocess.run(["meson", "setup", build, tree], check=True, stdout=subprocess.DEVNULL)
    if (result := ninja(build)).returncode:
        sys.exit(result.stdout)
    tests = known_tests(build, options.tests and options.tests.split(","))
    tests, sound = sound_tests(build, tests, options.limit)
    done = set()
    if options.table.exists():
        done = {row["bug"] for row in csv.DictReader(options.table.open())}
    with options.table.open("a", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        if not done:
            table.writerow(HEADING)
        for bug in planted_bugs(options.copy.resolve()):
            if bug["name"] in done or (options.bugs and bug["name"] not in options.bugs.split(",")):
                continue
            table.writerows(lines_of(bug, tree, build, tests, sound, options.limit))
            file.flush()


if __name__ == "__main__":
    main()
