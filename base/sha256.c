/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/sha256.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* FIPS 180-4, section 6.2, with its names. */

static const uint32_t K[64] = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

static uint32_t rotate(uint32_t x, int n)
{
    return x >> n | x << (32 - n);
}

/* W: the message schedule. */
static void expand(const unsigned char block[64], uint32_t W[64])
{
    for (int t = 0; t < 16; t++)
        W[t] = (uint32_t)block[4 * t] << 24 | (uint32_t)block[4 * t + 1] << 16 |
               (uint32_t)block[4 * t + 2] << 8 | block[4 * t + 3];
    for (int t = 16; t < 64; t++) {
        const uint32_t a = W[t - 15], b = W[t - 2];
        W[t] = (rotate(b, 17) ^ rotate(b, 19) ^ b >> 10) + W[t - 7] +
               (rotate(a, 7) ^ rotate(a, 18) ^ a >> 3) + W[t - 16];
    }
}

/* h: a to h of the standard. */
static void compress(uint32_t state[8], const unsigned char block[64])
{
    uint32_t W[64], h[8];
    expand(block, W);
    memcpy(h, state, sizeof h);
    for (int t = 0; t < 64; t++) {
        const uint32_t a = h[0], e = h[4];
        const uint32_t choice = (e & h[5]) ^ (~e & h[6]);
        const uint32_t majority = (a & h[1]) ^ (a & h[2]) ^ (h[1] & h[2]);
        const uint32_t first =
            h[7] + (rotate(e, 6) ^ rotate(e, 11) ^ rotate(e, 25)) + choice + K[t] + W[t];
        const uint32_t second = (rotate(a, 2) ^ rotate(a, 13) ^ rotate(a, 22)) + majority;
        memmove(h + 1, h, 7 * sizeof *h);
        h[4] += first;
        h[0] = first + second;
    }
    for (int i = 0; i < 8; i++)
        state[i] += h[i];
}

void br_sha256_start(struct br_sha256 *s)
{
    *s = (struct br_sha256){.state = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f,
                                      0x9b05688c, 0x1f83d9ab, 0x5be0cd19}};
}

void br_sha256_add(struct br_sha256 *s, const void *bytes, size_t count)
{
    const unsigned char *from = bytes;
    while (count) {
        const size_t used = s->length % 64, room = 64 - used, piece = count < room ? count : room;
        memcpy(s->block + used, from, piece);
        s->length += piece;
        from += piece;
        count -= piece;
        if (s->length % 64 == 0)
            compress(s->state, s->block);
    }
}

void br_sha256_add_text(struct br_sha256 *s, const char *text)
{
    br_sha256_add(s, text, strlen(text) + 1);
}

void br_sha256_end(struct br_sha256 *s, char text[BR_SHA256_TEXT])
{
    static const unsigned char padding[64] = {0x80};
    const uint64_t bits = 8 * s->length;
    unsigned char size[8];
    for (int i = 0; i < 8; i++)
        size[i] = (unsigned char)(bits >> (56 - 8 * i));
    br_sha256_add(s, padding, 1 + (119 - s->length % 64) % 64);
    br_sha256_add(s, size, sizeof size);
    for (int i = 0; i < 8; i++)
        snprintf(text + 8 * i, 9, "%08x", s->state[i]);
}

void br_sha256_of(const void *bytes, size_t count, char text[BR_SHA256_TEXT])
{
    struct br_sha256 sum;
    br_sha256_start(&sum);
    br_sha256_add(&sum, bytes, count);
    br_sha256_end(&sum, text);
}

bool br_sha256_file(int file, char text[BR_SHA256_TEXT])
{
    struct br_sha256 sum;
    char piece[1 << 15];
    ssize_t got;
    br_sha256_start(&sum);
    while ((got = read(file, piece, sizeof piece)) != 0) {
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return false;
        br_sha256_add(&sum, piece, (size_t)got);
    }
    br_sha256_end(&sum, text);
    return true;
}
