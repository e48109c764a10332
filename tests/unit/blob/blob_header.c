/* SPDX-License-Identifier: Apache-2.0
 * The header is C99 and C++11, and a plain C program can use the library. */
/* First, as it must need nothing before it. */
/* clang-format off */
#include "blob.h"

#include "blob_device_exact.h"
#include "blob_pose.h"
/* clang-format on */

#include <stdio.h>

int main(void) {
  const float centre[1][3] = {{0, 0, 0}}, radius = 1, width = 0.5f;
  const uint32_t offset[2] = {0, 1};
  const double point[3] = {0, 0, 0};
  uint32_t cursor = BLOB_NOWHERE;
  blob_sample sample;
  blob_model* model = NULL;
  blob_status status;
  blob_model_def def = blob_model_def_default();
  def.node_count = 1;
  def.centre = centre;
  def.radius = &radius;
  def.blobs.offset = offset;
  def.blobs.centre = centre;
  def.blobs.width = &width;
  status = blob_model_create(&def, &model);
  if (status != BLOB_OK) {
    printf("%s\n", blob_status_text(status));
    return 1;
  }
  blob_query(model, 0, point, &cursor, &sample);
  blob_model_close(model);
  return sample.distance < 0 ? 0 : 1;
}
