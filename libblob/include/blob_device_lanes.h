/* SPDX-License-Identifier: Apache-2.0
 *
 * Part of blob_device.h: loops over blocks of eight neighbours and of eight blobs. Lanes are added
 * and multiplied in the order of libblob's SIMD back ends, so the sums have their bits.
 */
#ifndef LUMEN_BLOB_DEVICE_LANES_H
#define LUMEN_BLOB_DEVICE_LANES_H

#include "blob_device_model.h"

typedef struct blob_device_eight {
  float lanes[8];
} blob_device_eight;

BLOB_DEVICE_FN float blob_device_total(const blob_device_eight* e) {
  return ((e->lanes[0] + e->lanes[2]) + (e->lanes[1] + e->lanes[3])) +
         ((e->lanes[4] + e->lanes[6]) + (e->lanes[5] + e->lanes[7]));
}

/* Index of the lowest bit of eight, of which one is set. */
BLOB_DEVICE_FN blob_device_word blob_device_first(blob_device_word bits) {
  blob_device_word found = 8, i;
  for (i = 0; i < 8; ++i)
    if (found == 8 && ((bits >> i) & 1u) != 0) found = i;
  return found;
}

/* Number of bits of eight that are set. */
BLOB_DEVICE_FN blob_device_word blob_device_count(blob_device_word bits) {
  blob_device_word count = 0, i;
  for (i = 0; i < 8; ++i) count += (bits >> i) & 1u;
  return count;
}

/* Bits of a block's neighbours k with (p_k - p_node) / tau < limit. */
BLOB_DEVICE_FN blob_device_word blob_device_below(blob_device_words block, const float* x,
                                                  float limit) {
  blob_device_word bits = 0, i;
  for (i = 0; i < 8; ++i)
    if (blob_device_difference(block, i, x) * blob_device_float(block[i + 32]) < limit)
      bits = bits | (1u << i);
  return bits;
}

/* The neighbour of least power in a block, if that is less than `least`; the lowest of equals.
 * Returns the bits of blob_device_below() for the limit 1. */
BLOB_DEVICE_FN blob_device_word blob_device_lower(blob_device_words block, const float* x,
                                                  blob_device_word node, float* least,
                                                  blob_device_word* next) {
  blob_device_word bits = 0, i;
  for (i = 0; i < 8; ++i) {
    const float difference = blob_device_difference(block, i, x);
    const blob_device_word k = block[i + 40];
    if (difference * blob_device_float(block[i + 32]) < 1.0f) bits = bits | (1u << i);
    if (difference < *least || (difference == *least && *next != node && k < *next)) {
      *least = difference;
      *next = k;
    }
  }
  return bits;
}

/* Whether a block has neighbour k. */
BLOB_DEVICE_FN int blob_device_holds(blob_device_words block, blob_device_word k) {
  int found = 0;
  blob_device_word i;
  for (i = 0; i < 8; ++i)
    if (block[i + 40] == k) found = 1;
  return found;
}

/* The product of psi against the neighbours of a block, and the gradient of its logarithm. */
BLOB_DEVICE_FN float blob_device_weigh_against(blob_device_words block, const float* x,
                                               float* part) {
  blob_device_eight psi, along_x, along_y, along_z;
  blob_device_word i;
  BLOB_DEVICE_UNROLL
  for (i = 0; i < 8; ++i) {
    const float inverse_tau = blob_device_float(block[i + 32]);
    const float t = blob_device_difference(block, i, x) * inverse_tau;
    const float s = blob_device_lesser(blob_device_greater(0.5f + 0.5f * t, 0.0f), 1.0f);
    const float sp = s * blob_device_step(s), rest = 1.0f - s;
    const float q = (15.0f * (rest * rest)) * inverse_tau / sp;
    psi.lanes[i] = (s * s) * sp;
    along_x.lanes[i] = q * blob_device_float(block[i]);
    along_y.lanes[i] = q * blob_device_float(block[i + 8]);
    along_z.lanes[i] = q * blob_device_float(block[i + 16]);
  }
  part[0] = blob_device_total(&along_x);
  part[1] = blob_device_total(&along_y);
  part[2] = blob_device_total(&along_z);
  return ((psi.lanes[0] * psi.lanes[2]) * (psi.lanes[1] * psi.lanes[3])) *
         ((psi.lanes[4] * psi.lanes[6]) * (psi.lanes[5] * psi.lanes[7]));
}

/* The least a |X - C|^2 of the blobs of `count` blocks; padding counts as far away. */
BLOB_DEVICE_FN float blob_device_least_exponent(blob_device_words first, blob_device_word count,
                                                const float* at) {
  float least = 3e38f, d[3];
  blob_device_word i, b;
  for (b = 0; b < count; ++b)
    for (i = 0; i < 8; ++i) {
      blob_device_words blob = first + BLOB_DEVICE_BLOB_WORDS * b + i;
      const float u = blob_device_exponent(blob, at, d);
      if (blob_device_float(blob[32]) > 0.0f) least = blob_device_lesser(u, least);
    }
  return least;
}

/* f and grad f of `count` blocks of blobs, times exp(shift). */
BLOB_DEVICE_FN void blob_device_sum_blobs(blob_device_word phi, blob_device_words first,
                                          blob_device_word count, const float* at, float shift,
                                          blob_device_lane* lane) {
  blob_device_eight f, along_x, along_y, along_z;
  blob_device_word i, b;
  BLOB_DEVICE_UNROLL
  for (i = 0; i < 8; ++i) f.lanes[i] = along_x.lanes[i] = along_y.lanes[i] = along_z.lanes[i] = 0;
  for (b = 0; b < count; ++b) {
    BLOB_DEVICE_UNROLL
    for (i = 0; i < 8; ++i) {
      blob_device_words blob = first + BLOB_DEVICE_BLOB_WORDS * b + i;
      float d[3], slope, u = blob_device_exponent(blob, at, d);
      u = phi == 1 ? blob_device_greater(u - shift, 0.0f) : u;
      f.lanes[i] += blob_device_term(phi, u, blob_device_float(blob[24]),
                                     blob_device_float(blob[32]), &slope);
      along_x.lanes[i] += slope * d[0];
      along_y.lanes[i] += slope * d[1];
      along_z.lanes[i] += slope * d[2];
    }
  }
  lane->field[0] = blob_device_total(&f);
  lane->field[1] = blob_device_total(&along_x);
  lane->field[2] = blob_device_total(&along_y);
  lane->field[3] = blob_device_total(&along_z);
}

#endif
