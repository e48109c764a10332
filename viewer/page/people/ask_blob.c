/* SPDX-License-Identifier: Apache-2.0 */
/* Answers of the native library at a position, for from_disk.test.mjs: ask_blob MODEL.lumen X Y Z prints the distance to
 * the wall, mm, with all digits, and the node. */
#include <stdio.h>
#include <stdlib.h>

#include "blob.h"

int main(int argc, char** argv) {
  blob_model* model = NULL;
  if (argc != 5 || blob_model_open(argv[1], NULL, &model) != BLOB_OK) {
    fputs("Usage: ask_blob MODEL.lumen X Y Z\n", stderr);
    return 1;
  }
  const double point[3] = {strtod(argv[2], NULL), strtod(argv[3], NULL), strtod(argv[4], NULL)};
  blob_sample s;
  blob_query(model, BLOB_BLENDED | BLOB_DISTANCE_EXACT, point, NULL, &s);
  printf("%.17g %u\n", s.distance, (unsigned)s.node);
  blob_model_close(model);
  return 0;
}
