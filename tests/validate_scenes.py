#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene schema against scenes: every bundled one and the template pass, every key of the template
passes, and every wrong scene of test_scene and test_verify is refused, where a schema can.

usage: validate_scenes.py BEAMRATE SCENES TEST...
"""
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import yaml
from jsonschema import Draft7Validator

# What takes more than the shape of one value; everything else has to be refused.
LEFT_TO_THE_PROGRAM = [
    "given twice", "is no expression in x and t", "it assigns", "more than one, separated",
    "1/0", "sqrt(-1)", "1e999", "stiffness plus viscosity", "at x = 0", "its derivative",
    "the derivative of", "expected a finite number everywhere", "Coulomb friction takes its bound from",
    # units, and what makes others
    "which is ", "another unit of", "has no effect alone", "makes no number", "is given beside",
    "forgotten?", "1e308 Tm", "1e-323 nm", "the wall of a tube",
    # of verify: numbers that belong together
    "errors, expected at least", "does not divide", "time levels of", "expected meshes and one",
    "expected one mesh and", "expected as many meshes", "both lists from coarse",
    "nothing is expected", "an order > 0", "a tolerance below", "a constant", "contradict",
    "does not go with time scheme", "does not use it", "friction_parameter: found",
]


class Text(yaml.SafeLoader):
    """YAML as the program has it: every scalar is text, but whole numbers, as editors have them."""


Text.yaml_implicit_resolvers = {}
Text.add_implicit_resolver("tag:yaml.org,2002:int", re.compile(r"^\d+$"), list("0123456789"))
Text.add_implicit_resolver("tag:yaml.org,2002:null", re.compile(r"^$"), [""])


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def errors(validator, text):
    return [f"{'/'.join(map(str, e.path))}: {e.message}"
            for e in validator.iter_errors(yaml.load(text, Text))]


def check_right(validator, scenes, template):
    for path in sorted(Path(scenes).glob("*.yaml")):
        assert not errors(validator, path.read_text()), (path, errors(validator, path.read_text()))
    assert not errors(validator, template), errors(validator, template)
    lines = template.splitlines()
    keys = 0
    for i, line in enumerate(lines):
        if re.match(r" *# \w+: [^#]*  *# ", line) and "bound" not in line:
            text = "\n".join(lines[:i] + [line.replace("# ", "", 1)] + lines[i + 1:])
            assert not errors(validator, text), (line, errors(validator, text))
            keys += 1
    assert keys >= 10, keys
    whole = re.sub(r"(?m)^# (?=verify:$|  )", "", template)
    assert "\nverify:\n" in whole and not errors(validator, whole), errors(validator, whole)


def check_wrong(validator, tests):
    with tempfile.TemporaryDirectory() as folder:
        for test in tests:
            subprocess.run([test], check=True, capture_output=True,
                           env={**os.environ, "BR_WRONG_SCENES": folder})
        wrong = sorted(Path(folder).glob("*.yaml"))
        assert len(wrong) > 100, len(wrong)
        refused, excused = 0, set()
        for path in wrong:
            text = path.read_text(errors="replace")
            try:
                found = errors(validator, text)
            except yaml.YAMLError:
                found = ["not YAML"]
            message = text.splitlines()[0]
            reasons = [m for m in LEFT_TO_THE_PROGRAM if m in message]
            assert found or reasons, (message, text)
            refused += bool(found)
            excused.update([] if found else reasons)
        print(f"# {refused} of {len(wrong)} wrong scenes are refused by the schema")
        assert refused > len(wrong) / 2
        assert excused == set(LEFT_TO_THE_PROGRAM), set(LEFT_TO_THE_PROGRAM) - excused


def main(program, scenes, *tests):
    schema = json.loads(output(program, "scenes", "--schema"))
    Draft7Validator.check_schema(schema)
    validator = Draft7Validator(schema)
    check_right(validator, scenes, output(program, "scenes", "--new", "-"))
    check_wrong(validator, tests)


main(*sys.argv[1:])
