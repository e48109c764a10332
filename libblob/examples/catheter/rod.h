/* SPDX-License-Identifier: Apache-2.0 */
/* A thin elastic rod that is pushed into a vessel: a catheter or guidewire to first order.
 *
 * Nodes at equal spacing carry mass; energies of bending (squared second differences) and
 * stretching hold them together. A step is implicit Euler by Newton's method: with the wall's
 * planes at hand, one banded system gives all nodes at once, however stiff the rod. Contact forces
 * are multipliers that carry over from step to step (augmented Lagrangian), so a rod at rest does
 * not sink into the wall. Friction is Coulomb's, regularised: a sticking contact creeps by
 * friction * force / contact stiffness per step.
 *
 * A wall that gives way gets the contact forces after each iteration and moves. The next iteration
 * holds each contact on a spring as soft as the wall, beginning at the force that the wall bears
 * already: where wall and rod agree, the spring is at rest and changes nothing, and a bound of the
 * wall's compliance keeps the exchange from overshooting along the normal. A force that turns, as in
 * a vessel's end, moves the wall sideways, so the wall bears only a part of the change at once.
 * Friction acts on both, by the slip against the frame of the case.
 *
 * Units: mm, s, N, hence tonnes. */
#ifndef CATHETER_ROD_H
#define CATHETER_ROD_H

#include <stddef.h>
#include <stdint.h>

#include "wall.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters of a rod: from rod_def_default(), then with entry and direction set. */
typedef struct rod_def {
  size_t elements;       /* default 200 */
  double element_length; /* mm; 0.5 */
  double radius;         /* radius of the rod's surface, mm; 0.15 */
  double young;          /* N/mm^2; 1e5, that is 100 GPa (thesis 5.5) */
  double density;        /* t/mm^3; 6.5e-9 */
  double friction;       /* Coulomb's coefficient; 0.1 */
  double time_step;      /* s; 0.001 */
  int iterations;        /* Newton steps in a time step; 4 */
  int detect_once;       /* 1: the wall is asked once a step, and its planes are kept; 0: at each
                            iteration */
  double entry[3];       /* mm; the rest of the rod lies behind this point on a straight guide */
  double direction[3];   /* unit vector of that guide, into the vessel */
} rod_def;

rod_def rod_def_default(void);

typedef struct rod_contact {
  double distance;  /* from `anchor` to the wall, mm */
  double normal[3]; /* outward */
  double anchor[3]; /* position of the node when the wall was asked, mm */
  double force;     /* N, along -normal; >= 0 */
  double drag[3];   /* friction on the wall, N */
  double push[3];   /* force that a wall that gives way bears, friction included, N */
  double yield;     /* mm/N, of a wall that gives way: see wall.press; else 0 */
  int active;       /* 1: it holds the node on the wall's plane, until the force would pull */
} rod_contact;

typedef struct rod {
  rod_def def;
  size_t node_count;     /* elements + 1; node 0 is the tip */
  size_t free_count;     /* nodes past the entry; the others lie on the guide */
  double inserted;       /* mm of rod past the entry */
  double (*position)[3]; /* mm */
  double (*velocity)[3]; /* mm/s */
  uint32_t* cursor;
  rod_contact* contact;
  size_t contact_count; /* nodes that press on the wall after the last step */
  double wall_seconds;  /* seconds in wall.query() in the last step */
  double yield_seconds; /* seconds in wall.press() */
  double solver_seconds;
  void* scratch;
} rod;

/* Creates a rod with `inserted` mm past the entry, straight and at rest. Returns 0 if memory ran
 * out. */
int rod_create(rod* r, const rod_def* def, const wall* w, double inserted);
void rod_destroy(rod* r);

/* Makes one time step: the rod is pushed at `speed` mm/s until no element is left outside. */
void rod_step(rod* r, const wall* w, double speed);

#ifdef __cplusplus
}
#endif
#endif
