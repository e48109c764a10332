/* SPDX-License-Identifier: Apache-2.0 */
/* A vessel that gives way: the nodes of a model as a tree of elastic tubes in elastic tissue.
 *
 * An edge of the tree is a tube that stretches, shears, bends and twists; surrounding tissue ties
 * each node to its place at rest, with damping. Displacements and rotations are small in the sense
 * of linear elasticity: the matrix of an implicit Euler step is constant and factorised once, along
 * the tree. The model follows as a blob_pose: forces on the wall go to the nodes by
 * blob_query_weights(), nodes carry the wall with them. Lumens keep their width, and links of the
 * model hold nothing.
 *
 * Units: mm, s, N, hence tonnes. */
#ifndef CATHETER_SOFT_VESSEL_H
#define CATHETER_SOFT_VESSEL_H

#include "blob.h"
#include "blob_pose.h"
#include "block_tree.h"
#include "wall.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters of a vessel; soft_vessel_def_default() gives those of an internal carotid artery. */
typedef struct soft_vessel_def {
  double wall_young; /* N/mm^2; 0.8, internal carotid: Alastruey et al., Modelling the circle of
                        Willis to assess the effects of anatomical variations and occlusions on
                        cerebral flows, J Biomech 40, 2007, table 1 (1.6 in smaller arteries) */
  double wall_share; /* thickness of the wall over the radius; 0.25: the same table */
  double tissue;     /* N of one mm of vessel that is moved by one mm; 0.01, between brain and
                        muscle: a body in a medium is held by about the medium's modulus per
                        length (Vesic, Bending of beams resting on isotropic elastic solid, J Eng
                        Mech Div ASCE 87, 1961); no measurement of the tissue at a siphon */
  double damping;    /* s, within which tissue follows; 0.05; no measurement */
  double density;    /* t/mm^3, of wall and blood; 1.06e-9 */
  double time_step;  /* s; that of the rod */
} soft_vessel_def;

soft_vessel_def soft_vessel_def_default(void);

typedef struct soft_vessel {
  soft_vessel_def def;
  const blob_model* rest;
  blob_pose* pose;
  size_t count; /* nodes */
  block_tree tree;
  double (*moved)[kBlock]; /* displacement, mm, and rotation vector of each node */
  double (*held)[kBlock];  /* stiffness of the tissue at each, N/mm and N mm */
  double reaction[3];      /* sum of the forces on the wall in the last step, N */
  uint32_t flags;
  void* scratch;
} soft_vessel;

/* Creates a vessel at rest from a model that must outlive it. Returns 0 if memory ran out or the
 * model's parents form a cycle. */
int soft_vessel_create(soft_vessel* v, const blob_model* rest, const soft_vessel_def* def);
void soft_vessel_destroy(soft_vessel* v);

/* The moving wall, for a rod; the vessel must outlive it. `flags` are those of blob_query(); `start`
 * is the node that points begin at. */
wall wall_of_soft_vessel(soft_vessel* v, uint32_t flags, uint32_t start);

/* The posed model. */
const blob_model* soft_vessel_model(const soft_vessel* v);

/* The sum of the forces of the tissue's springs on the vessel, N: the opposite of `reaction` once
 * the vessel rests. */
void soft_vessel_tissue_force(const soft_vessel* v, double sum[3]);

/* The greatest displacement of a node, mm. */
double soft_vessel_displacement(const soft_vessel* v);

#ifdef __cplusplus
}
#endif
#endif
