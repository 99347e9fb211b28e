# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads report.html of a folder: its tags are closed, it needs no other file and no script, its
letters can be read, and its tables are those of the folder's Markdown, cell by cell."""
import glob
import html.parser
import re
import sys

VOID = {"meta", "br"}


class Page(html.parser.HTMLParser):
    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.open, self.ids, self.targets, self.headings = [], [], [], []
        self.tables, self.cell, self.style, self.policy = [], None, "", ""

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        assert tag not in ("script", "link", "img", "iframe", "object", "image"), tag
        assert not any(name.startswith("on") for name in attrs), attrs
        self.ids += [attrs["id"]] if "id" in attrs else []
        for name, value in attrs.items():
            if name in ("href", "xlink:href", "src"):
                assert value.startswith("#"), value
                self.targets.append(value[1:])
            self.targets += re.findall(r"url\(#([^)]*)\)", value or "")
        assert tag != "th" or attrs["scope"] == "col"
        if attrs.get("http-equiv") == "Content-Security-Policy":
            self.policy = attrs["content"]
        assert tag != "html" or attrs["lang"] == "en"
        if tag == "table":
            self.tables.append([])
        elif tag == "tr":
            self.tables[-1].append([])
        elif tag in ("th", "td"):
            self.cell = ""
        elif tag == "small":
            self.cell += "("
        elif tag == "strong" and self.cell is not None:
            self.cell += "**"
        elif re.fullmatch("h[1-6]", tag):
            self.headings.append(int(tag[1]))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        self.open.pop()

    def handle_endtag(self, tag):
        assert self.open and self.open.pop() == tag, (tag, self.getpos())
        if tag == "small":
            self.cell += ")"
        elif tag == "strong" and self.cell is not None:
            self.cell += "**"
        elif tag in ("th", "td"):
            self.tables[-1][-1].append(self.cell)
            self.cell = None

    def handle_data(self, data):
        if self.cell is not None:
            self.cell += data
        if self.open and self.open[-1] == "style":
            self.style += data


def tables_of_markdown(text):
    tables = []
    for line, before in zip(text.splitlines(), [""] + text.splitlines()):
        if not line.startswith("|") or line.startswith("|---"):
            continue
        cells = re.split(r"(?<!\\)\|", line)[1:-1]
        if not before.startswith("|"):
            tables.append([])
        tables[-1].append([re.sub(r"\\(.)", r"\1", cell.strip()) for cell in cells])
    return tables


def luminance(colour):
    parts = [int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5)]
    parts = [p / 12.92 if p <= 0.04045 else ((p + 0.055) / 1.055) ** 2.4 for p in parts]
    return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2]


def check_contrast(style):
    for theme in re.findall(r":root \{(.*?)\}", style, re.S):
        colour = dict(re.findall(r"--(\w+): (#\w{6})", theme))
        assert len(colour) == 9, colour
        for ground in ("ground", "shade"):
            for name in ("ink", "quiet", "link", "good", "bad", "doubt"):
                high, low = sorted((luminance(colour[ground]), luminance(colour[name])))[::-1]
                assert (high + 0.05) / (low + 0.05) >= 4.5, (ground, name)
    assert style.count(":root {") == 2


def main(folder, pictures, texts):
    text = open(f"{folder}/report.html", encoding="utf-8").read()
    page = Page()
    page.feed(text)
    page.close()
    assert text.startswith("<!DOCTYPE html>\n") and not page.open, page.open
    assert "http:" not in text and "https:" not in text and "@import" not in text
    assert len(set(page.ids)) == len(page.ids), "an id stands twice"
    assert set(page.targets) <= set(page.ids), set(page.targets) - set(page.ids)
    steps = [b - a for a, b in zip(page.headings, page.headings[1:])]
    assert page.headings[0] == 1 and page.headings.count(1) == 1 and max(steps) <= 1
    assert text.count("<svg ") == int(pictures), text.count("<svg ")
    assert text.count("<figcaption>") == text.count("<figure>") >= int(pictures)
    first = text.find("<figure>")  # right below the answers and the verdicts
    assert not int(pictures) or text[:first].rstrip().endswith(("</ul>", "</p>")), text[first - 99:first]
    assert not int(pictures) or "<table>" not in text[:first]
    check_contrast(page.style)
    assert "default-src 'none'" in page.policy and "script" not in page.policy, page.policy
    written = glob.glob(f"{folder}/*.md")  # by all commands but run
    expected = [table for name in written
                for table in tables_of_markdown(open(name, encoding="utf-8").read())]
    assert bool(expected) == bool(written)
    for found, wanted in zip(sorted(page.tables), sorted(expected)):
        assert found == wanted, (found, wanted)
    assert not written or len(page.tables) == len(expected)
    for wanted in texts:
        assert wanted in text, wanted


main(sys.argv[1], sys.argv[2], sys.argv[3:])
