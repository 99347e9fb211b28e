/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/provenance.h"

#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

#include "base/quote.h"
#include "base/text.h"
#include "build_info.h"

static char *command_line, machine[512], date[32];

const char *br_version(void)
{
    return BR_VERSION;
}

void br_print_version(const char *program)
{
    printf("%s %s (%s)\n%s\n", program, BR_VERSION, BR_COMMIT, BR_LIBRARIES);
}

const char *br_command_line(void)
{
    return command_line ? command_line : "";
}

enum br_status br_remember_command_line(int argc, const char **argv, struct br_error *err)
{
    size_t size;
    free(command_line);
    command_line = NULL;
    FILE *text = br_text_open(&command_line, &size);
    for (int i = 0; text && i < argc; i++)
        br_print(text, &br_for_shell, i ? " %s" : "%s", argv[i]);
    return text && fclose(text) == 0 ? BR_OK : br_no_memory(err, "the command line");
}

/* The processor's name from Linux, or "". */
static void find_processor(char *name, size_t size)
{
    name[0] = '\0';
    FILE *file = fopen("/proc/cpuinfo", "r");
    char line[256];
    while (file && fgets(line, sizeof line, file)) {
        const char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) != 0 || !colon)
            continue;
        snprintf(name, size, "%s", colon + 2);
        name[strcspn(name, "\n")] = '\0';
        break;
    }
    if (file)
        fclose(file);
}

void br_provenance_fill(struct br_provenance *p, int threads)
{
    const time_t now = time(NULL);
    struct tm utc;
    struct utsname system;
    char processor[256];
    gmtime_r(&now, &utc);
    strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", &utc);
    find_processor(processor, sizeof processor);
    if (uname(&system) < 0)
        memset(&system, 0, sizeof system);
    snprintf(machine, sizeof machine, "%.32s %.64s %.32s, %s, %ld cores", system.sysname,
             system.release, system.machine, processor, sysconf(_SC_NPROCESSORS_ONLN));
    *p = (struct br_provenance){
        .version = BR_VERSION,
        .commit = BR_COMMIT,
        .compiler = BR_COMPILER,
        .flags = BR_FLAGS,
        .command_line = br_command_line(),
        .machine = machine,
        .date = date,
        .threads = threads,
    };
}
