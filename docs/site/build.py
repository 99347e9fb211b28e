#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes a site of README.md and docs/ with MkDocs: site/index.html in a folder of the build.

usage: build.py PROJECT PROGRAM FOLDER [SCENE...]

The pages and what they link to keep their places, so that their links hold; a link that does not is
an error. The gallery shows the tip over time of each bundled scene, or of the SCENEs.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

LINK = re.compile(r"\]\(([^)#:]+)(#[^)]*)?\)")
SETTINGS = """site_name: beamrate
docs_dir: source
site_dir: site
use_directory_urls: false
theme: {name: readthedocs, highlightjs: false}
plugins: [search]
markdown_extensions: [tables, fenced_code, toc]
nav:
"""


def list_folder(folder):
    """A page for a folder that a page links to."""
    files = sorted(file.name for file in folder.iterdir() if file.name != "index.md")
    lines = [f"# {folder.name}", ""] + [f"- [{name}]({name})" for name in files]
    (folder / "index.md").write_text("\n".join(lines) + "\n")


def copy_page(project, source, page):
    """Copies a page and the files and folders that it links to."""
    text = (project / page).read_text()
    for match in LINK.finditer(text):
        target = pathlib.Path(os.path.normpath(page.parent / match[1]))
        if (project / target).is_dir():
            shutil.copytree(project / target, source / target, dirs_exist_ok=True)
            list_folder(source / target)
        elif target.suffix != ".md":
            (source / target.parent).mkdir(parents=True, exist_ok=True)
            shutil.copy(project / target, source / target)

    def name_page(match):
        is_folder = (project / page.parent / match[1]).is_dir()
        return f"]({match[1].rstrip('/')}/index.md)" if is_folder else match[0]

    # MkDocs takes words after the language of a block for its options.
    text = re.sub(r"^```(\w+) .*$", r"```\1", LINK.sub(name_page, text), flags=re.M)
    (source / page).parent.mkdir(parents=True, exist_ok=True)
    (source / page).write_text(text)


def draw(program, scene, folder):
    """The picture of a scene's tip over time; None where there is no gnuplot."""
    command = [program, "run", scene, "--quiet", "--out", folder / "run"]
    subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
    picture = folder / "run" / "history.svg"
    there = picture.exists()
    if there:
        picture.rename(folder / f"{scene}.svg")
    shutil.rmtree(folder / "run")
    return f"{scene}.svg" if there else None


def make_gallery(program, scenes, folder):
    """A page with each scene's tip and what its file says of it."""
    folder.mkdir()
    page = ["# Gallery", "", "Each bundled scene, as `beamrate run SCENE --out` draws it."]
    for scene in scenes:
        text = subprocess.run([program, "scenes", scene], check=True, capture_output=True, text=True)
        title = re.search(r"^title: *(.*)$", text.stdout, re.M)
        remark = re.match(r"(#.*\n)*", text.stdout)[0]
        page += ["", f"## {title[1] if title else scene}", "", f"`beamrate run {scene}`", ""]
        page += [line.lstrip("# ") for line in remark.splitlines()]
        picture = draw(program, scene, folder)
        page += ["", f"![{scene}]({picture})"] if picture else []
    (folder / "index.md").write_text("\n".join(page) + "\n")


def read_navigation(project):
    """The headings of docs/README.md, each with the titles and pages of its table."""
    parts = []
    for line in (project / "docs/README.md").read_text().splitlines():
        row = re.match(r"\| \[([^]]+)\]\(([^)]+\.md)\) \|", line)
        if line.startswith("## "):
            parts.append((line[3:], []))
        elif row:
            parts[-1][1].append((row[1], pathlib.Path(os.path.normpath(f"docs/{row[2]}"))))
    return parts


def write_navigation(parts):
    lines = ["  - Home: README.md"]
    for heading, pages in parts:
        lines += [f"  - {json.dumps(heading)}:"]
        lines += [f"    - {json.dumps(title)}: {page}" for title, page in pages]
    return "\n".join(lines) + "\n"


def main():
    project, program, folder = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
    listed = subprocess.run([program, "scenes"], check=True, capture_output=True, text=True)
    scenes = sys.argv[4:] or [line.split()[0] for line in listed.stdout.splitlines() if line.strip()]
    source = folder / "source"
    shutil.rmtree(source, ignore_errors=True)
    parts = read_navigation(project)
    listed = {page for _, pages in parts for _, page in pages}
    pages = [page.relative_to(project) for pattern in ("*.md", "docs/*.md", "docs/decisions/*.md")
             for page in sorted(project.glob(pattern))] + [pathlib.Path("solver/README.md")]
    index = pathlib.Path("docs/README.md")
    lost = [str(page) for page in pages if page.parent == index.parent and page not in listed | {index}]
    if lost:
        sys.exit(f"{index} does not list {', '.join(lost)}")
    for page in pages:
        copy_page(project, source, page)
    make_gallery(program, scenes, source / "gallery")
    dict(parts)["The paper, and beams"].append(("Gallery", "gallery/index.md"))
    (folder / "mkdocs.yml").write_text(SETTINGS + write_navigation(parts))
    subprocess.run(["mkdocs", "build", "--strict", "--quiet", "--clean"], cwd=folder, check=True)
    print(folder / "site" / "index.html")


main()
