/* SPDX-License-Identifier: Apache-2.0 */
/* The whole of libblob's use in a simulator: a ball that is pushed along a vessel, and stays in it.
 *
 *     python3 libblob/amalgamate.py blob && c++ -std=c++20 -O2 -c blob/blob.cpp
 *     cc -DBLOB_STATIC -Iblob libblob/examples/cursor.c blob.o -lstdc++ -lm -o cursor && ./cursor head.lumen
 */
#include <blob.h>
#include <math.h>
#include <stdio.h>

int main(int argc, char** argv) {
  char message[256] = "";
  blob_model* vessel;
  blob_open_def def = blob_open_def_default();
  def.message = message;
  def.message_size = sizeof message;
  if (argc != 2 || blob_model_open(argv[1], &def, &vessel) != BLOB_OK) {
    fprintf(stderr, "cursor: %s\n", argc == 2 ? message : "expected a case, such as head.lumen");
    return 1;
  }
  const blob_node start = blob_model_node(vessel, 0), next = blob_model_node(vessel, 1);
  const double step = start.radius / 4, ball = start.radius / 8; /* mm */
  double point[3], way[3], deepest = -INFINITY;
  uint32_t cursor =
      0; /* the ball's node: it moves along the tree with the ball, so a vessel beside it is never met */
  for (int axis = 0; axis < 3; ++axis) {
    point[axis] = start.centre[axis];
    way[axis] = next.centre[axis] - start.centre[axis];
  }
  for (int k = 0; k < 400; ++k) {
    blob_sample s;
    const double length = sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
    for (int axis = 0; axis < 3; ++axis) point[axis] += step * way[axis] / length;
    blob_query(vessel, 0, point, &cursor, &s);
    const double depth = s.distance + ball; /* of the ball behind the wall, mm */
    for (int axis = 0; axis < 3 && depth > 0; ++axis) {
      point[axis] -= depth * s.normal[axis];
      way[axis] -= 0.5 * length * s.normal[axis]; /* the wall turns it */
    }
    blob_query(vessel, 0, point, &cursor, &s);
    if (s.distance > deepest) deepest = s.distance;
  }
  printf(
      "at (%.2f, %.2f, %.2f) mm, node %u; the centre was never nearer to the wall than %.3f mm\n",
      point[0], point[1], point[2], (unsigned)cursor, -deepest);
  blob_model_close(vessel);
  return 0;
}
