/* SPDX-License-Identifier: Apache-2.0
 *
 * libblob on other processors: the query of blob.h for one point, in the part of C that C99, C++11,
 * OpenCL C 1.2 and CUDA share, on a flat buffer that any interface uploads. There is no pointer in
 * the buffer, and no function here allocates, recurses or calls a mathematical library but for the
 * square root.
 *
 * On the host, with libblob:
 *
 *     size_t size = blob_device_pack(&model, 1, NULL, 0);
 *     void* buffer = malloc(size);
 *     blob_device_pack(&model, 1, buffer, size);       // upload it as it is
 *
 * On the device, a thread for each tool point, which keeps its cursor of four bytes:
 *
 *     blob_device_sample s;
 *     blob_device_query(words, vessel, BLOB_DEVICE_BLENDED, point, &cursor, &s);
 *
 * Points are floats, mm, in the frame of the case. Numbers are those of blob_query() at that point
 * to the rounding of floats; a compiler that fuses a*b+c rounds otherwise.
 *
 * The buffer, version 1: words of 32 bits in the byte order of the host; floats are IEEE 754.
 *
 *     word 0    BLOB_DEVICE_MAGIC
 *          1    version
 *          2    number of words of the buffer
 *          3    number of vessels
 *          4    eight words of each vessel: kernel, number of nodes, first word of the nodes, of
 *               the neighbours and of the blobs, level T and transformed level h_T (floats), first
 *               word after the vessel
 *
 *     a node, 12 words: centre (3 floats, mm), radius (mm), the centre relative to that of the node
 *               whose blobs answer (3 floats, mm), the square of the distance within which only the
 *               first eight neighbours count (mm^2), first blob, number of blobs, first neighbour,
 *               number of neighbours
 *     a neighbour k of node i, 6 words: n (3 floats), c and 1 / tau (floats), node k;
 *               p_k - p_i = n . (X - O_i) + c
 *     a blob, 5 words: offset from its node's centre (3 floats, mm), a (1/mm^2), width (mm)
 *
 * Vessels start at multiples of 16 words.
 */
#ifndef LUMEN_BLOB_DEVICE_H
#define LUMEN_BLOB_DEVICE_H

#include "blob_device_model.h"

/* ---------------------------------------------------------------- blending */

/* S(s) / s^3 of the smooth step; formats/field/blend_formulas.h. */
BLOB_DEVICE_FN float blob_device_step(float s) {
  return (6.0f * s - 15.0f) * s + 10.0f;
}

#define BLOB_DEVICE_MOST_ACTIVE 24

/* Nodes that blend, and the sums over them that libblob/src/simd/blend.h explains. */
typedef struct blob_device_mixture {
  blob_device_word nodes[BLOB_DEVICE_MOST_ACTIVE];
  int count, is_empty;
  float weight[4], excess[4], field[4];
  float f0, shift, radius;
} blob_device_mixture;

BLOB_DEVICE_FN void blob_device_add_active(blob_device_mixture* sum, blob_device_word k) {
  int i;
  for (i = 0; i < sum->count; ++i)
    if (sum->nodes[i] == k) return;
  if (sum->count < BLOB_DEVICE_MOST_ACTIVE) {
    sum->nodes[sum->count] = k;
    sum->count += 1;
  }
}

BLOB_DEVICE_FN int blob_device_is_neighbour(const blob_device_vessel* v, blob_device_word node,
                                            blob_device_word k) {
  blob_device_words record = v->words + v->nodes + BLOB_DEVICE_NODE_WORDS * node;
  blob_device_words first = v->words + v->neighbours + BLOB_DEVICE_NEIGHBOUR_WORDS * record[10];
  blob_device_word e;
  for (e = 0; e < record[11]; ++e)
    if (first[BLOB_DEVICE_NEIGHBOUR_WORDS * e + 5] == k) return 1;
  return 0;
}

/* The weight u of a node and its gradient; 0 if another beats it by tau. Its rivals are added to
 * those that blend, but for neighbours of the first node, which has added its own. */
BLOB_DEVICE_FN float blob_device_weigh(const blob_device_vessel* v, blob_device_word index,
                                       const blob_device_node* node, blob_device_mixture* sum,
                                       float* gradient) {
  blob_device_word e;
  float u = 1;
  int i;
  for (i = 0; i < 3; ++i) gradient[i] = 0;
  for (e = 0; e < node->neighbours; ++e) {
    blob_device_words k = node->neighbour + BLOB_DEVICE_NEIGHBOUR_WORDS * e;
    const float inverse_tau = blob_device_float(k[4]);
    const float t = blob_device_difference(node, e) * inverse_tau;
    const float s = 0.5f + 0.5f * t, sp = s * blob_device_step(s);
    if (!(t < 1.0f)) continue;
    u = t < -1.0f || s <= 0.0f ? 0.0f : u * ((s * s) * sp);
    if (!(u > 1e-20f)) return 0;
    for (i = 0; i < 3; ++i)
      gradient[i] +=
          (15.0f * ((1.0f - s) * (1.0f - s))) * inverse_tau / sp * blob_device_float(k[i]);
    if (index == sum->nodes[0] || !blob_device_is_neighbour(v, sum->nodes[0], k[5]))
      blob_device_add_active(sum, k[5]);
  }
  for (i = 0; i < 3; ++i) gradient[i] *= u;
  return u;
}

/* Brings two values of a Gaussian, each with a shift, to one shift. */
BLOB_DEVICE_FN void blob_device_share_shift(float* first, float second, float* of_first,
                                            float* of_second) {
  const float difference = *first - second;
  *of_first = 1;
  *of_second = 1;
  if (difference <= 60) {
    *of_second = blob_device_exp(difference);
  } else {
    *first = second;
    *of_first = blob_device_exp(-difference);
  }
}

BLOB_DEVICE_FN void blob_device_add(const blob_device_vessel* v, const blob_device_lane* own,
                                    float u, const float* gradient, blob_device_mixture* sum) {
  float of_sum = 1, of_own = 1, above;
  int i;
  if (sum->is_empty) {
    sum->is_empty = 0;
    sum->f0 = own->field[0];
    sum->shift = own->shift;
  } else if (v->phi == 1) {
    blob_device_share_shift(&sum->shift, own->shift, &of_sum, &of_own);
    sum->f0 *= of_sum;
    for (i = 0; i < 4; ++i) {
      sum->excess[i] *= of_sum;
      sum->field[i] *= of_sum;
    }
  }
  above = of_own * own->field[0] - sum->f0;
  sum->weight[0] += u;
  sum->excess[0] += above * u;
  sum->field[0] += u * (of_own * own->field[0]);
  for (i = 0; i < 3; ++i) {
    sum->weight[i + 1] += gradient[i];
    sum->excess[i + 1] += above * gradient[i];
    sum->field[i + 1] += u * (of_own * own->field[i + 1]);
  }
  sum->radius += u * own->radius;
}

/* Blends any number of nodes into the answer of one alone. */
BLOB_DEVICE_FN void blob_device_blend(const blob_device_vessel* v, const float* point,
                                      blob_device_word start, blob_device_lane* lane) {
  blob_device_mixture sum;
  float gradient[3], inverse, excess;
  int i, n;
  for (i = 0; i < 4; ++i) sum.weight[i] = sum.excess[i] = sum.field[i] = 0;
  sum.radius = sum.f0 = sum.shift = 0;
  sum.is_empty = 1;
  sum.nodes[0] = start;
  sum.count = 1;
  for (n = 0; n < sum.count; ++n) {
    const int before = sum.count;
    const blob_device_node node = blob_device_at(v, sum.nodes[n], point);
    const float u = blob_device_weigh(v, sum.nodes[n], &node, &sum, gradient);
    if (u > 0) {
      const blob_device_lane own = n == 0 ? *lane : blob_device_evaluate(v, &node);
      blob_device_add(v, &own, u, gradient, &sum);
    } else {
      sum.count = before;
    }
  }
  if (sum.is_empty) return;
  inverse = 1.0f / sum.weight[0];
  excess = sum.excess[0] * inverse;
  lane->field[0] = sum.f0 + excess;
  for (i = 1; i < 4; ++i)
    lane->field[i] = (sum.field[i] + (sum.excess[i] - excess * sum.weight[i])) * inverse;
  lane->shift = sum.shift;
  lane->radius = sum.radius * inverse;
}

/* ---------------------------------------------------------------- distance and normal */

/* h and |grad h| from f, times exp(shift), and |grad f| / f. */
BLOB_DEVICE_FN float blob_device_level(blob_device_word phi, float f, float shift, float relative,
                                       float* slope) {
  float h;
  if (phi == 1) {
    *slope = relative;
    return shift - blob_device_log(f);
  }
  h = phi == 0 ? BLOB_DEVICE_SQRT(1.0f / f) : 0.0f - BLOB_DEVICE_SQRT(f);
  *slope = (phi == 0 ? 0.5f : -0.5f) * h * relative;
  return h;
}

/* The distance of one evaluation; libblob/src/simd/wall_distance.h explains the form. */
BLOB_DEVICE_FN float blob_device_wall(float difference, float slope, float radius, int inside) {
  const float d = difference < 0 ? -difference : difference, gr = slope * radius;
  const float s = BLOB_DEVICE_SQRT(d * d + gr * gr), t = gr + s;
  if (!(d > 0)) return 0;
  return d * (t + d) * (inside ? -radius : 1.0f) / (t * (inside ? d + s : slope));
}

BLOB_DEVICE_FN void blob_device_finish(const blob_device_vessel* v, const blob_device_lane* lane,
                                       const float* at, blob_device_sample* sample) {
  const float f = lane->field[0], inverse_f = 1.0f / f, to_centre = blob_device_norm(at);
  const float scale = v->phi != 1           ? 1.0f
                      : lane->shift > 87.0f ? 0.0f
                                            : blob_device_exp(-lane->shift);
  float e[3], length, h, slope;
  int i, inside;
  sample->value = f * scale;
  for (i = 0; i < 3; ++i) {
    e[i] = lane->field[1 + i] * inverse_f;
    sample->gradient[i] = lane->field[1 + i] * scale;
  }
  inside = sample->value > v->level;
  length = blob_device_norm(e);
  h = blob_device_level(v->phi, f, lane->shift, length, &slope);
  sample->distance = blob_device_wall(v->transformed_level - h, slope, lane->radius, inside);
  if (!inside) {
    sample->distance = blob_device_lesser(sample->distance, to_centre + lane->radius);
    if (!(f > 1e-20f)) {
      sample->distance = blob_device_greater(to_centre - lane->radius, 0.0f);
      for (i = 0; i < 3; ++i) e[i] = -at[i];
      length = to_centre;
    }
  }
  for (i = 0; i < 3; ++i) sample->normal[i] = length > 0 ? e[i] * (-1.0f / length) : 0.0f;
  sample->state = inside ? BLOB_DEVICE_INSIDE : 0u;
}

/* blob_query(): `flags` are BLOB_DEVICE_BLENDED, _LOCAL and _HOLD. The cursor is read and moved;
 * one that is no node is located. A point that is not within 1e9 mm of its node gives zero or NaN,
 * as in blob.h, with an unmoved cursor. */
BLOB_DEVICE_FN void blob_device_query(blob_device_words words, blob_device_word vessel,
                                      blob_device_word flags, const float* point,
                                      blob_device_word* cursor, blob_device_sample* sample) {
  const blob_device_vessel v = blob_device_open(words, vessel);
  blob_device_node node;
  blob_device_lane lane;
  int i, in_range = 1;
  if (*cursor >= v.node_count) *cursor = blob_device_locate(&v, point);
  node = blob_device_at(&v, *cursor, point);
  for (i = 0; i < 3; ++i) in_range = in_range && node.x[i] <= 1e9f && node.x[i] >= -1e9f;
  if (!in_range) {
    const float length = blob_device_norm(node.x);
    sample->value = length - length == 0 ? 0.0f : (length > 0 ? 0.0f : length);
    sample->distance = length - blob_device_float(node.record[3]);
    for (i = 0; i < 3; ++i) {
      sample->gradient[i] = sample->value;
      sample->normal[i] = length > 0 && length <= 3e38f ? node.x[i] / length : sample->value;
    }
    sample->node = *cursor;
    sample->state = 0;
    return;
  }
  if ((flags & BLOB_DEVICE_HOLD) == 0) {
    *cursor = blob_device_follow(&v, point, *cursor);
    node = blob_device_at(&v, *cursor, point);
  }
  lane = blob_device_evaluate(&v, &node);
  if ((flags & BLOB_DEVICE_LOCAL) == 0) {
    blob_device_word e;
    for (e = 0; e < node.neighbours; ++e)
      if (blob_device_difference(&node, e) *
              blob_device_float(node.neighbour[BLOB_DEVICE_NEIGHBOUR_WORDS * e + 4]) <
          1.0f) {
        blob_device_blend(&v, point, *cursor, &lane);
        break;
      }
  }
  blob_device_finish(&v, &lane, node.x, sample);
  sample->node = *cursor;
}

#endif
