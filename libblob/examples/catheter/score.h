/* SPDX-License-Identifier: Apache-2.0 */
/* Smoothness of a tip's path along a wall (Yureidini's thesis, 5.5.3). */
#ifndef CATHETER_SCORE_H
#define CATHETER_SCORE_H

#include <stddef.h>

#include "blob.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Score of the positions from the first to the last that touches. */
typedef struct score {
  size_t used;
  /* Root mean square distance, mm, from the line fitted to them in the plane of the wall at the
   * first. It is meaningful where the true path is straight, as in a capsule. */
  double line_rms;
  /* Statistics of |gap| from the tip's surface to the true wall, mm. */
  double gap_min, gap_median, gap_90, gap_max;
  /* Root mean square of the gap's second differences from position to position, mm: jerks. */
  double gap_jerk;
} score;

/* Scores a path. `truth` is the surface that `positions` slid on, `touches[i]` states whether the
 * tip touched at i, and `radius` is the tool's, mm. Distances are exact. used is 0 if fewer than
 * three positions remain or memory ran out. */
score score_path(const blob_model* truth, size_t count, const double (*positions)[3],
                 const unsigned char* touches, double radius);

#ifdef __cplusplus
}
#endif
#endif
