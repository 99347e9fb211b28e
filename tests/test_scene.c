/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scene files: every refusal names line, key, what was found and what was expected; the
 * bundled scenes hold the paper's data. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study/extremes/beam_mode.h"
#include "study/scene/expression.h"
#include "study/scene/file.h"
#include "study/scene/schema.h"
#include "support.h"

static enum br_status read_text(const char *text, struct br_scene *scene, struct br_error *err)
{
    return br_scene_read(br_test_scene_file(text), scene, err);
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

/* One line spoilt, and what the message must say: where (line and key), and what. */
static const struct {
    size_t line;
    const char *replacement;
    size_t told; /* the line in the message */
    const char *key, *text;
} refusals[] = {
    /* keys */
    {4, "weight: 1e-4 kg/m", 4, "weight",
     "unknown key, expected one of: title, remark, length, duration, density, mass_density, young, area, inertia, section, axial, bending, contact, friction"},
    {7, "  damping: 1 N s", 7, "damping",
     "unknown key in axial, expected one of: stiffness, viscosity, relaxation_time, damping_ratio, load, tip_force, solution, displacement, velocity"},
    {14, "  stiffness: 0 m", 14, "stiffness",
     "found '0 m', which is a length, expected a force per length, as N/m"},
    {3, "length: 1 s", 3, "length", "given twice"},
    {13, "axial:", 13, "axial", "given twice"},
    {19, "  coefficient: 1 N/m", 19, "coefficient", "given twice"},
    {1, NULL, 1, "title", "missing, expected one line for a person"},
    {2, NULL, 1, "length", "missing, expected the beam's length L, in m"},
    {3, NULL, 1, "duration", "missing"},
    {4, NULL, 1, "density", "missing"},
    {6, NULL, 5, "stiffness", "missing in axial, expected a1, in N, or young * area to make it"},
    {11, NULL, 9, "viscosity",
     "missing in bending, expected c2, in N m^2 s, or relaxation_time * stiffness to make it"},
    {14, NULL, 14, "gap", "missing in contact, expected g, in m"},
    {17, NULL, 17, "law", "missing in friction, expected tresca or coulomb"},
    {18, NULL, 17, "coefficient",
     "missing in friction, expected c_V of Coulomb's law, or without unit c_V/c_H, in N/m"},
    {17, "  law: tresca", 17, "bound", "missing in friction, expected c_V of Tresca's law, in N"},
    {19, "  bound: 3000 N", 17, "bound", "does not belong to this friction law"},
    {17, "  law: dry", 17, "law", "found 'dry', expected tresca or coulomb"},
    {1, "? [a, b]\n: 1", 1, "scene", "a key must be a word"},
    {5, "axial: 3\nspare:", 5, "axial", "expected a mapping of keys to values"},
    {2, "length: [1 m]", 2, "length", "found a list or a mapping, expected the beam's length L"},
    {1, "title: {a: b}", 1, "title", "found a list or a mapping"},
    /* numbers and their units */
    {2, "length: 1", 2, "length", "found '1', expected a number and its unit, m"},
    {2, "length: 1 mn", 2, "length",
     "found '1 mn', expected a number and its unit, m, or another unit of a length, made of m s g "
     "N Pa J bar t min h % in inch ft lb lbf kip psi ksi, with prefixes from n to T"},
    {2, "length: 1 m m", 2, "length", "found '1 m m', which is an area, expected a length, as m"},
    {2, "length: 1 1 m", 2, "length", "found '1 1 m', expected a number and its unit, m"},
    {2, "length: 1 2 m", 2, "length", "found '1 2 m', expected a number and its unit, m"},
    {2, "length: 1 kkm", 2, "length", "found '1 kkm', expected a number and its unit, m"},
    {2, "length: 1 m^", 2, "length", "found '1 m^', expected a number and its unit, m"},
    {2, "length: 1 m^12", 2, "length", "found '1 m^12', expected a number and its unit, m"},
    {2, "length: 1 m*", 2, "length", "found '1 m*', expected a number and its unit, m"},
    {2, "length: 1 /m", 2, "length", "found '1 /m', expected a number and its unit, m"},
    {2, "length: 1 (m)", 2, "length", "found '1 (m)', expected a number and its unit, m"},
    {2, "length: 0x10 mm'", 2, "length", "found '0x10 mm'', expected a number and its unit"},
    {2, "length: 1e308 Tm", 2, "length", "found '1e308 Tm', expected a finite number"},
    {2, "length: 1e-323 nm", 2, "length", "found 1e-323 nm, expected a value > 0 m"},
    {3, "duration: 1 J/N s", 3, "duration", "found '1 J/N s', expected a number and its unit, s"},
    {3, "duration: 1 s/m/m", 3, "duration", "expected a number and its unit, s"},
    {3, "duration: 1 s/(m", 3, "duration", "expected a number and its unit, s"},
    {3, "duration: 1 s^2/kg", 3, "duration", "which is m^0 s^2 kg^-1, expected a time, as s"},
    {4, "density: 1 g/cm^3", 4, "density",
     "found '1 g/cm^3', which is a mass per volume, expected a mass per length, as kg/m"},
    {2, "length: 1m", 2, "length", "found '1m', expected a finite number in m"},
    {2, "length: long m", 2, "length", "found 'long m', expected a finite number in m"},
    {2, "length:", 2, "length", "found '', expected a finite number in m"},
    {2, "length: 1,5 m", 2, "length", "found '1,5 m', expected a finite number in m"},
    {2, "length: nan m", 2, "length", "found 'nan m', expected a finite number in m"},
    {2, "length: inf m", 2, "length", "found 'inf m', expected a finite number in m"},
    {2, "length: -inf m", 2, "length", "expected a finite number"},
    {2, "length: 1e999 m", 2, "length", "expected a finite number"},
    {2, "length: 0 m", 2, "length", "found 0 m, expected a value > 0 m"},
    {2, "length: -1 m", 2, "length", "found -1 m, expected a value > 0 m"},
    {3, "duration: 0 s", 3, "duration", "expected a value > 0 s"},
    {4, "density: -1e-4 kg/m", 4, "density", "expected a value >= 0 kg/m"},
    {6, "  stiffness: -1 N", 6, "stiffness", "expected a value >= 0 N"},
    {7, "  viscosity: -1 N s", 7, "viscosity", "expected a value >= 0 N s"},
    {10, "  stiffness: 1000 N", 10, "stiffness",
     "found '1000 N', which is a force, expected a force times an area, as N m^2"},
    {14, "  gap: -0.1 m", 14, "gap", "expected a value >= 0 m"},
    {15, "  stiffness: -1 N/m", 15, "stiffness", "expected a value >= 0 N/m"},
    {18, "  coefficient: -1 N/m", 18, "coefficient", "expected a value >= 0 N/m"},
    {19, "  regularisation: -1 m/s", 19, "regularisation", "expected a value >= 0 m/s"},
    /* expressions */
    {8, "  load: 400*(exp(t) - 1)", 8, "load",
     "expected an expression and its unit, like 'x*t [N/m]'"},
    {8, "  load: 400*(exp(t) - 1) [N]", 8, "load",
     "which is a force, expected a force per length, as N/m"},
    {8, "  load: 400*t [N/m", 8, "load", "expected an expression and its unit, like 'x*t [N/m]'"},
    {8, "  load: 400*t []", 8, "load", "expected an expression and its unit, like 'x*t [N/m]'"},
    {8, "  load: 400*t [newton]", 8, "load",
     "found '400*t [newton]', expected a number and its unit, N/m, or another unit of a force per length"},
    {8, "  load: 1) + (2 [kN/m]", 8, "load", "'1) + (2' is no expression in x and t"},
    {8, "  load: 400*(exp(t) - [N/m]", 8, "load", "'400*(exp(t) -' is no expression in x and t"},
    {8, "  load: x=1 [N/m]", 8, "load", "it assigns; a comparison is =="},
    {8, "  load: x, t [N/m]", 8, "load", "it is more than one, separated by commas"},
    {8, "  load: y*t [N/m]", 8, "load", "'y*t' is no expression in x and t"},
    {8, "  load: \"[N/m]\"", 8, "load", "is no expression in x and t"},
    {8, "  load: 1/0 [N/m]", 8, "load", "expected a finite number"},
    {8, "  load: sqrt(-1) [N/m]", 8, "load", "expected a finite number"},
    {8, "  load: [1, 2]", 8, "load", "found a list or a mapping"},
    {8, "  load: {shape: \"x [1]\"}", 8, "load",
     "expected 'shape: F(x) [1]' and 'history: G(t) [N/m]'"},
    {8, "  load: {history: \"t [N/m]\"}", 8, "load",
     "expected 'shape: F(x) [1]' and 'history: G(t) [N/m]'"},
    {8, "  load: {shape: \"t [1]\", history: \"t [N/m]\"}", 8, "load",
     "expected an expression without t"},
    {8, "  load: {shape: \"x [1]\", history: \"x [N/m]\"}", 8, "load",
     "expected an expression without x"},
    {8, "  load: {shape: \"x [N/m]\", history: \"t [1]\"}", 8, "load",
     "which is a force per length, expected a number without unit, as 1"},
    {8, "  load: {form: \"x [1]\", history: \"t [N/m]\"}", 8, "load", "found 'form', expected"},
    {8, "  load: {shape: \"x [1]\", shape: \"x [1]\"}", 8, "load", "'shape' is given twice"},
    {8, "  load: {shape: [1], history: \"t [N/m]\"}", 8, "load", "expected 'shape"},
    {8, "  displacement: x*t [m]", 8, "displacement",
     "found 'x*t [m]', expected an expression without t"},
    {8, "  tip_force: x*t [N]", 8, "tip_force",
     "found 'x*t [N]', expected an expression without x"},
    {12, "  tip_moment: t [N]", 12, "tip_moment",
     "which is a force, expected a force times a length, as N m"},
    /* what makes others */
    {18, "  coefficient: 0.3 N", 18, "coefficient",
     "which is a force, expected a force per length, as N/m, or a number without unit"},
    {18, "  coefficient: 5e6", 18, "coefficient",
     "found 5e+06 without unit, expected at most 10: was N/m forgotten?"},
    {18, "  coefficient: -0.3", 18, "coefficient", "expected a value >= 0"},
    {7, "  damping_ratio: 2", 7, "damping_ratio",
     "found 2 without unit, expected at most 1: was % forgotten?"},
    {7, "  viscosity: 1 N s\n  damping_ratio: 0.02", 7, "viscosity",
     "is given beside damping_ratio (line 8), which makes viscosity, too, expected one of the two"},
    {11, "  relaxation_time: 1 ms\n  damping_ratio: 0.02", 11, "relaxation_time",
     "is given beside damping_ratio (line 12), which makes relaxation_time, too"},
    {1, "title: T\nyoung: 210 GPa\nsection: circle 1 cm", 8, "stiffness",
     "is given beside young (line 2), which makes stiffness, too, expected one of the two"},
    {1, "title: T\nyoung: 210 GPa\ninertia: 1 cm^4", 12, "stiffness", "beside young (line 2)"},
    {1, "title: T\nmass_density: 1 kg/m^3\narea: 1 cm^2", 6, "density",
     "is given beside mass_density (line 2), which makes density, too"},
    {1, "title: T\narea: 1 cm^2\nsection: circle 1 cm", 2, "area",
     "is given beside section (line 3), which makes area, too"},
    {1, "title: T\narea: 1 cm^2", 2, "area", "makes nothing here, expected what it goes with"},
    {1, "title: T\nyoung: 210 GPa", 2, "young", "makes nothing here, expected what it goes with"},
    {1, "title: T\nsection: circle 1 cm", 2, "section", "makes nothing here, expected what"},
    {1, "title: T\nyoung: 210 kN", 2, "young",
     "which is a force, expected a force per area, as Pa"},
    {1, "title: T\nsection: circle 1 cm x 1 cm", 2, "section",
     "found 'circle 1 cm x 1 cm', expected rectangle WIDTH x HEIGHT, circle DIAMETER or tube"},
    {1, "title: T\nsection: rectangle 1 cm", 2, "section", "found 'rectangle 1 cm', expected"},
    {1, "title: T\nsection: square 1 cm", 2, "section", "found 'square 1 cm', expected"},
    {1, "title: T\nsection: rectangle 1 cm x 0 cm", 2, "section",
     "found 'rectangle 1 cm x 0 cm', expected lengths above 0"},
    {1, "title: T\nsection: rectangle 20 x 5 mm", 2, "section", "expected a number and its unit"},
    {1, "title: T\nsection: circle 1 kg", 2, "section", "which is a mass, expected a length"},
    {1, "title: T\nsection: tube 10 mm x 5 mm", 2, "section", "the wall of a tube below"},
    /* initial data */
    {8, "  displacement: 1 + x [m]", 8, "displacement",
     "initial axial displacement is 1 at x = 0, expected 0 where the beam is clamped"},
    {8, "  displacement: x + step(x - 0.3) [m]", 8, "displacement",
     "initial axial displacement jumps by 1 at x = 0.3 m, expected a continuous one"},
    {8, "  displacement: \"x < 0.123456789 ? x : 1.001*x [m]\"", 8, "displacement",
     "initial axial displacement jumps by 0.000123457 at x = 0.123456789 m"},
    {12, "  displacement: x^2 + 1e-6*step(x - 0.3001) [m]\n  displacement_slope: 2*x [1]", 12,
     "displacement", "initial bending displacement jumps by 1e-06 at x = 0.3001 m"},
    {12, "  displacement: max(0, x - 0.3) [m]\n  displacement_slope: step(x - 0.3) [1]", 13,
     "displacement_slope", "initial displacement_slope jumps by 1 at x = 0.3 m"},
    {8, "  velocity: cos(x) [m/s]", 8, "velocity", "initial axial velocity is 1 at x = 0"},
    {8, "  velocity: x/(x - 0.5) [m/s]", 8, "velocity",
     "found inf at x = 0.5 m, expected a finite number everywhere in [0, L]"},
    {12, "  displacement: x^2 [m]", 12, "displacement",
     "initial bending displacement needs displacement_slope, its derivative"},
    {12, "  velocity: x^2 [m/s]", 12, "velocity",
     "initial bending velocity needs velocity_slope, its derivative"},
    {12, "  displacement: x^2 [m]\n  displacement_slope: 3*x [1]", 13, "displacement_slope",
     "expected the derivative of bending displacement there"},
    {12, "  displacement: x [m]\n  displacement_slope: 1 [1]", 13, "displacement_slope",
     "initial displacement_slope is 1 at x = 0"},
    {12, "  velocity: x^2 [m/s]\n  velocity_slope: 2*x - 1e-3 [1/s]", 13, "velocity_slope",
     "initial velocity_slope is -0.001 at x = 0"},
    {12, "  velocity: x^2 [m/s]\n  velocity_slope: 2*x*(1 + 1e-4*x) [1/s]", 13, "velocity_slope",
     "expected the derivative of bending velocity there"},
    {12, "  displacement: x^2 [m]\n  displacement_slope: 2*x/(x < 0.3) [1]", 13,
     "displacement_slope", "expected a finite number everywhere in [0, L]"},
    /* not a number, or none, somewhere */
    {8, "  load: 1/(1 - t) [N/m]", 8, "load",
     "found inf at t = 1 s, expected a finite number everywhere in [0, T]"},
    {8, "  load: x*log(0.5 - t) [N/m]", 8, "load",
     "found -inf at t = 0.5 s, expected a finite number everywhere in [0, T]"},
    {8, "  load: log(0.5 + x - t) [N/m]", 8, "load",
     "at x = 0 m, t = 0.5 s, expected a finite number everywhere in [0, L] and [0, T]"},
    {8, "  load: {shape: \"1/x [1]\", history: \"t [N/m]\"}", 8, "load",
     "found inf at x = 0 m, expected a finite number everywhere in [0, L]"},
    {8, "  load: {shape: \"x [1]\", history: \"sqrt(0.25 - t) [N/m]\"}", 8, "load",
     "found nan at t = 0.5 s, expected"},
    {12, "  tip_moment: 1/t [N m]", 12, "tip_moment", "found inf at t = 0 s, expected"},
    {8, "  tip_force: exp(2000*t) [N]", 8, "tip_force", "found inf at t = 0.5 s, expected"},
};

TEST(test_refusals)
{
    for (size_t i = 0; i < sizeof refusals / sizeof *refusals; i++) {
        char text[4096], where[160];
        spoilt(refusals[i].line, refusals[i].replacement, text, sizeof text);
        br_test_scene_refused(text, false, refusals[i].text);
        snprintf(where, sizeof where, ".yaml:%zu: %s: ", refusals[i].told, refusals[i].key);
        br_test_scene_refused(text, false, where);
    }
}

/* Whole files: not YAML, or parts that mean nothing without another. */
#define TOP "title: t\nlength: 1 m\nduration: 1 s\ndensity: 1 kg/m\n"
#define AXIAL "axial: {stiffness: 1 N, viscosity: 1 N s}\n"
#define BENDING "bending: {stiffness: 1 N m^2, viscosity: 1 N m^2 s}\n"
#define CONTACT "contact: {gap: 0 m, stiffness: 1 N/m}\n"
static const struct {
    const char *text, *message;
} files[] = {
    {"", ":1: scene: the file is empty"},
    {"# nothing\n", ":1: scene: the file is empty"},
    {"just words\n", ":1: scene: expected a mapping of keys to values"},
    {"- a\n- b\n", ":1: scene: expected a mapping of keys to values"},
    {"title: \"t\n", "not YAML: "},
    {"title: t\nlength: {1 m\nduration: 1 s\n", "not YAML: "},
    {"title: t\n\tlength: 1 m\n", ":2: not YAML: "},
    {TOP, "neither axial nor bending is modelled"},
    {TOP BENDING "friction: {law: coulomb, coefficient: 1 N/m}\n",
     "Coulomb friction takes its bound from the contact, which is not modelled"},
    {TOP AXIAL BENDING "friction: {law: coulomb, coefficient: 0.3}\n",
     "Coulomb friction takes its bound from the contact, which is not modelled"},
    {TOP AXIAL CONTACT "friction: {law: tresca, bound: 1 N}\n",
     "friction needs the bending part, which is not modelled"},
    {TOP BENDING CONTACT, "contact needs the axial part, which is not modelled"},
    {TOP "axial: {stiffness: 0 N, viscosity: 0 N s}\n",
     "axial: stiffness plus viscosity is 0, expected a finite number > 0"},
    {TOP "bending: {stiffness: 0 N m^2, viscosity: 0 N m^2 s}\n",
     "bending: stiffness plus viscosity is 0"},
    {TOP "axial: {stiffness: 1e308 N, viscosity: 1e308 N s}\n", "stiffness plus viscosity is inf"},
    {"title: t\nlength: 1 m\nduration: 1 s\n" AXIAL,
     ":1: density: missing, expected mass per length rho, in kg/m, or mass_density * area to make it"},
    {"title: t\nlength: 1 m\nduration: 1 s\ndensity: 0 kg/m\n"
     "axial: {stiffness: 1 N, damping_ratio: 0.1}\n",
     ":5: damping_ratio: makes no number of relaxation_time, expected a stiffness and a density"},
    {"title: t\nlength: 1 m\nduration: 1 s\naxial: {stiffness: 1 N, damping_ratio: 0.1}\n",
     ":1: density: missing, expected mass per length rho"},
    {TOP "bending: {stiffness: 0 N m^2, damping_ratio: 0.1}\n",
     ":5: damping_ratio: makes no number of relaxation_time"},
    {TOP "young: 1e290 GPa\narea: 1e10 m^2\naxial: {viscosity: 1 N s}\n",
     ":5: young: makes no number of stiffness"},
    {TOP "young: 1e-200 GPa\narea: 1e-150 m^2\naxial: {viscosity: 1 N s}\n",
     ":5: young: makes no number of stiffness"},
};

TEST(test_files)
{
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        br_test_scene_refused(files[i].text, false, files[i].message);
}

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
        struct br_error err = {0};
        struct br_scene scene;
        char text[400];
        snprintf(text, sizeof text, TOP "axial:\n  stiffness: 1 N\n  viscosity: 1 N s\n%s",
                 bent[i]);
        MUST(read_text(text, &scene, &err));
        br_scene_clear(&scene);
    }
}

/* A byte that is not UTF-8, and a file cut anywhere: refused or read, never a crash. */
TEST(test_mangled)
{
    char text[4096];
    struct br_error err = {0};
    struct br_scene scene;
    spoilt(0, NULL, text, sizeof text);
    const size_t length = strlen(text);
    for (size_t cut = 0; cut < length; cut++) {
        char copy[4096];
        memcpy(copy, text, cut);
        copy[cut] = '\0';
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
    struct br_error err = {0};
    struct br_scene scene;
    REFUSED(br_scene_read("/nowhere/at/all.yaml", &scene, &err), BR_BAD_INPUT, "/nowhere/at/all");
    br_scene_clear(&scene);
    REFUSED(br_scene_read("/tmp", &scene, &err), BR_BAD_INPUT, "/tmp");
    br_scene_clear(&scene);
    char found[1024];
    const char *path = br_test_scene_file("");
    REFUSED(br_scene_find("example9", found, sizeof found, &err), BR_BAD_INPUT,
            "scene 'example9' is no file and no bundled scene");
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
    struct br_scene s = br_test_bundled(paper[i].name);
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
    br_scene_clear(&s);
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
        struct br_error err = {0};
        struct br_scene s;
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
        br_scene_clear(&s);
    }
}

TEST(test_good_initial_data)
{
    struct br_error err = {0};
    struct br_scene s;
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
    br_scene_clear(&s);
}

/* tau omega/2 of the lowest mode that finite elements have. */
TEST(test_damping_ratio)
{
    const double most[] = {[BR_AXIAL] = 5e-5, [BR_BENDING] = 1e-7}; /* of eight elements */
    struct br_error err = {0};
    struct br_scene s;
    MUST(read_text("title: T\nlength: 30 cm\nduration: 1 s\nyoung: 70 GPa\n"
                   "mass_density: 2.7 g/cm^3\nsection: tube 20 mm x 1 mm\n"
                   "axial: {damping_ratio: 2 %}\nbending: {damping_ratio: 0.02}\n",
                   &s, &err));
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        struct br_beam_mode mode;
        MUST(br_beam_mode_find(&mode, &s, (enum br_field_kind)kind, &err));
        const double tau = kind == BR_AXIAL ? s.axial.viscosity / s.axial.stiffness
                                            : s.bending.viscosity / s.bending.stiffness;
        CLOSE(tau * mode.omega / 2, 0.02, most[kind]);
    }
    br_scene_clear(&s);
}

/* A clone lives on without its source, and is another instance. */
TEST(test_clone)
{
    struct br_error err = {0};
    struct br_function f = br_test_function("x + 10*t"), copy;
    MUST(br_function_clone(&f, &copy, &err));
    assert_true(copy.self != f.self && copy.uses_x && copy.uses_t);
    br_function_free(&f);
    const double x[] = {1, 2, 3};
    double value[3];
    br_function_evaluate(&copy, 3, x, 0.5, value);
    for (int i = 0; i < 3; i++)
        CLOSE(value[i], x[i] + 5, 0);
    br_function_free(&copy);
    br_function_free(&copy);
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
        struct br_error err = {0};
        MUST(br_scene_check(&s, &err));
        for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
            const double value = *numbers[i];
            *numbers[i] = bad[b];
            REFUSED(br_scene_check(&s, &err), BR_BAD_INPUT, "expected a finite number");
            *numbers[i] = value;
        }
    }
}
