/* SPDX-License-Identifier: GPL-3.0-or-later */
/* SHA-256 of bytes and files. */
#ifndef BR_BASE_SHA256_H
#define BR_BASE_SHA256_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Of a stream of bytes: start it, add to it, end it once. */
struct br_sha256 {
    uint32_t state[8];
    uint64_t length; /* bytes so far */
    unsigned char block[64];
};

enum { BR_SHA256_TEXT = 65 }; /* 64 hexadecimal digits, as sha256sum prints them */

void br_sha256_start(struct br_sha256 *s);
void br_sha256_add(struct br_sha256 *s, const void *bytes, size_t count);
void br_sha256_add_text(struct br_sha256 *s, const char *text); /* with its final zero */
void br_sha256_end(struct br_sha256 *s, char text[BR_SHA256_TEXT]);

/* All at once. */
void br_sha256_of(const void *bytes, size_t count, char text[BR_SHA256_TEXT]);

/* The sum of an open file, from its position to its end. false: reading failed, see
 * errno. */
bool br_sha256_file(int file, char text[BR_SHA256_TEXT]);

#endif
