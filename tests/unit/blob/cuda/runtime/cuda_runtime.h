/* SPDX-License-Identifier: Apache-2.0
 * The functions of CUDA's runtime that the example uses, on the stand-in for the driver: streams run
 * where they are waited for, and copies wait in them. Nothing of NVIDIA's header is here. */
#ifndef LUMEN_TEST_CUDA_RUNTIME_H
#define LUMEN_TEST_CUDA_RUNTIME_H

#include <stddef.h>

typedef int cudaError_t;
typedef struct CUstream_st* cudaStream_t;
enum { cudaSuccess = 0 };
enum cudaMemcpyKind { cudaMemcpyHostToDevice = 1, cudaMemcpyDeviceToHost = 2 };

cudaError_t cudaStreamCreate(cudaStream_t* stream);
cudaError_t cudaMalloc(void** memory, size_t bytes);
cudaError_t cudaMemcpyAsync(void* to, const void* from, size_t bytes, enum cudaMemcpyKind kind,
                            cudaStream_t stream);
cudaError_t cudaStreamSynchronize(cudaStream_t stream);

#endif
