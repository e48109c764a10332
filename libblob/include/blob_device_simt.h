/* SPDX-License-Identifier: Apache-2.0
 *
 * Part of blob_device.h: functions of blob_device_lanes.h as NVIDIA's processors run them best. A
 * block of the buffer is loaded in pieces of 16 bytes, four lanes at a time, which leaves registers
 * for more threads, and what does not contribute is not computed. Every operation that counts and
 * their order are the same.
 */
#ifndef LUMEN_BLOB_DEVICE_SIMT_H
#define LUMEN_BLOB_DEVICE_SIMT_H

#include "blob_device_model.h"

/* Four lanes of a block; lanes 0 to 3 and 4 to 7 are its halves. */
typedef struct blob_device_half {
  float lanes[4];
} blob_device_half;

BLOB_DEVICE_FN blob_device_half blob_device_load(blob_device_words words) {
  blob_device_word read[4];
  blob_device_half half;
  int i;
  blob_device_read(words, read);
  BLOB_DEVICE_UNROLL
  for (i = 0; i < 4; ++i) half.lanes[i] = blob_device_float(read[i]);
  return half;
}

BLOB_DEVICE_FN float blob_device_total(const blob_device_half* e) {
  return (e->lanes[0] + e->lanes[2]) + (e->lanes[1] + e->lanes[3]);
}

/* Index of the lowest bit of eight, of which one is set, and the number of those. */
BLOB_DEVICE_FN blob_device_word blob_device_first(blob_device_word bits) {
#if defined(__CUDA_ARCH__) && !defined(__clang__)
  return (blob_device_word)__ffs((int)bits) - 1u;
#else
  return (blob_device_word)__builtin_ctz(bits);
#endif
}

BLOB_DEVICE_FN blob_device_word blob_device_count(blob_device_word bits) {
#if defined(__CUDA_ARCH__) && !defined(__clang__)
  return (blob_device_word)__popc(bits);
#else
  return (blob_device_word)__builtin_popcount(bits);
#endif
}

/* p_k - p_node of the neighbours of half a block, mm^2. */
BLOB_DEVICE_FN blob_device_half blob_device_differences(blob_device_words half, const float* x) {
  const blob_device_half nx = blob_device_load(half), ny = blob_device_load(half + 8),
                         nz = blob_device_load(half + 16), c = blob_device_load(half + 24);
  blob_device_half d;
  int i;
  BLOB_DEVICE_UNROLL
  for (i = 0; i < 4; ++i)
    d.lanes[i] = ((nx.lanes[i] * x[0] + ny.lanes[i] * x[1]) + nz.lanes[i] * x[2]) + c.lanes[i];
  return d;
}

BLOB_DEVICE_FN blob_device_word blob_device_below(blob_device_words block, const float* x,
                                                  float limit) {
  blob_device_word bits = 0, from;
  int i;
  BLOB_DEVICE_UNROLL
  for (from = 0; from < 8; from += 4) {
    const blob_device_half d = blob_device_differences(block + from, x),
                           inverse_tau = blob_device_load(block + from + 32);
    BLOB_DEVICE_UNROLL
    for (i = 0; i < 4; ++i)
      bits |= d.lanes[i] * inverse_tau.lanes[i] < limit ? 1u << (from + (blob_device_word)i) : 0u;
  }
  return bits;
}

/* Lanes that do not lower the power, nearly all, cost a comparison; the others one after another. */
BLOB_DEVICE_FN blob_device_word blob_device_lower(blob_device_words block, const float* x,
                                                  blob_device_word node, float* least,
                                                  blob_device_word* next) {
  blob_device_word bits = 0, below = 0, from;
  int i;
  BLOB_DEVICE_UNROLL
  for (from = 0; from < 8; from += 4) {
    const blob_device_half d = blob_device_differences(block + from, x),
                           inverse_tau = blob_device_load(block + from + 32);
    BLOB_DEVICE_UNROLL
    for (i = 0; i < 4; ++i) {
      const blob_device_word bit = 1u << (from + (blob_device_word)i);
      bits |= d.lanes[i] <= *least ? bit : 0u;
      below |= d.lanes[i] * inverse_tau.lanes[i] < 1.0f ? bit : 0u;
    }
  }
  for (; bits != 0; bits &= bits - 1) {
    const blob_device_word lane = blob_device_first(bits), k = block[lane + 40];
    const float difference = blob_device_difference(block, lane, x);
    if (difference < *least || (difference == *least && *next != node && k < *next)) {
      *least = difference;
      *next = k;
    }
  }
  return below;
}

BLOB_DEVICE_FN int blob_device_holds(blob_device_words block, blob_device_word k) {
  int found = 0, i;
  blob_device_word from;
  BLOB_DEVICE_UNROLL
  for (from = 0; from < 8; from += 4) {
    blob_device_word nodes[4];
    blob_device_read(block + from + 40, nodes);
    BLOB_DEVICE_UNROLL
    for (i = 0; i < 4; ++i) found |= (int)(nodes[i] == k);
  }
  return found;
}

/* Only neighbours that do not lose by tau have a psi below 1 and a gradient. */
BLOB_DEVICE_FN float blob_device_weigh_against(blob_device_words block, const float* x,
                                               float* part) {
  float product = 1;
  blob_device_word from;
  int i;
  for (i = 0; i < 3; ++i) part[i] = 0;
  BLOB_DEVICE_UNROLL
  for (from = 0; from < 8; from += 4) {
    blob_device_words half = block + from;
    const blob_device_half d = blob_device_differences(half, x),
                           inverse_tau = blob_device_load(half + 32);
    blob_device_half psi, along_x, along_y, along_z;
    BLOB_DEVICE_UNROLL
    for (i = 0; i < 4; ++i) {
      const float t = d.lanes[i] * inverse_tau.lanes[i];
      psi.lanes[i] = 1;
      along_x.lanes[i] = along_y.lanes[i] = along_z.lanes[i] = 0;
      if (t < 1.0f) {
        const float s = blob_device_greater(0.5f + 0.5f * t, 0.0f), rest = 1.0f - s;
        const float sp = s * blob_device_step(s);
        const float q = (15.0f * (rest * rest)) * inverse_tau.lanes[i] / sp;
        psi.lanes[i] = (s * s) * sp;
        along_x.lanes[i] = q * blob_device_float(half[i]);
        along_y.lanes[i] = q * blob_device_float(half[i + 8]);
        along_z.lanes[i] = q * blob_device_float(half[i + 16]);
      }
    }
    product *= (psi.lanes[0] * psi.lanes[2]) * (psi.lanes[1] * psi.lanes[3]);
    part[0] += blob_device_total(&along_x);
    part[1] += blob_device_total(&along_y);
    part[2] += blob_device_total(&along_z);
  }
  return product;
}

BLOB_DEVICE_FN float blob_device_least_exponent(blob_device_words first, blob_device_word count,
                                                const float* at) {
  float least = 3e38f, d[3];
  blob_device_word n, i;
  for (n = 0; n < count; ++n) {
    BLOB_DEVICE_UNROLL
    for (i = 0; i < 8; ++i) {
      blob_device_words blob = first + BLOB_DEVICE_BLOB_WORDS * n + i;
      const float u = blob_device_exponent(blob, at, d);
      if (blob_device_float(blob[32]) > 0.0f) least = blob_device_lesser(u, least);
    }
  }
  return least;
}

/* f and grad f of blobs of one kernel. The sum of a half is complete before the other half begins. */
BLOB_DEVICE_FN void blob_device_sum_of(blob_device_word phi, blob_device_words first,
                                       blob_device_word count, const float* at, float shift,
                                       blob_device_lane* lane) {
  blob_device_word from, n;
  int i;
  for (i = 0; i < 4; ++i) lane->field[i] = 0;
  BLOB_DEVICE_UNROLL
  for (from = 0; from < 8; from += 4) {
    blob_device_half f = {{0, 0, 0, 0}}, along_x = f, along_y = f, along_z = f;
    for (n = 0; n < count; ++n) {
      blob_device_words half = first + BLOB_DEVICE_BLOB_WORDS * n + from;
      const blob_device_half x = blob_device_load(half), y = blob_device_load(half + 8),
                             z = blob_device_load(half + 16), a = blob_device_load(half + 24),
                             width = blob_device_load(half + 32);
      BLOB_DEVICE_UNROLL
      for (i = 0; i < 4; ++i) {
        const float dx = at[0] - x.lanes[i], dy = at[1] - y.lanes[i], dz = at[2] - z.lanes[i];
        float slope, u = a.lanes[i] * ((dx * dx + dy * dy) + dz * dz);
        if (phi == 1) u = blob_device_greater(u - shift, 0.0f);
        f.lanes[i] += blob_device_term(phi, u, a.lanes[i], width.lanes[i], &slope);
        along_x.lanes[i] += slope * dx;
        along_y.lanes[i] += slope * dy;
        along_z.lanes[i] += slope * dz;
      }
    }
    lane->field[0] += blob_device_total(&f);
    lane->field[1] += blob_device_total(&along_x);
    lane->field[2] += blob_device_total(&along_y);
    lane->field[3] += blob_device_total(&along_z);
  }
}

BLOB_DEVICE_FN void blob_device_sum_blobs(blob_device_word phi, blob_device_words first,
                                          blob_device_word count, const float* at, float shift,
                                          blob_device_lane* lane) {
  if (phi == 0)
    blob_device_sum_of(0, first, count, at, shift, lane);
  else if (phi == 1)
    blob_device_sum_of(1, first, count, at, shift, lane);
  else if (phi == 2)
    blob_device_sum_of(2, first, count, at, shift, lane);
  else
    blob_device_sum_of(3, first, count, at, shift, lane);
}

#endif
