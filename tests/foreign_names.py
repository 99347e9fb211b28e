#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Hostile names, units, titles and messages in tables, study files, scenes and programs, through all
formats, read by parsers that are not ours: each report has the form that it has with a harmless name.
So have those of scenes whose files have such names, by every command that takes a scene, and gnuplot
($GNUPLOT) takes all their scripts. Texts that are not UTF-8 are refused with file, line and byte.
$BEAMRATE is the program."""
import csv
import html.parser
import json
import os
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

TEXTS = [
    "harmless",
    "=1+1",
    " \t@SUM(1)",
    "+cmd|' /C calc'!A0",
    "-2+3",
    "a\nb\r\n=c",
    "\x1b[31mred\x07\x7f\u202egnp\u2066\u009b",
    "]]> <![CDATA[ <!-- &lt; &#x1b; -- >",
    "</td></text><script>alert(1)</script><img src=x onerror=y>",
    "m^(\\input{x}) \\write18{y} $_$ 5% & # ~ {",
    "| a | `b` [c](d) *e* \\",
    "\"q\" 's' ''; system(\"touch MARK\")",
    "::error file=x::y%0A##[group]",
    "%s%n%99999d {/Symbol a}_b^c @x",
    "# SKIP a.b.c, d; e",
    "\ufffe\ufeff\u200b",
    40 * "\u00e4\u20ac",
]
# The name of a scene's file, and its title. The last one is as long as names may be.
SCENES = [
    ("harmless", "harmless"),
    ("'.system('touch MARK').'", "5'' beam"),
    ("'; system(\"touch MARK\"); '", "'; system(\"touch MARK\"); '"),
    ("<touch MARK", "''; system(\"touch MARK\"); ''"),
    ("|touch MARK", "' ' }} ; system('touch MARK'); # {"),
    ("`touch MARK`", "`touch MARK` \"`touch MARK`\" @stem \\"),
    ("$(touch MARK)", "a\nsystem('touch MARK')\n#\n! touch MARK\n\\"),
    ("\\input{MARK}", "\\input{/etc/passwd} \\write18{touch MARK} $x_1^2$ 5% & # ~"),
    ("<td><script>", "</td><script>alert(1)</script> <img src=x onerror=y> [a](b) | c"),
    ("]]>&amp;", "]]> <!-- &lt; &#x1b; <![CDATA["),
    ("=1+1", "=cmd|' /C calc'!A0"),
    ("-@+x", "--out=MARK @SUM(1) +1,\"2\""),
    ("a\nb\x1b[2J\u202e\x9b\x7f", "\x1b[31m\u202eabc\u2066\x85\x9b\a\r\x7f\u200f"),
    ("100%s%n%d", "%s%n%d %99999d {/Symbol a}_b^c"),
    (b"latin \xe4\xff", "Tr\u00e4ger"),
    (240 * "n", 1100 * "'"),
]
# What takes a scene, and its exit code; the last one takes long.
COMMANDS = [
    ("run SCENE --n 2 --k 0.5 --out run --json run.json", 0),
    ("study SCENE --n 2,4 --k 0.5,0.25 --reference mms --out study", 0),
    ("check SCENE --junit c.xml --json c.json --markdown c.md", 1),
    ("trade SCENE --methods euler --n 2 --k 0.5,0.25 --reference mms --out trade", 0),
    ("trade SCENE --split --methods euler --n 2 --k 0.5,0.25 --out split", 0),
    ("scenes SCENE", 0),
    ("run SCENE --n 2 --k 3", 2),
    ("study SCENE.no", 2),
    ("trade SCENE --error 0.3 --methods euler --reference mms --out goal", 0),
]
HIDDEN = re.compile("[\0-\x09\x0b-\x1f\x7f-\x9f\u061c\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff"
                    "\ufffe\uffff]")
ESCAPES = {"textbackslash", "textasciitilde", "_", "%", "&", "#", "$", "{", "}", "^"}


class Tags(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.found = []

    def handle_starttag(self, tag, attrs):
        self.found.append((tag, [name for name, value in attrs]))

    def handle_endtag(self, tag):
        self.found.append("/" + tag)


def form_of_csv(text):
    rows = list(csv.reader(text.splitlines(keepends=True), strict=True))
    for cell in sum(rows, []):
        assert "\n" not in cell and "\r" not in cell, cell
        if cell.lstrip()[:1] in tuple("=+-@"):
            float(cell)
    return [len(row) for row in rows]


def form_of_json(text):
    def once(pairs):
        assert len(dict(pairs)) == len(pairs), pairs
        return dict(pairs)
    document = json.loads(text, object_pairs_hook=once)
    assert document["format"] and document["tables"]
    return {key: len(rows) for key, rows in document["tables"].items()}


def form_of_xml(text):
    return [(e.tag, sorted(e.keys())) for e in ElementTree.fromstring(text).iter()
            if "svg" not in e.tag]  # a letter that gnuplot knows may take an element of its own


def form_of_html(text):
    page = Tags()
    page.feed(re.sub("<svg.*?</svg>", "<svg/>", text, flags=re.S))
    for svg in re.findall("<svg.*?</svg>", text, flags=re.S):
        assert "<script" not in re.sub(r"<!\[CDATA\[.*?\]\]>", "", svg, flags=re.S)
    return page.found


def form_of_markdown(text):
    plain = re.sub(r"(?m)^````\n.*?^````$|`[^`\n]*`$", "", text, flags=re.S)
    plain = re.sub(r"\\[^A-Za-z0-9\s]", "", plain)
    assert not re.search("<(?![^>]*\\.svg>)", plain), plain
    return [line.count("|") for line in plain.split("\n") if "|" in line]


def form_of_latex(text):
    plain = re.sub(r"\\detokenize\{.*?\}\.pdf|(?m:^%.*)", "", text)
    commands = [c for c in re.findall(r"\\([A-Za-z]+|.)", plain) if c not in ESCAPES]
    bare = re.sub(r"\\[^A-Za-z]", "", plain)
    assert bare.count("{") == bare.count("}") and bare.count("%") + bare.count("#") == 0
    return [c for c in commands if c != "cdot"]


def form_of_github(text):
    return [re.fullmatch(r"::(\w+) (?:file=[^:,]*,line=\d+,)?title=[^:,]*::.*", line).group(1)
            for line in text.splitlines()]


FORMS = {".csv": form_of_csv, ".json": form_of_json, ".xml": form_of_xml, ".svg": form_of_xml,
         ".html": form_of_html, ".md": form_of_markdown, ".tex": form_of_latex,
         ".github": form_of_github, ".txt": str.count, ".gp": str.count, ".dat": str.count}


def is_hidden(text):
    found = HIDDEN.search(text)
    return found and repr(text[max(0, found.start() - 40):found.end()])


def run(words, code, said=""):
    words = [word if isinstance(word, bytes) else word.encode() for word in words]
    ran = subprocess.run([os.environ["BEAMRATE"].encode(), *words], capture_output=True, check=False)
    out = (ran.stdout + ran.stderr).decode()  # is UTF-8
    assert ran.returncode == code, (words, ran.returncode, out)
    assert not is_hidden(out), (words, is_hidden(out))
    assert said in " ".join(out.split()), (words, out)
    return out


def quoted(text):
    """In YAML, on one line."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\x7f").translate(
        {code: f"\\u{code:04x}" for code in (0x85, 0x9b, 0x2028, 0xfeff, 0xfffe)})


def write(path, text):
    with open(path, "wb") as file:
        file.write(text if isinstance(text, bytes) else text.encode())


def make_reports(text):
    """All that a stranger types is `text`."""
    unit = re.sub("[][\t]", "", text)  # what is behind the last bracket is the unit; a tab separates
    name = "q" + re.sub("[,:\n=]", "", text) if text[0] == "=" else re.sub("[,:\n=]", "", text)
    short = re.sub("[,:;\\s\x85\u2028]+", " ", text).encode()[:60].decode(errors="ignore").strip()
    with open("t.csv", "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, quoting=csv.QUOTE_ALL)
        table.writerow([f"h [{unit}]", f"{short} [{unit}]", f"{short} v"])
        table.writerows([h, 3 * h * h, 1 + h * h] for h in (0.8, 0.4, 0.2, 0.1))
    write("study.yaml", f"title: {quoted(text)}\ntable: t.csv\nverify:\n  {quoted(short)}: h 3 +- 0.1\n"
          )
    write("p.sh", "#!/bin/sh\n[ $1 = 8 ] && { /bin/cat message >&2; exit 3; }\necho e=1e-$1\n")
    write("message", text + "\n")
    run(["orders", "t.csv", "--out", "table"], 0)
    run(["check", "study.yaml", "--junit", "c.xml", "--json", "c.json", "--markdown", "c.md",
         "--github", "c.github"], 1)
    run(["orders", "study.yaml", "--out", "study", "--quiet"], 1)
    run(["orders", "--run", "/bin/sh p.sh {n}", "-n", "2,4,8,16", "--read", f"{name}=e=(.+)", "--out",
         "program"], 3)
    write("scene.yaml", f"title: {quoted(text)}\nremark: {quoted(text)}\nlength: 1 m\nduration: 1 s\n"
          "density: 1 kg/m\naxial:\n  stiffness: 1 N\n  viscosity: 1 N s\n  load: 1 [N/m]\n")
    run(["study", "scene.yaml", "--n", "2,4", "--k", "0.5,0.25", "--out", "scene"], 0)


def forms():
    found = {}
    for folder, _, names in os.walk("."):
        for name in names:
            path = os.path.join(folder, name)
            stem, extension = os.path.splitext(path)
            assert not name.startswith("MARK"), "something was run"
            if extension not in FORMS or path == "./t.csv" or ".cache" in path \
                    or "orders-cache" in path:
                continue
            with open(path, encoding="utf-8", newline="") as file:
                text = file.read()
            assert not is_hidden(text) or extension in (".svg", ".json"), (path, is_hidden(text))
            try:
                form = FORMS[extension](text) if FORMS[extension] is not str.count else 0
            except Exception as why:
                raise AssertionError(f"{path} is not sound: {why}") from why
            found[path] = form
    return found


def make_scene_reports(name, title, commands):
    file = b"./" + (name if isinstance(name, bytes) else name.encode()) + b".yaml"
    title = json.dumps(title).replace("\x7f", "\\x7f")  # `scenes` shows a file as it is
    write(file, f"title: {title}\nremark: {title}\nlength: 1 m\nduration: 1 s\ndensity: 1 kg/m\n"
          "axial:\n  stiffness: 1 N\n  viscosity: 1 N s\n  solution: t*x*(2 - x) [m]\n"
          "verify:\n  space:\n    n: 2, 4, 8, 16, 32\n    k: 0.5 s\n    l2: 1 +- 0.1\n")
    for line, code in commands:
        out = run([word.encode().replace(b"SCENE", file) for word in line.split()], code)
        assert "is not drawn" not in out, out


def check_scripts():
    """gnuplot takes each one without a word: as SVG alone, which is quick."""
    draw = ("find . -name '*.gp' ! -name '*-h.*' ! -name '*-work.*' -execdir sh -c "
            "'sed s/svg.png.pdf/svg/ \"$1\" | \"$GNUPLOT\" --default-settings 2>&1 || echo \"$1\"' sh {} \\;")
    said = subprocess.run(["/bin/sh", "-c", "PATH=/usr/bin:/bin; " + draw], capture_output=True, check=True).stdout
    assert not said, said


def check_scenes(path):
    """All files of a scene, whatever their names are, have the forms of those of the harmless one."""
    expected, failures = {}, 0
    for i, (name, title) in enumerate(SCENES):
        planned = i % 5 == 0 or "BR_TEST_LONG" in os.environ
        # Pictures take most of the time.
        drawn = i in (1, len(SCENES) - 1) or "BR_TEST_LONG" in os.environ
        os.environ["PATH"] = path if drawn else "/nonexistent"
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                make_scene_reports(name, title, COMMANDS if planned else COMMANDS[:-1])
                if "GNUPLOT" in os.environ:
                    check_scripts()
                found = sorted((os.path.dirname(file), os.path.splitext(file)[1], repr(form))
                               for file, form in forms().items() if file[-4:] != ".svg" and "goal" not in file)
                harmless = expected.setdefault(drawn, found)
                assert found == harmless, set(found) ^ set(harmless)
            except AssertionError as why:
                print(f"{name!r}: {why}", file=sys.stderr)
                failures += 1
            os.chdir("/")
    os.environ["PATH"] = path
    return failures


def check_refusals():
    """Latin-1, as old programs write the degree sign, in all places where text is read."""
    scene = b"title: a\nlength: 1 m\nduration: 1 s\nremark: 5 \xb0C\n"
    study = b"title: a\ntable: good.csv\n# 5 \xb0C\nverify:\n  e: h 2 +- 0.1\n"
    write("good.csv", "h,e\n0.4,4\n0.2,1\n0.1,0.25\n")
    for name, text, command in [
            ("scene.yaml", scene, ["run"]), ("scene.yaml", scene, ["scenes"]),
            ("study.yaml", study, ["check"]), ("study.yaml", study, ["orders"]),
            ("t.csv", b"h [mm],e\n1,2\n2,3\n3,5 \xb0C\n", ["orders"]),
            ("t.csv", b"h,n\n# \n\n1 [\xe2\x82],2\n", ["orders"])]:
        write(name, text)
        byte = 0xe2 if b"\xe2" in text else 0xb0
        line = 3 if text is study else 4
        run([*command, name], 2, f"{name}:{line}: found the byte 0x{byte:02x}")
    write("study.yaml", study.replace(b"\xb0", b""))
    write("old.json", b"{\n\"format\": \"\xb0\"\n}\n")
    run(["check", "study.yaml", "--compare", "old.json"], 2, "old.json:2: ")
    for words in (["orders", "--run", "echo e=1e-{n}", "-n", "1,2,3,4", "--read", b"\xb0=e=(.+)"],
                  ["orders", "good.csv", "--value", b"\xb0"],
                  ["orders", "good.csv", "--expect", b"\xb0: h 2 +- 0.1"],
                  ["orders", b"\xb0.csv"], ["run", b"\xb0.yaml"], ["run", "example1", "--set", b"\xb0=1"]):
        run(words, 2, "\\xb0")
    # Of a program, what it prints is shown by its bytes; a folder may have any name.
    run(["orders", "--run", "printf 'e=\\260\\n{n}'", "-n", "1,2,3", "--read", "e=e=(.+)", "--out", b"f\xb0"],
        3, "found '\\xb0', expected a finite number")
    with open(b"f\xb0/orders.json", encoding="ascii") as file:
        document = json.load(file)
    assert "--out 'f\\xb0'" in document["provenance"]["command_line"] or \
        "--out f\\xb0" in document["provenance"]["command_line"], document["provenance"]


def main():
    expected, failures, path = {}, 0, os.environ["PATH"]
    os.environ["XDG_STATE_HOME"] = "/nonexistent"
    for text in TEXTS[:1] + TEXTS:
        # Pictures take most of the time: of harmless texts they are not drawn.
        drawn = bool(re.search("[]<{\u20ac]", text) or 0 in expected and 1 not in expected)
        os.environ["PATH"] = path if drawn else "/nonexistent"
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                make_reports(text)
                found = forms()
                harmless = expected.setdefault(drawn, found)
                for name in set(harmless) | set(found):
                    assert harmless.get(name) == found.get(name), f"{name} has another form"
            except AssertionError as why:
                print(f"{text!r}: {why}", file=sys.stderr)
                failures += 1
            os.chdir("/")
    failures += check_scenes(path)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        check_refusals()
        os.chdir("/")
    sys.exit(failures > 0)


main()
