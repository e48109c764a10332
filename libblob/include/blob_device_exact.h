/* SPDX-License-Identifier: Apache-2.0
 *
 * libblob on other processors: distance and normal of the nearest point of the wall, as
 * BLOB_DISTANCE_EXACT gives them, for the buffer of blob_device.h and in its part of C.
 *
 *     blob_device_query_exact(words, vessel, BLOB_DEVICE_BLENDED, point, &cursor, &s);
 *
 * The search is that of libblob/src/nearest.cpp, in floats relative to the query point and as
 * steps between evaluations of f, so that one copy of the query is in a kernel. It learns how the
 * wall bends from its normals at two places about a foot, not from second derivatives. The distance
 * is right to 1e-5 of the node's radius; bits are not those of blob_query().
 */
#ifndef LUMEN_BLOB_DEVICE_EXACT_H
#define LUMEN_BLOB_DEVICE_EXACT_H

#include "blob_device_wall.h"

/* clang-format off */
#define BLOB_DEVICE_EXACT 2u         /* flag of blob.h, for kernels */
#define BLOB_DEVICE_NOT_CONVERGED 2u /* state */
/* clang-format on */

/* ---------------------------------------------------------------- stages */

/* Waits for f at a vector from the best place. */
BLOB_DEVICE_FN void blob_device_wait(blob_device_search* s, blob_device_word stage, float share,
                                     const float* vector) {
  blob_device_along(s->best.at, share, vector, s->here.at);
  s->here.node = s->best.node;
  s->stage = stage;
}

/* A unit vector along the vessel at a node; any for a node alone. */
BLOB_DEVICE_FN void blob_device_axis(const blob_device_vessel* v, blob_device_word node,
                                     float* axis) {
  blob_device_words record = v->words + v->nodes + BLOB_DEVICE_NODE_WORDS * node;
  blob_device_words first = v->words + v->neighbours + BLOB_DEVICE_NEIGHBOUR_WORDS * record[10];
  float length;
  int i;
  for (i = 0; i < 3; ++i) axis[i] = blob_device_float(first[8 * i]);
  length = blob_device_norm(axis);
  for (i = 0; i < 3; ++i) axis[i] = length > 0 ? axis[i] / length : (i == 0 ? 1.0f : 0.0f);
}

/* Waits at the side of this number of a point in the lumen, whose normal leads along the vessel. */
BLOB_DEVICE_FN void blob_device_go_beside(blob_device_search* s) {
  const float across = 0.7f * s->radius, signed_length = (s->tried & 1) == 0 ? across : -across;
  int i;
  for (i = 0; i < 3; ++i)
    s->here.at[i] = signed_length * (s->tried < 2 ? s->first[i] : s->second[i]);
  s->stage = BLOB_DEVICE_BESIDE;
}

/* Distance between places whose normals give the wall's bend, mm: about the root of the rounding of
 * normals, below which that takes over. */
BLOB_DEVICE_FN float blob_device_reach(const blob_device_search* s) {
  return 0.002f * s->radius;
}

/* Waits for normals at two places about the best one, which state how the wall bends there. */
BLOB_DEVICE_FN void blob_device_curve(blob_device_search* s) {
  const float reach = blob_device_reach(s);
  blob_device_perpendicular(s->best.normal, s->first);
  blob_device_cross(s->best.normal, s->first, s->second);
  s->tried = 0;
  blob_device_wait(s, BLOB_DEVICE_CURVING, reach, s->first);
}

/* Waits after a share of the step, on the wall as it is thought to bend. */
BLOB_DEVICE_FN void blob_device_go_on(blob_device_search* s) {
  const float depth = s->best.distance + s->share * s->share * s->sag;
  blob_device_wait(s, BLOB_DEVICE_GLIDING, s->share, s->step);
  blob_device_along(s->here.at, -depth, s->best.normal, s->here.at);
}

/* Goes to the wall along the normal of the last place; waits where that was long. Returns whether
 * the place is on the wall. */
BLOB_DEVICE_FN int blob_device_project(const blob_device_vessel* v, blob_device_search* s) {
  const int is_near = blob_device_size(s->here.distance) <= 0.5f * s->tolerance;
  float axis[3];
  if (!(s->here.value > 1e-20f) && !(blob_device_size(s->here.distance) > 0)) {
    s->stage = BLOB_DEVICE_STOPPED;
    return 0;
  }
  if (!(blob_device_dot(s->here.normal, s->here.normal) > 0)) {
    blob_device_axis(v, s->here.node, axis);
    blob_device_perpendicular(axis, s->here.normal);
  }
  blob_device_along(s->here.at, -s->here.distance, s->here.normal, s->here.at);
  s->here.distance = 0;
  s->stage = BLOB_DEVICE_PROJECTING;
  return is_near;
}

/* Follows the wall downhill in steps from wall to wall, each halved until the distance decreases. */
BLOB_DEVICE_FN void blob_device_improve(const blob_device_vessel* v, blob_device_search* s) {
  const int most_halvings = 8;
  const float stalled = 1e-3f; /* share of the squared distance: converged if no step leads on */
  float length;
  if (blob_device_project(v, s) == 0) return;
  length = blob_device_norm(s->here.at);
  if (s->is_improving == 0 || length < s->nearest) {
    s->is_improving = 1;
    s->nearest = length;
    s->best = s->here;
    blob_device_curve(s);
    return;
  }
  s->places += 1;
  s->share = 0.5f * s->share;
  if (s->places < most_halvings)
    blob_device_wait(s, BLOB_DEVICE_PROJECTING, s->share, s->step);
  else
    s->stage =
        s->gain <= stalled * (s->nearest * s->nearest) ? BLOB_DEVICE_FOUND : BLOB_DEVICE_STOPPED;
}

/* Goes on from the best place, where steps along the wall lead on no farther. */
BLOB_DEVICE_FN void blob_device_stop_gliding(const blob_device_vessel* v, blob_device_search* s) {
  s->here = s->best;
  s->is_improving = 0;
  blob_device_improve(v, s);
}

/* Makes the step from the best place by the shape of the wall. */
BLOB_DEVICE_FN void blob_device_make_step(blob_device_search* s) {
  const float enough = 0.1f * s->tolerance;  /* least gain, and off the wall: mm */
  const float slow = 0.6f, misjudged = 0.3f; /* of the step before; of (off / R)^2 */
  const float before = s->steps == 0 || s->share < 1 ? 0.0f : s->length;
  const float off = s->best.distance;
  float length;
  int i;
  blob_device_find_step(s);
  s->share = 1;
  if (s->is_improving != 0) {
    s->places = 0;
    if (s->length <= s->tolerance || s->gain <= enough * s->nearest)
      s->stage = BLOB_DEVICE_FOUND;
    else
      blob_device_wait(s, BLOB_DEVICE_PROJECTING, 1.0f, s->step);
    return;
  }
  blob_device_along(s->best.at, -off, s->best.normal, s->begun);
  for (i = 0; i < 3; ++i) s->before[i] = s->best.normal[i];
  length = blob_device_norm(s->begun);
  s->reached = length + misjudged * off * off / s->radius;
  s->steps += 1;
  if (before > 0 && s->length > slow * before) s->slow += 1;
  if (off * off <= enough * s->radius && s->gain <= enough * length)
    s->stage = BLOB_DEVICE_FOUND;
  else
    blob_device_go_on(s);
}

/* Goes on along the wall to the nearest point; each step must shorten the distance. */
BLOB_DEVICE_FN void blob_device_glide(const blob_device_vessel* v, blob_device_search* s) {
  const int most_places = 12, most_slow = 1;
  const float shorten = 0.4f, least_share = 0.1f, off_wall = 0.1f * s->radius;
  float foot[3], turn[3];
  blob_device_along(s->here.at, -s->here.distance, s->here.normal, foot);
  if (s->places == 0) s->best = s->here;
  s->places += 1;
  if (s->places > most_places || !(s->here.value > 1e-20f)) {
    blob_device_stop_gliding(v, s);
    return;
  }
  if (s->steps > 0 && blob_device_norm(foot) > s->reached) {
    s->share = shorten * s->share;
    if (s->share < least_share)
      blob_device_stop_gliding(v, s);
    else
      blob_device_go_on(s);
    return;
  }
  s->best = s->here;
  if (blob_device_size(s->here.distance) > off_wall) {
    blob_device_wait(s, BLOB_DEVICE_GLIDING, -s->here.distance, s->here.normal);
  } else if (s->steps == 0 || s->slow > most_slow) {
    blob_device_curve(s);
  } else {
    blob_device_along(foot, -1.0f, s->begun, foot);
    blob_device_along(s->best.normal, -1.0f, s->before, turn);
    blob_device_bend(s, foot, turn);
    blob_device_make_step(s);
  }
}

/* ---------------------------------------------------------------- the search */

/* After f at the query point. */
BLOB_DEVICE_FN void blob_device_leave_point(const blob_device_vessel* v, blob_device_search* s) {
  s->first_distance = s->here.distance;
  s->best = s->here;
  if (s->here.value > 1e-20f)
    blob_device_wait(s, BLOB_DEVICE_APPROACHING, -s->here.distance, s->here.normal);
  else
    blob_device_improve(v, s);
}

/* After f along the normal of the query point, which may lead along the vessel about its axis. */
BLOB_DEVICE_FN void blob_device_arrive(const blob_device_vessel* v, blob_device_search* s) {
  const int is_deep = s->is_inside != 0 && s->first_distance < -0.5f * s->radius;
  float axis[3];
  if (is_deep && s->here.distance < 0.5f * s->first_distance) {
    blob_device_axis(v, s->best.node, axis);
    blob_device_perpendicular(axis, s->first);
    blob_device_cross(axis, s->first, s->second);
    s->here.node = s->best.node;
    blob_device_go_beside(s);
  } else {
    blob_device_glide(v, s);
  }
}

/* After f at a side: the one where the wall is nearest is the best. */
BLOB_DEVICE_FN void blob_device_choose_side(blob_device_search* s) {
  if (s->tried == 0 || s->here.distance > s->best.distance) s->best = s->here;
  s->tried += 1;
  s->here.node = s->best.node;
  if (s->tried < 4)
    blob_device_go_beside(s);
  else
    blob_device_wait(s, BLOB_DEVICE_GLIDING, -s->best.distance, s->best.normal);
}

/* After f at a place about the best one. */
BLOB_DEVICE_FN void blob_device_see_shape(blob_device_search* s) {
  const float reach = blob_device_reach(s);
  int i;
  s->tried += 1;
  if (s->tried == 1) {
    for (i = 0; i < 3; ++i) s->turned[i] = s->here.normal[i];
    blob_device_wait(s, BLOB_DEVICE_CURVING, reach, s->second);
  } else {
    blob_device_shape(s, 1.0f / reach);
    blob_device_make_step(s);
  }
}

/* Takes f at the place where the search waits, and goes on to the next. */
BLOB_DEVICE_FN void blob_device_advance(const blob_device_vessel* v, blob_device_search* s,
                                        const blob_device_sample* there) {
  int i;
  s->here.value = there->value;
  s->here.distance = there->distance;
  s->here.node = there->node;
  for (i = 0; i < 3; ++i) s->here.normal[i] = there->normal[i];
  if (s->stage == BLOB_DEVICE_AT_POINT)
    blob_device_leave_point(v, s);
  else if (s->stage == BLOB_DEVICE_APPROACHING)
    blob_device_arrive(v, s);
  else if (s->stage == BLOB_DEVICE_BESIDE)
    blob_device_choose_side(s);
  else if (s->stage == BLOB_DEVICE_GLIDING)
    blob_device_glide(v, s);
  else if (s->stage == BLOB_DEVICE_CURVING)
    blob_device_see_shape(s);
  else
    blob_device_improve(v, s);
}

BLOB_DEVICE_FN void blob_device_begin_search(blob_device_search* s, blob_device_word node) {
  int i;
  for (i = 0; i < 3; ++i) s->here.at[i] = 0;
  s->here.node = node;
  s->stage = BLOB_DEVICE_AT_POINT;
  s->share = 1;
  s->length = s->sag = s->gain = s->reached = s->nearest = 0;
  s->is_improving = s->tried = s->places = s->steps = s->slow = 0;
}

/* Replaces distance and normal by those of the best place's foot. */
BLOB_DEVICE_FN void blob_device_report(const blob_device_search* s, blob_device_sample* sample) {
  float foot[3], length;
  int i;
  blob_device_along(s->best.at, -s->best.distance, s->best.normal, foot);
  length = blob_device_norm(foot);
  sample->distance = s->is_inside != 0 ? -length : length;
  for (i = 0; i < 3; ++i) sample->normal[i] = s->best.normal[i];
  if (s->stage != BLOB_DEVICE_FOUND) sample->state = sample->state | BLOB_DEVICE_NOT_CONVERGED;
}

/* blob_query() with BLOB_DISTANCE_EXACT; arguments are those of blob_device_query(). Some tens of
 * evaluations, at most 128; a point whose search ends with BLOB_DEVICE_NOT_CONVERGED has the nearest
 * place so far. */
BLOB_DEVICE_FN void blob_device_query_exact(blob_device_words words, blob_device_word vessel,
                                            blob_device_word flags, const float* point,
                                            blob_device_word* cursor, blob_device_sample* sample) {
  const blob_device_vessel v = blob_device_open(words, vessel);
  const int most = 128;
  blob_device_place place = blob_device_place_at(point);
  blob_device_search s;
  int n, i;
  if (*cursor >= v.node_count) *cursor = blob_device_locate(&v, &place);
  blob_device_begin_search(&s, *cursor);
  for (n = 0; n < most; ++n) {
    blob_device_sample there;
    blob_device_word node = s.here.node;
    int in_range;
    for (i = 0; i < 3; ++i) place.step[i] = s.here.at[i];
    in_range = blob_device_sample_at(&v, flags, &place, &node, &there);
    if (n == 0) {
      *sample = there;
      *cursor = node;
      if (in_range == 0) return;
      s.is_inside = (there.state & BLOB_DEVICE_INSIDE) != 0;
      s.radius = blob_device_float(v.words[v.nodes + BLOB_DEVICE_NODE_WORDS * node + 3]);
      s.tolerance = 1e-5f * s.radius;
    }
    blob_device_advance(&v, &s, &there);
    if (s.stage >= BLOB_DEVICE_FOUND) break;
  }
  blob_device_report(&s, sample);
}

#endif
