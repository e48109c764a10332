/* SPDX-License-Identifier: Apache-2.0
 * query_points CASE.lumen: distances of a million points of the vessel's axis, moved by half a radius,
 * on an NVIDIA graphics processor. Needs CUDA's runtime; prints the nearest to the wall. */
#include <blob_cuda.h>
#include <cuda_runtime.h>
#include <stdio.h>
#include <stdlib.h>

enum { COUNT = 1000000 };
static float point[COUNT][3], answer[COUNT][4];
static uint32_t cursor[COUNT];

int main(int argc, char** argv) {
  blob_model* model;
  if (argc != 2 || blob_model_open(argv[1], NULL, &model) != BLOB_OK) return 1;
  for (uint32_t i = 0; i < COUNT; ++i) { /* as a simulator has them on the device already */
    cursor[i] = i % (uint32_t)blob_model_describe(model).node_count;
    const blob_node node = blob_model_node(model, cursor[i]);
    for (int k = 0; k < 3; ++k)
      point[i][k] = (float)(node.centre[k] + (k == 0 ? 0.5 * node.radius : 0));
  }
  const size_t size = blob_device_pack((const blob_model* const*)&model, 1, NULL, 0);
  void* packed = malloc(size);
  blob_device_pack((const blob_model* const*)&model, 1, packed, size);

  char reason[256] = "";
  blob_cuda_def def = blob_cuda_def_default();
  def.message = reason;
  def.message_size = sizeof reason;
  blob_cuda* vessels;
  const blob_cuda_status status = blob_cuda_create(packed, size, &def, &vessels);
  if (status != BLOB_CUDA_OK) return printf("%s: %s\n", blob_cuda_status_text(status), reason), 1;

  void *points, *cursors, *answers;
  cudaStream_t stream;
  cudaStreamCreate(&stream);
  cudaMalloc(&points, sizeof point), cudaMalloc(&cursors, sizeof cursor);
  cudaMalloc(&answers, sizeof answer);
  cudaMemcpyAsync(points, point, sizeof point, cudaMemcpyHostToDevice, stream);
  cudaMemcpyAsync(cursors, cursor, sizeof cursor, cudaMemcpyHostToDevice, stream);
  blob_cuda_columns c = blob_cuda_columns_default();
  c.count = COUNT;
  c.point = points;
  c.cursor = cursors;
  c.answer = answers;
  blob_cuda_query(vessels, stream, BLOB_BLENDED, &c); /* in every step of a simulation */
  cudaMemcpyAsync(answer, answers, sizeof answer, cudaMemcpyDeviceToHost, stream);
  if (cudaStreamSynchronize(stream) != cudaSuccess) return printf("a fault on the device\n"), 1;

  float greatest = answer[0][0];
  for (int i = 1; i < COUNT; ++i) greatest = answer[i][0] > greatest ? answer[i][0] : greatest;
  printf("greatest distance %g mm\n", (double)greatest);
  blob_cuda_close(vessels);
  return 0;
}
