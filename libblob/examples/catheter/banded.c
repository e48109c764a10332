/* SPDX-License-Identifier: Apache-2.0 */
#include "banded.h"

#include <math.h>

static int factorise(size_t size, double (*lower)[kBand]) {
  for (size_t i = 0; i < size; ++i)
    for (size_t j = i < kBand - 1 ? 0 : i - (kBand - 1); j <= i; ++j) {
      double sum = lower[i][kBand - 1 - (i - j)];
      for (size_t k = i < kBand - 1 ? 0 : i - (kBand - 1); k < j; ++k)
        sum -= lower[i][kBand - 1 - (i - k)] * lower[j][kBand - 1 - (j - k)];
      if (j < i)
        lower[i][kBand - 1 - (i - j)] = sum / lower[j][kBand - 1];
      else if (sum > 0)
        lower[i][kBand - 1] = sqrt(sum);
      else
        return 0;
    }
  return 1;
}

int banded_solve(size_t size, double (*lower)[kBand], double* b) {
  if (!factorise(size, lower)) return 0;
  for (size_t i = 0; i < size; ++i) {
    for (size_t k = i < kBand - 1 ? 0 : i - (kBand - 1); k < i; ++k)
      b[i] -= lower[i][kBand - 1 - (i - k)] * b[k];
    b[i] /= lower[i][kBand - 1];
  }
  for (size_t i = size; i-- > 0;) {
    b[i] /= lower[i][kBand - 1];
    for (size_t k = i < kBand - 1 ? 0 : i - (kBand - 1); k < i; ++k)
      b[k] -= lower[i][kBand - 1 - (i - k)] * b[i];
  }
  return 1;
}
