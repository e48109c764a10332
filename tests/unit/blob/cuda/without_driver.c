/* SPDX-License-Identifier: Apache-2.0
 * The header is C99, and a machine without NVIDIA's driver, or with one that lacks a function, gets a
 * status and its reason. Exit code 77: there is a driver. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "blob_cuda.h"

int main(int argc, char** argv) {
  const float centre[1][3] = {{0, 0, 0}}, radius = 1, width = 0.5f;
  const uint32_t offset[2] = {0, 1};
  char message[256] = "";
  blob_model* model = NULL;
  blob_cuda* vessels = NULL;
  blob_model_def def = blob_model_def_default();
  blob_cuda_def options = blob_cuda_def_default();
  blob_cuda_status status;
  const blob_model* models[1];
  size_t size;
  void* packed;
  def.node_count = 1;
  def.centre = centre;
  def.radius = &radius;
  def.blobs.offset = offset;
  def.blobs.centre = centre;
  def.blobs.width = &width;
  if (argc != 2 || blob_model_create(&def, &model) != BLOB_OK) return 1;
  models[0] = model;
  size = blob_device_pack(models, 1, NULL, 0);
  packed = malloc(size);
  blob_device_pack(models, 1, packed, size);
  options.message = message;
  options.message_size = sizeof message;
  status = blob_cuda_create(packed, size, &options, &vessels);
  printf("%s: %s\n", blob_cuda_status_text(status), message);
  free(packed);
  blob_model_close(model);
  if (status == BLOB_CUDA_OK || status == BLOB_CUDA_ERROR_NO_DEVICE) return 77;
  return status == BLOB_CUDA_ERROR_NO_DRIVER && strstr(message, argv[1]) != NULL ? 0 : 1;
}
