/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What headings may mean. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/words.h"
#include "orders/reading/roles.h"

enum { LONGEST = 200 };

/* Names in small letters without other characters, and log odds of what they state. */
static const struct {
    const char *column;
    double odds;
    const char *names;
} of_sizes[] = {
    {"h", 5,
     " h dx dy \xce\x94x \xe2\x88\x86x deltax meshsize meshwidth elementsize elsize cellsize gridspacing meshspacing "
     "spacing hmax maxh hmin minh hmean havg hx hy meshh gridwidth cellwidth "
     "hsize steph stepwidth elementlength lc gitterweite maschenweite 步长h 网格尺寸 "},
    {"h", 1.75, " gridsize size mesh grid resolution delta stepsize chanh 步长 "},
    {"n", 5,
     " nx ny cellsperside elementsperside inverseh invh hinv invdx 1overh gridresolution nxny "
     "numel1d cellsperdim samples nsamples samplesize paths npaths "},
    {"n", 4,
     " n nel nelements resolution intervals subdivisions nsub ndivisions divisions numintervals "
     "nintervals nn "},
    {"n", 4, " ncell "},
    {"n", 2, " grid mesh gridsize size m ne nex nez "},
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
    {"cells", 1.75, " grid mesh gridsize size volumes ncell ne "},
    {"k", 4, " k "},
    {"dt", 4,
     " dt \xce\x94t \xe2\x88\x86t deltat timestep timestepsize stepsize tau \xcf\x84 timestepdt maxdt dtmax "
     "deltatime timeincrement timestepwidth timesteplength 步长 时间步长 "},
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
    {BR_KIND_FACTOR,
     " ratio ratios reduction factor factors quotient gci asymptotic extrapolated extrapolation "
     "stride "},
    {BR_KIND_COST,
     " time times cpu wall walltime seconds sec secs runtime iter iters its iteration iterations "
     "setup rhs solve solver assemble assembly mb gb mib gib nnz nonzeros threads ranks procs cores "
     "cycle index row memory mem ram newton gmres cg nit niter flops cost elapsed ms step id idx "
     "date timestamp run_id speedup took zeit tol tolerance atol rtol "},
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

/* Whether one of the words of a name is in a list. */
static bool has_word(const char *name, const char *words)
{
    char word[LONGEST];
    while (next_word(&name, word))
        if (lists(words, word))
            return true;
    return false;
}

/* The last word of a name (out); returns how many it has. */
static size_t last_word(const char *name, char last[LONGEST])
{
    char word[LONGEST];
    size_t words = 0;
    for (*last = '\0'; next_word(&name, word); words++)
        strcpy(last, word);
    return words;
}

/* A name without the words that say nothing: "number of cells", "max h". */
static void without_fill(const char *name, char text[LONGEST])
{
    static const char fill[] = " num number no of max min avg mean average total count the in nb "
                               "nr global mesh grid values list array ";
    char word[LONGEST];
    size_t length = 0;
    while (next_word(&name, word))
        if (!lists(fill, word) && length + strlen(word) < LONGEST) {
            strcpy(text + length, word);
            length += strlen(word);
        }
    text[length] = '\0';
}

static bool is_unit_of(enum br_axis axis, const char *unit)
{
    return unit &&
           lists(axis == BR_AXIS_SPACE ? " m dm mm cm km um nm pm ft in deg \xc2\xb5m \xce\xbcm "
                                         "metres meters "
                                       : " s ms us ns \xc2\xb5s \xce\xbcs ps min ",
                 unit);
}

/* A name without its plural, "hs", "mesh_sizes", as lists have it, in place; false: there is none,
 * or it is a unit, "ms", or a quotient, "h/s". */
static bool make_singular(char text[LONGEST], const char *name)
{
    const size_t length = strlen(text);
    const bool is_plural = length > 1 && text[length - 1] == 's' && !strchr(name, '/') &&
                           (!is_unit_of(BR_AXIS_TIME, text) || strcmp(name, "Ns") == 0);
    text[length - is_plural] = '\0';
    return is_plural;
}

/* A name with its letter, "mesh width h", without it; false: there is none, or another one. */
static bool without_letter(char text[LONGEST], const char *name, const char *column)
{
    char last[LONGEST];
    last_word(name, last);
    const size_t length = strlen(text), end = strlen(last);
    if (strcmp(last, column) != 0 || length <= end || strcmp(text + length - end, last) != 0)
        return false;
    text[length - end] = '\0';
    return true;
}

/* "N per direction", "cells along x": n; "steps per period": steps. NULL: nothing of the kind, as
 * "time per step". */
static const char *of_a_part(const char *name)
{
    char last[LONGEST];
    if (!has_word(name, " per along across through direction side dim edge ") ||
        last_word(name, last) < 2)
        return NULL;
    return has_word(name, " steps timesteps nsteps nt ") ? "steps"
           : br_kind_of(name) == BR_KIND_COST            ? NULL
                                                         : "n";
}

/* The odds that a list gives a plain name; *most: of any column. */
static double listed_odds(const char *plain_name, const char *column, double *most)
{
    double best = -9;
    for (size_t i = 0; i < sizeof of_sizes / sizeof *of_sizes; i++) {
        if (!lists(of_sizes[i].names, plain_name))
            continue;
        *most = fmax(*most, of_sizes[i].odds);
        if (strcmp(of_sizes[i].column, column) == 0)
            best = fmax(best, of_sizes[i].odds);
    }
    return best;
}

/* The column that a formula of another gives: "1/N", "sqrt(1/N)" and "dofs^(-1/2)" are an h; "1/h"
 * and "sqrt(cells)" an n. NULL: the name is no such formula. */
static const char *formula_of(const char *name)
{
    char text[LONGEST], base[LONGEST];
    const char *at = strchr(name, '=') ? strchr(name, '=') + 1 : name;
    size_t length = 0;
    for (; *at && length + 1 < LONGEST; at++)
        if (*at == '*')
            text[length] = '^', length += !length || text[length - 1] != '^';
        else if (!strchr(" \\{}$()", *at))
            text[length++] = (char)tolower((unsigned char)*at);
    text[length] = '\0';
    at = text;
    bool inverse = br_takes(&at, "frac1"), root = br_takes(&at, "sqrt") || br_takes(&at, "cbrt");
    inverse |= br_takes(&at, "1/");
    root |= br_takes(&at, "sqrt") || br_takes(&at, "cbrt");
    snprintf(base, sizeof base, "%.*s", (int)strcspn(at, "^/"), at);
    at += strlen(base);
    if (br_takes(&at, "^")) {
        inverse |= br_takes(&at, "-");
        if (br_takes(&at, "1/2") || br_takes(&at, "1/3") || br_takes(&at, "1/d") ||
            br_takes(&at, "0.5"))
            root = true;
        else if (!br_takes(&at, "1") || !inverse)
            return NULL;
    }
    if (*at || !(inverse || root))
        return NULL;
    plain(base, text);
    double most = 0;
    for (const struct br_resolution_column *c = br_resolution_columns; c->name; c++) {
        const bool time = c->axis == BR_AXIS_TIME;
        if (listed_odds(text, c->name, &most) < (c->is_size ? 4 : 1.5) || c->is_power)
            continue;
        if (c->is_size)
            return !inverse || root ? NULL : time ? "steps" : "n";
        return inverse ? time ? "dt" : "h" : c->is_volume && !lists(" n m ", text) ? "n" : NULL;
    }
    return NULL;
}

bool br_is_unit(const char *text)
{
    return is_unit_of(BR_AXIS_SPACE, text) || is_unit_of(BR_AXIS_TIME, text) ||
           lists(" N kN Pa kPa MPa GPa K J W kW V kV mV A mA kg rad Hz ", text);
}

/* "grid_spacing_m": without the unit of length or time at its end. False: it has none. */
static bool without_unit(const char *name, char text[LONGEST])
{
    char word[LONGEST];
    const char *end = strrchr(name, '_');
    end = end ? end : strrchr(name, ' ');
    if (!end || end == name)
        return false;
    plain(end, word);
    snprintf(text, LONGEST, "%.*s", (int)(end - name), name);
    return is_unit_of(BR_AXIS_SPACE, word) || is_unit_of(BR_AXIS_TIME, word);
}

/* "normalized spacing", "average cell width". */
static bool has_spacing(const char *name)
{
    return has_word(name, " spacing ") || (has_word(name, " mesh grid cell element zone ") &&
                                           has_word(name, " width size length "));
}

/* A length that is called a resolution or a grid is a size. */
static bool is_length(const char *name, const char *unit)
{
    double most = 0;
    char text[LONGEST], last[LONGEST];
    plain(name, text);
    last_word(name, last);
    return is_unit_of(BR_AXIS_SPACE, unit) &&
           (listed_odds(text, "h", &most) > 0 || lists(" step basesize ", text) ||
            strcmp(last, "resolution") == 0);
}

char *br_unit_behind_slash(char *name)
{
    char unit[LONGEST], *slash = strrchr(name, '/');
    if (!slash || slash == name)
        return NULL;
    char *at = slash + 1 + strspn(slash + 1, " {$\\");
    at += strncmp(at, "mathrm{", 7) == 0 ? 7 : strncmp(at, "text{", 5) == 0 ? 5 : 0;
    at[strcspn(at, " }$")] = *slash = '\0';
    snprintf(unit, sizeof unit, "%s", at);
    for (const struct br_resolution_column *c = br_resolution_columns; c->name; c++)
        if (c->is_size && is_unit_of(c->axis, unit) &&
            br_name_odds(name, unit, c) >= BR_USUAL_NAME) {
            while (slash[-1] == ' ')
                *--slash = '\0';
            return at;
        }
    return NULL;
}

double br_name_odds(const char *name, const char *unit, const struct br_resolution_column *column)
{
    const double unknown = column->axis == BR_AXIS_TIME ? -9 : 0.5, definite = 5, excluded = -2,
                 of_a_word = 1.5; /* less than of all: "macro subdivisions" */
    enum { LEAST = 4 };           /* letters of such a word */
    char whole[LONGEST], bare[LONGEST], stripped[LONGEST];
    double best = -9, most = 0;
    if (!name)
        return unknown;
    const char *is = formula_of(name);
    if (!is && without_unit(name, stripped)) {
        unit = name + strlen(stripped) + 1;
        name = stripped;
    }
    is = is ? is : of_a_part(name);
    is = is ? is : is_length(name, unit) ? "h" : NULL;
    plain(name, whole);
    without_fill(name, bare);
    if (!is) {
        best = listed_odds(whole, column->name, &most);
        best = most > 0 ? best : listed_odds(bare, column->name, &most);
        if (!(most > 0) && (without_letter(bare, name, "h") || make_singular(bare, name)))
            best = listed_odds(bare, column->name, &most);
        if (!(most > 0) && make_singular(whole, name))
            best = listed_odds(whole, column->name, &most);
        if (!(most > 0) && has_spacing(name))
            is = "h";
        if (!(most > 0) && !is && last_word(name, bare) > 1 && strlen(bare) >= LEAST &&
            br_kind_of(name) == BR_KIND_UNKNOWN)
            best = listed_odds(bare, column->name, &most) - of_a_word;
    }
    if (is)
        return strcmp(column->name, is) == 0 ? definite : fmin(excluded, unknown);
    return best > 0 ? best : most >= definite ? fmin(excluded, unknown) : unknown;
}

double br_size_name_odds(const char *name)
{
    double most = BR_ANY_NAME;
    for (const struct br_resolution_column *c = br_resolution_columns; c->name; c++)
        most = fmax(most, br_name_odds(name, NULL, c));
    return most;
}

bool br_is_summary(const char *text)
{
    return has_word(text,
                    " richardson extrapolated extrapolation gci exact reference theory theoretical "
                    "analytical expected asymptotic limit mean average order ");
}

/* A field that says that there is no number, beside those that number.c knows. */
bool br_is_gap(const char *text)
{
    char small[LONGEST];
    plain(text, small);
    return strcmp(text, ".") == 0 || strspn(text, "?") == strlen(text) ||
           lists(
               " \xce\xb5 eps epsilon diverged diverges div notconverged noconvergence nc fail failed "
               "failure dnf oom timeout tbd ",
               small);
}

const struct br_cost_row br_costs[BR_COSTS] = {
    [BR_COST_CPU] = {" cpu cputime ", "processor time", "s"},
    [BR_COST_WALL] = {" wall walltime elapsed wallclock ", "wall time", "s"},
    [BR_COST_TIME] = {" time seconds sec secs s runtime zeit ms ", "time", "s"},
    [BR_COST_DOFS] = {" dofs dof ndofs ndof unknowns ", "dofs", ""},
    [BR_COST_ITERATIONS] = {" iterations iteration iters iter its nit niter ", "iterations", ""},
    [BR_COST_MEMORY] = {" memory mem ram mb gb mib gib ", "peak memory", "MB"},
};

static const char logarithms[] = " log log2 log10 ln lg ";

bool br_is_logarithm(const char *name)
{
    char first[LONGEST], last[LONGEST];
    const char *at = name, *end = name + strlen(name);
    while (end > name && strchr(" )]", end[-1]))
        end--;
    const bool decibels = end - name >= 2 && strncasecmp(end - 2, "db", 2) == 0 &&
                          (end - name == 2 || !isalnum((unsigned char)end[-3]));
    last_word(name, last);
    return decibels || lists(logarithms, last) ||
           (next_word(&at, first) && lists(logarithms, first));
}

enum br_cost br_cost_of(const char *name, const char *unit, double *factor)
{
    static const struct {
        const char *names;
        double factor;
        bool of_time;
    } units[] = {
        {" s sec secs seconds ", 1, true},
        {" ms ", 1e-3, true},
        {" \xc2\xb5s us ", 1e-6, true},
        {" ns ", 1e-9, true},
        {" min ", 60, true},
        {" h hours ", 3600, true},
        {" b bytes ", 1e-6, false},
        {" kb ", 1e-3, false},
        {" mb ", 1, false},
        {" gb ", 1e3, false},
        {" kib ", 0x1p10 * 1e-6, false},
        {" mib ", 0x1p20 * 1e-6, false},
        {" gib ", 0x1p30 * 1e-6, false},
    };
    const size_t all = sizeof units / sizeof *units;
    char word[LONGEST], last[LONGEST] = "";
    bool part = br_is_logarithm(name); /* "time per step", "log10 cpu" */
    enum br_cost found = BR_COSTS;
    for (const char *at = name; next_word(&at, word); strcpy(last, word)) {
        part |= lists(" per ", word);
        for (enum br_cost i = 0; i < found; i++)
            found = lists(br_costs[i].words, word) ? i : found;
    }
    if (unit)
        plain(unit, last);
    *factor = found == BR_COST_MEMORY ? 1e-6 : 1;
    if (found == BR_COSTS || part || (found != BR_COST_DOFS && br_kind_of(name) != BR_KIND_COST))
        return BR_COSTS;
    const bool of_time = found <= BR_COST_TIME;
    for (size_t i = 0; i < all && (of_time || found == BR_COST_MEMORY); i++)
        if (units[i].of_time == of_time && lists(units[i].names, last)) {
            *factor = units[i].factor;
            return found;
        }
    return unit && *unit ? BR_COSTS : found; /* another unit */
}

bool br_is_samples(const char *name)
{
    char text[LONGEST];
    without_fill(name, text);
    return lists(" samples nsamples samplesize paths npaths ", text);
}

bool br_is_no_number_of_points(const char *name)
{
    static const char *const others[] = {"cell", "elem",   "interval", "divi", "nel",
                                         "inv",  "sample", "path",     "over"};
    char text[LONGEST];
    plain(name ? name : "", text);
    bool is = name && formula_of(name);
    for (size_t i = 0; i < sizeof others / sizeof *others && !is; i++)
        is = strstr(text, others[i]);
    return is;
}

bool br_is_coefficient(const char *name)
{
    char text[LONGEST];
    plain(name, text);
    const bool letters = *text == 'c' && text[1] && strchr("dlfmp", text[1]);
    return (letters && strspn(text + 2, "pvfd0123456789") == strlen(text + 2)) ||
           lists(" drag lift nusselt strouhal ", text);
}

bool br_says_error(const char *name)
{
    return has_word(name, " error errors err rmse mse mae rms difference diff fehler erreur errore "
                          "erro defect semi ") ||
           (*name == 'e' && !isalpha((unsigned char)name[1])) || strcmp(name, "E") == 0 ||
           strchr(name, '-');
}

bool br_is_prediction(const char *name)
{
    return has_word(name, " expected predicted theoretical ideal ");
}

bool br_is_residual(const char *name)
{
    return has_word(name, " residual residuals res resid residuum ") &&
           !has_word(name, " error errors err ");
}

static bool begins_as_error(const char *name)
{
    char word[LONGEST];
    return next_word(&name, word) && lists(" e err error errors ", word);
}

int br_power_in(const char *name, char base[20])
{
    const size_t length = strcspn(name, "^*0123456789 ");
    const char *at = name + length + strspn(name + length, "^*{ ");
    if (!length || length >= 20 || *at < '2' || *at > '4' || at[1 + strspn(at + 1, "} ")])
        return 0;
    snprintf(base, 20, "%.*s", (int)length, name);
    return *at - '0';
}

enum br_kind br_kind_of(const char *name)
{
    char word[LONGEST], last[LONGEST];
    if (!name)
        return BR_KIND_UNKNOWN;
    const char *at;
    const size_t words = last_word(name, last);
    if (words == 1 && lists(" r o p q o1 o2 oh l2r ", last))
        return strcmp(last, "p") == 0 || strcmp(last, "q") == 0 ? BR_KIND_DEGREE : BR_KIND_RATE;
    if (words == 1 && strcmp(last, "k") == 0)
        return BR_KIND_UNKNOWN;
    if (words == 1 && strcmp(last, "red") == 0)
        return BR_KIND_FACTOR;
    enum br_kind found = BR_KIND_UNKNOWN; /* "error_mb", "time_error": an error */
    for (size_t i = 0; i < sizeof of_kinds / sizeof *of_kinds; i++) {
        bool is_first = true; /* "e_u" is an error, N_e is none; "e_sigma" is that of a stress */
        for (at = name; next_word(&at, word); is_first = false)
            if (lists(of_kinds[i].words, word) && (is_first || strcmp(word, "e") != 0) &&
                (strcmp(word, "sigma") != 0 || !begins_as_error(name)) &&
                (!found || (found == BR_KIND_COST && lists(" error errors err fehler ", word))))
                found = of_kinds[i].kind;
    }
    if ((!found || found == BR_KIND_ERROR) && br_is_logarithm(name))
        return BR_KIND_LOGARITHM;
    return found                                               ? found
           : strstr(name, "\xc2\xb1") || strstr(name, "+-")    ? BR_KIND_DEVIATION
           : strchr(name, '|') || strstr(name, "\xe2\x80\x96") ? BR_KIND_ERROR
                                                               : BR_KIND_UNKNOWN;
}
