/* SPDX-License-Identifier: Apache-2.0
 *
 * POSIX calls that the C library for WASI declares and has not: each fails, as in missing_calls.h. */
#include <errno.h>

int flock(int descriptor, int operation) {
  (void)descriptor;
  (void)operation;
  errno = ENOSYS;
  return -1;
}
