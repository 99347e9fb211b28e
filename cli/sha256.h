/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BR_CLI_SHA256_H
#define BR_CLI_SHA256_H

#include <stddef.h>
#include <stdint.h>

/* SHA-256 (FIPS 180-4) of a stream of bytes: start it, add to it, end it once. */
struct br_sha256 {
    uint32_t state[8];
    uint64_t length; /* bytes so far */
    unsigned char block[64];
};

enum { BR_SHA256_TEXT = 65 };

void br_sha256_start(struct br_sha256 *sum);
void br_sha256_add(struct br_sha256 *sum, const void *bytes, size_t count);

/* text (out): 64 hexadecimal digits, as sha256sum prints them. */
void br_sha256_end(struct br_sha256 *sum, char text[BR_SHA256_TEXT]);

#endif
