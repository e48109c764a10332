/* SPDX-License-Identifier: Apache-2.0 */
/* Direct solution of the equations of a forest: six unknowns at each node, coupled along edges. */
#ifndef CATHETER_BLOCK_TREE_H
#define CATHETER_BLOCK_TREE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { kBlock = 6 };
typedef double block[kBlock][kBlock];

typedef struct block_tree {
  size_t count;
  int32_t* parent; /* or -1; of any order */
  uint32_t* order; /* nodes, each after its parent */
  block* diagonal; /* A[i][i]; then its Cholesky factor */
  block* above;    /* A[i][parent]; then A[i][i]^-1 A[i][parent], all children of i eliminated */
} block_tree;

/* Makes a forest whose blocks are zero. Returns 0 if memory ran out, or if a node is its own
 * ancestor. */
int block_tree_create(block_tree* t, size_t count, const int32_t* parent);
void block_tree_destroy(block_tree* t);

/* Factorises a symmetric positive definite matrix from the leaves to the roots: no block is filled.
 * Returns 0 if it is not positive definite. */
int block_tree_factorise(block_tree* t);

/* Solves A x = b after block_tree_factorise(); `b` becomes x. The caller provides the nodes that may
 * have a right side or move, each after its parent: t->order, or a part of it that holds the parents
 * of its nodes. All others count as zero. */
void block_tree_solve(const block_tree* t, size_t count, const uint32_t* nodes,
                      double (*b)[kBlock]);

/* Writes the diagonal blocks of A^-1 after block_tree_factorise(): the compliance of each node. */
void block_tree_inverse(const block_tree* t, block* inverse);

#ifdef __cplusplus
}
#endif
#endif
