/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scene format as the program tells it: `beamrate scenes`, its template and its JSON schema
 * follow the reader's table of keys. */
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli_driver.h"
#include "study/scene/file.h"
#include "study/scene/schema.h"
#include "support.h"

static struct cli_outcome out;

/* ---- the schema ---- */

static json_t *load_schema(void)
{
    cli_run_line("scenes --schema", NULL, &out);
    assert_int_equal(out.exit_code, 0);
    json_t *schema = json_loads(out.output, JSON_REJECT_DUPLICATES, NULL);
    assert_non_null(schema);
    return schema;
}

/* The mapping of a section. */
static json_t *section_of(json_t *schema, const char *section)
{
    json_t *properties = json_object_get(schema, "properties");
    return *section ? json_object_get(properties, section) : schema;
}

static bool is_required(json_t *section, const char *name)
{
    size_t i;
    json_t *value;
    json_array_foreach(json_object_get(section, "required"), i, value)
    {
        if (strcmp(json_string_value(value), name) == 0)
            return true;
    }
    return false;
}

static void check_key(json_t *schema, const struct br_scene_key *k)
{
    json_t *section = section_of(schema, k->section);
    json_t *property = json_object_get(json_object_get(section, "properties"), k->name);
    if (!property)
        fail_msg("the schema has no %s %s", k->section, k->name);
    assert_true(json_is_false(json_object_get(section, "additionalProperties")));
    assert_int_equal(is_required(section, k->name), k->need == BR_REQUIRED && !k->law);
    const char *text = json_string_value(json_object_get(property, "description"));
    assert_non_null(text);
    assert_non_null(strstr(text, k->help));
    assert_non_null(strstr(text, k->unit));
}

/* A property for each key, and none beyond. */
static void test_schema_has_every_key(void **state)
{
    (void)state;
    json_t *schema = load_schema();
    size_t keys = 0, properties = 0;
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++, keys++)
        check_key(schema, k);
    const char *name;
    json_t *value;
    json_object_foreach(json_object_get(schema, "properties"), name, value)
    {
        properties++;
        if (strcmp(name, "verify") != 0)
            properties += json_object_size(json_object_get(value, "properties"));
    }
    assert_int_equal(properties, keys);
    json_decref(schema);
}

/* The names that a key may have are those of a registry. */
static void check_names(json_t *study, const char *key, const char *const *names)
{
    json_t *list =
        json_object_get(json_object_get(json_object_get(study, "properties"), key), "enum");
    size_t count = 0;
    for (; names[count]; count++)
        assert_string_equal(json_string_value(json_array_get(list, count)), names[count]);
    assert_int_equal(json_array_size(list), count);
}

static void test_schema_has_every_method(void **state)
{
    (void)state;
    json_t *schema = load_schema();
    json_t *studies = json_object_get(section_of(schema, "verify"), "properties");
    assert_int_equal(json_object_size(studies), BR_VERIFY_KINDS);
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++) {
        json_t *study = json_object_get(studies, br_verify_names[kind]);
        const char *names[16] = {0};
        for (size_t i = 0; br_linear_solvers[i]; i++)
            names[i] = br_linear_solvers[i]->name;
        check_names(study, "solver", names);
        for (size_t i = 0; br_time_schemes[i]; i++)
            names[i] = br_time_schemes[i]->name;
        check_names(study, "scheme", names);
        for (const struct br_norm *const *n = br_norms; *n; n++)
            for (int part = 0; part < BR_PARTS; part++) {
                char key[64];
                snprintf(key, sizeof key, "%s %s", (*n)->name, br_part_names[part]);
                assert_non_null(json_object_get(json_object_get(study, "properties"), key));
            }
    }
    json_decref(schema);
}

/* ---- the template ---- */

/* A line of the template with a key's name, its unit and its meaning. */
static bool explains(const char *text, const struct br_scene_key *k)
{
    char begin[64];
    snprintf(begin, sizeof begin, "%s:", k->name);
    for (const char *at = text; (at = strstr(at, begin)); at++) {
        const size_t length = strcspn(at, "\n");
        char line[512];
        snprintf(line, sizeof line, "%.*s", (int)length, at);
        const bool has_unit = strcmp(k->unit, "1") == 0 || strstr(line, k->unit);
        const bool has_default = strstr(line, "default: ");
        if (strstr(line, k->help) && has_unit &&
            (k->kind == BR_KEY_VERIFY ||
             has_default == (k->need == BR_OPTIONAL || k->need == BR_MAKES)))
            return true;
    }
    return false;
}

static void test_template(void **state)
{
    (void)state;
    cli_expect("scenes --new fresh.yaml", NULL, 0, "");
    cli_run_line("scenes --new -", NULL, &out);
    assert_int_equal(out.exit_code, 0);
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++)
        if (!explains(out.output, k))
            fail_msg("the template does not explain %s %s", k->section, k->name);
    char path[512];
    struct br_scene scene;
    struct br_error err = {0};
    cli_path("fresh.yaml", path);
    MUST(br_scene_read(path, &scene, &err));
    assert_true(scene.axial.modelled && scene.bending.modelled && scene.contact.modelled);
    br_scene_clear(&scene);
    cli_expect("study fresh.yaml --n 5,10 --k 0.1,0.05 --reference none --quiet --no-plots --out f",
               NULL, 0, "");
}

/* What is there stays as it is. */
static void test_template_replaces_nothing(void **state)
{
    (void)state;
    cli_write_file("mine.yaml", "title: mine\n");
    cli_expect("scenes --new mine.yaml", NULL, 2,
               "--new: mine.yaml is there already and is not replaced");
    assert_true(cli_file_contains("mine.yaml", "title: mine\n"));
    cli_expect("scenes --new nowhere/at/all.yaml", NULL, 2, "--new");
}

/* ---- the bundled scenes ---- */

/* Each has its line and its reason: the comment that it begins with. */
static void test_list(void **state)
{
    (void)state;
    static struct cli_outcome list;
    char **name;
    size_t count;
    struct br_error err = {0};
    MUST(br_scene_list(&name, &count, &err));
    assert_true(count >= 28);
    cli_run_line("scenes", NULL, &list);
    assert_int_equal(list.exit_code, 0);
    for (size_t i = 0; i < count; i++) {
        char line[128];
        snprintf(line, sizeof line, "scenes %s", name[i]);
        cli_run_line(line, NULL, &out);
        assert_int_equal(out.exit_code, 0);
        assert_true(strncmp(out.output, "# ", 2) == 0);
        char *title = strstr(out.output, "\ntitle: ");
        assert_non_null(title);
        title += strlen("\ntitle: ");
        title[strcspn(title, "\n")] = '\0';
        if (!strstr(list.output, title) || !strstr(list.output, name[i]))
            fail_msg("the list does not have %s: %s", name[i], title);
    }
    br_scene_list_free(name, count);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_schema_has_every_key),
        cmocka_unit_test(test_schema_has_every_method),
        cmocka_unit_test(test_template),
        cmocka_unit_test(test_template_replaces_nothing),
        cmocka_unit_test(test_list),
    };
    return cmocka_run_group_tests(tests, cli_make_folder, cli_remove_folder);
}
