/* SPDX-License-Identifier: Apache-2.0 */
/* The wall as a simulator of solids asks for it: positive where a tool may be, with its gradient. Shared by the
 * collision functions for MuJoCo 2 (vessel.c) and the plugin for MuJoCo 3 (plugin.c). No memory, no state. */
#ifndef MUJOCO_WALL_H
#define MUJOCO_WALL_H

#include <stdint.h>

#include "blob.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct wall {
  const blob_model* blobs;
  double unit; /* of the simulator's lengths in a millimetre: 1, or 0.001 for metres */
} wall;

/* Of a point in the vessel's frame, in the simulator's unit. */
typedef struct wall_answer {
  double gap; /* to the wall, in that unit: positive in the lumen; NaN for a point that is none */
  double normal[3]; /* unit vector out of the lumen; the gap's gradient is its opposite */
} wall_answer;

/* Asks libblob. The cursor is kept from call to call by who follows one point; BLOB_NOWHERE looks in the whole tree,
 * which sees no walls: of two vessels that touch it finds the nearer. */
wall_answer wall_at(const wall* w, const double point[3], uint32_t* cursor);

/* The deepest point of a capsule's axis, as blob_capsule_approach() finds it: its share of the way. */
double wall_deepest(const wall* w, const double from[3], const double to[3], double radius,
                    uint32_t cursor, wall_answer* answer);

/* Middle and half sides of a box of the simulator's unit that holds the vessel and `around` of wall. */
void wall_box(const wall* w, double around, double box[6]);

#ifdef __cplusplus
}
#endif
#endif
