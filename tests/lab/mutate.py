#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which small changes of the code no test sees. Draws lines that tests cover and changes one thing on
each: an operator, a bound, a constant, an index, a sign, the order of two arguments. Builds the change
in a copy of the tree, and runs the tests that cover the line, the fastest first. Prints each change
that none of them sees as a diff; a change that leaves the object file as it was is passed over.

usage: mutate.py COPY COUNT [--seed N] [--in FOLDER]... [--test NAME]... [--at-most PER CENT]

COPY: a folder, kept for the next run. --in: only lines of these folders. --test: only these tests;
without it all but the longest. --at-most: exit code 1 if more survive.
"""
import argparse
import collections
import difflib
import hashlib
import json
import os
import pathlib
import random
import re
import subprocess
import sys
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


def output_of(*words, **more):
    return subprocess.run([str(w) for w in words], capture_output=True, text=True, check=True, **more).stdout


def copy_tree(copy):
    """Returns the tree and its build."""
    tree, build = copy / "tree", copy / "build"
    tree.mkdir(parents=True, exist_ok=True)
    output_of("sh", "-c", 'git ls-files -z | xargs -0 cp -u --preserve=timestamps --parents -t "$0"', tree, cwd=SOURCE)
    if not (build / "build.ninja").exists():
        output_of("meson", "setup", build, tree, "-Doptimization=1", "-Db_coverage=true")
    output_of("ninja", "-C", build)
    return tree, build


def targets_of(test, build):
    words = test["cmd"] + list(test["env"].values())
    return sorted({os.path.relpath(w, build) for w in words if w.startswith(f"{build}/") and os.path.isfile(w)})


def run(test, seconds):
    """Its exit code and its seconds; it may take so much processor time, and three times as long."""
    begun, limits = time.monotonic(), 'ulimit -c 0; ulimit -t "$0"; exec timeout -s KILL "$@"'
    code = subprocess.run(["sh", "-c", limits, str(int(seconds) + 1), str(3 * seconds), *test["cmd"]],
                          env={**os.environ, **test["env"], "CMOCKA_TEST_ABORT": "1"}, cwd=test["workdir"],
                          stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode
    return code, time.monotonic() - begun


def lines_run(tree, build):
    """The lines of the product that have run since the counts were removed."""
    counts = [str(p) for p in build.rglob("*.gcda")]
    lines = set()
    for text in output_of("gcov", "--json-format", "--stdout", *counts, cwd=build).splitlines() if counts else []:
        for file in json.loads(text)["files"]:
            path = os.path.relpath(os.path.join(build, file["file"]), tree)
            if path.endswith(".c") and not path.startswith(("..", "tests/")):
                lines |= {(path, line["line_number"]) for line in file["lines"] if line["count"]}
    return lines


def measure(tree, build, wanted):
    """Each test that passes, its seconds, and the lines that it runs: anew where its programs are others."""
    stored = build.parent / "lines.json"
    known = json.loads(stored.read_text()) if stored.exists() else {}
    for test in json.loads(output_of("meson", "introspect", "--tests", build)):
        name = test["name"]
        if name.startswith(("planted", "mutate")) or (wanted and name not in wanted):
            continue
        programs = [digest(build / target) for target in targets_of(test, build)]
        if known.get(name, [0])[0] != programs:
            for counts in build.rglob("*.gcda"):
                counts.unlink()
            code, seconds = run(test, LONGEST)
            print(f"# {name}: exit code {code}, {seconds:.1f} s", file=sys.stderr)
            known[name] = [programs, seconds, sorted(lines_run(tree, build)) if code == 0 else []]
            stored.write_text(json.dumps(known))
        yield test, known[name][1], [tuple(line) for line in known[name][2]]


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
    output_of("ninja", "-C", build, made)
    before = digest(build / made)
    (tree / file).write_text(text)
    if subprocess.run(["ninja", "-C", build, made], stdout=subprocess.DEVNULL).returncode:
        return "does not build"
    if digest(build / made) == before:
        return "same"
    for test, seconds in tests:
        if subprocess.run(["ninja", "-C", build, *targets_of(test, build)], stdout=subprocess.DEVNULL).returncode:
            return "does not build"
        if run(test, 10 + 3 * seconds)[0] not in (0, 77):
            return test["name"]
    return ""


def main():
    words = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1])
    words.add_argument("copy", type=pathlib.Path)
    words.add_argument("count", type=int)
    words.add_argument("--seed", type=int, default=1)
    words.add_argument("--in", dest="folders", action="append", default=[])
    words.add_argument("--test", dest="tests", action="append", default=[])
    words.add_argument("--at-most", type=float, default=100)
    asked = words.parse_args()
    tree, build = copy_tree(asked.copy.resolve())
    covered = collections.defaultdict(list)
    for test, seconds, lines in measure(tree, build, asked.tests):
        for line in lines:
            covered[line].append((test, seconds))
    places = sorted(p for p in covered if not asked.folders or p[0].split("/")[0] in asked.folders)
    draw, tried, survivors = random.Random(asked.seed), 0, 0
    while tried < asked.count and places:
        file, number = places.pop(draw.randrange(len(places)))
        text = (tree / file).read_text()
        lines = text.splitlines(keepends=True)
        changes = sorted(set(changes_of(lines[number - 1])))
        if not changes:
            continue
        changed = [*lines[:number - 1], draw.choice(changes), *lines[number:]]
        try:
            seen = try_change(tree, build, file, "".join(changed), sorted(covered[file, number], key=lambda r: r[1]))
        finally:
            (tree / file).write_text(text)
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
