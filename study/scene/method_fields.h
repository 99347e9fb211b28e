/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fields of a method, one row each. By these rows a method is read and written the same way on
 * the command line, in a scene's `verify` part, in the names of `trade`, in reports and in JSON. */
#ifndef BR_STUDY_SCENE_METHOD_FIELDS_H
#define BR_STUDY_SCENE_METHOD_FIELDS_H

#include "base/words.h"
#include "orders/expectation/setting.h"
#include "solver/method.h"

enum br_method_key {
    BR_METHOD_SCHEME,
    BR_METHOD_TOLERANCE,
    BR_METHOD_DEGREE,
    BR_METHOD_SOLVER,
    BR_METHOD_KERNEL,
    BR_METHOD_CONTACT,
    BR_METHOD_FRICTION,
    BR_METHOD_FRICTION_PARAMETER,
    BR_METHOD_FRICTION_TOLERANCE,
    BR_METHOD_FIELDS
};

struct br_method_field {
    const char *name;            /* of the option */
    const char *title;           /* in a sentence: "time scheme" */
    const char *argument, *help; /* of the option, for the help; argument NULL: no option */
    double (*get)(const struct br_method *m); /* a number, or a row of the words */
    void (*set)(struct br_method *m, double value);
    const char *key;              /* of scenes and JSON; NULL: the name */
    const char *more;             /* sentences for the manual; or NULL */
    const char *standard;         /* the default in words; NULL: br_method_default's value */
    const struct br_words *words; /* the values are its rows; NULL: numbers of the range */
    struct br_number_range range;
    double (*below)(const struct br_method *m); /* an upper limit; or NULL */
    enum br_method_key by; /* the field whose value decides whether this one is used */
    bool (*in)(const struct br_scene *scene); /* whether the scene models it; NULL: always */
    const char *before, *after;               /* the text around the value in a sentence */
    bool quiet;                               /* left out of sentences where it is the default */
    bool unsaid;                /* a property of the machine: a scene cannot choose it */
    const char *group, *member; /* its object in JSON, and its key there; or NULL */
    const char *const *word;    /* of the values in names ("p2"); ends with NULL. NULL: the words */
};

extern const struct br_method_field br_method_fields[BR_METHOD_FIELDS];

/* How a field is written: --axial-degree, axial_degree. */
enum br_method_style { BR_METHOD_OPTION, BR_METHOD_IN_SCENE };

enum { BR_METHOD_VALUE = 64, BR_METHOD_TEXT = 512 };

/* The field's name as a key: axial_degree. */
static inline const char *br_method_field_key(const struct br_method_field *f)
{
    return f->key ? f->key : f->name;
}

/* Writes the value, to its last bit; returns text (out). */
const char *br_method_field_text(const struct br_method_field *f, const struct br_method *m,
                                 char text[BR_METHOD_VALUE]);

/* Whether another field decides if this one is used. */
static inline bool br_method_field_depends(const struct br_method_field *f)
{
    return f != &br_method_fields[f->by];
}

/* Whether it is used. */
bool br_method_field_used(const struct br_method_field *f, const struct br_method *m);

bool br_methods_equal(const struct br_method *a, const struct br_method *b);

/* Reads one field into *m (in/out). Fails with BR_BAD_INPUT: what was found and expected, without
 * the field's name. */
enum br_status br_method_field_read(const struct br_method_field *f, const char *text,
                                    struct br_method *m, struct br_error *err);

/* Reads the given fields (text not NULL) into *m (in/out), in their order. If the contact rule is
 * not given and does not go with the scheme, the scheme's own rule replaces it. Fails with
 * BR_BAD_INPUT, naming field, value and what was expected, or fields that do not go together. */
enum br_status br_method_read(const char *const text[BR_METHOD_FIELDS], enum br_method_style style,
                              struct br_method *m, struct br_error *err);

/* Refuses (BR_BAD_INPUT) a given field that none of `count` methods uses. */
enum br_status br_method_check_used(const char *const text[BR_METHOD_FIELDS],
                                    enum br_method_style style,
                                    const struct br_method *const *method, size_t count,
                                    struct br_error *err);

/* A scene and the meshes that a method is used on, by their numbers of elements. Borrowed. */
struct br_meshes {
    const struct br_scene *scene;
    const size_t *n;
    size_t count;
};

/* Writes which linear solver is used on the meshes: "plain"; "plain and riccati" if those of axial
 * and bending differ; "plain at n = 8, 16; riccati at n = 100" if those of meshes differ. Returns
 * text (out). */
const char *br_method_taken(const struct br_meshes *on, const struct br_method *m,
                            char text[BR_METHOD_TEXT]);

/* The settings of a method on its meshes (out): the fields, in their order, and "solver_taken". */
void br_method_settings(const struct br_meshes *on, const struct br_method *m,
                        struct br_settings *settings);

/* Writes "scheme euler, solver auto: riccati on avx2, contact lagged, friction none"; "none" is not
 * modelled by the scene. Fields that the method does not use are left out. Returns text (out). */
const char *br_method_text(const struct br_meshes *on, const struct br_method *m,
                           char text[BR_METHOD_TEXT]);

/* Writes " --scheme bdf2 --tolerance 1e-06": the options that are not the default and have an
 * effect in the scene, each after a blank. Returns text (out). */
const char *br_method_options(const struct br_scene *scene, const struct br_method *m,
                              char text[BR_METHOD_TEXT]);

#endif
