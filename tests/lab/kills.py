#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Commands that are ended at times drawn at random, while they replace old results. Whatever the time:
the results are the old ones or the new ones, whole; no program that was started is left; after TERM and
INT no other file is left, and the exit code says which results are there. After KILL the next command
puts the folder right. How fast the machine is changes how many are ended early, and no verdict.

usage: kills.py PROGRAM KILLS [SEED [COMMAND...]]

KILLS: of each command and each of three signals.
"""
import ctypes
import filecmp
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

# What a command does, the options of its old results, and those of the new ones. Two of them run a
# program that leaves another behind, which only its group's end can end.
COMMANDS = {
    "orders": (["orders", "errors.csv", "--json", "one.json", "--markdown", "one.md"],
               ["--expect", "e: 1"], ["--expect", "e: 2 +- 0.1"]),
    "program": (["orders", "--run", "sh program.sh {n}", "--read", "e=e (.+)", "-j", "2"],
                ["-n", "10,20,40"], ["-n", "20,40,80,160"]),
    "programs": (["trade", "program.yaml", "--trust"], ["--cost", "wall"], ["--cost", "cpu"]),
    "baseline": (["orders", "errors.csv", "--expect", "e: 2", "--compare", "one.json", "--update-baseline"],
                 ["--finest", "4"], ["--finest", "5"]),
    "check": (["check", "example1", "--junit", "one.xml", "--json", "one.json"],
              ["--scheme", "bdf2"], ["--set", "friction.coefficient=0.1"]),
    "run": (["run", "example1", "--k", "0.1", "--json", "one.json"], ["--n", "4"], ["--n", "8"]),
    "study": (["study", "example1"], ["--n", "4,8", "-k", "0.1"], ["--n", "4,8", "-k", "0.1,0.05"]),
    "trade": (["trade", "example1", "--no-plots", "--methods", "euler"],
              ["-n", "4", "-k", "0.1"], ["-n", "4,8", "-k", "0.1,0.05"]),
    "split": (["trade", "example2", "--split", "--k", "0.1"], ["-n", "4"], ["-n", "8"]),
    "extremes": (["extremes", "stability", "impact"], ["-n", "4"], ["-n", "8"]),
    "figures": (["figures"], [], []),
    "tables": (["tables"], ["--n", "4,8", "-k", "0.1,0.05"], ["--n", "4,8,16", "-k", "0.1,0.05"]),
    "help": (["help", "man"], [], []),
}
INPUTS = {
    "errors.csv": "n,e\n" + "".join(f"{2**i},{0.3 * 4.0**-i + 0.01 * 9.0**-i!r}\n" for i in range(2, 8)),
    "program.sh": "sleep 600 & sleep 0.05\necho e $(awk \"BEGIN { print 3 / $1 ^ 2 }\")\n",
    "program.yaml": "run: sh program.sh {n}\nn: 10, 20, 40\nread:\n  e: e (.+)\n",
}
TIMED = ["programs", "trade"]  # their numbers are seconds
SIGNALS = [signal.SIGTERM, signal.SIGINT, signal.SIGKILL]
HIDDEN = {".beamrate-new", ".beamrate-lock"}


def end_others():
    """Ends what was left to this process, which adopts all orphans; returns their names."""
    left = []
    for place in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            name, rest = (place / "stat").read_text().rsplit(")", 1)
            state, parent = rest.split()[:2]
            if int(parent) == os.getpid() and state != "Z":
                left.append(name)
                os.kill(int(place.name), signal.SIGKILL)
        except (FileNotFoundError, ProcessLookupError):
            pass
    try:
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass
    except ChildProcessError:
        pass
    return left


def wait_for_others():
    """What the kernel ends needs a moment, and a picture is drawn soon; a program lasts ten minutes."""
    for _ in range(1200):
        if not any(os.path.exists(f"/proc/{child}") for child in children()):
            break
        time.sleep(0.05)
    return end_others()


def children():
    found = []
    for task in pathlib.Path("/proc/self/task").iterdir():
        found += (task / "children").read_text().split()
    for child in found:
        try:
            os.waitpid(int(child), os.WNOHANG)
        except ChildProcessError:
            pass
    return found


def letters(path):
    """What two runs have in common; seconds and dates are told in numbers."""
    return re.sub(rb"\d(e[-+]\d)?|[^A-Za-z]", b"", path.read_bytes())


class Case:
    def __init__(self, program, name, folder):
        self.program, self.name, self.folder = program, name, folder
        self.words, old, new = COMMANDS[name]
        self.has_set = name != "help"
        self.temporary = folder / "temporary"
        self.environment = dict(os.environ, TMPDIR=str(self.temporary), HOME=str(folder / "home"))
        self.environment.pop("BEAMRATE_TEST", None)
        for made in (self.temporary, folder / "home"):
            made.mkdir()
        self.old, self.new, self.again = (folder / word for word in ("old", "new", "again"))
        self.make(self.old, old if old or not self.has_set else None)
        self.more = new
        start = time.monotonic()
        self.make(self.new, new, self.old)
        self.seconds = time.monotonic() - start
        self.make(self.again, new, self.old)
        self.lasting = {n for n in self.listing(self.new) if letters(self.new / n) == letters(self.again / n)}

    def line(self, more):
        out = ["--out", "set"] if self.has_set else []
        return [self.program, *self.words, *more, *out]

    def make(self, place, more, before=None):
        """A folder in which the command has run; more None: a set of another command."""
        shutil.copytree(before, place) if before else place.mkdir()
        for name, text in INPUTS.items():
            (place / name).write_text(text)
        line = self.line(more) if more is not None else [
            self.program, "run", "example1", "--n", "4", "--k", "0.1", "--out", "set"]
        ended = subprocess.run(line, cwd=place, env=self.environment, capture_output=True, text=True)
        assert ended.returncode in (0, 1), f"{line}: {ended.returncode}: {ended.stderr}"

    @staticmethod
    def listing(place):
        """Finished runs that are cached have names of hexadecimal digits, and may be there or not; so may the
        hidden file of one that was being written when the program was killed."""
        names = {str(p.relative_to(place)) for p in place.rglob("*") if not p.is_dir()}
        return {n for n in names if not re.fullmatch(r"set/\.cache/([0-9a-f]{64}|\.[0-9a-f]{64}\.\d+)", n)}

    def is_like(self, place, wanted, names):
        """Whether files are those of a run: old ones to the byte, new ones in their letters, if all runs
        have the same; the rest of the new ones differ from the old."""
        return all(self.is_one_like(place / n, wanted, n) for n in names)

    def is_one_like(self, path, wanted, name):
        """Seconds decide what timed results hold: of these the whole reports need to differ from old ones."""
        old, other = self.old / name, wanted / name
        if other.exists() and filecmp.cmp(path, other, shallow=False):
            return True
        if wanted == self.old or path.stat().st_size == 0:
            return False
        if self.name not in TIMED and name in self.lasting:
            return letters(path) == letters(other)
        whole = path.suffix in (".html", ".json", ".txt") and old.exists()  # these hold all seconds
        return not (whole and filecmp.cmp(path, old, shallow=False))

    def which_set(self, place):
        """old, new, or a word that says what is there."""
        there = self.listing(place)
        found = {n for n in there if n.startswith("set/")}
        for word, wanted in (("old", self.old), ("new", self.new)):
            names = {n for n in self.listing(wanted) if n.startswith("set/")}
            if word == "new" and self.name in TIMED:  # which tables there are depends on the times, too
                listed = (place / "set/.beamrate-set").read_text().split("\n")[1:-1]
                names = {"set/.beamrate-set"} | {f"set/{n}" for n in listed}
            if found == names and self.is_like(place, wanted, names - {"set/.beamrate-set"}):
                return word
        return "mixed: " + " ".join(sorted(found))

    def check_beside(self, place, problems, only_known):
        """Files outside the set: each is old or new."""
        known = self.listing(self.new) | self.listing(self.old)
        for name in sorted(n for n in self.listing(place) if not n.startswith("set/")):
            if name not in known:
                if only_known:
                    problems.append(f"left behind: {name}")
            elif not any(self.is_like(place, w, [name]) for w in (self.old, self.new) if (w / name).exists()):
                problems.append(f"neither old nor new: {name}")
        for name in sorted(n for n in self.listing(self.old) - self.listing(place) if not n.startswith("set/")):
            problems.append(f"lost: {name}")

    def end_one(self, number, after):
        place, problems = self.folder / "place", []
        shutil.rmtree(place, ignore_errors=True)
        shutil.copytree(self.old, place)
        with open(self.folder / "said", "w+") as said:
            child = subprocess.Popen(self.line(self.more), cwd=place, env=self.environment, stdout=said,
                                     stderr=said, start_new_session=True)
            time.sleep(after)
            child.send_signal(number)
            code = child.wait()
            said.seek(0)
            text = said.read()
        left = end_others() if number != signal.SIGKILL else wait_for_others()
        if left:
            problems.append("still there: " + " ".join(left))
        if number == signal.SIGKILL:
            which = self.after_kill(place, problems)
        else:
            which = self.after_request(place, problems, code, text, number)
        for kept in list(self.temporary.iterdir()):
            shutil.rmtree(kept) if kept.is_dir() else kept.unlink()
        return which, problems, code, text

    def after_request(self, place, problems, code, text, number):
        problems += [f"in TMPDIR: {p.name}" for p in self.temporary.iterdir()]
        problems += [f"in HOME: {p.name}" for p in (self.folder / "home").iterdir()]
        self.check_beside(place, problems, True)
        if not self.has_set:
            return "none"
        which = self.which_set(place)
        if which not in ("old", "new"):
            problems.append(which)
        if code not in (0, 1, -number):
            problems.append(f"exit code {code}")
        if (code in (0, 1) or "everything was written" in text) and which != "new":
            problems.append(f"exit code {code} and {which} results")
        if code == -number and which == "new" and not re.search("everything was written|Written to set", text):
            problems.append("new results, which are not named")
        return which

    def after_kill(self, place, problems):
        self.check_beside(place, problems, False)
        if not self.has_set:
            return "none"
        decided = (place / "set/.beamrate-new/.beamrate-set").exists()
        which = "decided" if decided else None
        if not decided:
            hidden = place / "set/.beamrate-new"
            shutil.rmtree(hidden, ignore_errors=True)
            (place / "set/.beamrate-lock").unlink(missing_ok=True)
            which = self.which_set(place)
            if which not in ("old", "new"):
                problems.append(which)
        line = [self.program, "run", "example1", "--n", "4", "--k", "0.1", "--no-plots", "--quiet", "--out", "set"]
        if subprocess.run(line, cwd=place, env=self.environment, capture_output=True).returncode:
            problems.append("the next command fails")
        names = set((place / "set/.beamrate-set").read_text().split("\n")[1:]) - {""}
        there = set(os.listdir(place / "set")) - {".beamrate-set", ".cache"}
        if names != there:
            problems.append("after the next command: " + " ".join(sorted(names ^ there)))
        return which


def main():
    program, kills = os.path.abspath(sys.argv[1]), int(sys.argv[2])
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 20281128
    print(f"# seed {seed}", flush=True)
    ctypes.CDLL(None).prctl(36, 1, 0, 0, 0)  # PR_SET_CHILD_SUBREAPER
    failures = 0
    for name in sys.argv[4:] or COMMANDS:
        draw, counts = random.Random(f"{seed} {name}"), {}
        with tempfile.TemporaryDirectory() as folder:
            case = Case(program, name, pathlib.Path(folder))
            for i in range(kills):
                for number in SIGNALS:
                    after = draw.uniform(0, 1.2 * case.seconds)
                    which, problems, code, text = case.end_one(number, after)
                    counts[which] = counts.get(which, 0) + 1
                    if problems:
                        failures += 1
                        print(f"{name}, {number.name} after {after:.3f} s of {case.seconds:.3f}, exit code {code}: " +
                              "; ".join(problems) + "\n" + text, flush=True)
        print(f"# {name}, {case.seconds:.2f} s: " + ", ".join(f"{n} {w}" for w, n in sorted(counts.items())),
              flush=True)
    print(f"{failures} failures")
    return failures > 0


if __name__ == "__main__":
    sys.exit(main())
