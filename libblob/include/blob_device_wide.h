/* SPDX-License-Identifier: Apache-2.0
 *
 * Part of blob_device.h: the functions of blob_device_lanes.h in vectors of OpenCL C. Every
 * operation and its order are the same.
 */
#ifndef LUMEN_BLOB_DEVICE_WIDE_H
#define LUMEN_BLOB_DEVICE_WIDE_H

#include "blob_device_model.h"

BLOB_DEVICE_FN float8 blob_device_load(blob_device_words words) {
  return as_float8(vload8(0, words));
}

BLOB_DEVICE_FN float blob_device_total(float8 e) {
  const float4 pair = (float4)(e.s01, e.s45) + (float4)(e.s23, e.s67);
  return (pair.s0 + pair.s1) + (pair.s2 + pair.s3);
}

/* Bits of the lanes whose comparison holds. */
BLOB_DEVICE_FN blob_device_word blob_device_bits_of(int8 holds) {
#if defined(__AVX__)
  typedef float lanes __attribute__((__vector_size__(32)));
  return (uint)__builtin_ia32_movmskps256((lanes)holds);
#else
  const uint8 bit = as_uint8(holds) & (uint8)(1, 2, 4, 8, 16, 32, 64, 128);
  const uint4 four = bit.lo | bit.hi;
  return (four.s0 | four.s1) | (four.s2 | four.s3);
#endif
}

BLOB_DEVICE_FN blob_device_word blob_device_first(blob_device_word bits) {
  return 31 - clz(bits & (0 - bits));
}

BLOB_DEVICE_FN blob_device_word blob_device_count(blob_device_word bits) {
  return popcount(bits);
}

BLOB_DEVICE_FN float8 blob_device_differences(blob_device_words block, const float* x) {
  return ((blob_device_load(block) * x[0] + blob_device_load(block + 8) * x[1]) +
          blob_device_load(block + 16) * x[2]) +
         blob_device_load(block + 24);
}

BLOB_DEVICE_FN blob_device_word blob_device_below(blob_device_words block, const float* x,
                                                  float limit) {
  return blob_device_bits_of(blob_device_differences(block, x) * blob_device_load(block + 32) <
                             limit);
}

BLOB_DEVICE_FN blob_device_word blob_device_lower(blob_device_words block, const float* x,
                                                  blob_device_word node, float* least,
                                                  blob_device_word* next) {
  const float8 differences = blob_device_differences(block, x);
  blob_device_word bits = blob_device_bits_of(differences <= *least);
  for (; bits != 0; bits &= bits - 1) {
    const blob_device_word i = blob_device_first(bits), k = block[i + 40];
    const float difference = blob_device_difference(block, i, x);
    if (difference < *least || (difference == *least && *next != node && k < *next)) {
      *least = difference;
      *next = k;
    }
  }
  return blob_device_bits_of(differences * blob_device_load(block + 32) < 1.0f);
}

BLOB_DEVICE_FN int blob_device_holds(blob_device_words block, blob_device_word k) {
  return any(vload8(0, block + 40) == k);
}

BLOB_DEVICE_FN float blob_device_weigh_against(blob_device_words block, const float* x,
                                               float* part) {
  const float8 inverse_tau = blob_device_load(block + 32);
  const float8 t = blob_device_differences(block, x) * inverse_tau, raw = 0.5f + 0.5f * t;
  const float8 positive = select((float8)(0.0f), raw, 0.0f < raw);
  const float8 s = select((float8)(1.0f), positive, positive < 1.0f);
  const float8 sp = s * ((6.0f * s - 15.0f) * s + 10.0f), rest = 1.0f - s;
  const float8 q = (15.0f * (rest * rest)) * inverse_tau / sp, psi = (s * s) * sp;
  const float4 pair = (float4)(psi.s01, psi.s45) * (float4)(psi.s23, psi.s67);
  part[0] = blob_device_total(q * blob_device_load(block));
  part[1] = blob_device_total(q * blob_device_load(block + 8));
  part[2] = blob_device_total(q * blob_device_load(block + 16));
  return (pair.s0 * pair.s1) * (pair.s2 * pair.s3);
}

/* blob_device_exp() for x <= 0. */
BLOB_DEVICE_FN float8 blob_device_exp_wide(float8 unbounded) {
  const float8 x = select((float8)(-87.0f), unbounded, -87.0f < unbounded);
  const int8 n = convert_int8_rte(x * 1.44269504f);
  const float8 whole = convert_float8(n);
  const float8 r = (x - whole * 0.693359375f) - whole * -2.12194440e-4f;
  float8 p = 1.9875691500e-4f;
  p = p * r + 1.3981999507e-3f;
  p = p * r + 8.3334519073e-3f;
  p = p * r + 4.1665795894e-2f;
  p = p * r + 1.6666665459e-1f;
  p = p * r + 5.0000001201e-1f;
  return (p * (r * r) + (r + 1.0f)) * as_float8((n + 127) << 23);
}

/* blob_device_term() of eight blobs. */
BLOB_DEVICE_FN float8 blob_device_terms(blob_device_word phi, float8 u, float8 a, float8 w,
                                        float8* slope) {
  float8 q, value;
  if (phi == 0) { /* Cauchy */
    q = 1.0f / (1.0f + u);
    value = w * (q * q);
    *slope = (-4.0f * a) * (value * q);
    return value;
  }
  if (phi == 1) { /* Gaussian */
    value = w * blob_device_exp_wide(-u);
    *slope = (-2.0f * a) * value;
    return value;
  }
  q = 1.0f - u;
  q = select((float8)(0.0f), q, 0.0f < q);
  if (phi == 2) { /* quartic */
    *slope = (-4.0f * a) * (w * q);
    return w * (q * q);
  }
  *slope = (-2.0f / 9.0f * a) * (w * q) * (10.0f + 12.0f * q); /* soft object */
  return w * (q * q) * (5.0f + 4.0f * q) * (1.0f / 9.0f);
}

BLOB_DEVICE_FN float blob_device_least_exponent(blob_device_words first, blob_device_word count,
                                                const float* at) {
  float8 least = 3e38f;
  float4 four;
  blob_device_word b;
  for (b = 0; b < count; ++b) {
    blob_device_words block = first + BLOB_DEVICE_BLOB_WORDS * b;
    const float8 x = at[0] - blob_device_load(block), y = at[1] - blob_device_load(block + 8),
                 z = at[2] - blob_device_load(block + 16);
    const float8 u = blob_device_load(block + 24) * ((x * x + y * y) + z * z);
    least = select(least, u, (u < least) & (blob_device_load(block + 32) > 0.0f));
  }
  four = select(least.hi, least.lo, least.lo < least.hi);
  return blob_device_lesser(blob_device_lesser(four.s0, four.s1),
                            blob_device_lesser(four.s2, four.s3));
}

BLOB_DEVICE_FN void blob_device_sum_blobs(blob_device_word phi, blob_device_words first,
                                          blob_device_word count, const float* at, float shift,
                                          blob_device_lane* lane) {
  float8 f = 0.0f, along_x = 0.0f, along_y = 0.0f, along_z = 0.0f, slope;
  blob_device_word b;
  for (b = 0; b < count; ++b) {
    blob_device_words block = first + BLOB_DEVICE_BLOB_WORDS * b;
    const float8 x = at[0] - blob_device_load(block), y = at[1] - blob_device_load(block + 8),
                 z = at[2] - blob_device_load(block + 16), a = blob_device_load(block + 24);
    float8 u = a * ((x * x + y * y) + z * z);
    if (phi == 1) u = select((float8)(0.0f), u - shift, 0.0f < u - shift);
    f += blob_device_terms(phi, u, a, blob_device_load(block + 32), &slope);
    along_x += slope * x;
    along_y += slope * y;
    along_z += slope * z;
  }
  lane->field[0] = blob_device_total(f);
  lane->field[1] = blob_device_total(along_x);
  lane->field[2] = blob_device_total(along_y);
  lane->field[3] = blob_device_total(along_z);
}

#endif
