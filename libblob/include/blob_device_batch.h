/* SPDX-License-Identifier: Apache-2.0
 *
 * blob_device_query() for eight points, in the vectors of OpenCL C: places, models and distances are
 * three loops, as short ones overlap better in a processor. Every operation is that of a single
 * query, so the answers have its bits.
 */
#ifndef LUMEN_BLOB_DEVICE_BATCH_H
#define LUMEN_BLOB_DEVICE_BATCH_H

#include "blob_device.h"

/* Up to eight points and their answers. Points are mm, in the frame of the case; cursors are read
 * and moved. */
typedef struct blob_device_group {
  float point[8][3];
  blob_device_word node[8], state[8], rivals[8];
  float field[4][8];               /* f and its gradient */
  float distance[8], normal[3][8]; /* as in blob_device_sample */
  float x[3][8];                   /* relative to the node's centre, mm */
  float shift[8], radius[8];
} blob_device_group;

/* Bits of the points that are in range and at their nodes. */
BLOB_DEVICE_FN blob_device_word blob_device_place_group(const blob_device_vessel* v,
                                                        blob_device_word flags,
                                                        blob_device_word count,
                                                        blob_device_group* g) {
  blob_device_word bits = 0, k;
  for (k = 0; k < count; ++k) {
    const blob_device_place place = blob_device_place_at(g->point[k]);
    blob_device_word node = g->node[k];
    blob_device_node here;
    blob_device_sample none;
    if (node >= v->node_count) node = blob_device_locate(v, &place);
    here = blob_device_at(v, node, &place);
    if (blob_device_is_out_of_range(&here, &none) == 0) {
      if ((flags & BLOB_DEVICE_HOLD) == 0)
        here = blob_device_follow(v, &place, &node);
      else
        here.rivals = blob_device_rivals(&here);
      bits |= 1u << k;
    }
    g->node[k] = node;
    g->rivals[k] = here.rivals;
  }
  return bits;
}

/* f before its distance, of the points of these bits; any for the others. */
BLOB_DEVICE_FN void blob_device_evaluate_group(const blob_device_vessel* v, blob_device_word flags,
                                               blob_device_word bits, blob_device_group* g) {
  blob_device_word k;
  int i;
  for (k = 0; k < 8; ++k) {
    blob_device_lane lane = {{1.0f, 0.0f, 0.0f, 0.0f}, 0.0f, 1.0f};
    float x[3] = {0.0f, 0.0f, 0.0f};
    if (((bits >> k) & 1u) != 0) {
      const blob_device_place place = blob_device_place_at(g->point[k]);
      blob_device_node node = blob_device_at(v, g->node[k], &place);
      node.rivals = g->rivals[k];
      lane = blob_device_evaluate(v, &node);
      if ((flags & BLOB_DEVICE_LOCAL) == 0) blob_device_blend(v, &place, g->node[k], &node, &lane);
      for (i = 0; i < 3; ++i) x[i] = node.x[i];
    }
    for (i = 0; i < 3; ++i) g->x[i][k] = x[i];
    for (i = 0; i < 4; ++i) g->field[i][k] = lane.field[i];
    g->shift[k] = lane.shift;
    g->radius[k] = lane.radius;
  }
}

/* blob_device_level() of eight points. */
BLOB_DEVICE_FN float8 blob_device_levels(blob_device_word phi, float8 f, float8 shift,
                                         float8 relative, float8* slope) {
  float8 h;
  if (phi == 1) {
    float lanes[8];
    int i;
    vstore8(f, 0, lanes);
    for (i = 0; i < 8; ++i) lanes[i] = blob_device_log(lanes[i]);
    *slope = relative;
    return shift - vload8(0, lanes);
  }
  h = phi == 0 ? sqrt(1.0f / f) : 0.0f - sqrt(f);
  *slope = (phi == 0 ? 0.5f : -0.5f) * h * relative;
  return h;
}

/* blob_device_wall() of eight points. */
BLOB_DEVICE_FN float8 blob_device_walls(float8 difference, float8 slope, float8 radius,
                                        int8 inside) {
  const float8 d = select(difference, -difference, difference < 0.0f), gr = slope * radius;
  const float8 s = sqrt(d * d + gr * gr), t = gr + s;
  const float8 wall =
      d * (t + d) * select((float8)(1.0f), -radius, inside) / (t * select(slope, d + s, inside));
  return select((float8)(0.0f), wall, d > 0.0f);
}

/* blob_device_finish() of eight points. */
BLOB_DEVICE_FN void blob_device_finish_group(const blob_device_vessel* v, blob_device_group* g) {
  const float8 f = vload8(0, g->field[0]), shift = vload8(0, g->shift), zero = 0.0f;
  const float8 radius = vload8(0, g->radius), inverse_f = 1.0f / f;
  const float8 x = vload8(0, g->x[0]), y = vload8(0, g->x[1]), z = vload8(0, g->x[2]);
  const float8 gx = vload8(0, g->field[1]), gy = vload8(0, g->field[2]),
               gz = vload8(0, g->field[3]);
  float8 ex = gx * inverse_f, ey = gy * inverse_f, ez = gz * inverse_f, scale = 1.0f;
  float8 length = sqrt((ex * ex + ey * ey) + ez * ez), distance, inverse, slope;
  int8 inside;
  if (v->phi == 1) scale = select(blob_device_exp_wide(-shift), zero, shift > 87.0f);
  inside = f * scale > v->level;
  distance = v->transformed_level - blob_device_levels(v->phi, f, shift, length, &slope);
  distance = blob_device_walls(distance, slope, radius, inside);
  if (!all(inside)) {
    const float8 to_centre = sqrt((x * x + y * y) + z * z), far = to_centre + radius;
    const float8 near = to_centre - radius, ball = select(near, zero, near < 0.0f);
    const int8 has_vanished = ~inside & ~(f > 1e-20f);
    distance = select(distance, far, ~inside & ~(distance < far));
    distance = select(distance, ball, has_vanished);
    ex = select(ex, -x, has_vanished);
    ey = select(ey, -y, has_vanished);
    ez = select(ez, -z, has_vanished);
    length = select(length, to_centre, has_vanished);
  }
  inverse = select(zero, -1.0f / length, length > 0.0f);
  vstore8(f * scale, 0, g->field[0]);
  vstore8(gx * scale, 0, g->field[1]);
  vstore8(gy * scale, 0, g->field[2]);
  vstore8(gz * scale, 0, g->field[3]);
  vstore8(distance, 0, g->distance);
  vstore8(ex * inverse, 0, g->normal[0]);
  vstore8(ey * inverse, 0, g->normal[1]);
  vstore8(ez * inverse, 0, g->normal[2]);
  vstore8(as_uint8(inside) & BLOB_DEVICE_INSIDE, 0, g->state);
}

/* The answers at the points that are out of range. */
BLOB_DEVICE_FN void blob_device_leave_group(const blob_device_vessel* v, blob_device_word bits,
                                            blob_device_group* g) {
  blob_device_word k;
  int i;
  for (k = 0; k < 8; ++k) {
    blob_device_sample sample;
    if (((bits >> k) & 1u) != 0) {
      const blob_device_place place = blob_device_place_at(g->point[k]);
      const blob_device_node here = blob_device_at(v, g->node[k], &place);
      blob_device_is_out_of_range(&here, &sample);
      g->field[0][k] = sample.value;
      g->distance[k] = sample.distance;
      g->state[k] = sample.state;
      for (i = 0; i < 3; ++i) g->field[i + 1][k] = sample.gradient[i];
      for (i = 0; i < 3; ++i) g->normal[i][k] = sample.normal[i];
    }
  }
}

/* blob_device_query() of the first `count` points of a group. */
BLOB_DEVICE_FN void blob_device_query_group(const blob_device_vessel* v, blob_device_word flags,
                                            blob_device_word count, blob_device_group* g) {
  const blob_device_word bits = blob_device_place_group(v, flags, count, g);
  const blob_device_word others = ((1u << count) - 1u) & ~bits;
  blob_device_evaluate_group(v, flags, bits, g);
  blob_device_finish_group(v, g);
  if (others != 0) blob_device_leave_group(v, others, g);
}

#endif
