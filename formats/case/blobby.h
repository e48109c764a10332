// SPDX-License-Identifier: Apache-2.0
// Kernels and the implicit function that they sum to: the scalar double-precision reference.
#pragma once

#include <cstdint>

#include "formats/case/case.h"
#include "formats/field/kernel.h"

namespace lumen::formats {

// All functions of this header give the same bits on every machine with IEEE 754 doubles.

using field::repeatableExp;
using field::repeatableLog;

/// phi and its first three derivatives with respect to x = r^2 (r in units of the width), x >= 0.
using KernelValue = field::KernelChain<double>;

/// phi and its derivatives at x; at the edge of a compact kernel (x = 1) the outer value, zero.
KernelValue evaluateKernel(Kernel kernel, double parameter, double x);

/// The kernel's usual parameter; 0 for the kernels without one.
inline double defaultKernelParameter(Kernel kernel) {
  return field::usualParameter(kernel);
}

/// The r >= 0, mm, at which width * phi(r^2 / width^2) = level; 0 if the blob never exceeds the
/// level. level > 0. The level at the result is right to a relative 1e-11.
double isoRadius(Kernel kernel, double parameter, double width, double level);

/// The width w of `count` equal blobs in one place whose surface w * count * phi(r^2/w^2) = level
/// has radius r. For radius >= 0, level > 0 and count > 0 there is exactly one, because the left
/// side grows with w from zero without bound; it is found to a relative 1e-12. Otherwise NaN.
double widthForRadius(Kernel kernel, double parameter, double radius, double level, int count = 1);

struct Vec3d {
  double x = 0, y = 0, z = 0;
};

struct FieldValue {
  double f = 0;    ///< mm
  Vec3d gradient;  ///< dimensionless
};

/// f and its gradient for the model of `node`, at a point in mm, LPS; zero for a node without
/// blobs.
FieldValue evaluateField(const BlobbyModels& models, std::uint32_t node, const Vec3d& point);

}  // namespace lumen::formats
