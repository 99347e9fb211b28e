#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which small changes of the code no test sees. Draws lines that tests cover and changes one thing on
each: an operator, a bound, a constant, an index, a sign, the order of two arguments. Builds the change
in a copy of the tree, and runs the tests that cover the line, the fastest first. Prints each change
that none of them sees as a diff; a change that leaves the object file as it was is passed over.

usage: mutate.py COPY COUNT [--seed N] [--in FOLDER]... [--test NAME]... [--longest SECONDS]
                 [--at-most PER CENT]

COPY: a folder, kept for the next run; drawn.jsonl in it has a row for each change. --in: only lines of
these folders. --test: only these tests. --longest: no test that takes longer. --at-most: exit code 1
if more survive. A changed program may end or remove anything: as root, each test runs in name spaces
of its own, where all but the copy is read-only.
"""
import argparse
import collections
import concurrent.futures
import difflib
import filecmp
import hashlib
import json
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import threading
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
LONGEST = 100  # seconds of a test
NAME, NUMBER = r"[A-Za-z_][\w.]*(?:->\w+)*", r"(?<![\w.])\d+(?:\.\d*)?(?:[eE][-+]?\d+)?(?![\w.])"
# What is replaced, and by what.
CHANGES = [
    (r" <= ", " < "), (r" < ", " <= "), (r" >= ", " > "), (r" > ", " >= "), (r" == ", " != "), (r" != ", " == "),
    (r" && ", " || "), (r" \|\| ", " && "), (r" \+ ", " - "), (r" - ", " + "), (r" \* (?=\w)", " / "), (r" / ", " * "),
    (r" \+= ", " -= "), (r" \*= ", " /= "), (r"\bfmin\b", "fmax"), (r"\bfmax\b", "fmin"), (r"\btrue\b", "false"),
    (r"\bfalse\b", "true"), (r"(?<=[(=] )-(?=[\w(])|(?<=\()-(?=[\w(])|(?<=return )-(?=[\w(])", ""),
    (r"(?<=[( ])!(?=[\w(])", ""), (r" (<=?) (" + NAME + r")(?=[;) ])", r" \1 \2 - 1"),
    (r"\[(" + NAME + r")\]", r"[\1 - (\1 > 0)]"),
    (r"\((" + NAME + r"), (" + NAME + r")(?=[,)])", r"(\2, \1"),
    (r", (" + NAME + r"), (" + NAME + r")(?=\))", r", \2, \1"),
    (NUMBER, lambda found: str(int(found[0]) + 1) if found[0].isdigit() else "(1.5 * " + found[0] + ")"),
]


RUN = 'cd "$1" && ulimit -c 0 && ulimit -t "$2" && shift 2 && exec "$@"'
# With name spaces: alone with its processes, whose first one is sh, on files that it cannot lose.
ALONE = """mount --bind "$0" /mnt && mount -t tmpfs none /tmp && mkdir -p "$0" && mount --bind /mnt "$0" &&
mount --bind "$0/tree" "$0/tree" && mount -o remount,bind,ro "$0/tree" && mount -o remount,bind,ro / || exit 99
(""" + RUN + "); exit $?"
SPACES = ["unshare", "-mpf", "--mount-proc", "--kill-child"]
CAN_BE_ALONE = subprocess.run([*SPACES, "true"], capture_output=True).returncode == 0


def output_of(*words, **more):
    return subprocess.run([str(w) for w in words], capture_output=True, text=True, check=True, **more).stdout


def ninja(build, *targets):
    return subprocess.run(["ninja", "-C", build, *targets], stdout=subprocess.DEVNULL).returncode == 0


def copy_tree(copy):
    """Returns the tree, its build, and a build that counts which lines run."""
    tree, build, covered = copy / "tree", copy / "build", copy / "covered"
    for name in filter(lambda n: (SOURCE / n).is_file(), output_of("git", "ls-files", cwd=SOURCE).splitlines()):
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        if not ((tree / name).exists() and filecmp.cmp(SOURCE / name, tree / name, shallow=False)):
            shutil.copy(SOURCE / name, tree / name)
    for folder, option in (build, "-Db_coverage=false"), (covered, "-Db_coverage=true"):
        if not (folder / "build.ninja").exists():
            output_of("meson", "setup", folder, tree, "-Doptimization=1", option)
    return tree, build, covered


def tests_of(build):
    """Meson's tests, with the files that each needs."""
    made = {t["id"]: t["filename"] for t in json.loads(output_of("meson", "introspect", "--targets", build))}
    outputs = {file for files in made.values() for file in files}
    for test in json.loads(output_of("meson", "introspect", "--tests", build)):
        words = test["cmd"] + list(test["env"].values()) + [file for i in test["depends"] for file in made[i]]
        test["needs"] = sorted({os.path.relpath(w, build) for w in words if w in outputs})
        yield test


def run(test, copy, seconds, **more):
    """Whether it passes, and its seconds of processor; ends at the first case that fails, after so many
    seconds, or where it only waits."""
    words = [*SPACES, "sh", "-c", ALONE] if CAN_BE_ALONE else ["sh", "-c", RUN]
    words += [copy, test["workdir"] or copy / "build", int(seconds) + 1, *test["cmd"]]
    usual = {**os.environ, "CMOCKA_TEST_ABORT": "1", "CCACHE_DISABLE": "1"}
    process = subprocess.Popen([str(word) for word in words], env={**usual, **test["env"], **more},
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    limit = threading.Timer(60 + 20 * seconds, process.kill)
    limit.start()
    with process.stdout as lines:
        for line in lines:
            if test["protocol"] == "tap" and line.startswith(b"not ok"):
                process.kill()
    _, status, used = os.wait4(process.pid, 0)
    limit.cancel()
    return os.waitstatus_to_exitcode(status) in (0, 77), used.ru_utime + used.ru_stime


def lines_run(tree, covered, counts):
    """The lines of the product that have run, by the counts in a folder."""
    found = [p for p in counts.rglob("*.gcda") if "/tests/" not in str(p)]
    for file in found:
        notes = (pathlib.Path("/") / file.relative_to(counts)).with_suffix(".gcno")
        file.with_suffix(".gcno").symlink_to(notes)
    lines = collections.defaultdict(set)
    for text in output_of("gcov", "--json-format", "--stdout", *found, cwd=covered).splitlines() if found else []:
        for file in json.loads(text)["files"]:
            path = os.path.relpath(os.path.join(covered, file["file"]), tree)
            if path.endswith(".c") and not path.startswith(("..", "tests/")):
                lines[path] |= {line["line_number"] for line in file["lines"] if line["count"]}
    return {path: sorted(lines[path]) for path in sorted(lines)}


def measure_one(test, twin, tree, covered):
    """Seconds of a test that passes, without counts, and the lines that it runs."""
    counts = tree.parent / "counts" / test["name"]
    shutil.rmtree(counts, ignore_errors=True)
    passes, seconds = run(test, tree.parent, LONGEST)
    if passes and twin:
        passes, _ = run(twin, tree.parent, 3 * LONGEST, GCOV_PREFIX=str(counts))
    print(f"# {test['name']}: {'passes' if passes else 'left out'}, {seconds:.1f} s", file=sys.stderr)
    lines = lines_run(tree, covered, counts) if passes else {}
    shutil.rmtree(counts, ignore_errors=True)
    return seconds, lines


def measure(tree, build, covered, wanted):
    """Each test, its seconds, and the lines that it runs: anew where its programs are others."""
    stored = build.parent / "lines.json"
    known = json.loads(stored.read_text()) if stored.exists() else {}
    twins = {test["name"]: test for test in tests_of(covered)}
    tests = [t for t in tests_of(build) if (not wanted or t["name"] in wanted) and
             not t["name"].startswith(("planted", "mutate"))]
    ninja(build, *(need for t in tests for need in t["needs"]))
    ninja(covered, *(need for t in tests for need in twins[t["name"]]["needs"]))
    programs = {t["name"]: [digest(build / need) for need in t["needs"]] for t in tests}
    new = [t for t in tests if known.get(t["name"], [0])[0] != programs[t["name"]]]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        measured = pool.map(lambda t: measure_one(t, twins[t["name"]], tree, covered), new)
        for test, result in zip(new, measured):
            known[test["name"]] = [programs[test["name"]], *result]
            stored.write_text(json.dumps(known))
    for test in tests:
        yield test, known[test["name"]][1], known[test["name"]][2]


def without_text(line):
    """The line with its strings and remarks blotted out, of the same length."""
    if line.startswith(("#", " *", "/*", "struct", "static const", "enum")):
        return ""
    return re.sub(r'"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])*\'|/\*.*?(?:\*/|$)|//.*', lambda m: "\0" * len(m[0]), line)


def changes_of(line):
    code = without_text(line)
    for pattern, instead in CHANGES:
        for found in re.finditer(pattern, code):
            new = instead(found) if callable(instead) else found.expand(instead)
            yield line[:found.start()] + new + line[found.end():]


def object_of(build, tree, file):
    """The build's first output of this file."""
    for row in json.loads((build / "compile_commands.json").read_text()):
        if os.path.normpath(os.path.join(row["directory"], row["file"])) == str(tree / file):
            return row["output"]
    return None


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def try_change(tree, build, file, text, tests):
    """What becomes of the file with this text: "same", "does not build", the test that sees it, or ""."""
    made = object_of(build, tree, file)
    ninja(build, made)
    before = digest(build / made)
    (tree / file).write_text(text)
    if not ninja(build, made):
        return "does not build"
    if digest(build / made) == before:
        return "same"
    for test, seconds in tests:
        if not ninja(build, *test["needs"]):
            return "does not build"
        if not run(test, build.parent, 3 + 3 * seconds)[0]:
            return test["name"]
    return ""


def main():
    words = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1])
    words.add_argument("copy", type=pathlib.Path)
    words.add_argument("count", type=int)
    words.add_argument("--seed", type=int, default=1)
    words.add_argument("--in", dest="folders", action="append", default=[])
    words.add_argument("--test", dest="tests", action="append", default=[])
    words.add_argument("--longest", type=float, default=LONGEST)
    words.add_argument("--at-most", type=float, default=100)
    asked = words.parse_args()
    tree, build, covered = copy_tree(asked.copy.resolve())
    tests_of_line = collections.defaultdict(list)
    for test, seconds, files in measure(tree, build, covered, asked.tests):
        for place in ((file, line) for file in files for line in files[file] if seconds <= asked.longest):
            tests_of_line[place].append((test, seconds))
    places = sorted(p for p in tests_of_line if not asked.folders or p[0].split("/")[0] in asked.folders)
    draw, tried, survivors = random.Random(asked.seed), 0, 0
    while tried < asked.count and places:
        file, number = places.pop(draw.randrange(len(places)))
        text = (tree / file).read_text()
        lines = text.splitlines(keepends=True)
        changes = sorted(set(changes_of(lines[number - 1])))
        if not changes:
            continue
        changed = [*lines[:number - 1], draw.choice(changes), *lines[number:]]
        tests = sorted(tests_of_line[file, number], key=lambda row: row[1])
        begun = time.monotonic()
        try:
            seen = try_change(tree, build, file, "".join(changed), tests)
        finally:
            (tree / file).write_text(text)
        with open(build.parent / "drawn.jsonl", "a") as drawn:
            print(json.dumps([asked.seed, file, number, lines[number - 1], changed[number - 1], seen,
                              time.monotonic() - begun]), file=drawn)
        if seen in ("same", "does not build"):
            continue
        tried += 1
        survivors += not seen
        print(f"# {tried}: {file}:{number}: {'seen by ' + seen if seen else 'SURVIVES'}", flush=True)
        if not seen:
            sys.stdout.writelines(difflib.unified_diff(lines, changed, f"a/{file}", f"b/{file}", n=2))
    print(f"{tried} changes, {survivors} seen by no test", flush=True)
    return int(survivors * 100 > asked.at_most * tried)


if __name__ == "__main__":
    sys.exit(main())
