# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the tables of docs/anchors.md: numbers that others print, and those of `beamrate orders`.

usage: compare.py [--check]     --check: exit code 1 where the page has other tables
$BEAMRATE is the program (beamrate). A number of others that differs in its printed digits must have a
note on the page, and only such a one.
"""
import json
import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
PAGE = HERE.parent / "anchors.md"

# Example, number, key of our table of limits, factor of the printed unit; then who prints what, and the
# note on a difference.
CELIK, PYGCS, CONVERGENCE, VERIFY = "Celik et al.", "pyGCS", "convergence", "NASA verify"
TRIPLES = [
    ("celik", "order p", "p", 1, {CELIK: "1.53", PYGCS: "1.53", CONVERGENCE: "1.533850:a"}),
    ("celik", "extrapolated value", "phi_ext", 1, {CELIK: "6.1685", PYGCS: "6.17", CONVERGENCE: "6.168507:a"}),
    ("celik", "e_a, %", "e_a", 100, {CELIK: "1.5", CONVERGENCE: "1.500907"}),
    ("celik", "e_ext, %", "e_ext", 100, {CELIK: "1.7", CONVERGENCE: "1.710407:a"}),
    ("celik", "GCI fine, %", "gci_fine", 100, {CELIK: "2.2", PYGCS: "2.17", CONVERGENCE: "2.175214:a"}),
    ("celik", "GCI coarse, %", "gci_coarse", 100, {PYGCS: "4.11", CONVERGENCE: "4.113245:a"}),
    ("celik", "asymptotic ratio", "asymptotic", 1, {PYGCS: "1.015", CONVERGENCE: "0.984952:b"}),
    ("inlet", "order p", "p", 1, {VERIFY: "1.78618479:c", CONVERGENCE: "1.786170"}),
    ("inlet", "extrapolated value", "phi_ext", 1, {VERIFY: "0.971300304:c", CONVERGENCE: "0.971300"}),
    ("inlet", "GCI fine, %", "gci_fine", 100, {VERIFY: "0.103080:c", CONVERGENCE: "0.1031"}),
    ("inlet", "GCI coarse, %", "gci_coarse", 100, {VERIFY: "0.356244:c", CONVERGENCE: "0.3562"}),
    ("inlet", "asymptotic ratio", "asymptotic", 1, {VERIFY: "0.997980:b", CONVERGENCE: "0.997980:b"}),
    ("airfoil", "order p", "p", 1, {PYGCS: "7.09", CONVERGENCE: "7.087028:a"}),
    ("airfoil", "GCI fine, %", "gci_fine", 100, {PYGCS: "0.92", CONVERGENCE: "0.916423:a"}),
    ("airfoil", "GCI coarse, %", "gci_coarse", 100, {PYGCS: "2.35", CONVERGENCE: "2.345690:a"}),
    ("airfoil", "asymptotic ratio", "asymptotic", 1, {PYGCS: "0.988", CONVERGENCE: "1.011643:b"}),
    ("airfoil", "extrapolated value", "phi_ext", 1, {PYGCS: "0.00836", CONVERGENCE: "0.008363"}),
    ("airfoil_coarse", "order p", "p", 1, {PYGCS: "6.27:d", CONVERGENCE: "6.298674:a"}),
    ("airfoil_coarse", "GCI fine, %", "gci_fine", 100, {PYGCS: "2.79:d", CONVERGENCE: "2.774673:a"}),
    ("airfoil_coarse", "GCI coarse, %", "gci_coarse", 100, {PYGCS: "5.56:d", CONVERGENCE: "5.521017:a"}),
    ("airfoil_coarse", "asymptotic ratio", "asymptotic", 1, {PYGCS: "0.981:d", CONVERGENCE: "1.022994:b"}),
    ("airfoil_coarse", "extrapolated value", "phi_ext", 1, {PYGCS: "0.00833", CONVERGENCE: "0.008334"}),
]

# Example, its formal order, the exact value where it is known; what StREEQ finds on its own data, with its 95 %
# intervals: the limit, the orders in h and in k.
RANGES = [
    ("mie_y1", 2, 5.88644, "5.886 [5.877, 5.931]", "2.03 [0.50, 2.69]", ""),
    ("mie_y2", 2, 0.555542, "0.5555 [0.5542, 0.5573]", "2.07 [0.88, 2.84]", ""),
    ("albedo_y11", 1, None, "0.01423 [0.01377, 0.01492]", "0.67 [0.37, 0.88]", ""),
    ("albedo_y6", 1, None, "0.01361 [0.01354, 0.01387]", "0.95 [0.84, 1.01]", ""),
    ("albedo_y13", 1, None, "left out", "left out", ""),
    ("testmodel", 2, 1, "1.005 [0.994, 1.023]", "1.82 [1.64, 2.25]", "0.87 [0.68, 1.43]"),
]


def ours(example, formal=2):
    """The report of `beamrate orders` on the example, whose number is its last column."""
    path = HERE / f"{example}.csv"
    heading = path.read_text(encoding="utf-8").splitlines()[1].split(",")
    words = [os.environ.get("BEAMRATE", "beamrate"), "orders", str(path), "--value", heading[-1],
             "--formal-order", str(formal), "--quiet", "--json", "-"]
    words += ["--dimension", "2"] if "dofs" in heading else []
    return json.loads(subprocess.run(words, check=True, capture_output=True, text=True).stdout)


def rounded(value, printed):
    return f"{value:.{len(printed.partition('.')[2])}f}"


def triples():
    who = [CELIK, VERIFY, PYGCS, CONVERGENCE]
    lines = ["| example | number | " + " | ".join(who) + " | beamrate |", "|---" * 7 + "|"]
    reports = {name: ours(name)["tables"]["limits"][0] for name in {row[0] for row in TRIPLES}}
    for example, number, key, factor, printed in TRIPLES:
        value, cells, most = factor * reports[example][key], [], ""
        for name in who:
            text, _, note = printed.get(name, "").partition(":")
            if text and (rounded(value, text) != text) != bool(note):
                sys.exit(f"{example}, {number}: {name} has {text}, beamrate {value!r}, and the note is "
                         f"'{note}'")
            cells.append(text + (f" ({note})" if note else ""))
            most = max(most, text, key=len)
        lines.append(f"| {example} | {number} | " + " | ".join(cells) + f" | {rounded(value, most)} |")
    return lines


def ranges():
    lines = ["| example | exact | limit: StREEQ | beamrate | order in h: StREEQ | beamrate | order in k: StREEQ "
             "| beamrate |", "|---" * 8 + "|"]
    for example, formal, exact, limit, *orders in RANGES:
        report = ours(example, formal)
        found = report["tables"]["limits"][-1]
        if exact is not None and not found["low"] <= exact <= found["high"]:
            sys.exit(f"{example}: the exact value {exact} is not between {found['low']} and {found['high']}")
        cells = [example, str(exact or ""), limit, "none" if found["limit"] is None else
                 f"{found['limit']:.5g}, between {found['low']:.5g} and {found['high']:.5g}"]
        for axis, asked in zip("hk", orders):
            line = [row for row in report["tables"]["orders"] if row["in"] == axis][-1:]
            cells += [asked, "" if not line else "not seen" if line[0]["order"] is None else
                      "{order:.2f} [{low:.2f}, {high:.2f}]".format(**line[0])]
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def short():
    printed = [text for row in TRIPLES for text in row[4].values()]
    explained = sum(":" in text for text in printed)
    exact = sum(row[2] is not None for row in RANGES)  # ranges() asks for it
    return [f"**In short: of {len(printed)} printed numbers of three grids, {len(printed) - explained} agree in "
            f"all printed digits.", f"The other {explained} have one of four causes, a to d below. All {exact} exact "
            "values lie between our limits.**"]


def main():
    page = PAGE.read_text(encoding="utf-8")
    written = page
    for name, table in (("triples", triples), ("ranges", ranges), ("short", short)):
        begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->"
        head, rest = written.split(begin)
        written = head + begin + "\n".join(table()) + "\n" + end + rest.split(end)[1]
    if "--check" not in sys.argv:
        PAGE.write_text(written, encoding="utf-8")
    elif written != page:
        for old, new in zip(page.splitlines(), written.splitlines()):
            if old != new:
                print(f"the page: {old}\nfound:    {new}")
        sys.exit(f"{PAGE} has other tables: python3 docs/anchors/compare.py writes them")


main()
