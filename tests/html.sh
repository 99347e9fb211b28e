#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Reports of real commands, with and without gnuplot, as readers find them, where they are
# installed: Python's parser, libxml2's, a browser, and LaTeX. $BEAMRATE is the program.
set -eu
: "${BEAMRATE:?is the program}" "${BEAMRATE_DATA:?is the project}"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir bin
ln -s "$BEAMRATE" bin/beamrate
pictures=0
if gnuplot --version >/dev/null 2>&1; then pictures=1; else echo "skipped: gnuplot is not installed"; fi
for tool in python3 xmllint pdflatex; do command -v $tool >/dev/null || echo "skipped: $tool is not installed"; done
command -v chromium chromium-browser google-chrome >/dev/null || echo "skipped: no browser is installed"

# shellcheck disable=SC2016
sed 's/^title:.*/title: "<script>alert(1)<\/script> \\"q\\" \x27s\x27 \\u202E <b id=gpDot>"/' \
    "$BEAMRATE_DATA/study/scenes/example2.yaml" >hostile.yaml
beamrate() { bin/beamrate "$@" --threads 1 --quiet; }
grid=(--n 4,8 --k 0.1,0.05)
beamrate study hostile.yaml "${grid[@]}" --norm l2,tip --out two
beamrate study hostile.yaml "${grid[@]}" --out bare --format html,markdown --no-plots
PATH=bin beamrate study example2 "${grid[@]}" --out missing 2>/dev/null
beamrate extremes floors --n 3,6 --k 0.01 --out floors
beamrate trade example2 example3 --methods euler,trbdf2 --n 10 --k 0.1 --no-plots --out trade
beamrate trade example2 --split --n 10 --k 0.1,0.05 --out split
beamrate check example3 --out check
beamrate trade example2 --error 1e-2 --methods euler+implicit --out goal
bin/beamrate run example1 --n 4 --k 0.1 --check --quiet --out run

if command -v python3 >/dev/null; then
    page() { python3 "$BEAMRATE_DATA/tests/html_page.py" "$@"; }
    title="&lt;script&gt;alert(1)&lt;/script&gt; &quot;q&quot; 's' \\u202e &lt;b id=gpDot&gt;"
    page two $((6 * pictures)) "<title>beamrate study: 2 reports</title>" "<h2>$title</h2>" "<h2>$title: error at the tip</h2>"
    page bare 0 "<title>$title</title>"
    page missing 0 "<code>gnuplot example2-h.gp</code>"
    page trade 0 "<title>beamrate trade: 3 reports</title>"
    page split $pictures
    page goal $((2 * pictures))
    shown="<figcaption>Each observed order"
    [ $pictures = 1 ] || shown="<code>gnuplot check.gp</code>"
    page check $pictures "$shown"
    page run $pictures "<td"
    page floors $pictures "<h1>Round-off floors of the linear solvers</h1>"
    echo "Python read the pages"
fi
# It knows no HTML5: of its errors, only those of the structure count.
if command -v xmllint >/dev/null; then
    xmllint --html --noout two/report.html 2>&1 | grep -E 'mismatch|end tag|EntityRef|redefined|already defined' && exit 1
    echo "libxml2 read a page"
fi
for browser in chromium chromium-browser google-chrome; do
    command -v $browser >/dev/null || continue
    timeout 100 $browser --headless --no-sandbox --disable-gpu --user-data-dir="$folder/profile" \
        --dump-dom "file://$folder/two/report.html" >dom 2>/dev/null || break
    [ "$(grep -c '<table>' dom)" -eq "$(grep -c '<table>' two/report.html)" ]
    [ "$(grep -c '<svg ' dom)" -eq $((6 * pictures)) ]
    ! grep -q '<script\|<b id' dom
    echo "$browser read a page"
    break
done
# LaTeX reads the same report, with its pictures and a title that would run commands.
if command -v pdflatex >/dev/null; then
    printf '%s\n' '\documentclass{article}' '\usepackage{booktabs,longtable,graphicx}' \
        '\begin{document}' '\input{hostile.tex}' '\end{document}' >two/page.tex
    (cd two && pdflatex -interaction=nonstopmode -halt-on-error page.tex >page.out) ||
        { cat two/page.out; exit 1; }
    echo "LaTeX read a report"
fi
