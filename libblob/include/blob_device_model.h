/* SPDX-License-Identifier: Apache-2.0
 *
 * Part of blob_device.h: numbers, the layout of the buffer, nodes and their neighbours.
 */
#ifndef LUMEN_BLOB_DEVICE_MODEL_H
#define LUMEN_BLOB_DEVICE_MODEL_H

/* clang-format off */

#define BLOB_DEVICE_MAGIC 0x5642424cu /* "LBBV" */
#define BLOB_DEVICE_VERSION 2u
#define BLOB_DEVICE_HEADER_WORDS 4u
#define BLOB_DEVICE_VESSEL_WORDS 8u
#define BLOB_DEVICE_NODE_WORDS 16u
#define BLOB_DEVICE_NEIGHBOUR_WORDS 48u /* a block of eight */
#define BLOB_DEVICE_BLOB_WORDS 40u      /* a block of eight */
#define BLOB_DEVICE_ALIGN_WORDS 16u

/* Flags and states: the values of blob.h. */
#define BLOB_DEVICE_BLENDED 0u
#define BLOB_DEVICE_LOCAL 1u
#define BLOB_DEVICE_HOLD 4u
#define BLOB_DEVICE_INSIDE 1u
#define BLOB_DEVICE_NOWHERE 0xffffffffu

#if defined(__OPENCL_VERSION__)
#pragma OPENCL FP_CONTRACT OFF
#define BLOB_DEVICE_GLOBAL __global
#define BLOB_DEVICE_FN static inline
#define BLOB_DEVICE_SQRT(x) sqrt(x)
typedef uint blob_device_word;
#else
#include <stdint.h>
#define BLOB_DEVICE_GLOBAL
#if defined(__CUDACC__) || defined(__CUDA__) || defined(__HIP__)
#if defined(__host__) && defined(__device__)
#define BLOB_DEVICE_FN static __forceinline__ __host__ __device__
#else
#define BLOB_DEVICE_FN static inline __attribute__((host, device, always_inline))
#endif
#define BLOB_DEVICE_SQRT(x) __builtin_sqrtf(x)
#define BLOB_DEVICE_UNROLL _Pragma("unroll") /* arrays of eight stay in registers */
#else
#include <math.h>
#define BLOB_DEVICE_FN static inline
#define BLOB_DEVICE_SQRT(x) sqrtf(x)
#endif
typedef uint32_t blob_device_word;
#endif

#if !defined(BLOB_DEVICE_UNROLL)
#define BLOB_DEVICE_UNROLL
#endif

#if !defined(BLOB_DEVICE_SIMT)
#if defined(__CUDA_ARCH__)
#define BLOB_DEVICE_SIMT 1 /* blob_device_simt.h */
#else
#define BLOB_DEVICE_SIMT 0
#endif
#endif

/* clang-format on */

typedef const BLOB_DEVICE_GLOBAL blob_device_word* blob_device_words;

/* Answer at one point: the fields of blob_sample in blob.h. */
typedef struct blob_device_sample {
  float value, gradient[3]; /* f in mm, grad f */
  float distance;           /* mm, negative in the lumen */
  float normal[3];
  blob_device_word node, state;
} blob_device_sample;

/* ---------------------------------------------------------------- numbers */

typedef union blob_device_bits {
  blob_device_word word;
  float number;
} blob_device_bits;

BLOB_DEVICE_FN float blob_device_float(blob_device_word word) {
  blob_device_bits bits;
  bits.word = word;
  return bits.number;
}

BLOB_DEVICE_FN float blob_device_lesser(float a, float b) {
  return a < b ? a : b;
}

BLOB_DEVICE_FN float blob_device_greater(float a, float b) {
  return b < a ? a : b;
}

BLOB_DEVICE_FN float blob_device_norm(const float* v) {
  return BLOB_DEVICE_SQRT((v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]);
}

/* exp(x), x cut to -87..88, to a few units in the last place; S. Moshier, Cephes library, 1989. */
BLOB_DEVICE_FN float blob_device_exp(float unbounded) {
  const float x = unbounded < -87.0f ? -87.0f : unbounded > 88.0f ? 88.0f : unbounded;
  const float scaled = x * 1.44269504f, rest = scaled - (float)(int)scaled;
  const int n = (int)scaled + (rest > 0.5f ? 1 : rest < -0.5f ? -1 : 0);
  const float r = (x - (float)n * 0.693359375f) - (float)n * -2.12194440e-4f;
  float p = 1.9875691500e-4f;
  blob_device_bits power;
  p = p * r + 1.3981999507e-3f;
  p = p * r + 8.3334519073e-3f;
  p = p * r + 4.1665795894e-2f;
  p = p * r + 1.6666665459e-1f;
  p = p * r + 5.0000001201e-1f;
  power.word = (blob_device_word)(n + 127) << 23;
  return (p * (r * r) + (r + 1.0f)) * power.number;
}

/* Natural logarithm of x > 0; source as above. */
BLOB_DEVICE_FN float blob_device_log(float x) {
  blob_device_bits bits;
  int exponent;
  float m, p, e, square;
  bits.number = x;
  exponent = (int)(bits.word >> 23) - 126;
  bits.word = (bits.word & 0x007FFFFFu) | 0x3F000000u;
  m = bits.number;
  if (m < 0.70710678f) {
    --exponent;
    m = m + m;
  }
  m -= 1.0f;
  p = 7.0376836292e-2f;
  p = p * m + -1.1514610310e-1f;
  p = p * m + 1.1676998740e-1f;
  p = p * m + -1.2420140846e-1f;
  p = p * m + 1.4249322787e-1f;
  p = p * m + -1.6668057665e-1f;
  p = p * m + 2.0000714765e-1f;
  p = p * m + -2.4999993993e-1f;
  p = p * m + 3.3333331174e-1f;
  e = (float)exponent;
  square = m * m;
  return (m + ((m * square * p + e * -2.12194440e-4f) - 0.5f * square)) + e * 0.693359375f;
}

/* ---------------------------------------------------------------- a vessel */

typedef struct blob_device_vessel {
  blob_device_words words;
  blob_device_word phi, node_count, nodes, neighbours, blobs;
  float level, transformed_level;
} blob_device_vessel;

/* A vessel of a checked buffer. `index` is less than the number of vessels. */
BLOB_DEVICE_FN blob_device_vessel blob_device_open(blob_device_words words,
                                                   blob_device_word index) {
  const blob_device_word at = BLOB_DEVICE_HEADER_WORDS + BLOB_DEVICE_VESSEL_WORDS * index;
  blob_device_vessel v;
  v.words = words;
  v.phi = words[at];
  v.node_count = words[at + 1];
  v.nodes = words[at + 2];
  v.neighbours = words[at + 3];
  v.blobs = words[at + 4];
  v.level = blob_device_float(words[at + 5]);
  v.transformed_level = blob_device_float(words[at + 6]);
  return v;
}

/* A point and a step from it, mm: a short step keeps its digits far from zero. */
typedef struct blob_device_place {
  float point[3], step[3];
} blob_device_place;

BLOB_DEVICE_FN blob_device_place blob_device_place_at(const float* point) {
  blob_device_place place;
  int i;
  for (i = 0; i < 3; ++i) place.point[i] = point[i];
  for (i = 0; i < 3; ++i) place.step[i] = 0;
  return place;
}

#if BLOB_DEVICE_SIMT
#include "blob_device_load.h"
#else
/* A node, and a place relative to its centre. */
typedef struct blob_device_node {
  blob_device_words record;    /* 16 words */
  blob_device_words neighbour; /* first block */
  blob_device_word blocks;     /* number of blocks that count at x */
  blob_device_word rivals;     /* of a node where a walk has ended: blob_device_rivals() */
  float x[3];
} blob_device_node;

BLOB_DEVICE_FN blob_device_node blob_device_at(const blob_device_vessel* v, blob_device_word index,
                                               const blob_device_place* place) {
  blob_device_words record = v->words + v->nodes + BLOB_DEVICE_NODE_WORDS * index;
  const float x =
      ((place->point[0] - blob_device_float(record[0])) - blob_device_float(record[12])) +
      place->step[0];
  const float y =
      ((place->point[1] - blob_device_float(record[1])) - blob_device_float(record[13])) +
      place->step[1];
  const float z =
      ((place->point[2] - blob_device_float(record[2])) - blob_device_float(record[14])) +
      place->step[2];
  const float square = (x * x + y * y) + z * z;
  blob_device_node node;
  node.record = record;
  node.x[0] = x;
  node.x[1] = y;
  node.x[2] = z;
  node.rivals = 0;
  node.blocks = node.record[11];
  if (node.blocks > 1 && square < blob_device_float(node.record[7])) node.blocks = 1;
  node.neighbour = v->words + v->neighbours + BLOB_DEVICE_NEIGHBOUR_WORDS * node.record[10];
  return node;
}
#endif

/* The node of least power by a look at each: O(n). blob_cursor_locate() on the host is faster. */
BLOB_DEVICE_FN blob_device_word blob_device_locate(const blob_device_vessel* v,
                                                   const blob_device_place* place) {
  blob_device_word best = 0, i;
  float least = 3e38f;
  for (i = 0; i < v->node_count; ++i) {
    const blob_device_node node = blob_device_at(v, i, place);
    const float r = blob_device_float(node.record[3]);
    const float power =
        ((node.x[0] * node.x[0] + node.x[1] * node.x[1]) + node.x[2] * node.x[2]) - r * r;
    if (power < least) {
      least = power;
      best = i;
    }
  }
  return best;
}

/* p_k - p_node of neighbour `lane` of a block, mm^2. */
BLOB_DEVICE_FN float blob_device_difference(blob_device_words block, blob_device_word lane,
                                            const float* x) {
  blob_device_words k = block + lane;
  return ((blob_device_float(k[0]) * x[0] + blob_device_float(k[8]) * x[1]) +
          blob_device_float(k[16]) * x[2]) +
         blob_device_float(k[24]);
}

/* S(s) / s^3 of the smooth step; formats/field/blend_formulas.h. */
BLOB_DEVICE_FN float blob_device_step(float s) {
  return (6.0f * s - 15.0f) * s + 10.0f;
}

/* ---------------------------------------------------------------- kernels */

/* X - C and u = a |X - C|^2 of the blob whose first word is given; `at` is X. */
BLOB_DEVICE_FN float blob_device_exponent(blob_device_words blob, const float* at, float* d) {
  d[0] = at[0] - blob_device_float(blob[0]);
  d[1] = at[1] - blob_device_float(blob[8]);
  d[2] = at[2] - blob_device_float(blob[16]);
  return blob_device_float(blob[24]) * ((d[0] * d[0] + d[1] * d[1]) + d[2] * d[2]);
}

/* A blob's part of f and the factor of X - C in its part of grad f; u = a |X - C|^2. The formulas
 * are those of formats/field/kernel_formulas.h. */
BLOB_DEVICE_FN float blob_device_term(blob_device_word phi, float u, float a, float w,
                                      float* slope) {
  float q, value;
  if (phi == 0) { /* Cauchy */
    q = 1.0f / (1.0f + u);
    value = w * (q * q);
    *slope = (-4.0f * a) * (value * q);
    return value;
  }
  if (phi == 1) { /* Gaussian */
    value = w * blob_device_exp(-u);
    *slope = (-2.0f * a) * value;
    return value;
  }
  q = blob_device_greater(1.0f - u, 0.0f);
  if (phi == 2) { /* quartic */
    *slope = (-4.0f * a) * (w * q);
    return w * (q * q);
  }
  *slope = (-2.0f / 9.0f * a) * (w * q) * (10.0f + 12.0f * q); /* soft object */
  return w * (q * q) * (5.0f + 4.0f * q) * (1.0f / 9.0f);
}

/* A point before its distance: f and grad f, both times exp(shift), and the radius. */
typedef struct blob_device_lane {
  float field[4], shift, radius;
} blob_device_lane;

#endif
