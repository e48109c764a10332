/* SPDX-License-Identifier: Apache-2.0
 *
 * Part of blob_device.h: numbers, the layout of the buffer, the walk, and the model of one node.
 */
#ifndef LUMEN_BLOB_DEVICE_MODEL_H
#define LUMEN_BLOB_DEVICE_MODEL_H

/* clang-format off */

#define BLOB_DEVICE_MAGIC 0x5642424cu /* "LBBV" */
#define BLOB_DEVICE_VERSION 1u
#define BLOB_DEVICE_HEADER_WORDS 4u
#define BLOB_DEVICE_VESSEL_WORDS 8u
#define BLOB_DEVICE_NODE_WORDS 12u
#define BLOB_DEVICE_NEIGHBOUR_WORDS 6u
#define BLOB_DEVICE_BLOB_WORDS 5u
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
#define BLOB_DEVICE_FN static inline __host__ __device__
#else
#define BLOB_DEVICE_FN static inline __attribute__((host, device))
#endif
#define BLOB_DEVICE_SQRT(x) __builtin_sqrtf(x)
#else
#include <math.h>
#define BLOB_DEVICE_FN static inline
#define BLOB_DEVICE_SQRT(x) sqrtf(x)
#endif
typedef uint32_t blob_device_word;
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
  const int n = (int)(x * 1.44269504f + (x < 0 ? -0.5f : 0.5f));
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

/* A node, and a point relative to its centre. */
typedef struct blob_device_node {
  blob_device_words record;    /* 12 words */
  blob_device_words neighbour; /* of those that count at x */
  blob_device_word neighbours; /* number of them */
  float x[3];
} blob_device_node;

BLOB_DEVICE_FN blob_device_node blob_device_at(const blob_device_vessel* v, blob_device_word index,
                                               const float* point) {
  blob_device_node node;
  float square;
  int i;
  node.record = v->words + v->nodes + BLOB_DEVICE_NODE_WORDS * index;
  for (i = 0; i < 3; ++i) node.x[i] = point[i] - blob_device_float(node.record[i]);
  square = (node.x[0] * node.x[0] + node.x[1] * node.x[1]) + node.x[2] * node.x[2];
  node.neighbours = node.record[11];
  if (node.neighbours > 8 && square < blob_device_float(node.record[7])) node.neighbours = 8;
  node.neighbour = v->words + v->neighbours + BLOB_DEVICE_NEIGHBOUR_WORDS * node.record[10];
  return node;
}

/* p_k - p_i for neighbour e, mm^2. */
BLOB_DEVICE_FN float blob_device_difference(const blob_device_node* node, blob_device_word e) {
  blob_device_words k = node->neighbour + BLOB_DEVICE_NEIGHBOUR_WORDS * e;
  return ((blob_device_float(k[0]) * node->x[0] + blob_device_float(k[1]) * node->x[1]) +
          blob_device_float(k[2]) * node->x[2]) +
         blob_device_float(k[3]);
}

/* Walks to the neighbour of least power while that falls: blob_cursor_follow(). */
BLOB_DEVICE_FN blob_device_word blob_device_follow(const blob_device_vessel* v, const float* point,
                                                   blob_device_word start) {
  blob_device_word before = start, node = start;
  int step;
  for (step = 0; step < 256; ++step) {
    const blob_device_node here = blob_device_at(v, node, point);
    blob_device_word next = node, e;
    float least = 0;
    for (e = 0; e < here.neighbours; ++e) {
      const float difference = blob_device_difference(&here, e);
      const blob_device_word k = here.neighbour[BLOB_DEVICE_NEIGHBOUR_WORDS * e + 5];
      if (difference < least || (difference == least && next != node && k < next)) {
        least = difference;
        next = k;
      }
    }
    if (next == node || next == before) break;
    before = node;
    node = next;
  }
  return node;
}

/* The node of least power by a look at each: O(n). blob_cursor_locate() on the host is faster. */
BLOB_DEVICE_FN blob_device_word blob_device_locate(const blob_device_vessel* v,
                                                   const float* point) {
  blob_device_word best = 0, i;
  float least = 3e38f;
  for (i = 0; i < v->node_count; ++i) {
    const blob_device_node node = blob_device_at(v, i, point);
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

/* ---------------------------------------------------------------- one model */

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

BLOB_DEVICE_FN float blob_device_square(blob_device_words blob, const float* at, float* d) {
  int i;
  for (i = 0; i < 3; ++i) d[i] = at[i] - blob_device_float(blob[i]);
  return (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2];
}

/* The model of one node. */
BLOB_DEVICE_FN blob_device_lane blob_device_evaluate(const blob_device_vessel* v,
                                                     const blob_device_node* node) {
  const blob_device_word count = node->record[9];
  blob_device_words first = v->words + v->blobs + BLOB_DEVICE_BLOB_WORDS * node->record[8];
  blob_device_lane lane;
  blob_device_word j;
  float at[3], d[3];
  int i;
  lane.shift = 0;
  lane.radius = blob_device_float(node->record[3]);
  for (i = 0; i < 3; ++i) at[i] = node->x[i] + blob_device_float(node->record[4 + i]);
  for (i = 0; i < 4; ++i) lane.field[i] = 0;
  if (v->phi == 1 && count > 0) {
    lane.shift = 3e38f;
    for (j = 0; j < count; ++j) {
      blob_device_words blob = first + BLOB_DEVICE_BLOB_WORDS * j;
      lane.shift = blob_device_lesser(blob_device_float(blob[3]) * blob_device_square(blob, at, d),
                                      lane.shift);
    }
  }
  for (j = 0; j < count; ++j) {
    blob_device_words blob = first + BLOB_DEVICE_BLOB_WORDS * j;
    const float a = blob_device_float(blob[3]);
    float slope, u = a * blob_device_square(blob, at, d);
    u = v->phi == 1 ? blob_device_greater(u - lane.shift, 0.0f) : u;
    lane.field[0] += blob_device_term(v->phi, u, a, blob_device_float(blob[4]), &slope);
    for (i = 0; i < 3; ++i) lane.field[1 + i] += slope * d[i];
  }
  return lane;
}

#endif
