/* SPDX-License-Identifier: Apache-2.0 */
#include "block_tree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Orders parents before children. A node waits until its parent is placed: one round over all nodes
 * is enough where parents have smaller indices, and another round follows for each node that is not
 * so. */
static int order_nodes(block_tree* t) {
  unsigned char* placed = calloc(t->count + 1, 1);
  if (placed == NULL) return 0;
  size_t count = 0, before = t->count;
  while (count < t->count && count != before) {
    before = count;
    for (size_t i = 0; i < t->count; ++i) {
      if (placed[i] || (t->parent[i] >= 0 && !placed[t->parent[i]])) continue;
      placed[i] = 1;
      t->order[count++] = (uint32_t)i;
    }
  }
  free(placed);
  return count == t->count;
}

int block_tree_create(block_tree* t, size_t count, const int32_t* parent) {
  memset(t, 0, sizeof *t);
  t->count = count;
  t->parent = calloc(count, sizeof t->parent[0]);
  t->order = calloc(count, sizeof t->order[0]);
  t->diagonal = calloc(count, sizeof t->diagonal[0]);
  t->above = calloc(count, sizeof t->above[0]);
  if (t->parent && t->order && t->diagonal && t->above) {
    memcpy(t->parent, parent, count * sizeof parent[0]);
    if (order_nodes(t)) return 1;
  }
  block_tree_destroy(t);
  return 0;
}

void block_tree_destroy(block_tree* t) {
  free(t->parent);
  free(t->order);
  free(t->diagonal);
  free(t->above);
  memset(t, 0, sizeof *t);
}

static int cholesky(block a) {
  for (int i = 0; i < kBlock; ++i)
    for (int j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (int k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
      if (j < i)
        a[i][j] = sum / a[j][j];
      else if (sum > 0)
        a[i][i] = sqrt(sum);
      else
        return 0;
    }
  return 1;
}

static void solve_block(block factor, double b[kBlock]) {
  for (int i = 0; i < kBlock; ++i) {
    for (int k = 0; k < i; ++k) b[i] -= factor[i][k] * b[k];
    b[i] /= factor[i][i];
  }
  for (int i = kBlock; i-- > 0;) {
    for (int k = i + 1; k < kBlock; ++k) b[i] -= factor[k][i] * b[k];
    b[i] /= factor[i][i];
  }
}

/* Replaces B = A[i][parent] by W = A[i][i]^-1 B, and takes B^T W from the parent's block. */
static void eliminate(block_tree* t, uint32_t i, uint32_t parent) {
  block before;
  memcpy(before, t->above[i], sizeof before);
  for (int column = 0; column < kBlock; ++column) {
    double b[kBlock];
    for (int k = 0; k < kBlock; ++k) b[k] = before[k][column];
    solve_block(t->diagonal[i], b);
    for (int k = 0; k < kBlock; ++k) t->above[i][k][column] = b[k];
  }
  for (int a = 0; a < kBlock; ++a)
    for (int b = 0; b < kBlock; ++b)
      for (int k = 0; k < kBlock; ++k)
        t->diagonal[parent][a][b] -= before[k][a] * t->above[i][k][b];
}

int block_tree_factorise(block_tree* t) {
  for (size_t n = t->count; n-- > 0;) {
    const uint32_t i = t->order[n];
    if (!cholesky(t->diagonal[i])) return 0;
    if (t->parent[i] >= 0) eliminate(t, i, (uint32_t)t->parent[i]);
  }
  return 1;
}

void block_tree_solve(const block_tree* t, size_t count, const uint32_t* nodes,
                      double (*b)[kBlock]) {
  for (size_t n = count; n-- > 0;) {
    const uint32_t i = nodes[n];
    if (t->parent[i] >= 0)
      for (int k = 0; k < kBlock; ++k)
        for (int a = 0; a < kBlock; ++a) b[t->parent[i]][a] -= t->above[i][k][a] * b[i][k];
    solve_block(t->diagonal[i], b[i]);
  }
  for (size_t n = 0; n < count; ++n) {
    const uint32_t i = nodes[n];
    if (t->parent[i] < 0) continue;
    for (int k = 0; k < kBlock; ++k)
      for (int a = 0; a < kBlock; ++a) b[i][k] -= t->above[i][k][a] * b[t->parent[i]][a];
  }
}

void block_tree_inverse(const block_tree* t, block* inverse) {
  for (size_t n = 0; n < t->count; ++n) {
    const uint32_t i = t->order[n];
    for (int column = 0; column < kBlock; ++column) {
      double unit[kBlock] = {0};
      unit[column] = 1;
      solve_block(t->diagonal[i], unit);
      for (int k = 0; k < kBlock; ++k) inverse[i][k][column] = unit[k];
    }
    if (t->parent[i] < 0) continue;
    /* W P W^T, with P the parent's block of the inverse */
    block product = {{0}};
    for (int a = 0; a < kBlock; ++a)
      for (int b = 0; b < kBlock; ++b)
        for (int k = 0; k < kBlock; ++k)
          product[a][b] += t->above[i][a][k] * inverse[t->parent[i]][k][b];
    for (int a = 0; a < kBlock; ++a)
      for (int b = 0; b < kBlock; ++b)
        for (int k = 0; k < kBlock; ++k) inverse[i][a][b] += product[a][k] * t->above[i][b][k];
  }
}
