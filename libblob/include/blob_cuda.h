/* SPDX-License-Identifier: Apache-2.0
 *
 * libblob on NVIDIA's graphics processors (C99, C++11): the query of blob.h for columns of points
 * in device memory, on a stream of the caller.
 *
 *     blob_cuda* vessels;
 *     if (blob_cuda_create(packed, bytes, NULL, &vessels) != BLOB_CUDA_OK) return 1;
 *     blob_cuda_columns c = blob_cuda_columns_default();
 *     c.count = 6553600;                                  // all from cudaMalloc(), cuMemAlloc(),
 *     c.point = point;                                    // PyTorch, CuPy...
 *     c.cursor = cursor;                                  // kept from step to step
 *     c.answer = answer;                                  // distance and normal
 *     blob_cuda_query(vessels, stream, BLOB_BLENDED, &c); // returns before the answers are there
 *
 * `packed` is a buffer of blob_device_pack() in host memory, of any number of vessels. Points are
 * floats, mm, in the frame of the case. Answers are those of blob_device.h, which this library
 * compiles for the device.
 *
 * Neither this header nor the library needs NVIDIA's SDK: the driver, libcuda.so.1, is loaded by
 * blob_cuda_create(), and translates the kernels (PTX of compute capability 7.0) for its device.
 *
 * Streams. A query is at most three launches of kernels, one for BLOB_LOCAL and for
 * BLOB_DISTANCE_EXACT: it neither waits, nor allocates, nor copies. Queries of one stream follow one
 * another, so one that reads cursors sees those that the one before has moved; queries of different
 * streams must not share columns that they write. Faults within a kernel appear where the caller
 * waits for the stream, as those of its own kernels.
 *
 * Speed. Points that follow one another along a vessel share what a processor loads, so keep the
 * points of a tool together; answers at addresses that are multiples of 16 are written at once.
 *
 * Threads. Any number of threads may query one object.
 */
#ifndef LUMEN_BLOB_CUDA_H
#define LUMEN_BLOB_CUDA_H

/* Comments stand in columns. */
/* clang-format off */

#include "blob.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------- status */

/* Result of a call. Values are only appended. */
typedef enum blob_cuda_status {
  BLOB_CUDA_OK = 0,
  BLOB_CUDA_ERROR_MEMORY = 1,        /* the system has no more memory */
  BLOB_CUDA_ERROR_ARGUMENT = 2,      /* a null pointer, a definition or columns not made by their
                                        default function, or a vessel that the buffer has not */
  BLOB_CUDA_ERROR_BUFFER = 3,        /* blob_device_check() refuses the buffer */
  BLOB_CUDA_ERROR_NO_DRIVER = 4,     /* libcuda.so.1 cannot be loaded, or lacks a function */
  BLOB_CUDA_ERROR_NO_DEVICE = 5,     /* there is no such device, or it cannot be used */
  BLOB_CUDA_ERROR_DEVICE_MEMORY = 6, /* the device has not enough memory, or copying to it failed */
  BLOB_CUDA_ERROR_KERNEL = 7,        /* the driver does not translate the kernels */
  BLOB_CUDA_ERROR_LAUNCH = 8         /* the driver refuses a query: a stream of another device, or an
                                        earlier fault in the context */
} blob_cuda_status;

/* Describes a status.
 * Takes any value, also one that is no status.
 * Returns one English sentence without a full stop, static, never null. O(1). */
BLOB_API const char* blob_cuda_status_text(blob_cuda_status status) BLOB_NOEXCEPT;

/* ---------------------------------------------------------------- vessels on a device */

/* A packed buffer and the kernels in the memory of one device. */
typedef struct blob_cuda blob_cuda;

/* Options. */
typedef struct blob_cuda_def {
  int device;          /* number of the device, whose primary context is used, as by CUDA's runtime,
                          PyTorch and others; -1 (default): the context that is current on the
                          calling thread, and where there is none the primary one of device 0 */
  char* message;       /* null, or a buffer for a zero-terminated sentence about a failure */
  size_t message_size; /* bytes at `message` */
  uint32_t cookie;     /* set by blob_cuda_def_default() */
} blob_cuda_def;

/* Default options.
 * Returns a definition; change its fields, not its cookie. Cannot fail. O(1). */
BLOB_API blob_cuda_def blob_cuda_def_default(void) BLOB_NOEXCEPT;

/* Checks a packed buffer, and copies it and the kernels to a device.
 * The caller provides `size` bytes of host memory, aligned to 4, which it may free afterwards, and a
 * definition or null for the default.
 * On BLOB_CUDA_OK *vessels is to be closed by blob_cuda_close(); otherwise it is null.
 * Fails with any status but _LAUNCH; def->message, if not null, receives the driver's reason.
 * O(size), and up to seconds where the driver translates the kernels for the first time. */
BLOB_API blob_cuda_status blob_cuda_create(const void* buffer, size_t size,
                                           const blob_cuda_def* def,
                                           blob_cuda** vessels) BLOB_NOEXCEPT;

/* Frees the memory on the device. All queries must have ended; a context that was current at
 * creation must still exist. Null is allowed. Cannot fail. O(1). */
BLOB_API void blob_cuda_close(blob_cuda* vessels) BLOB_NOEXCEPT;

/* The buffer in device memory, aligned to 256 bytes, for kernels of the caller that call
 * blob_device_query().
 * Returns its address; it lives as long as the object. Cannot fail. O(1). */
BLOB_API const uint32_t* blob_cuda_words(const blob_cuda* vessels) BLOB_NOEXCEPT;

/* Number of vessels in the buffer. Cannot fail. O(1). */
BLOB_API uint32_t blob_cuda_vessel_count(const blob_cuda* vessels) BLOB_NOEXCEPT;

/* ---------------------------------------------------------------- queries */

/* Points and answers in device memory, one after another, aligned to 4 bytes. */
typedef struct blob_cuda_columns {
  uint32_t count;
  uint32_t vessel;             /* the vessel of all points, if `vessel_of_point` is null */
  const uint32_t* vessel_of_point; /* the vessel of each point; one that the buffer has not answers
                                      NaN, outside, with an unmoved cursor */
  const float* point;          /* x, y, z of each point, mm */
  uint32_t* cursor;            /* read and moved; BLOB_NOWHERE: located by a look at every node */
  float* answer;               /* of each point: distance in mm, and outward normal (4 floats) */
  float* value;                /* null, or of each point: f in mm, and its gradient (4 floats) */
  uint32_t* state;             /* null, or of each point: BLOB_INSIDE and BLOB_NOT_CONVERGED */
  uint32_t cookie;             /* set by blob_cuda_columns_default() */
} blob_cuda_columns;

/* Columns without data, of vessel 0.
 * Returns them; set count, point, cursor and answer at least. Cannot fail. O(1). */
BLOB_API blob_cuda_columns blob_cuda_columns_default(void) BLOB_NOEXCEPT;

struct CUstream_st; /* cudaStream_t and CUstream are pointers to it */

/* Puts blob_device_query() at many points on a stream, or with BLOB_DISTANCE_EXACT
 * blob_device_query_exact(), and returns before the answers are there.
 * The caller provides a stream of the device of the object (null: its default stream), flags as for
 * blob_query(), and columns; the structure itself may change after the call. A stream that is being
 * captured into a graph records the launches.
 * Fails with BLOB_CUDA_ERROR_ARGUMENT, without a launch, and _LAUNCH, after which answers are
 * undefined and cursors are located anew.
 * O(1) on the host. */
BLOB_API blob_cuda_status blob_cuda_query(const blob_cuda* vessels, struct CUstream_st* stream,
                                          uint32_t flags,
                                          const blob_cuda_columns* columns) BLOB_NOEXCEPT;

#ifdef __cplusplus
}
#endif
#endif
