/* SPDX-License-Identifier: Apache-2.0 */
#include "wall.h"

static wall_answer answer_of(const wall* w, double distance, const double normal[3]) {
  const wall_answer answer = {-distance * w->unit, {normal[0], normal[1], normal[2]}};
  return answer;
}

static void to_mm(const wall* w, const double point[3], double mm[3]) {
  for (int a = 0; a < 3; ++a) mm[a] = point[a] / w->unit;
}

wall_answer wall_at(const wall* w, const double point[3], uint32_t* cursor) {
  double mm[3];
  blob_sample s;
  to_mm(w, point, mm);
  blob_query(w->blobs, BLOB_BLENDED, mm, cursor, &s);
  return answer_of(w, s.distance, s.normal);
}

double wall_deepest(const wall* w, const double from[3], const double to[3], double radius,
                    uint32_t cursor, wall_answer* answer) {
  double a[3], b[3];
  blob_approach deepest;
  to_mm(w, from, a);
  to_mm(w, to, b);
  blob_capsule_approach(w->blobs, BLOB_BLENDED, a, b, radius / w->unit, &cursor, &deepest);
  *answer = answer_of(w, deepest.distance, deepest.normal);
  return deepest.t;
}

void wall_box(const wall* w, double around, double box[6]) {
  const blob_model_info info = blob_model_describe(w->blobs);
  for (int a = 0; a < 3; ++a) {
    box[a] = 0.5 * (info.low[a] + info.high[a]) * w->unit;
    box[3 + a] = 0.5 * (info.high[a] - info.low[a]) * w->unit + around;
  }
}
