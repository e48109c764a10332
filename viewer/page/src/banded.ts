// SPDX-License-Identifier: Apache-2.0
/** Direct solution of the equations of a chain, whose matrix is a narrow band about its diagonal. */

/** A point is coupled to two points on either side, three coordinates each. */
export const kBand = 9;

/** Solves A x = b for a symmetric positive definite A by Cholesky's factorisation. Row i of `lower` holds A[i][i - 8] to
 * A[i][i] and is overwritten; `b` becomes x. False if A is not positive definite. */
export function solveBanded(size: number, lower: Float64Array, b: Float64Array): boolean {
  const last = kBand - 1;
  for (let i = 0; i < size; ++i) {
    const row = kBand * i,
      from = Math.max(0, i - last);
    for (let j = from; j <= i; ++j) {
      let sum = lower[row + last - (i - j)];
      const other = kBand * j;
      for (let k = Math.max(from, j - last); k < j; ++k)
        sum -= lower[row + last - (i - k)] * lower[other + last - (j - k)];
      if (j < i) lower[row + last - (i - j)] = sum / lower[other + last];
      else if (sum > 0) lower[row + last] = Math.sqrt(sum);
      else return false;
    }
  }
  for (let i = 0; i < size; ++i) {
    let sum = b[i];
    for (let k = Math.max(0, i - last); k < i; ++k) sum -= lower[kBand * i + last - (i - k)] * b[k];
    b[i] = sum / lower[kBand * i + last];
  }
  for (let i = size - 1; i >= 0; --i) {
    let sum = b[i];
    for (let k = i + 1; k <= Math.min(size - 1, i + last); ++k)
      sum -= lower[kBand * k + last - (k - i)] * b[k];
    b[i] = sum / lower[kBand * i + last];
  }
  return true;
}
