/* SPDX-License-Identifier: Apache-2.0 */
/* Direct solution of the equations of a chain, whose matrix is a narrow band about its diagonal. */
#ifndef CATHETER_BANDED_H
#define CATHETER_BANDED_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A node is coupled to two nodes on either side, three coordinates each. */
enum { kBand = 9 };

/* Solves A x = b for a symmetric positive definite A by Cholesky's factorisation. Row i of `lower`
 * holds A[i][i - 8] .. A[i][i] and is overwritten; `b` becomes x. Returns 0 if A is not positive
 * definite. */
int banded_solve(size_t size, double (*lower)[kBand], double* b);

#ifdef __cplusplus
}
#endif
#endif
