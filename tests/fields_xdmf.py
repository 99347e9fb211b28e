#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The fields of marches in XDMF, read by Python's XML parser, are those in CSV to the last bit.
$BEAMRATE is the program."""
import csv
import os
import subprocess
import tempfile
import xml.etree.ElementTree as ElementTree

XI = "{http://www.w3.org/2001/XInclude}include"
MESH = "xpointer(//Grid[@Name='%s']/*[self::Topology or self::Geometry])"
PIECE = 150000  # elements
ROD = """title: a rod
length: 3 m
duration: 1 s
density: 1 kg/m
axial:
  stiffness: 3 N
  viscosity: 1 N s
  load: 1 [N/m]
"""
BLOWS_UP = """title: "<a & \\"b\\"> ]]>"
length: 1 m
duration: 1 s
density: 1e-9 kg/m
axial:
  stiffness: 1e-5 N
  viscosity: 0 N s
  load: 1e148*t [N/m]
"""


def array(parent, kind):
    """The rows of a DataItem, which has as many numbers as it says."""
    item = parent.find("DataItem")
    assert (item.get("Format"), item.get("NumberType"), item.get("Precision")) == ("XML", kind, "8")
    size = [int(word) for word in item.get("Dimensions").split()]
    rows = [[float(word) for word in line.split()] for line in item.text.strip().split("\n")]
    assert [len(rows)] + [len(rows[0])] * (len(size) > 1) == size, size
    assert all(len(row) == len(rows[0]) for row in rows)
    return rows if len(size) > 1 else [row[0] for row in rows]


def check_piece(mesh, grid, nodes):
    """nodes: the lines of the CSV."""
    size = len(nodes)
    assert array(mesh.find("Geometry"), "Float") == [[float(node["x"]), 0, 0] for node in nodes]
    assert array(mesh.find("Topology"), "Int") == [[i, i + 1] for i in range(size - 1)]
    assert mesh.find("Topology").get("NumberOfElements") == str(size - 1)
    assert [child.tag for child in grid][:2] == [XI, "Time"]
    assert grid[0].get("xpointer") == MESH % mesh.get("Name")
    assert float(grid.find("Time").get("Value")) == float(nodes[0]["t"])
    known = [name for name in list(nodes[0])[2:] if nodes[-1][name]]
    attributes = {a.get("Name"): a for a in grid.findall("Attribute")}
    assert list(attributes) == ["displacement"] + known, list(attributes)
    for name in known:
        cells = name.endswith("_middle")
        assert attributes[name].get("Center") == ("Cell" if cells else "Node")
        assert array(attributes[name], "Float") == [float(node[name]) for node in nodes[cells:]], name
    vector = [[float(node["u"] or 0), float(node["w"] or 0), 0] for node in nodes]
    assert array(attributes["displacement"], "Float") == vector
    assert attributes["displacement"].get("AttributeType") == "Vector"


def check(folder, times, elements, columns):
    with open(folder + "/fields.csv", encoding="utf-8", newline="") as file:
        lines = [line for line in csv.DictReader(file) if not line["t"].startswith("#")]
    root = ElementTree.parse(folder + "/fields.xdmf").getroot()
    assert root.tag == "Xdmf" and root.get("Version") == "3.0"
    *meshes, collection = root.findall("Domain/Grid")
    assert len(meshes) == -(-elements // PIECE)
    assert collection.get("CollectionType") == "Temporal"
    assert len(collection) == times and len(lines) == times * (elements + 1), len(lines)
    assert list(lines[0])[2:] == columns.split(",")
    for i, grid in enumerate(collection):
        pieces = [grid] if len(meshes) == 1 else grid.findall("Grid")
        assert len(pieces) == len(meshes)
        for j, piece in enumerate(pieces):
            first = i * (elements + 1) + j * PIECE
            last = min(first + PIECE, (i + 1) * (elements + 1) - 1)
            check_piece(meshes[j], piece, lines[first:last + 1])
    return {i.get("Name"): i.get("Value") for i in root.findall("Domain/Information")}


def main():
    linear = "u,u_t,w,w_slope,w_t,w_t_slope"
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        with open("blow \"&<.yaml", "w", encoding="utf-8") as file:
            file.write(BLOWS_UP)
        with open("rod.yaml", "w", encoding="utf-8") as file:
            file.write(ROD)
        for scene, code, times, columns in [
                ("example2 --n 6 --k 0.05 --at 0,0.1,1", 0, 3, linear),
                ("initial_data --n 4 --k 0.05 --axial-degree 2", 0, 11,
                 linear + ",u_middle,u_t_middle"),
                ("rod.yaml --n 4 --k 0.05 --at every:0.5", 0, 3, linear),
                ("rod.yaml --n 150001 --k 0.5 --at 1", 0, 1, linear),
                ("blow\t\"&<.yaml --n 10", 3, 1, linear)]:  # stops after its start
            words = [word.replace("\t", " ") for word in scene.split(" ")]
            ran = subprocess.run([os.environ["BEAMRATE"], "run", *words, "--out", "r", "--quiet"],
                                 capture_output=True, text=True, check=False)
            assert ran.returncode == code, ran.stderr
            said = check("r", times, int(words[2]), columns)
            assert "--out r" in said["command_line"] and said["units"] == "SI"
            assert ("stopped" in said) == (code == 3), said
            assert code == 0 or 'blow "&<.yaml' in said["command_line"], said


main()
