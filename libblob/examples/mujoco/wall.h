/* SPDX-License-Identifier: Apache-2.0 */
/* The wall for a simulator of solids: a gap that is positive where a tool may be, with its
 * gradient. Shared by the collision functions for MuJoCo 2 (vessel.c) and the plugin for MuJoCo 3
 * (plugin.cpp). No memory, no state. */
#ifndef MUJOCO_WALL_H
#define MUJOCO_WALL_H

#include <stdint.h>

#include "blob.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct wall {
  const blob_model* blobs;
  double unit; /* the simulator's length of a millimetre: 1, or 0.001 for metres */
} wall;

/* Answer at a point in the vessel's frame, in the simulator's unit. */
typedef struct wall_answer {
  double gap;       /* distance to the wall, positive in the lumen; NaN for a NaN coordinate */
  double normal[3]; /* unit vector out of the lumen, opposite to the gap's gradient */
} wall_answer;

/* Queries libblob. A caller that follows one point keeps its cursor from call to call; BLOB_NOWHERE
 * searches the whole tree, which sees no walls: it finds the nearer of two vessels that touch. */
wall_answer wall_at(const wall* w, const double point[3], uint32_t* cursor);

/* Finds the deepest point of a capsule's axis by blob_capsule_approach(); returns its fraction of
 * the path from `from` to `to`. */
double wall_deepest(const wall* w, const double from[3], const double to[3], double radius,
                    uint32_t cursor, wall_answer* answer);

/* Box around the vessel and `around` of wall: centre and half sides, in the simulator's unit. */
void wall_box(const wall* w, double around, double box[6]);

#ifdef __cplusplus
}
#endif
#endif
