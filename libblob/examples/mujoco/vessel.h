/* SPDX-License-Identifier: Apache-2.0 */
/* A vessel as a geom of MuJoCo 2.x: a box stands for it, and collisions with the box ask libblob.
 * Tools are spheres and capsules. */
#ifndef MUJOCO_VESSEL_H
#define MUJOCO_VESSEL_H

#include <mujoco/mujoco.h>

#include "blob.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Makes the box geom `name` of `m` the vessel. Its body's frame is the case's frame,
 * scaled: one millimetre is `unit` of the model's lengths (1 for a model in mm, 0.001 in metres).
 * The box must enclose the vessel. Collision functions are MuJoCo's globals, so one vessel at a
 * time and one thread; both models must outlive it. Returns 0 if there is no such box or memory ran
 * out. */
int vessel_attach(const mjModel* m, const char* name, const blob_model* blobs, double unit);

/* Restores MuJoCo's own collision functions. */
void vessel_detach(void);

/* The node that a geom follows, once it has been near the vessel; BLOB_NOWHERE before. After moving
 * a tool by hand, vessel_attach() again. */
uint32_t vessel_node(int geom);

#ifdef __cplusplus
}
#endif
#endif
