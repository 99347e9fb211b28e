/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/method_fields.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "solver/linear/linear_solver.h"
#include "solver/scene.h"

/* ---- values: rows of a registry, and numbers ---- */

#define CHOICE(member, registry)                                                         \
    BR_WORDS(member, registry)                                                           \
    static const struct br_words member##_words = {member##_name, member##_title, NULL}; \
    static double get_##member(const struct br_method *m)                                \
    {                                                                                    \
        size_t row = 0;                                                                  \
        while ((registry)[row] && (registry)[row] != m->member)                          \
            row++;                                                                       \
        return (double)row;                                                              \
    }                                                                                    \
    static void set_##member(struct br_method *m, double row)                            \
    {                                                                                    \
        m->member = (registry)[(size_t)row];                                             \
    }
CHOICE(scheme, br_time_schemes)
CHOICE(solver, br_linear_solvers)
CHOICE(contact, br_contact_rules)
CHOICE(friction, br_friction_rules)

#define NUMBER(name, member, type)                            \
    static double get_##name(const struct br_method *m)       \
    {                                                         \
        return (double)m->member;                             \
    }                                                         \
    static void set_##name(struct br_method *m, double value) \
    {                                                         \
        m->member = (type)value;                              \
    }
NUMBER(tolerance, tolerance, double)
NUMBER(friction_parameter, iteration.parameter, double)
NUMBER(friction_tolerance, iteration.tolerance, double)

static const char *degree_name(size_t row)
{
    static const char *const degrees[] = {"1", "2", NULL};
    return degrees[row];
}
static const struct br_words degree_words = {degree_name, NULL, NULL};

static double get_degree(const struct br_method *m)
{
    return m->axial_degree - 1;
}

static void set_degree(struct br_method *m, double row)
{
    m->axial_degree = (int)row + 1;
}

static const char *kernel_name(size_t row)
{
    return br_kernels[row] ? br_kernels[row]->name : NULL;
}

static bool kernel_available(size_t row)
{
    return br_kernels[row]->available();
}
static const struct br_words kernels = {kernel_name, NULL, kernel_available};

/* If no kernel is chosen: the best one, which is then used. */
static double get_kernel(const struct br_method *m)
{
    const struct br_kernel *kernel = m->kernel ? m->kernel : br_kernel_best();
    size_t row = 0;
    while (br_kernels[row] && br_kernels[row] != kernel)
        row++;
    return (double)row;
}

static void set_kernel(struct br_method *m, double row)
{
    m->kernel = br_kernels[(size_t)row];
}

/* ---- what a scene models ---- */

static double parameter_below(const struct br_method *m)
{
    return m->friction->iterates ? m->friction->parameter_below : INFINITY;
}

static bool has_axial_field(const struct br_scene *scene)
{
    return scene->axial.modelled;
}

static bool has_contact(const struct br_scene *scene)
{
    return scene->contact.modelled;
}

static bool has_friction(const struct br_scene *scene)
{
    return scene->friction.law != BR_FRICTIONLESS;
}

/* ---- the table ---- */

static const char *const degree_names[] = {"p1", "p2", NULL};

#define VALUE(name) .get = get_##name, .set = set_##name

const struct br_method_field br_method_fields[BR_METHOD_FIELDS] = {
    [BR_METHOD_SCHEME] =
        {"scheme", "time scheme", "NAME", "time scheme", VALUE(scheme),
         .more =
             "A march is refused where vibration of too little damping would grow (bdf3), and where forces, displacements or velocities go beyond 1e150 in SI units or are lost to underflow. adaptive chooses its steps and finds the times of switching.",
         .words = &scheme_words, .by = BR_METHOD_SCHEME, .before = "scheme "},
    [BR_METHOD_TOLERANCE] = {"tolerance", "tolerance", "X",
                             "error a step of an adaptive scheme, relative to the largest strain",
                             VALUE(tolerance), .more = "Above 1e-14 and below 1.",
                             .range = {1e-14, 1, false}, .by = BR_METHOD_SCHEME, .before = " to "},
    [BR_METHOD_DEGREE] =
        {"axial-degree", "axial elements", "COUNT", "degree of the axial elements: 1 or 2",
         VALUE(degree), .key = "axial_degree",
         .more =
             "2: quadratic, of order 3 in space and 4 at the tip; solvers riccati and plain. A reference run has the same.",
         .words = &degree_words, .by = BR_METHOD_DEGREE, .in = has_axial_field,
         .before = ", axial elements of degree ", .quiet = true, .word = degree_names},
    [BR_METHOD_SOLVER] = {"solver", "solver", "NAME", "linear solver", VALUE(solver),
                          .words = &solver_words, .by = BR_METHOD_SOLVER, .before = ", solver "},
    [BR_METHOD_KERNEL] = {"kernel", "kernel", "NAME", "instruction set of the solver riccati",
                          VALUE(kernel),
                          .more = "The results record it; those of two kernels agree to round-off.",
                          .standard = "the best", .words = &kernels, .by = BR_METHOD_SOLVER,
                          .before = " on ", .unsaid = true},
    [BR_METHOD_CONTACT] = {"contact", "contact", "NAME", "where contact takes its force",
                           VALUE(contact),
                           .more = "lagged, the paper's, is for the scheme euler alone.",
                           .standard = "the first that goes with the scheme",
                           .words = &contact_words, .by = BR_METHOD_CONTACT, .in = has_contact,
                           .before = ", contact "},
    [BR_METHOD_FRICTION] = {"friction", "friction rule", "NAME", "friction law, or its iteration",
                            VALUE(friction), .words = &friction_words, .by = BR_METHOD_FRICTION,
                            .in = has_friction, .before = ", friction "},
    [BR_METHOD_FRICTION_PARAMETER] =
        {"friction-parameter", "friction parameter", "X",
         "of a friction rule that iterates, over the one that converges fastest",
         VALUE(friction_parameter), .key = "friction_parameter",
         .more =
             "Over 1/z, z being the tip's compliance; penalty-duality converges for all above 0, uzawa below 2.",
         .range = {0, INFINITY, false}, .below = parameter_below, .by = BR_METHOD_FRICTION,
         .in = has_friction, .before = " (parameter ", .group = "iteration", .member = "parameter"},
    [BR_METHOD_FRICTION_TOLERANCE] = {"friction-tolerance", "friction tolerance", "X",
                                      "of such a rule, relative to the friction bound",
                                      VALUE(friction_tolerance), .key = "friction_tolerance",
                                      .range = {1e-14, 1, false}, .by = BR_METHOD_FRICTION,
                                      .in = has_friction, .before = ", to ", .after = ")",
                                      .group = "iteration", .member = "tolerance"},
};

/* ---- one field ---- */

const char *br_method_field_text(const struct br_method_field *f, const struct br_method *m,
                                 char text[BR_METHOD_VALUE])
{
    const double value = f->get(m);
    if (f->words) {
        const char *name = f->words->name((size_t)value);
        snprintf(text, BR_METHOD_VALUE, "%s", name ? name : "unknown");
        return text;
    }
    return br_shortest(value, text, BR_METHOD_VALUE);
}

bool br_method_field_used(const struct br_method_field *f, const struct br_method *m)
{
    return !br_method_field_depends(f)   ? true
           : f->by == BR_METHOD_SCHEME   ? m->scheme->adaptive
           : f->by == BR_METHOD_FRICTION ? m->friction->iterates
                                         : m->solver->takes_kernel;
}

bool br_methods_equal(const struct br_method *a, const struct br_method *b)
{
    for (const struct br_method_field *f = br_method_fields;
         f < br_method_fields + BR_METHOD_FIELDS; f++)
        if (f->get(a) != f->get(b))
            return false;
    return true;
}

enum br_status br_method_field_read(const struct br_method_field *f, const char *text,
                                    struct br_method *m, struct br_error *err)
{
    struct br_number_range range = f->range;
    double value = 0;
    size_t row = 0;
    enum br_status status;
    if (f->words) {
        status = br_words_read(f->words, text, strlen(text), &row, err);
        value = (double)row;
    } else {
        range.high = f->below ? f->below(m) : range.high;
        status = br_read_in_range(text, &range, &value, err);
    }
    if (!status)
        f->set(m, value);
    return status;
}

/* ---- a method ---- */

/* The name of a field as the user writes it. */
static const char *name_of(const struct br_method_field *f, enum br_method_style style,
                           char name[BR_METHOD_VALUE])
{
    if (style == BR_METHOD_IN_SCENE)
        return br_method_field_key(f);
    snprintf(name, BR_METHOD_VALUE, "--%s", f->name);
    return name;
}

enum br_status br_method_read(const char *const text[BR_METHOD_FIELDS], enum br_method_style style,
                              struct br_method *m, struct br_error *err)
{
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++) {
        struct br_error inner = {0};
        char name[BR_METHOD_VALUE];
        if (text[i] && br_method_field_read(&br_method_fields[i], text[i], m, &inner))
            return br_fail(err, inner.status, "%s: %s", name_of(&br_method_fields[i], style, name),
                           inner.message);
    }
    if (!text[BR_METHOD_CONTACT] && !m->scheme->may_lag && !m->contact->at_new_step)
        m->contact = br_contact_rule_of(m->scheme);
    return br_method_check(m, NULL, err);
}

/* ", as --solver riccati does": the first row that uses the field. */
static const char *example(const struct br_method_field *f, enum br_method_style style,
                           char text[2 * BR_METHOD_VALUE])
{
    const struct br_method_field *by = &br_method_fields[f->by];
    struct br_method m = br_method_default();
    char name[BR_METHOD_VALUE];
    text[0] = '\0';
    for (size_t row = 0; !*text && by->words->name(row); row++) {
        by->set(&m, (double)row);
        if (br_method_field_used(f, &m))
            snprintf(text, 2 * BR_METHOD_VALUE, "; %s%s %s does", name_of(by, style, name),
                     style == BR_METHOD_IN_SCENE ? ":" : "", by->words->name(row));
    }
    return text;
}

static enum br_status refuse(const struct br_method_field *f, enum br_method_style style,
                             const struct br_method *const *method, size_t count,
                             struct br_error *err)
{
    const struct br_method_field *by = &br_method_fields[f->by];
    char field[BR_METHOD_VALUE], value[BR_METHOD_VALUE], text[2 * BR_METHOD_VALUE];
    const char *name = name_of(f, style, field);
    if (count == 1)
        return br_fail(err, BR_BAD_INPUT, "%s: %s %s does not use it%s", name, by->title,
                       br_method_field_text(by, method[0], value), example(f, style, text));
    return br_fail(err, BR_BAD_INPUT, "%s: no study here has a %s that uses it%s", name, by->title,
                   example(f, style, text));
}

enum br_status br_method_check_used(const char *const text[BR_METHOD_FIELDS],
                                    enum br_method_style style,
                                    const struct br_method *const *method, size_t count,
                                    struct br_error *err)
{
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++) {
        bool used = !text[i];
        for (size_t j = 0; j < count && !used; j++)
            used = br_method_field_used(&br_method_fields[i], method[j]);
        if (!used)
            return refuse(&br_method_fields[i], style, method, count, err);
    }
    return BR_OK;
}

/* ---- in words ---- */

static bool is_default(const struct br_method_field *f, const struct br_method *m)
{
    struct br_method standard = br_method_default();
    standard.scheme = m->scheme;
    standard.contact = br_contact_rule_of(m->scheme);
    return f == &br_method_fields[BR_METHOD_SCHEME] ? m->scheme == br_time_schemes[0]
                                                    : f->get(m) == f->get(&standard);
}

/* Writes the solver of a mesh: "plain", "plain and riccati". Returns word (out). */
static const char *taken_at(const struct br_meshes *on, const struct br_method *m, size_t n,
                            char word[2 * BR_METHOD_VALUE])
{
    const char *name[2] = {NULL, NULL};
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_field field = br_field_of_scene(on->scene, kind, n, 1, m->axial_degree);
        if (on->scene->field[kind].modelled)
            name[kind] = br_method_solver(m, &field)->name;
    }
    const bool two = name[0] && name[1] && strcmp(name[0], name[1]) != 0;
    snprintf(word, 2 * BR_METHOD_VALUE, "%s%s%s",
             name[0]   ? name[0]
             : name[1] ? name[1]
                       : "none",
             two ? " and " : "", two ? name[1] : "");
    return word;
}

const char *br_method_taken(const struct br_meshes *on, const struct br_method *m,
                            char text[BR_METHOD_TEXT])
{
    char word[2 * BR_METHOD_VALUE], before[2 * BR_METHOD_VALUE] = "none";
    size_t groups = 0;
    text[0] = '\0';
    for (size_t i = 0; i < on->count; i++) {
        const bool other = strcmp(taken_at(on, m, on->n[i], word), before) != 0 || i == 0;
        if (other)
            br_append(text, BR_METHOD_TEXT, "%s%s at n = %zu", i ? "; " : "", word, on->n[i]);
        else
            br_append(text, BR_METHOD_TEXT, ", %zu", on->n[i]);
        groups += other;
        strcpy(before, word);
    }
    if (groups <= 1)
        snprintf(text, BR_METHOD_TEXT, "%s", before);
    return text;
}

/* "" where the method does not use the field. */
static void set_text(const struct br_method_field *f, const struct br_method *m, size_t size,
                     char *text)
{
    char value[BR_METHOD_VALUE] = "";
    if (f->quiet || br_method_field_used(f, m))
        br_method_field_text(f, m, value);
    snprintf(text, size, "%s", value);
}

/* A report without a key is older than it: the method was the default one. The rows of the
 * registries were always there, but for the time schemes. */
void br_method_settings(const struct br_meshes *on, const struct br_method *m,
                        struct br_settings *settings)
{
    _Static_assert((int)BR_METHOD_FIELDS < (int)BR_MOST_SETTINGS, "there is room for all fields");
    const struct br_method standard = br_method_default();
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++) {
        const struct br_method_field *f = &br_method_fields[i];
        const bool whole = i == BR_METHOD_DEGREE || (!f->words && f->range.whole);
        struct br_setting *s = &settings->row[i];
        *s = (struct br_setting){
            .name = f->name,
            .group = f->group,
            .key = f->group ? f->member : br_method_field_key(f),
            .kind = whole      ? BR_SETTING_COUNT
                    : f->words ? BR_SETTING_WORD
                               : BR_SETTING_NUMBER,
            .compared = !f->unsaid,
            .needed = i == BR_METHOD_SOLVER || i == BR_METHOD_CONTACT || i == BR_METHOD_FRICTION,
        };
        set_text(f, &standard, sizeof s->usual, s->usual);
        set_text(f, m, sizeof s->text, s->text);
    }
    struct br_setting *taken = &settings->row[BR_METHOD_FIELDS];
    *taken = (struct br_setting){.key = "solver_taken"};
    br_method_taken(on, m, taken->text);
    settings->count = BR_METHOD_FIELDS + 1;
}

/* The method, with the solver that is used on all meshes if there is only one. The fields that it
 * uses are then known. */
static struct br_method with_taken(const struct br_method *m, const char *taken)
{
    const struct br_linear_solver *solver = br_linear_solver_find(taken);
    struct br_method out = *m;
    out.solver = solver ? solver : m->solver;
    return out;
}

const char *br_method_text(const struct br_meshes *on, const struct br_method *m,
                           char text[BR_METHOD_TEXT])
{
    char value[BR_METHOD_VALUE], taken[BR_METHOD_TEXT];
    const struct br_scene *scene = on->scene;
    const struct br_method used = with_taken(m, br_method_taken(on, m, taken));
    text[0] = '\0';
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++) {
        const struct br_method_field *f = &br_method_fields[i];
        const bool modelled = !f->in || f->in(scene);
        if (!br_method_field_used(f, &used) || (f->quiet && (!modelled || is_default(f, m))) ||
            (br_method_field_depends(f) && !modelled))
            continue;
        br_append(text, BR_METHOD_TEXT, "%s%s%s", f->before,
                  modelled ? br_method_field_text(f, m, value) : "none", f->after ? f->after : "");
        if (i == BR_METHOD_SOLVER && strcmp(value, taken) != 0)
            br_append(text, BR_METHOD_TEXT, ": %s", taken);
    }
    return text;
}

const char *br_method_options(const struct br_scene *scene, const struct br_method *m,
                              char text[BR_METHOD_TEXT])
{
    char value[BR_METHOD_VALUE];
    text[0] = '\0';
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++) {
        const struct br_method_field *f = &br_method_fields[i];
        const bool always = i == BR_METHOD_TOLERANCE; /* the choice of a trade must be visible */
        if ((f->in && !f->in(scene)) || !br_method_field_used(f, m) || f->unsaid || !f->argument ||
            (is_default(f, m) && !always))
            continue;
        br_append(text, BR_METHOD_TEXT, " --%s %s", f->name, br_method_field_text(f, m, value));
    }
    return text;
}
