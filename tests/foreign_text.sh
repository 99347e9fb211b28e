#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What others have written (a scene's title, name, remark, file, keys, messages that repeat them)
# is printed through base/quote.h alone: no printf and no fputs of plots/, tables/ and cli/
# has such a field among its arguments. usage: foreign_text.sh ROOT
set -u
cd "$1" || exit 1
field='(title|name|remark|message|path|caption|stem|key|unit|heading|label)'

# Expressions that may be printed as they are, as "FILES EXPRESSION": words of our own.
allowed=$(sed 's/ *#.*//' <<'END'
* (scheme|contact|friction|solver|named|norms?(\[[a-z0-9]*\])?)->name # of registries
* (c|\(\*c\))->(name|title)|row(->|\[i\]\.)name # commands, options
* (list|rows|br_method_fields|br_field_variables)\[[^,]*\]\.name|list\[i\]\.words->title # our tables
cli/beam/topics.c list\[i\].title|title       # headings
cli/beam/manual.c (list|sections)\[i\]\.title    # headings, of registries and of this file
cli/*.c br_program\.name                     # of the program
plots/[fs]*.c (p|p->series\[j\])->title       # a panel's and a curve's; the figure's own is quoted
plots/beam/paper.c (figure|f)->title          # captions of the paper
tables/document_*.c t->column\[c\]\.key       # a column's
tables/document_latex.c b->what\.key          # a picture's file: br_is_name
tables/beam/scene_template.c (key|br_norms\[0\])->(name|unit)|br_friction_models\[law\]\.name # of rows of ours
END
)

found=$(for file in $(find plots tables cli -name '*.c' | sort); do
    names=$(echo "$allowed" | while read -r which what; do
        case $file in $which) printf '%s|' "$what" ;; esac
    done)
    # A statement a line, without its strings, questions whether a text is there, and quoted texts.
    sed 's/"\([^"\\]\|\\.\)*"//g' "$file" | tr '\n' ' ' | tr ';{}' '\n\n\n' |
        sed -E "s/[][a-z_.*()>-]*(->|\.)$field(\[0\])? \?//g; s/br_quoted\([^()]*\)//g
                s/(^|[^a-z_])(${names}@)/\1/g" |
        grep -E '(^|[^a-z_])(v?f?printf|dprintf|f?puts|fwrite)\(' |
        grep -E "((->|\.)$field|[(, ](title|remark|message|caption|path|unit|heading))( *[],)?:]|$)" |
        sed "s|^ *|$file: |"
done)
[ -z "$found" ] || { echo "written past base/quote.h:" "$found" >&2; exit 1; }
