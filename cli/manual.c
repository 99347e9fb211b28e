/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/manual.h"

#include <stddef.h>

/* Paragraphs are parted by roff's .PP. */
const struct br_manual_section br_manual_sections[] = {
    {"WHAT IS SAID BEFORE A MARCH",
     "run predicts the discretisation error from coarse marches, with bounds, or says "
     "that it cannot, and the round-off of the linear solver; both are relative to the "
     "solution and stand in the summaries. It warns on standard error, with what to do "
     "instead, where round-off is above the discretisation error, and where the latter "
     "is above 5 %; where a load does between the time levels what they do not see, or "
     "inside of elements what their quadrature does not see; and where a lagged contact "
     "will be unstable, or may gain energy. A march that needs more memory than there "
     "is, or more than a century, is refused before a folder is made; one of more than a "
     "day is warned of. The other commands say of their marches what is cheap to tell, "
     "and study and tables add up the memory of marches that run at once."},
    {"MORE MACHINES",
     "Started by mpirun or srun (with MPI built in), the ranks share the work, and rank "
     "0 alone speaks and writes; results are those of one process, to the bit. --threads "
     "counts for each rank; by default a rank uses the cores that it is bound to, shared "
     "with the ranks that are bound to the same ones. All ranks must see the same "
     "scenes. A build without MPI refuses to be started several times."},
    {"SCENES", "A scene is a YAML file; every number carries its unit, loads and initial data are "
               "expressions in x and t. What it leaves out is not modelled. 'beamrate scenes "
               "--new' explains every key. It is read once, from a file, a pipe, or standard input "
               "(-), and is refused beyond 1 MiB. An editor with a YAML language server completes "
               "and checks a scene that begins with the line '# yaml-language-server: "
               "$schema=PATH' of scene.schema.json."},
    {"FILES", "For every table NAME, the files NAME.txt, .csv, .md, .tex and .json, and for every "
              "plot a gnuplot script NAME-*.gp, its data NAME-*.dat, and, where gnuplot is "
              "installed, .svg and .png. If gnuplot fails on a picture, a warning names it and "
              "only that picture is missing; the exit code is that of the results. A scene's NAME "
              "is its file's, with _ for what is no letter, digit, blank or one of _ . - +, at "
              "most 100 bytes."
              "\n.PP\n"
              "The files of one run are a set. manifest.json lists the sets of its folder: for "
              "each its run, version and command, and its files with their sizes and SHA-256. "
              "Files are written in the hidden folder .beamrate, which is locked: a second "
              "program that would write there is refused. Then the manifest is taken away, the "
              "files are renamed into place, and the new manifest follows last. So a folder "
              "without a manifest has no set, and one that has a manifest has all of what that "
              "lists. A program that is killed before it has decided for the new set leaves the "
              "old one; after that, the next command with the same folder finishes its work "
              "first. A new set takes the place of those with which it shares a file's name; "
              "their other files are removed, unless somebody has changed them. Files that no "
              "manifest lists are never touched: where one is in the way, the results go into the "
              "folder set-RUN beside it, and the exit code is 3."
              "\n.PP\n"
              "Installed: share/beamrate/study/scenes (the bundled scenes), "
              "share/beamrate/scene.schema.json (their schema), and the completions of bash, zsh "
              "and fish."},
    {"ENVIRONMENT",
     "BEAMRATE_DATA: the folder that holds study/scenes and reference/printed, instead "
     "of the one the program was built or installed with."
     "\n.PP\n"
     "BEAMRATE_SILENCE: seconds after which a rank that says nothing is taken for dead, "
     "60 by default."
     "\n.PP\n"
     "BEAMRATE_GNUPLOT_SECONDS: seconds that gnuplot may take for one script, 60 by "
     "default; then it is killed, as it is by an interrupt."
     "\n.PP\n"
     "TMPDIR: the folder for what run --plot and --animate need for a moment, /tmp by "
     "default."},
    {"EXIT STATUS",
     "0 done; 1 a verdict failed; 2 bad input; 3 the computation failed (a failed cell, "
     "too, after the results have been written; a march of run that stops early keeps "
     "what it has written). An interrupted program ends by its signal and leaves no file "
     "half written; a hidden folder that a second signal leaves behind is removed, or "
     "its set put in place, by the next command that writes there."},
    {"SEE ALSO", "gnuplot(1), mpirun(1)"},
    {NULL, NULL},
};
