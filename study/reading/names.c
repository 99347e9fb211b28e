/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What headings may mean. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/reading/roles.h"

enum { LONGEST = 200 };

/* Names in small letters without other characters, and log odds of what they state. */
static const struct {
    const char *column;
    double odds;
    const char *names;
} of_sizes[] = {
    {"h", 5,
     " h dx dy \xce\x94x deltax meshsize meshwidth elementsize elsize cellsize gridspacing meshspacing "
     "spacing hmax maxh hmin minh hmean havg hx hy meshh gridwidth cellwidth resolutionkm resolutionm "
     "steph stepwidth elementlength lc gitterweite maschenweite "},
    {"h", 1.75, " gridsize size mesh grid resolution delta stepsize chanh "},
    {"n", 5,
     " nx ny cellsperside elementsperside 1h 1dx inverseh invh hinv invdx 1overh gridresolution nxny "
     "numel1d cellsperdim samples nsamples paths npaths "},
    {"n", 4,
     " n nel nelements resolution intervals subdivisions nsub ndivisions divisions numintervals "
     "nintervals nn "},
    {"n", 2, " grid mesh gridsize size m "},
    {"n", 1.5, " points gridpoints numpts npts npoints numpoints nodes nnodes numnodes "},
    {"points", 2.5, " points gridpoints numpts npts npoints numpoints "},
    {"points", 1.75, " nodes nnodes numnodes meshpoints "},
    {"interior", 4, " interior interiornodes interiorpoints ninterior "},
    {"level", 4,
     " level lvl reflevel levels refinement refinements refinementlevel refine nref reflvl "
     "numrefinements meshlevel "},
    {"level", 1.75, " ref refs cycle mesh grid l "},
    {"dofs", 4,
     " dofs dof freiheitsgrade ndofs ndof numdofs unknowns degreesoffreedom nunknowns dofcount "
     "ndoftotal "},
    {"dofs", 1.75,
     " nodes nnodes numnodes vertices nvertices numvertices points gridpoints numpts npts npoints "
     "numpoints nv "},
    {"cells", 4,
     " ncells cells cell elements nelem nelems numelem numelements numberofelements numberofcells "
     "numcells cellcount triangles ntriangles nelt ntri elementcount elems nelements "},
    {"cells", 1.75, " grid mesh gridsize size volumes "},
    {"k", 4, " k "},
    {"dt", 4,
     " dt \xce\x94t deltat timestep timestepsize stepsize tau \xcf\x84 timestepdt maxdt dtmax "},
    {"steps", 4, " steps nt nsteps timesteps numsteps ntimesteps numberofsteps stepcount "},
};

static const struct {
    enum br_kind kind;
    const char *words; /* one of them is in the name */
} of_kinds[] = {
    {BR_KIND_DEVIATION, " std sigma sd stderr sem stdev stddev deviation uncertainty unc pm "},
    {BR_KIND_RATE,
     " rate rates eoc ooc roc order orders slope conv convergence eocs convrate p_obs "
     "poc ordre ordnung ordem orden "},
    {BR_KIND_FACTOR, " ratio ratios reduction factor factors quotient "},
    {BR_KIND_COST,
     " time times cpu wall walltime seconds sec secs runtime iter iters its iteration iterations "
     "solver cycle index row memory mem ram newton gmres cg nit niter flops cost elapsed ms step id idx "
     "date timestamp run_id speedup zeit "},
    {BR_KIND_DEGREE, " degree deg poly polynomial polydeg pdeg "},
    {BR_KIND_REPEAT, " seed repeat replicate trial run sample rep repetition "},
    {BR_KIND_ERROR,
     " error errors err l1 l2 linf h1 e rmse mse mae rms res residual difference diff fehler norm "
     "loo l\xe2\x88\x9e max_error erreur errore erro abs rel defect hdiv hcurl semi w1p linfty "},
};

/* The letters and digits of a name, in small letters. */
static void plain(const char *name, char text[LONGEST])
{
    size_t length = 0;
    for (; *name && length + 1 < LONGEST; name++)
        if (isalnum((unsigned char)*name) || (unsigned char)*name >= 0x80)
            text[length++] = (char)tolower((unsigned char)*name);
    text[length] = '\0';
}

static bool lists(const char *names, const char *word)
{
    char padded[LONGEST + 2];
    snprintf(padded, sizeof padded, " %s ", word);
    return *word && strstr(names, padded);
}

/* Takes the next word of a name: "err_L2Norm" has err, l2, norm. False: there is none. */
static bool next_word(const char **at, char word[LONGEST])
{
    size_t length = 0;
    const char *s = *at;
    while (*s && !isalnum((unsigned char)*s) && (unsigned char)*s < 0x80)
        s++;
    for (const char *from = s; *s && length + 1 < LONGEST; s++) {
        const bool part = isalnum((unsigned char)*s) || (unsigned char)*s >= 0x80;
        const bool hump = s > from && isupper((unsigned char)*s) && islower((unsigned char)s[-1]);
        if (!part || hump)
            break;
        word[length++] = (char)tolower((unsigned char)*s);
    }
    word[length] = '\0';
    *at = s;
    return length;
}

/* A name without the words that say nothing: "number of cells", "max h". */
static void without_fill(const char *name, char text[LONGEST])
{
    static const char fill[] = " num number no of max min avg mean average total count the in nb "
                               "nr global mesh grid ";
    char word[LONGEST];
    size_t length = 0;
    while (next_word(&name, word))
        if (!lists(fill, word) && length + strlen(word) < LONGEST) {
            strcpy(text + length, word);
            length += strlen(word);
        }
    text[length] = '\0';
}

/* A name with its letter, "mesh width h", without it; false: there is none, or another one. */
static bool without_letter(char text[LONGEST], const char *name, const char *column)
{
    char word[LONGEST], last[LONGEST] = "";
    while (next_word(&name, word))
        strcpy(last, word);
    const size_t length = strlen(text), end = strlen(last);
    if (strcmp(last, column) != 0 || length <= end || strcmp(text + length - end, last) != 0)
        return false;
    text[length - end] = '\0';
    return true;
}

/* "N per direction", "cells along x": of one side. */
static bool is_of_a_side(const char *name)
{
    char word[LONGEST];
    while (next_word(&name, word))
        if (lists(" per along direction side dim edge ", word))
            return true;
    return false;
}

double br_name_odds(const char *name, const struct br_resolution_column *column)
{
    const double unknown = column->axis == BR_AXIS_TIME ? -9 : 0.5, definite = 5, excluded = -2;
    char whole[LONGEST], bare[LONGEST];
    double best = -9, most = 0;
    if (!name)
        return unknown;
    plain(name, whole);
    without_fill(name, bare);
    if (is_of_a_side(name))
        return strcmp(column->name, "n") == 0 ? definite : fmin(excluded, unknown);
    for (int pass = 0; pass < 3 && most == 0; pass++) {
        if (pass == 2 && !without_letter(bare, name, "h"))
            break;
        for (size_t i = 0; i < sizeof of_sizes / sizeof *of_sizes; i++) {
            if (!lists(of_sizes[i].names, pass ? bare : whole))
                continue;
            most = fmax(most, of_sizes[i].odds);
            if (strcmp(of_sizes[i].column, column->name) == 0)
                best = fmax(best, of_sizes[i].odds);
        }
    }
    return best > 0 ? best : most >= definite ? fmin(excluded, unknown) : unknown;
}

enum br_kind br_kind_of(const char *name)
{
    char word[LONGEST], last[LONGEST] = "";
    size_t words = 0;
    const char *at = name;
    if (!name)
        return BR_KIND_UNKNOWN;
    while (next_word(&at, word)) {
        strcpy(last, word);
        words++;
    }
    if (words == 1 && lists(" r o p q o1 o2 oh l2r ", last))
        return strcmp(last, "p") == 0 || strcmp(last, "q") == 0 ? BR_KIND_DEGREE : BR_KIND_RATE;
    if (words == 1 && strcmp(last, "k") == 0)
        return BR_KIND_UNKNOWN;
    if (words == 1 && strcmp(last, "red") == 0)
        return BR_KIND_FACTOR;
    for (size_t i = 0; i < sizeof of_kinds / sizeof *of_kinds; i++)
        for (at = name; next_word(&at, word);)
            if (lists(of_kinds[i].words, word))
                return of_kinds[i].kind;
    return strstr(name, "\xc2\xb1") || strstr(name, "+-") ? BR_KIND_DEVIATION
           : strchr(name, '|') || strstr(name, "\\|")     ? BR_KIND_ERROR
                                                          : BR_KIND_UNKNOWN;
}
