/* SPDX-License-Identifier: Apache-2.0
 *
 * blob_wire: guidewires in vessels, many at a time, for programs that learn (C99, C++11).
 *
 * A wire is an elastic rod of equal elements that is pushed, pulled and turned at a place where it
 * enters a vessel. Node 0 is the tip. The nodes that are not in yet lie behind the entry on a
 * straight guide, which clamps the wire. A step finds the balance of
 *   - bending: EI / (2 h^3) |x[i-1] - 2 x[i] + x[i+1] - h^2 c m|^2, where the curve c of the wire
 *     at rest (its bent tip) lies in a direction m that turns with the wire;
 *   - stretch: an element is 100 times as stiff along it as across, and hardly changes its length;
 *   - contact: a spring from where the wire's surface meets the wall, and Coulomb's friction;
 *   - `load`, forces of the caller.
 * The wire does not twist: the turn at the hand is that of the tip, and the torque that this takes
 * is not modelled. There is no mass: steps are quasi-static, with a small drag that bounds motions
 * without resistance.
 *
 * Nodes and quarters of elements stay half the wire's radius inside of the lumen, by the cursors of
 * their nodes: what a step would take out is moved back to the wall, or else stays where it was. A
 * quarter of an element whose ends are deeper than three quarters of its length is taken to be inside.
 *
 * Wires are independent, and none of their bits depends on the number of threads. A step does not
 * allocate. Lengths are mm in the frame of the case, forces N. */
#ifndef LUMEN_BLOB_WIRE_H
#define LUMEN_BLOB_WIRE_H

/* Comments stand in columns. */
/* clang-format off */

#include "blob.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The shape and the material of a wire. */
typedef struct blob_wire_def {
  double spacing;      /* length of an element, mm; default 1 */
  double radius;       /* of the wire's surface, mm; 0.18 */
  double bending;      /* bending stiffness EI of the shaft, N mm^2; 50 */
  double tip_bending;  /* EI at the tip, from which it rises linearly to the shaft's; 2 */
  double tip_length;   /* mm, on which it does; 30 */
  double curve_length; /* mm of the tip that are bent at rest; 8 */
  double curve_angle;  /* radians, by which they are; 0.8 */
  double friction;     /* Coulomb's coefficient; 0.05 */
  double push_limit;   /* N: the hand slips where a push or pull would take more; 2 */
  uint32_t cookie;     /* set by blob_wire_def_default() */
} blob_wire_def;

/* The values above.
 * Returns a definition; change its fields, not its cookie. Cannot fail. O(1). */
blob_wire_def blob_wire_def_default(void) BLOB_NOEXCEPT;

/* The place where a wire begins. */
typedef struct blob_wire_place {
  double entry[3];     /* mm; more than half the wire's radius inside of the lumen */
  double direction[3]; /* of the guide, into the vessel; any length */
  double inserted;     /* mm past the entry at first, along the vessel's course; at least 0 */
  double rotation;     /* radians, at first */
} blob_wire_place;

/* A number of wires with equally many nodes. */
typedef struct blob_wires blob_wires;

/* Columns of all wires, wire w's entries following those of w - 1; they stay in place. */
typedef struct blob_wires_state {
  size_t count, nodes;
  const double* position;  /* count x nodes x 3, mm, from the tip; those on the guide, too */
  const double* inserted;  /* count, mm past the entry */
  const double* rotation;  /* count, radians */
  const double* force;     /* count, N: the hand's push (negative: pull) after the last step */
  const double* pressing;  /* count x nodes x 4, N: on the wall, at each quarter of an element */
  const uint32_t* node;    /* count x nodes: the cursors; of nodes on the guide that of the entry */
  const uint32_t* free;    /* count: nodes past the entry */
  const uint32_t* held;    /* count: nodes that stayed where they were, since the beginning */
  double* load;            /* count x nodes x 3, N: forces on nodes, which the caller may set */
} blob_wires_state;

/* Makes wires without a place.
 * The caller provides their number, at least 1, the nodes of each, 8 to 1000, and a number of
 * threads (0: as many as there are processors).
 * On BLOB_OK *wires is to be closed by blob_wires_close(); otherwise it is null.
 * Fails with BLOB_ERROR_MEMORY, _ARGUMENT or _RANGE. O(count nodes). */
blob_status blob_wires_create(size_t count, size_t nodes, size_t threads,
                              blob_wires** wires) BLOB_NOEXCEPT;

/* Frees wires, or does nothing for null. Cannot fail. */
void blob_wires_close(blob_wires* wires) BLOB_NOEXCEPT;

/* Puts a wire at a place, straight and at rest, and pushes it in.
 * The caller provides the index of the wire; a vessel, which it keeps until the wire has another
 * (null: nothing is around the wire); a definition or null for the default; and the place.
 * Fails with BLOB_ERROR_ARGUMENT (an index that is no wire, a definition without its cookie) or
 * _RANGE (a number out of its range; an entry outside of the lumen). O(nodes inserted / spacing). */
blob_status blob_wires_set(blob_wires* wires, size_t wire, const blob_model* model,
                           const blob_wire_def* def, const blob_wire_place* place) BLOB_NOEXCEPT;

/* Pushes, pulls and turns all wires that have a place.
 * The caller provides a push for each wire, mm (negative: a pull), and a turn, radians. Its tip ends
 * at the entry, and three elements before the whole wire is in.
 * Cannot fail. O(count nodes steps): a push of half an element or less, or 15 degrees, is a step;
 * there are at least two. */
void blob_wires_step(blob_wires* wires, const double* push, const double* turn) BLOB_NOEXCEPT;

/* The state of all wires. Cannot fail. O(1). */
blob_wires_state blob_wires_describe(const blob_wires* wires) BLOB_NOEXCEPT;

#ifdef __cplusplus
}
#endif
#endif
