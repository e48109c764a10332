/* SPDX-License-Identifier: Apache-2.0
 *
 * Part of blob_device.h: the model of one node, the walk along the tree, and the nodes that blend.
 */
#ifndef LUMEN_BLOB_DEVICE_BLEND_H
#define LUMEN_BLOB_DEVICE_BLEND_H

#include "blob_device_model.h"

#if !defined(BLOB_DEVICE_WIDE)
#if defined(__OPENCL_VERSION__) && (defined(__x86_64__) || defined(__aarch64__))
#define BLOB_DEVICE_WIDE 1
#else
#define BLOB_DEVICE_WIDE 0
#endif
#endif
#if BLOB_DEVICE_WIDE
#include "blob_device_wide.h"
#elif BLOB_DEVICE_SIMT
#include "blob_device_simt.h"
#else
#include "blob_device_lanes.h"
#endif

/* ---------------------------------------------------------------- one node */

/* The model of one node. */
BLOB_DEVICE_FN blob_device_lane blob_device_evaluate(const blob_device_vessel* v,
                                                     const blob_device_node* node) {
  const blob_device_word count = node->record[9];
  blob_device_words first = v->words + v->blobs + BLOB_DEVICE_BLOB_WORDS * node->record[8];
  blob_device_lane lane;
  float at[3];
  at[0] = node->x[0] + blob_device_float(node->record[4]);
  at[1] = node->x[1] + blob_device_float(node->record[5]);
  at[2] = node->x[2] + blob_device_float(node->record[6]);
  lane.shift = 0;
  if (v->phi == 1 && count > 0) lane.shift = blob_device_least_exponent(first, count, at);
  lane.radius = blob_device_float(node->record[3]);
  blob_device_sum_blobs(v->phi, first, count, at, lane.shift, &lane);
  return lane;
}

#define BLOB_DEVICE_MANY 0xffffffffu

/* Bits of a node's rivals, neighbours that it does not beat by tau, in its first block; _MANY if a
 * later block has one. */
BLOB_DEVICE_FN blob_device_word blob_device_rivals(const blob_device_node* node) {
  blob_device_word b;
  for (b = 1; b < node->blocks; ++b)
    if (blob_device_below(node->neighbour + BLOB_DEVICE_NEIGHBOUR_WORDS * b, node->x, 1.0f) != 0)
      return BLOB_DEVICE_MANY;
  return blob_device_below(node->neighbour, node->x, 1.0f);
}

/* Walks to the neighbour of least power while that falls, from *node on: blob_cursor_follow(). Returns
 * the last node, with its rivals, and its number in *node. */
BLOB_DEVICE_FN blob_device_node blob_device_follow(const blob_device_vessel* v,
                                                   const blob_device_place* place,
                                                   blob_device_word* node) {
  blob_device_node here = blob_device_at(v, *node, place);
  blob_device_word before = *node, b;
  int step;
  for (step = 0; step < 256; ++step) {
    blob_device_word next = *node;
    float least = 0;
    here.rivals = 0;
    for (b = 0; b < here.blocks; ++b) {
      const blob_device_word bits = blob_device_lower(
          here.neighbour + BLOB_DEVICE_NEIGHBOUR_WORDS * b, here.x, *node, &least, &next);
      here.rivals = b == 0 ? bits : bits != 0 ? BLOB_DEVICE_MANY : here.rivals;
    }
    if (next == *node || next == before) return here;
    before = *node;
    *node = next;
    here = blob_device_at(v, next, place);
  }
  here.rivals = blob_device_rivals(&here);
  return here;
}

/* ---------------------------------------------------------------- blending */

#define BLOB_DEVICE_MOST_ACTIVE 24

/* Nodes that blend. */
typedef struct blob_device_active {
  blob_device_word nodes[BLOB_DEVICE_MOST_ACTIVE];
  int count;
} blob_device_active;

/* Sums over them, which libblob/src/simd/blend.h explains. */
typedef struct blob_device_mixture {
  float weight[4], excess[4], field[4];
  float f0, shift, radius;
  int is_empty;
} blob_device_mixture;

BLOB_DEVICE_FN void blob_device_add_active(blob_device_active* blending, blob_device_word k) {
  int i;
  for (i = 0; i < blending->count; ++i)
    if (blending->nodes[i] == k) return;
  if (blending->count < BLOB_DEVICE_MOST_ACTIVE) {
    blending->nodes[blending->count] = k;
    blending->count += 1;
  }
}

BLOB_DEVICE_FN int blob_device_is_neighbour(const blob_device_vessel* v, blob_device_word node,
                                            blob_device_word k) {
  blob_device_words record = v->words + v->nodes + BLOB_DEVICE_NODE_WORDS * node;
  blob_device_words first = v->words + v->neighbours + BLOB_DEVICE_NEIGHBOUR_WORDS * record[10];
  blob_device_word b;
  for (b = 0; b < record[11]; ++b)
    if (blob_device_holds(first + BLOB_DEVICE_NEIGHBOUR_WORDS * b, k)) return 1;
  return 0;
}

/* The weight u of a node and its gradient; 0 if another beats it by tau. Its rivals are added to
 * those that blend, but for neighbours of the first node, which has added its own. */
BLOB_DEVICE_FN float blob_device_weigh(const blob_device_vessel* v, blob_device_word index,
                                       const blob_device_node* node, blob_device_active* blending,
                                       float* gradient) {
  blob_device_word b, i, number;
  float u = 1, part[3];
  int axis;
  for (axis = 0; axis < 3; ++axis) gradient[axis] = 0;
  for (b = 0; b < node->blocks; ++b) {
    blob_device_words block = node->neighbour + BLOB_DEVICE_NEIGHBOUR_WORDS * b;
    blob_device_word rivals = blob_device_below(block, node->x, 1.0f);
    if (rivals == 0) continue;
    u *= blob_device_weigh_against(block, node->x, part);
    if (!(u > 1e-20f)) return 0;
    for (axis = 0; axis < 3; ++axis) gradient[axis] += part[axis];
    number = blob_device_count(rivals);
    for (i = 0; i < number; ++i) {
      const blob_device_word k = block[blob_device_first(rivals) + 40];
      rivals = rivals & (rivals - 1u);
      if (index == blending->nodes[0] || !blob_device_is_neighbour(v, blending->nodes[0], k))
        blob_device_add_active(blending, k);
    }
  }
  for (axis = 0; axis < 3; ++axis) gradient[axis] *= u;
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

BLOB_DEVICE_FN void blob_device_clear(blob_device_mixture* sum) {
  int i;
  for (i = 0; i < 4; ++i) sum->weight[i] = sum->excess[i] = sum->field[i] = 0;
  sum->radius = sum->f0 = sum->shift = 0;
  sum->is_empty = 1;
}

BLOB_DEVICE_FN blob_device_lane blob_device_quotient(const blob_device_mixture* sum) {
  const float inverse = 1.0f / sum->weight[0], excess = sum->excess[0] * inverse;
  blob_device_lane lane;
  int i;
  lane.field[0] = sum->f0 + excess;
  for (i = 1; i < 4; ++i)
    lane.field[i] = (sum->field[i] + (sum->excess[i] - excess * sum->weight[i])) * inverse;
  lane.shift = sum->shift;
  lane.radius = sum->radius * inverse;
  return lane;
}

/* Blends any number of nodes into the answer of one alone. */
BLOB_DEVICE_FN void blob_device_blend_all(const blob_device_vessel* v,
                                          const blob_device_place* place, blob_device_word start,
                                          blob_device_lane* lane) {
  blob_device_active blending;
  blob_device_mixture sum;
  float gradient[3];
  int n;
  blob_device_clear(&sum);
  blending.nodes[0] = start;
  blending.count = 1;
  for (n = 0; n < blending.count; ++n) {
    const int before = blending.count;
    const blob_device_node node = blob_device_at(v, blending.nodes[n], place);
    const float u = blob_device_weigh(v, blending.nodes[n], &node, &blending, gradient);
    if (u > 0) {
      const blob_device_lane own = n == 0 ? *lane : blob_device_evaluate(v, &node);
      blob_device_add(v, &own, u, gradient, &sum);
    } else {
      blending.count = before;
    }
  }
  if (sum.is_empty == 0) *lane = blob_device_quotient(&sum);
}

/* Whether a node and its one rival, which has these rivals, blend alone. 0: no. 1: yes, and their
 * weights are psi and 1 - psi. 2: yes; other rivals of the rival are neighbours of the node, and so
 * have no weight. */
BLOB_DEVICE_FN int blob_device_pair(const blob_device_vessel* v, blob_device_word node,
                                    const blob_device_node* other, blob_device_word rivals,
                                    float t) {
  blob_device_word i, number, rest = rivals;
  if (rivals == BLOB_DEVICE_MANY || !(t > -0.999f)) return 0;
  if ((rivals & (rivals - 1)) == 0)
    if (rivals == 0 || other->neighbour[blob_device_first(rivals) + 40] == node) return 1;
  number = blob_device_count(rivals);
  for (i = 0; i < number; ++i) {
    const blob_device_word k = other->neighbour[blob_device_first(rest) + 40];
    rest = rest & (rest - 1u);
    if (k != node && !blob_device_is_neighbour(v, node, k)) return 0;
  }
  return 2;
}

/* Mixes the answers of a node and a rival whose weights are psi and 1 - psi, into the first. */
BLOB_DEVICE_FN void blob_device_mix(const blob_device_vessel* v, blob_device_words rival, float t,
                                    const blob_device_lane* other, blob_device_lane* lane) {
  const float s = 0.5f + 0.5f * t, rest = 1.0f - s, psi = s * s * s * blob_device_step(s);
  const float slope = (15.0f * ((s * s) * (rest * rest))) * blob_device_float(rival[32]);
  float of_own = 1, of_other = 1, excess[4];
  int i;
  if (v->phi == 1) blob_device_share_shift(&lane->shift, other->shift, &of_own, &of_other);
  for (i = 0; i < 4; ++i) excess[i] = lane->field[i] * of_own - other->field[i] * of_other;
  if (v->phi == 1) { /* 1 - psi is psi(1 - s), which keeps its digits where a model vanishes */
    const float other_psi = rest * rest * rest * blob_device_step(rest);
    for (i = 0; i < 4; ++i)
      lane->field[i] = psi * (lane->field[i] * of_own) + other_psi * (other->field[i] * of_other);
  } else {
    for (i = 0; i < 4; ++i) lane->field[i] = other->field[i] * of_other + psi * excess[i];
  }
  for (i = 0; i < 3; ++i)
    lane->field[i + 1] += (slope * excess[0]) * blob_device_float(rival[8 * i]);
  lane->radius = other->radius + psi * (lane->radius - other->radius);
}

/* Mixes the answers of a node and a rival that has other rivals, too. */
BLOB_DEVICE_FN void blob_device_mix_two(const blob_device_vessel* v, blob_device_words rival,
                                        float t, const blob_device_node* node,
                                        const blob_device_lane* other, blob_device_lane* lane) {
  const float s = 0.5f + 0.5f * t, rest = 1.0f - s, sp = s * blob_device_step(s);
  const float u = (s * s) * sp, q = (15.0f * (rest * rest)) * blob_device_float(rival[32]) / sp;
  const blob_device_lane own = *lane;
  blob_device_mixture sum;
  float gradient[3], product;
  int i;
  blob_device_clear(&sum);
  for (i = 0; i < 3; ++i) gradient[i] = u * (q * blob_device_float(rival[8 * i]));
  blob_device_add(v, &own, u, gradient, &sum);
  product = blob_device_weigh_against(node->neighbour, node->x, gradient);
  if (product > 1e-20f) {
    for (i = 0; i < 3; ++i) gradient[i] *= product;
    blob_device_add(v, other, product, gradient, &sum);
  }
  *lane = blob_device_quotient(&sum);
}

/* Blends the model of the one rival of a node, number `number` of its first block, into the node's own
 * answer. Returns false, and leaves the answer, where more nodes blend. */
BLOB_DEVICE_FN int blob_device_blend_one(const blob_device_vessel* v,
                                         const blob_device_place* place, blob_device_word index,
                                         const blob_device_node* node, blob_device_word number,
                                         blob_device_lane* lane) {
  blob_device_words rival = node->neighbour + number;
  const float t = blob_device_difference(rival, 0, node->x) * blob_device_float(rival[32]);
  const blob_device_node other = blob_device_at(v, rival[40], place);
  const int kind = blob_device_pair(v, index, &other, blob_device_rivals(&other), t);
  blob_device_lane second;
  if (kind == 0) return 0;
  second = blob_device_evaluate(v, &other);
  if (kind == 1)
    blob_device_mix(v, rival, t, &second, lane);
  else
    blob_device_mix_two(v, rival, t, &other, &second, lane);
  return 1;
}

/* Blends the models of a node's rivals, which it states, into the node's own answer. */
BLOB_DEVICE_FN void blob_device_blend(const blob_device_vessel* v, const blob_device_place* place,
                                      blob_device_word index, const blob_device_node* node,
                                      blob_device_lane* lane) {
  const blob_device_word rivals = node->rivals;
  if (rivals == 0) return;
  if ((rivals & (rivals - 1)) != 0 ||
      blob_device_blend_one(v, place, index, node, blob_device_first(rivals), lane) == 0)
    blob_device_blend_all(v, place, index, lane);
}

#endif
