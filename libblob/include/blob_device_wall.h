/* SPDX-License-Identifier: Apache-2.0
 *
 * Part of blob_device_exact.h: the state of a search for the nearest point of the wall, how the wall
 * bends about a place, and the step along it.
 */
#ifndef LUMEN_BLOB_DEVICE_WALL_H
#define LUMEN_BLOB_DEVICE_WALL_H

#include "blob_device.h"

/* clang-format off */
/* Stages: the place at which the search waits for f. */
#define BLOB_DEVICE_AT_POINT 0u    /* the query point */
#define BLOB_DEVICE_APPROACHING 1u /* along the normal there */
#define BLOB_DEVICE_BESIDE 2u      /* one of four places across the vessel */
#define BLOB_DEVICE_GLIDING 3u     /* a step along the wall and to it at once */
#define BLOB_DEVICE_CURVING 4u     /* one of two places about the best one */
#define BLOB_DEVICE_PROJECTING 5u  /* on the path to the wall, along normals */
#define BLOB_DEVICE_FOUND 6u
#define BLOB_DEVICE_STOPPED 7u     /* no place is nearer, and the search has not converged */
/* clang-format on */

/* A place, mm relative to the query point, with the answer of f there. */
typedef struct blob_device_foot {
  float at[3], normal[3], value, distance;
  blob_device_word node;
} blob_device_foot;

typedef struct blob_device_search {
  blob_device_foot here, best;          /* the last place, and the best so far */
  float first[3], second[3];            /* unit vectors across the vessel or along the wall */
  float diagonal[3], mixed[3];          /* turn of the normal per mm: xx, yy, zz; xy, xz, yz */
  float begun[3], before[3], turned[3]; /* foot and normal at the last step; normal at `first` */
  float step[3], length, sag, gain;     /* mm, along the wall; bend of the wall; gain in mm^2 */
  float share, reached, nearest;        /* part of the step; distances, mm */
  float radius, tolerance, first_distance;
  blob_device_word stage;
  int is_inside, is_improving, tried, places, steps, slow;
} blob_device_search;

/* ---------------------------------------------------------------- vectors */

BLOB_DEVICE_FN float blob_device_dot(const float* a, const float* b) {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

BLOB_DEVICE_FN float blob_device_size(float x) {
  return x < 0 ? -x : x;
}

BLOB_DEVICE_FN void blob_device_cross(const float* a, const float* b, float* result) {
  result[0] = a[1] * b[2] - a[2] * b[1];
  result[1] = a[2] * b[0] - a[0] * b[2];
  result[2] = a[0] * b[1] - a[1] * b[0];
}

/* result = a + s b */
BLOB_DEVICE_FN void blob_device_along(const float* a, float s, const float* b, float* result) {
  int i;
  for (i = 0; i < 3; ++i) result[i] = a[i] + s * b[i];
}

/* A unit vector at right angles to a vector that is not zero. */
BLOB_DEVICE_FN void blob_device_perpendicular(const float* a, float* result) {
  const float x = blob_device_size(a[0]), y = blob_device_size(a[1]), z = blob_device_size(a[2]);
  float axis[3], inverse;
  int i;
  for (i = 0; i < 3; ++i) axis[i] = 0;
  if (x <= y && x <= z)
    axis[0] = 1;
  else if (y <= z)
    axis[1] = 1;
  else
    axis[2] = 1;
  blob_device_cross(a, axis, result);
  inverse = 1.0f / blob_device_norm(result);
  for (i = 0; i < 3; ++i) result[i] = result[i] * inverse;
}

/* The symmetric matrix of a search times a vector. */
BLOB_DEVICE_FN void blob_device_turn(const blob_device_search* s, const float* a, float* result) {
  result[0] = (s->diagonal[0] * a[0] + s->mixed[0] * a[1]) + s->mixed[1] * a[2];
  result[1] = (s->mixed[0] * a[0] + s->diagonal[1] * a[1]) + s->mixed[2] * a[2];
  result[2] = (s->mixed[1] * a[0] + s->mixed[2] * a[1]) + s->diagonal[2] * a[2];
}

/* ---------------------------------------------------------------- the wall's shape */

/* Adds r m^T + m r^T to the matrix. */
BLOB_DEVICE_FN void blob_device_add_products(blob_device_search* s, const float* r,
                                             const float* m) {
  int i;
  for (i = 0; i < 3; ++i) s->diagonal[i] += 2.0f * (r[i] * m[i]);
  s->mixed[0] += r[0] * m[1] + m[0] * r[1];
  s->mixed[1] += r[0] * m[2] + m[0] * r[2];
  s->mixed[2] += r[1] * m[2] + m[1] * r[2];
}

/* The matrix from the normals at the best place and a short step from there in each direction. */
BLOB_DEVICE_FN void blob_device_shape(blob_device_search* s, float inverse_step) {
  float along_first[3], along_second[3], r[3];
  int i;
  for (i = 0; i < 3; ++i) {
    along_first[i] = (s->turned[i] - s->best.normal[i]) * inverse_step;
    along_second[i] = (s->here.normal[i] - s->best.normal[i]) * inverse_step;
    s->diagonal[i] = s->mixed[i] = 0;
  }
  for (i = 0; i < 3; ++i)
    r[i] = 0.5f * blob_device_dot(along_first, s->first) * s->first[i] +
           0.5f *
               (blob_device_dot(along_first, s->second) + blob_device_dot(along_second, s->first)) *
               s->second[i];
  blob_device_add_products(s, r, s->first);
  for (i = 0; i < 3; ++i) r[i] = 0.5f * blob_device_dot(along_second, s->second) * s->second[i];
  blob_device_add_products(s, r, s->second);
}

/* Corrects the matrix by what a move has turned the normal: the least change of a symmetric matrix
 * that explains the turn (M. Powell, A new algorithm for unconstrained optimization, 1970). */
BLOB_DEVICE_FN void blob_device_bend(blob_device_search* s, const float* moved, const float* turn) {
  const float square = blob_device_dot(moved, moved);
  float missing[3], r[3], inverse, part;
  int i;
  if (!(square > 0)) return;
  inverse = 1.0f / square;
  blob_device_turn(s, moved, missing);
  for (i = 0; i < 3; ++i) missing[i] = turn[i] - missing[i];
  part = 0.5f * inverse * blob_device_dot(missing, moved);
  for (i = 0; i < 3; ++i) r[i] = inverse * (missing[i] - part * moved[i]);
  blob_device_add_products(s, r, moved);
}

/* A step's part along an eigenvector, in which the vector to the query point has this part. */
BLOB_DEVICE_FN float blob_device_part(const blob_device_search* s, float part, float eigenvalue) {
  const float flat = 0.02f, leave = 0.1f; /* least divisor; share of the radius off a maximum */
  if (eigenvalue < -flat && blob_device_size(part) < s->tolerance) return leave * s->radius;
  return part / blob_device_greater(blob_device_size(eigenvalue), flat);
}

/* Solves (I + d S) step = t, the tangential part of the vector to the query point, with the shape
 * operator S of the wall and the distance d: by elimination well within a valley, elsewhere along
 * eigenvectors, downhill. At most half the radius. */
BLOB_DEVICE_FN void blob_device_find_step(blob_device_search* s) {
  const float valley = 0.2f, doubted = 0.2f, longest = 0.5f * s->radius;
  float of_first[3], of_second[3], a, b, c, t1, t2, x, y, distance, share;
  int i;
  blob_device_perpendicular(s->best.normal, s->first);
  blob_device_cross(s->best.normal, s->first, s->second);
  blob_device_turn(s, s->first, of_first);
  blob_device_turn(s, s->second, of_second);
  distance = s->best.distance - blob_device_dot(s->best.at, s->best.normal);
  a = 1.0f + distance * blob_device_dot(s->first, of_first);
  b = distance * blob_device_dot(s->first, of_second);
  c = 1.0f + distance * blob_device_dot(s->second, of_second);
  t1 = -blob_device_dot(s->first, s->best.at);
  t2 = -blob_device_dot(s->second, s->best.at);
  if (a > valley && (a - valley) * (c - valley) > b * b) {
    const float inverse = 1.0f / (a * c - b * b);
    x = inverse * (c * t1 - b * t2);
    y = inverse * (a * t2 - b * t1);
  } else {
    const float mean = 0.5f * (a + c), spread = 0.5f * (a - c);
    const float root = BLOB_DEVICE_SQRT(spread * spread + b * b),
                turn = root > 0 ? spread / root : 1.0f;
    const float cosine = BLOB_DEVICE_SQRT(blob_device_greater(0.5f * (1.0f + turn), 0.0f));
    const float positive = BLOB_DEVICE_SQRT(blob_device_greater(0.5f * (1.0f - turn), 0.0f));
    const float sine = b < 0 ? -positive : positive;
    const float p1 = blob_device_part(s, cosine * t1 + sine * t2, mean + root);
    const float p2 = blob_device_part(s, cosine * t2 - sine * t1, mean - root);
    x = cosine * p1 - sine * p2;
    y = sine * p1 + cosine * p2;
  }
  s->length = BLOB_DEVICE_SQRT(x * x + y * y);
  share = s->length > longest ? longest / s->length : 1.0f;
  x = x * share;
  y = y * share;
  s->length = s->length * share;
  for (i = 0; i < 3; ++i) s->step[i] = x * s->first[i] + y * s->second[i];
  blob_device_turn(s, s->step, of_first);
  s->sag = 0.5f * blob_device_dot(s->step, of_first);
  s->gain = 0.5f * (x * t1 + y * t2);
  if (s->is_improving == 0)
    s->gain = blob_device_greater(s->gain, 0.5f / doubted * (t1 * t1 + t2 * t2));
}

#endif
