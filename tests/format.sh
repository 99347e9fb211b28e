#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# That clang-format leaves every file of C as it is, but the table of planted bugs. Other versions than 14
# have another taste. usage: format.sh SOURCE
set -u
cd "$1" || exit 99
for program in clang-format-14 clang-format ''; do
    case $("$program" --version 2>/dev/null) in *'version 14.'*) break ;; esac
done
[ "$program" ] || { echo "skipped: clang-format 14 is not installed"; exit 77; }
find base cli orders plots reference solver study tables tests -name '*.[ch]' ! -name planted_bugs.h \
    -exec "$program" --dry-run -Werror {} +
