/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a method is made of, a row each. By these rows a method is read and said the same way on the
 * command line, in a scene's `verify` part, in the names of `trade`, in reports and in JSON. */
#ifndef BR_STUDY_SCENE_METHOD_FIELDS_H
#define BR_STUDY_SCENE_METHOD_FIELDS_H

#include "solver/method.h"
#include "study/scene/words.h"

enum br_method_key {
    BR_METHOD_SCHEME,
    BR_METHOD_TOLERANCE,
    BR_METHOD_DEGREE,
    BR_METHOD_SOLVER,
    BR_METHOD_KERNEL,
    BR_METHOD_SCALING,
    BR_METHOD_REFINEMENT,
    BR_METHOD_CONTACT,
    BR_METHOD_FRICTION,
    BR_METHOD_FRICTION_PARAMETER,
    BR_METHOD_FRICTION_TOLERANCE,
    BR_METHOD_FRICTION_ITERATIONS,
    BR_METHOD_FIELDS
};

/* A word that stands for a value in the names of methods: "p2". */
struct br_method_word {
    const char *word;
    double value;
};

struct br_method_field {
    const char *name;                         /* of the option */
    const char *title;                        /* in a sentence: "time scheme" */
    const char *argument, *help;              /* of the option, for the help */
    double (*get)(const struct br_method *m); /* a number, or a row of the words */
    void (*set)(struct br_method *m, double value);
    const char *key;              /* of scenes and JSON; NULL: the name */
    const char *more;             /* sentences for the manual; or NULL */
    const char *standard;         /* the default in words; NULL: br_method_default's value */
    const struct br_words *words; /* the values are its rows; NULL: numbers of the range */
    struct br_number_range range;
    double (*below)(const struct br_method *m); /* an upper end of the method's own; or NULL */
    enum br_method_key by; /* the field whose value decides whether this one is used */
    bool (*in)(const struct br_scene *scene); /* whether the scene models it; NULL: always */
    const char *before, *after;               /* what stands around the value in a sentence */
    bool quiet;                               /* not said where it is the default */
    bool unsaid;                              /* of the machine: not a scene's to choose */
    const char *group, *member;               /* where JSON has it in an object; or NULL */
    const struct br_method_word *word;        /* in names; ends with NULL. NULL: there are none */
    const char *words_title;                  /* of those words */
};

extern const struct br_method_field br_method_fields[BR_METHOD_FIELDS];

/* Where a field is named: --axial-degree, axial_degree. */
enum br_method_style { BR_METHOD_OPTION, BR_METHOD_IN_SCENE };

enum { BR_METHOD_VALUE = 64, BR_METHOD_TEXT = 512 };

/* The field's name as a key: axial_degree. */
static inline const char *br_method_field_key(const struct br_method_field *f)
{
    return f->key ? f->key : f->name;
}

/* The value, to its last bit; returns text (out). */
const char *br_method_field_text(const struct br_method_field *f, const struct br_method *m,
                                 char text[BR_METHOD_VALUE]);

/* Whether another field's value decides whether it is used; whether it is. */
bool br_method_field_depends(const struct br_method_field *f);
bool br_method_field_heeded(const struct br_method_field *f, const struct br_method *m);

/* Whether a report gives its value: the method uses it, or it is the default and has no effect. */
bool br_method_field_reported(const struct br_method_field *f, const struct br_method *m);

bool br_methods_equal(const struct br_method *a, const struct br_method *b);

/* Reads one field into *m (in/out). Fails with BR_BAD_INPUT: what was found and expected, without
 * the field's name. */
enum br_status br_method_field_read(const struct br_method_field *f, const char *text,
                                    struct br_method *m, struct br_error *err);

/* Reads the fields that are given (text not NULL) into *m (in/out), in their order, and lets the
 * contact rule, if it is not given, follow a scheme that cannot do with it. Fails with
 * BR_BAD_INPUT, naming field, value and what was expected, or what does not go together. */
enum br_status br_method_read(const char *const text[BR_METHOD_FIELDS], enum br_method_style style,
                              struct br_method *m, struct br_error *err);

/* Refuses (BR_BAD_INPUT) a given field that none of `count` methods uses: it is not ignored. */
enum br_status br_method_check_heeded(const char *const text[BR_METHOD_FIELDS],
                                      enum br_method_style style,
                                      const struct br_method *const *method, size_t count,
                                      struct br_error *err);

/* What a method is used on: a scene, and meshes of so many elements. Borrowed. */
struct br_meshes {
    const struct br_scene *scene;
    const size_t *n;
    size_t count;
};

/* The linear solver that marches the meshes: "plain"; of both fields "plain and riccati", axial and
 * bending, where these differ; "plain at n = 8, 16; riccati at n = 100" where meshes do. Returns
 * text (out). */
const char *br_method_taken(const struct br_meshes *on, const struct br_method *m,
                            char text[BR_METHOD_TEXT]);

/* "scheme euler, solver auto: riccati on avx2, contact lagged, friction none": what the scene does
 * not model is "none"; what the method does not use is left out. Returns text (out). */
const char *br_method_text(const struct br_meshes *on, const struct br_method *m,
                           char text[BR_METHOD_TEXT]);

/* " --scheme bdf2 --tolerance 1e-06": the options of what is not the default and does something in
 * the scene, each with a blank before it. Returns text (out). */
const char *br_method_options(const struct br_scene *scene, const struct br_method *m,
                              char text[BR_METHOD_TEXT]);

#endif
