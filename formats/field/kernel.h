// SPDX-License-Identifier: Apache-2.0
// The list of kernels, and the kernels on doubles; standard library only.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "formats/field/repeatable_math.h"

namespace lumen::field {

/// Stored in files and in the interface of libblob: values are only appended.
enum class Kernel : std::uint8_t { Cauchy = 0, Gaussian = 1, Quartic = 2, SoftObject = 3 };

// Functions that kernel_formulas.h requires of its number type, for doubles.
[[gnu::always_inline]] inline double constant(double, double value) {
  return value;
}
[[gnu::always_inline]] inline double positivePart(double v) {
  return v > 0.0 ? v : 0.0;
}
/// `value` where v > 0, else zero.
[[gnu::always_inline]] inline double ifPositive(double v, double value) {
  return v > 0.0 ? value : 0.0;
}
inline double naturalLog(double x) {
  return repeatableLog(x);
}

#include "formats/field/kernel_formulas.h"

inline constexpr std::size_t kKernelCount = static_cast<std::size_t>(Kernel::SoftObject) + 1;

/// The names that kernels have in files and on the command line, in the order of their values.
inline constexpr auto kKernelNames = [] {
  std::array<std::string_view, kKernelCount> names;
  for (std::size_t i = 0; i < kKernelCount; ++i)
    names[i] = withKernel(static_cast<Kernel>(i), [](auto k) { return std::string_view(k.kName); });
  return names;
}();

/// Behaviour of a kernel far out.
inline KernelTail kernelTail(Kernel kernel) {
  return withKernel(kernel, [](auto k) { return k.kTail; });
}

/// Whether phi is zero from u = 1 on.
inline bool isCompact(Kernel kernel) {
  return kernelTail(kernel) == KernelTail::Compact;
}

/// The default of the parameter p; 0 for a kernel without one.
inline double usualParameter(Kernel kernel) {
  return withKernel(kernel, [](auto k) { return k.kUsualParameter; });
}

inline bool hasParameter(Kernel kernel) {
  return usualParameter(kernel) > 0.0;
}

/// s in u = s |X - C|^2 / w^2: the parameter, or 1 for a kernel without one.
inline double chainScale(Kernel kernel, double parameter) {
  return hasParameter(kernel) ? parameter : 1.0;
}

/// a in u = a |X - C|^2 for a blob of width w, 1/mm^2.
inline double blobScale(Kernel kernel, double parameter, double width) {
  return chainScale(kernel, parameter) / (width * width);
}

/// phi(u), u >= 0.
inline double phi(Kernel kernel, double u) {
  return withKernel(kernel, [u](auto k) { return k.phi(u); });
}

/// The x = |X - C|^2 / w^2 >= 0 at which phi falls to a value between 0 and 1.
inline double inversePhi(Kernel kernel, double parameter, double value) {
  const double s = chainScale(kernel, parameter);
  return withKernel(kernel, [value, s](auto k) { return k.inverse(value, s); });
}

/// The level transform h, a falling function of f > 0 that grows nearly with the square of the
/// distance from the axis of a tube, and |grad h|, from |grad f|.
struct LevelTransform {
  double h, slope;
};
inline LevelTransform levelTransform(Kernel kernel, double f, double gradient = 0.0) {
  return withKernel(kernel, [f, gradient](auto k) -> LevelTransform {
    const double h = k.level(f, 1.0 / f, 0.0);
    return {h, k.levelSlope(h, gradient / f)};
  });
}

}  // namespace lumen::field
