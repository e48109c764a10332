// SPDX-License-Identifier: Apache-2.0
// POSIX calls that the C library for WASI has not, and that sources name: each fails, with ENOSYS, as a file system without
// locks, owners and processes would let it. The module is handed bytes and opens no file.
#ifndef LUMEN_WASM_MISSING_CALLS
#define LUMEN_WASM_MISSING_CALLS

#include <errno.h>
#include <sys/types.h>

static inline int lumenMissing(void) {
  errno = ENOSYS;
  return -1;
}

#define LOCK_EX 2
#define LOCK_NB 4
#define flock(...) lumenMissing()
#define copy_file_range(...) lumenMissing()

#endif
