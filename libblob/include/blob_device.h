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
 * blob_device_exact.h adds the distance to the nearest point of the wall, blob_device_batch.h eight
 * points at once in OpenCL C.
 *
 * Points are floats, mm, in the frame of the case. Every operation is that of blob_query(), in its
 * order: where a compiler divides and takes square roots as IEEE 754 does, and does not fuse a*b+c,
 * answers have the bits of blob_query() at that point; elsewhere they differ by rounding.
 *
 * BLOB_DEVICE_WIDE 1 computes eight neighbours or blobs at once, by the vectors of OpenCL C, with
 * the same bits. It is the default where OpenCL C is compiled for a processor without graphics.
 *
 * In CUDA, blob_device_simt.h reads the buffer in pieces of 16 bytes: `words` must be a multiple of 16
 * there, as all memory of cudaMalloc() is, and nothing may write to the buffer meanwhile.
 *
 * The buffer, version 2: words of 32 bits in the byte order of the host; floats are IEEE 754.
 *
 *     word 0    BLOB_DEVICE_MAGIC
 *          1    version
 *          2    number of words of the buffer
 *          3    number of vessels
 *          4    eight words of each vessel: kernel, number of nodes, first word of the nodes, of
 *               the neighbours and of the blobs, level T and transformed level h_T (floats), first
 *               word after the vessel
 *
 *     a node, 16 words: centre (3 floats, mm), radius (mm), the centre relative to that of the node
 *               whose blobs answer (3 floats, mm), the square of the distance within which only the
 *               first block of neighbours counts (mm^2), first block of blobs, number of them,
 *               first block of neighbours, number of them, what the centre exceeds its floats by
 *               (3 floats, mm; nodes of a pose have centres in doubles), 0
 *     a block of eight neighbours k of node i, 48 words: x, y and z of n, c, and 1 / tau (eight
 *               floats each), nodes k (eight words); p_k - p_i = n . (X - O_i) + c. Padding has a
 *               c of 3e38 and node BLOB_DEVICE_NOWHERE
 *     a block of eight blobs, 40 words: x, y and z of the offset from the node's centre, a (1/mm^2)
 *               and width (mm; eight floats each). Padding is zero
 *
 * Vessels start at multiples of 16 words.
 */
#ifndef LUMEN_BLOB_DEVICE_H
#define LUMEN_BLOB_DEVICE_H

#include "blob_device_blend.h"

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

/* The answer at a place that is not within 1e9 mm of a node; false for any other. */
BLOB_DEVICE_FN int blob_device_is_out_of_range(const blob_device_node* node,
                                               blob_device_sample* sample) {
  const float most = 1e9f;
  float length;
  int i;
  if (node->x[0] <= most && node->x[0] >= -most && node->x[1] <= most && node->x[1] >= -most &&
      node->x[2] <= most && node->x[2] >= -most)
    return 0;
  length = blob_device_norm(node->x);
  sample->value = length - length == 0 ? 0.0f : (length > 0 ? 0.0f : length);
  sample->distance = length - blob_device_float(node->record[3]);
  for (i = 0; i < 3; ++i) {
    sample->gradient[i] = sample->value;
    sample->normal[i] = length > 0 && length <= 3e38f ? node->x[i] / length : sample->value;
  }
  sample->state = 0;
  return 1;
}

/* Moves a cursor, which is a node, to the node that answers at a place; false, with the answer, out of
 * its range. */
BLOB_DEVICE_FN int blob_device_enter(const blob_device_vessel* v, blob_device_word flags,
                                     const blob_device_place* place, blob_device_word* cursor,
                                     blob_device_node* node, blob_device_sample* sample) {
  *node = blob_device_at(v, *cursor, place);
  if (blob_device_is_out_of_range(node, sample)) {
    sample->node = *cursor;
    return 0;
  }
  if ((flags & BLOB_DEVICE_HOLD) == 0)
    *node = blob_device_follow(v, place, cursor);
  else
    node->rivals = blob_device_rivals(node);
  return 1;
}

/* blob_query() at a place, whose cursor is a node; false out of its range. */
BLOB_DEVICE_FN int blob_device_sample_at(const blob_device_vessel* v, blob_device_word flags,
                                         const blob_device_place* place, blob_device_word* cursor,
                                         blob_device_sample* sample) {
  blob_device_node node;
  blob_device_lane lane;
  if (!blob_device_enter(v, flags, place, cursor, &node, sample)) return 0;
  lane = blob_device_evaluate(v, &node);
  if ((flags & BLOB_DEVICE_LOCAL) == 0) blob_device_blend(v, place, *cursor, &node, &lane);
  blob_device_finish(v, &lane, node.x, sample);
  sample->node = *cursor;
  return 1;
}

/* blob_query(): `flags` are BLOB_DEVICE_BLENDED, _LOCAL and _HOLD. The cursor is read and moved;
 * one that is no node is located. A point that is not within 1e9 mm of its node gives zero or NaN,
 * as in blob.h, with an unmoved cursor. */
BLOB_DEVICE_FN void blob_device_query(blob_device_words words, blob_device_word vessel,
                                      blob_device_word flags, const float* point,
                                      blob_device_word* cursor, blob_device_sample* sample) {
  const blob_device_vessel v = blob_device_open(words, vessel);
  const blob_device_place place = blob_device_place_at(point);
  if (*cursor >= v.node_count) *cursor = blob_device_locate(&v, &place);
  blob_device_sample_at(&v, flags, &place, cursor, sample);
}

#endif
