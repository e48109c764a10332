/* SPDX-License-Identifier: Apache-2.0 */
#include "score.h"

#include <math.h>
#include <stdlib.h>

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Two unit vectors perpendicular to the unit vector n. */
static void plane_of(const double n[3], double u[3], double v[3]) {
  const int least = fabs(n[0]) < 0.6 ? 0 : 1;
  for (int a = 0; a < 3; ++a) u[a] = (a == least) - n[least] * n[a];
  const double length = sqrt(dot(u, u));
  for (int a = 0; a < 3; ++a) u[a] /= length;
  for (int a = 0; a < 3; ++a)
    v[a] = n[(a + 1) % 3] * u[(a + 2) % 3] - n[(a + 2) % 3] * u[(a + 1) % 3];
}

/* The least eigenvalue of the projected points' covariance is their mean square distance from the
 * line. */
static double rms_from_line(size_t count, const double (*p)[3], const double normal[3]) {
  double u[3], v[3], mean[2] = {0, 0}, uu = 0, uv = 0, vv = 0;
  plane_of(normal, u, v);
  const double n = (double)count;
  for (size_t i = 0; i < count; ++i) {
    mean[0] += dot(p[i], u) / n;
    mean[1] += dot(p[i], v) / n;
  }
  for (size_t i = 0; i < count; ++i) {
    const double x = dot(p[i], u) - mean[0], y = dot(p[i], v) - mean[1];
    uu += x * x / n;
    uv += x * y / n;
    vv += y * y / n;
  }
  const double half = 0.5 * (uu + vv), root = hypot(0.5 * (uu - vv), uv);
  /* the product of both eigenvalues over the greater one: no difference of near equals */
  return half + root > 0 ? sqrt(fmax(0, (uu * vv - uv * uv) / (half + root))) : 0;
}

static int compare(const void* a, const void* b) {
  const double x = *(const double*)a, y = *(const double*)b;
  return (x > y) - (x < y);
}

static void gap_statistics(const blob_model* truth, size_t count, const double (*p)[3],
                           double radius, double* gaps, score* s) {
  uint32_t cursor = blob_cursor_locate(truth, p[0]);
  double sum = 0;
  for (size_t i = 0; i < count; ++i) {
    blob_nearest_point nearest;
    blob_nearest(truth, 0, p[i], &cursor, 1e-7, 0, &nearest);
    gaps[i] = -nearest.distance - radius;
  }
  for (size_t i = 1; i + 1 < count; ++i) {
    const double jerk = gaps[i - 1] - 2 * gaps[i] + gaps[i + 1];
    sum += jerk * jerk;
  }
  for (size_t i = 0; i < count; ++i) gaps[i] = fabs(gaps[i]);
  qsort(gaps, count, sizeof gaps[0], compare);
  s->gap_min = gaps[0];
  s->gap_median = gaps[count / 2];
  s->gap_90 = gaps[count * 9 / 10];
  s->gap_max = gaps[count - 1];
  s->gap_jerk = sqrt(sum / (double)(count - 2));
}

score score_path(const blob_model* truth, size_t count, const double (*positions)[3],
                 const unsigned char* touches, double radius) {
  score s = {0};
  size_t first = 0, end = count;
  while (first < count && !touches[first]) ++first;
  while (end > first && !touches[end - 1]) --end;
  if (end - first < 3) return s;
  const size_t used = end - first;
  double* gaps = malloc(used * sizeof *gaps);
  if (gaps == NULL) return s;
  blob_nearest_point start;
  blob_nearest(truth, 0, positions[first], NULL, 1e-7, 0, &start);
  s.used = used;
  s.line_rms = rms_from_line(used, positions + first, start.normal);
  gap_statistics(truth, used, positions + first, radius, gaps, &s);
  free(gaps);
  return s;
}
