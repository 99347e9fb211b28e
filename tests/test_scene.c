/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scene files: every refusal names line, key, what was found and what was expected; the
 * bundled scenes hold the paper's data. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study/known/expression.h"
#include "study/scene/file.h"
#include "study/scene/schema.h"
#include "study/scene/statement.h"
#include "study/verify/verify.h"
#include "support.h"

static enum br_status read_text(const char *text, struct br_scene *scene, struct br_error *why)
{
    return br_scene_read(br_test_scene_file(text), scene, why);
}

/* A good scene, which the tables below spoil in one place: lines 1 to 4, axial 5 to 8,
 * bending 9 to 12, contact 13 to 15, friction 16 to 19. */
static const char *const good[] = {
    "title: A scene",
    "length: 1 m",
    "duration: 1 s",
    "density: 1e-4 kg/m",
    "axial:",
    "  stiffness: 1000 N",
    "  viscosity: 1 N s",
    "  load: 400*(exp(t) - 1) [N/m]",
    "bending:",
    "  stiffness: 1000 N m^2",
    "  viscosity: 1 N m^2 s",
    "  load: -10000*(exp(t) - 1) [N/m]",
    "contact:",
    "  gap: 0 m",
    "  stiffness: 1e3 N/m",
    "friction:",
    "  law: coulomb",
    "  coefficient: 5e6 N/m",
    "  regularisation: 1e-10 m/s",
};
enum { LINES = sizeof good / sizeof *good };

/* The good scene with line `line` replaced; NULL: left out. */
static void spoilt(size_t line, const char *replacement, char *text, size_t size)
{
    size_t used = 0;
    for (size_t i = 1; i <= LINES; i++) {
        const char *content = i == line ? replacement : good[i - 1];
        if (content)
            used += (size_t)snprintf(text + used, size - used, "%s\n", content);
    }
}

/* Where the message names line and key, and what it says. */
static void refuse(char *row)
{
    char text[4096], where[160];
    char *instead = br_test_part(row), *at = br_test_part(instead), *says = br_test_part(at);
    const size_t line = strtoul(row, NULL, 10);
    br_test_unescape(instead);
    spoilt(line, *instead ? instead : NULL, text, sizeof text);
    br_test_scene_refused(line ? text : instead, false, br_test_unescape(says));
    snprintf(where, sizeof where, ".yaml:%s: ", at);
    if (*at)
        br_test_scene_refused(text, false, where);
}

TEST(test_refusals)
{
    br_test_rows("scenes", refuse);
}

#define TOP "title: t\nlength: 1 m\nduration: 1 s\ndensity: 1 kg/m\n"

/* Displacements that bend, and velocities that jump, are no displacements that jump. */
TEST(test_bent)
{
    static const char *const bent[] = {"  displacement: max(0, x - 0.4) [m]\n",
                                       "  displacement: min(x, 0.3) [m]\n",
                                       "  displacement: x + abs((x - 0.3)^3) - 0.027 [m]\n",
                                       "  displacement: x*abs(sin(9*x)) [m]\n",
                                       "  displacement: 1e9*(x - 0.7)*step(x - 0.7) [m]\n",
                                       "  velocity: step(x - 0.4) [m/s]\n"};
    for (size_t i = 0; i < sizeof bent / sizeof *bent; i++) {
        OWNED(br_scene) scene;
        char text[400];
        snprintf(text, sizeof text, TOP "axial:\n  stiffness: 1 N\n  viscosity: 1 N s\n%s",
                 bent[i]);
        MUST(read_text(text, &scene, &err));
    }
}

/* A byte that is not UTF-8, and a file cut anywhere: refused or read, never a crash. */
TEST(test_mangled)
{
    char text[4096];
    struct br_scene scene;
    spoilt(0, NULL, text, sizeof text);
    const size_t length = strlen(text);
    for (size_t cut = 0; cut < length; cut++) {
        char copy[4096];
        memcpy(copy, text, cut);
        copy[cut] = '\0';
        err.status = BR_OK;
        if (read_text(copy, &scene, &err))
            assert_int_equal(err.status, BR_BAD_INPUT);
        br_scene_clear(&scene);
        memcpy(copy, text, length + 1);
        copy[cut] = (char)0xff;
        assert_int_equal(read_text(copy, &scene, &err), BR_BAD_INPUT);
        br_scene_clear(&scene);
    }
}

TEST(test_no_file)
{
    struct br_scene scene;
    REFUSED(br_scene_read("/nowhere/at/all.yaml", &scene, &err), BR_BAD_INPUT, "/nowhere/at/all");
    br_scene_clear(&scene);
    REFUSED(br_scene_read("/tmp", &scene, &err), BR_BAD_INPUT, "/tmp");
    br_scene_clear(&scene);
    char found[1024];
    const char *path = br_test_scene_file("");
    REFUSED(br_scene_find("example9", found, sizeof found, &err), BR_BAD_INPUT,
            "'example9' is neither a file nor a bundled scene");
    MUST(br_scene_find(path, found, sizeof found, &err));
    assert_string_equal(found, path);
}

/* ---- good scenes ---- */

/* The data of section 3.2 of the paper. */
static const struct {
    const char *name;
    double duration, axial, bending; /* loads at (x, t) = (0.3, 0.7) */
    enum br_friction_law law;
    double coefficient;
} paper[] = {
    {"example1", 1, 405.5010829881906, -10137.527074704765, BR_COULOMB, 5e6},
    {"example2", 1, 101.37527074704765, -1013.7527074704765, BR_COULOMB, 1e4},
    {"example3", 1, 0, -7000, BR_TRESCA, 3000},
    {"example4", 3, 87.5, 8910.065241883679, BR_COULOMB, 5e4},
};

static void check_paper(size_t i)
{
    OWNED(br_scene) s = br_test_bundled(paper[i].name);
    assert_string_equal(s.name, paper[i].name);
    assert_non_null(strstr(s.title, "Example "));
    assert_true(s.length == 1 && s.duration == paper[i].duration && s.density == 1e-4);
    assert_true(s.bending.modelled && s.bending.stiffness == 1000 && s.bending.viscosity == 1);
    assert_int_equal(s.friction.law, paper[i].law);
    assert_true(s.friction.coefficient == paper[i].coefficient);
    assert_true(s.friction.regularisation == 1e-10);
    CLOSE(br_load_value(&s.bending.load, 0.3, 0.7), paper[i].bending, 1e-8);
    const bool axial = paper[i].law == BR_COULOMB;
    assert_true(s.axial.modelled == axial && s.contact.modelled == axial);
    if (axial) {
        assert_true(s.axial.stiffness == 1000 && s.axial.viscosity == 1);
        assert_true(s.contact.gap == 0 && s.contact.stiffness == 1e3);
        CLOSE(br_load_value(&s.axial.load, 0.3, 0.7), paper[i].axial, 1e-9);
    }
    const struct br_function *initial[] = {&s.axial.displacement, &s.axial.velocity,
                                           &s.bending.displacement, &s.bending.velocity};
    for (size_t f = 0; f < 4; f++)
        assert_true(br_function_is_zero(initial[f]));
}

TEST(test_bundled)
{
    for (size_t i = 0; i < sizeof paper / sizeof *paper; i++)
        check_paper(i);
}

/* Where a load goes: what depends on x is space, what depends on t alone is time. */
static const struct {
    const char *load;
    bool space_x, space_t, time_x, time_t_;
    double value; /* at x = 0.5, t = 2 */
} loads[] = {
    {"7 [N/m]", false, false, false, false, 7},
    {"\"2*pi  [N/m]\"", false, false, false, false, 6.283185307179586},
    {"3*t [N/m]", false, false, false, true, 6},
    {"3*x [N/m]", true, false, false, false, 1.5},
    {"x*t [N/m]", true, false, false, true, 1},
    {"exp(x*t) [N/m]", true, true, false, false, 2.718281828459045},
    {"{shape: \"x^2 [1]\", history: \"expm1(t) [N/m]\"}", true, false, false, true,
     1.5972640247326626},
    {"{history: \"log(e) [N/m]\", shape: \"4 [1]\"}", false, false, false, false, 4},
    {"\"t > 1 ? min(x, 3) : abs(-x) [N/m]\"", true, true, false, false, 0.5},
};

TEST(test_loads)
{
    for (size_t i = 0; i < sizeof loads / sizeof *loads; i++) {
        OWNED(br_scene) s;
        char text[4096], line[256];
        snprintf(line, sizeof line, "  load: %s", loads[i].load);
        spoilt(12, line, text, sizeof text);
        MUST(read_text(text, &s, &err));
        const struct br_load *load = &s.bending.load;
        assert_true(load->term[0].space.uses_x == loads[i].space_x);
        assert_true(load->term[0].space.uses_t == loads[i].space_t);
        assert_true(load->term[0].time.uses_x == loads[i].time_x);
        assert_true(load->term[0].time.uses_t == loads[i].time_t_);
        CLOSE(br_load_value(load, 0.5, 2), loads[i].value, 1e-14);
    }
}

TEST(test_good_initial_data)
{
    OWNED(br_scene) s;
    char text[4096];
    spoilt(12,
           "  displacement: 1 - cos(3*x) [m]\n  displacement_slope: 3*sin(3*x) [1]\n"
           "  velocity: x^3*exp(-x) [m/s]\n  velocity_slope: (3*x^2 - x^3)*exp(-x) [1/s]",
           text, sizeof text);
    MUST(read_text(text, &s, &err));
    assert_true(s.bending.displacement.uses_x && !s.bending.displacement.uses_t);
    assert_true(br_function_is_zero(&s.bending.load.term[0].space) ||
                br_function_is_zero(&s.bending.load.term[0].time)); /* no load is given */
    const double x = 0.4;
    double value;
    br_function_evaluate(&s.bending.velocity_slope, 1, &x, 0, &value);
    CLOSE(value, (3 * x * x - x * x * x) * exp(-x), 1e-15);
}

/* tau omega/2 of the lowest mode: pi/2 of a rod, and of a cantilever the root of 1 + cos cosh. */
TEST(test_damping_ratio)
{
    const double root[] = {[BR_AXIAL] = M_PI_2, [BR_BENDING] = 1.8751040687119611664};
    OWNED(br_scene) s;
    MUST(read_text("title: T\nlength: 30 cm\nduration: 1 s\nyoung: 70 GPa\n"
                   "mass_density: 2.7 g/cm^3\nsection: tube 20 mm x 1 mm\n"
                   "axial: {damping_ratio: 2 %}\nbending: {damping_ratio: 0.02}\n",
                   &s, &err));
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_scene_field *f = &s.field[kind];
        const double omega = pow(root[kind] / s.length, 1 + kind) * sqrt(f->stiffness / s.density);
        CLOSE(f->viscosity / f->stiffness * omega / 2, 0.02, 1e-14);
    }
}

/* Every number of a scene built by hand, as a NaN, an infinity and a negative one. */
TEST(test_check)
{
    static const double bad[] = {NAN, INFINITY, -INFINITY, -1};
    for (size_t b = 0; b < 4; b++) {
        struct br_scene s = br_test_bare();
        s.contact.modelled = true;
        double *const numbers[] = {&s.length,
                                   &s.duration,
                                   &s.density,
                                   &s.axial.stiffness,
                                   &s.axial.viscosity,
                                   &s.bending.stiffness,
                                   &s.bending.viscosity,
                                   &s.contact.gap,
                                   &s.contact.stiffness,
                                   &s.friction.coefficient,
                                   &s.friction.regularisation};
        MUST(br_scene_check(&s, &err));
        for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
            const double value = *numbers[i];
            *numbers[i] = bad[b];
            REFUSED(br_scene_check(&s, &err), BR_BAD_INPUT, "expected a finite number");
            *numbers[i] = value;
        }
    }
}

/* ---- --set ---- */

/* All that the scene says, but for its title. Ends the scene. */
static char *stated(struct br_scene *scene)
{
    struct br_statement statement;
    char *title = scene->title;
    scene->title = NULL;
    br_statement_begin(&statement);
    br_state_scene(&statement, scene);
    char *text = br_statement_end(&statement);
    scene->title = title;
    br_scene_clear(scene);
    assert_non_null(text);
    return text;
}

/* A scene with `set` is that of the file which says the same, and so is the text that it leaves. */
static void try_set(const char *text, const char *set, const char *same)
{
    struct br_scene scene;
    char title[400], *left = NULL;
    const struct br_scene_asked asked = {.set = set, .text = &left};
    MUST(br_scene_parse("file.yaml", same, &(struct br_scene_asked){0}, &scene, &err));
    snprintf(title, sizeof title, "%s, with ", scene.title);
    FREED char *expected = stated(&scene);
    MUST(br_scene_parse("file.yaml", text, &asked, &scene, &err));
    assert_true(strncmp(scene.title, title, strlen(title)) == 0);
    assert_true(strncmp(scene.title + strlen(title), set, strcspn(set, "\n")) == 0);
    assert_string_equal(scene.name, "file");
    char *found = stated(&scene);
    assert_string_equal(found, expected);
    free(found);
    MUST(br_scene_read_text("file.yaml", left, &scene, &err));
    assert_false(strstr(scene.title, set));
    found = stated(&scene);
    assert_string_equal(found, expected);
    free(found);
    free(left);
}

/* The good scene with `set`, and the line that says the same. */
static void try_line(const char *set, size_t line, const char *replacement)
{
    char text[4096], same[4096];
    spoilt(0, NULL, text, sizeof text);
    spoilt(line, replacement, same, sizeof same);
    try_set(text, set, same);
}

#define ROD "axial: {stiffness: 3 N, viscosity: 1 N s}\n"
#define BEAM "bending: {stiffness: 1 N m^2, viscosity: 1 N m^2 s"

/* Units, expressions, words, nested parts and keys that the scene does not have. */
TEST(test_set)
{
    try_line("length=500 mm", 2, "length: 0.5 m");
    try_line("length =  2 m ", 2, "length: 2 m");
    try_line("remark=a: 'b' # [c]", 1, "title: A scene\nremark: \"a: 'b' # [c]\"");
    try_line("friction.coefficient=0.3", 18, "  coefficient: 300 N/m");
    try_line("axial.tip_force=5*sin(t) + exp(-t) [kN]", 7,
             "  viscosity: 1 N s\n  tip_force: 5*sin(t) + exp(-t) [kN]");
    try_set(TOP ROD, "contact.gap=1 mm\ncontact.stiffness=2 kN/m",
            TOP ROD "contact: {gap: 1 mm, stiffness: 2 kN/m}");
    try_set(TOP ROD "friction: {law: tresca, bound: 1 N}\n" BEAM
                    ", load: {shape: 'x [1]', history: 't [N/m]'}}",
            "bending.load.history=t^2 [N/m]\nfriction.bound=2 N\nlength=2 m",
            "title: t\nlength: 2 m\nduration: 1 s\ndensity: 1 kg/m\n" ROD
            "friction: {law: tresca, bound: 2 N}\n" BEAM
            ", load: {shape: 'x [1]', history: 't^2 [N/m]'}}");
    try_set(TOP ROD BEAM ", load: {shape: 'x [1]', history: 't [N/m]'}}",
            "bending.load=x*t^2 [N/m]", TOP ROD BEAM ", load: 'x*t^2 [N/m]'}");
}

/* Directives, tags, blocks, and parts that no reader of a scene reads. */
TEST(test_set_in_yaml)
{
    try_set(
        "%YAML 1.1\n%TAG !e! tag:e.org,2000:\n---\n" TOP ROD
        "remark: !e!r |\n  of two\n  lines\nverify: &v {a: *v, [1, 2]: 3, 'x': !!int 4}\n...\n",
        "length=2 m",
        "remark: \"of two\\nlines\\n\"\ntitle: t\nlength: 2 m\nduration: 1 s\ndensity: 1 kg/m\n" ROD);
}

/* Another place that an alias names keeps its value: of a number, and of a whole part. */
TEST(test_set_aliases)
{
    try_set(
        TOP
        "axial: {stiffness: &a 3 N, viscosity: 1 N s}\nfriction: {law: tresca, bound: *a}\n" BEAM
        "}\n",
        "axial.stiffness=5 N",
        TOP "axial: {stiffness: 5 N, viscosity: 1 N s}\nfriction: {law: tresca, bound: 3 N}\n" BEAM
            "}\n");
    try_set(
        TOP
        "axial: {stiffness: &a 3 N, viscosity: 1 N s}\nfriction: {law: tresca, bound: *a}\n" BEAM
        "}\n",
        "friction.bound=5 N",
        TOP "axial: {stiffness: 3 N, viscosity: 1 N s}\nfriction: {law: tresca, bound: 5 N}\n" BEAM
            "}\n");
    static const char two[] = TOP "axial: {stiffness: 3 N, viscosity: 1 N s, load: &a "
                                  "{shape: 'x [1]', history: 't [N/m]'}}\n" BEAM ", load: *a}\n";
    try_set(
        two, "bending.load.shape=x^2 [1]",
        TOP
        "axial: {stiffness: 3 N, viscosity: 1 N s, load: {shape: 'x [1]', history: 't [N/m]'}}\n" BEAM
        ", load: {shape: 'x^2 [1]', history: 't [N/m]'}}\n");
    try_set(
        two, "axial.load.shape=x^2 [1]",
        TOP
        "axial: {stiffness: 3 N, viscosity: 1 N s, load: {shape: 'x^2 [1]', history: 't [N/m]'}}\n" BEAM
        ", load: {shape: 'x [1]', history: 't [N/m]'}}\n");
}

/* A place is that of --set, or a line of the file and then all that is set. */
TEST(test_sets_refused)
{
    static const struct {
        const char *set, *says;
    } rows[] = {
        {"", "--set: found '', expected KEY=VALUE in UTF-8, like 'contact.stiffness=2e3 N/m'"},
        {"length", "--set: found 'length', expected KEY=VALUE"},
        {"length=1 m\n", "--set: found '', expected KEY=VALUE"},
        {"title=\xff", "expected KEY=VALUE in UTF-8"},
        {"=1", "file.yaml: --set =1: : unknown key, expected one of: title, "},
        {"lenght=1 m",
         "file.yaml: --set lenght=1 m: lenght: unknown key, expected one of: title, remark"},
        {"lenght=1 m", "; did you mean 'length'?"},
        {"contact.gasp=1 m",
         "--set contact.gasp=1 m: gasp: unknown key in contact, expected one of: gap, "
         "stiffness; did you mean 'gap'?"},
        {"length.x=1 m",
         "--set length.x=1 m: length: has a value, expected a mapping of keys to values"},
        {"contact=1", "--set contact=1: contact: expected a mapping of keys to values"},
        {"length=1 N",
         "file.yaml: --set length=1 N: length: found '1 N', which is a force, expected a length"},
        {"length=-1 m", "file.yaml: --set length=-1 m: length: found -1 m, expected a value > 0 m"},
        {"length=", "--set length=: length: found '', expected a finite number in m"},
        {"length=[1 m]",
         "--set length=[1 m]: length: found '[1 m]', expected a finite number in m"},
        {"axial.load=x*t",
         "--set axial.load=x*t: load: found 'x*t', expected an expression and its unit"},
        {"axial.load=y [N/m]", "file.yaml: --set axial.load=y [N/m]: load: "},
        {"length=1 m\nlength =2 m",
         "--set length=1 m and --set length =2 m are given, expected one of the two"},
        {"contact.gap=0 m\ncontact=1", "are given, expected one of the two"},
        {"axial.load=x [N/m]\naxial.load.shape=x", "are given, expected one of the two"},
        {"length=2 m\naxial.damping_ratio=2 %",
         "file.yaml:7: viscosity: is given beside damping_ratio (--set axial.damping_ratio=2 %), which "
         "makes viscosity, too, expected one of the two (with --set length=2 m, --set "
         "axial.damping_ratio=2 %)"},
        {"friction.law=tresca",
         "file.yaml:17: bound: missing in friction, expected c_V of Tresca's law, in N "
         "(with --set friction.law=tresca)"},
        {"young=1 Pa", "--set young=1 Pa: young: has no effect alone"},
        {"verify.space.n=1", "--set verify.space.n=1: verify: only 'beamrate check' uses it"},
    };
    char text[4096];
    spoilt(0, NULL, text, sizeof text);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        OWNED(br_scene) scene;
        char *left = NULL;
        const struct br_scene_asked asked = {.set = rows[i].set, .text = &left};
        REFUSED(br_scene_parse("file.yaml", text, &asked, &scene, &err), BR_BAD_INPUT,
                rows[i].says);
        assert_null(left);
    }
}

/* What is expected is set, too; it has no line in the file then. */
TEST(test_set_expectations)
{
    OWNED(br_scene) scene;
    OWNED(br_verify) verify;
    MUST(br_verify_read("file.yaml",
                        TOP "axial: {stiffness: 3 N, viscosity: 1 N s, load: 'x*t [N/m]'}\n"
                            "verify:\n  space:\n    n: 10, 20, 40, 80, 160\n    k: 0.1 s\n"
                            "    l2: 2 +- 0.1\n",
                        "verify.space.n=5, 10, 20, 40, 80\nverify.space.l2=2 +- 0.2", &scene,
                        &verify, &err));
    const struct br_verify_study *space = &verify.study[BR_VERIFY_SPACE];
    assert_int_equal(space->count, 5);
    assert_int_equal(space->n[0], 5);
    assert_int_equal(space->line, 8);
    assert_int_equal(space->expectations, 1);
    assert_true(space->expectation[0].band.tolerance == 0.2);
    assert_int_equal(space->expectation[0].band.line, 0);
}
