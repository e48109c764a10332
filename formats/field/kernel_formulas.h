// SPDX-License-Identifier: Apache-2.0
// The kernels, each defined here and nowhere else. This is text to be included inside a namespace,
// because libblob compiles it once for each set of SIMD instructions; all others include kernel.h.
//
// A kernel phi(u) falls from 1 at u = 0. A blob of centre C and width w adds w phi(u) to f, where
// u = a |X - C|^2 and a = p / w^2; p is the kernel's parameter, or 1 for a kernel without one.
// A. Yureidini, "Robust blood vessel surface reconstruction for interactive simulations from
// patient data", 2014, table 4.1.
//
// The number type T is double or a vector of floats. It has + - * / and, found with it,
// constant(T, double), positivePart(T), sqrt(T), expOfMinus(T), naturalLog(T) and, for derivatives
// of the second order and above, ifPositive(T, T).
//
// To add a kernel: its value and the count in kernel.h, a structure here with all that the others
// have, its line in withKernel(), its value in blob.h, and a row in the table of the specification.

// clang-format off

#define LUMEN_FORMULA [[gnu::always_inline]] static inline

/// phi(s x) and its first three derivatives by x; s is 1 for a kernel without a parameter.
template <class T>
struct KernelChain {
  T phi, d1, d2, d3;
};

/// One blob's part of f, and the factor of (X - C) in its part of grad f.
template <class T>
struct BlobTerm {
  T value, slope;
};

// Members of each kernel:
//   phi(u), first(u), second(u)   phi and its derivatives by u
//   chain(s x, s)                 phi(s x) and three derivatives by x
//   term(u, a, w)                 a blob's part of f and grad f
//   inverse(value, s)             the x >= 0 at which phi(s x) is a value between 0 and 1
//   reach(ratio)                  a u from which on phi <= 1 / ratio; at most 0 if for all u
//   level(f, 1 / f, shift)        the level transform h, a falling function of f that grows nearly
//                                 with the square of the distance from the axis of a tube; f is
//                                 given times exp(shift), which only the Gaussian needs
//   levelSlope(h, |grad f| / f)   |grad h|

/// Behaviour of a kernel far out: falls like a power of the distance, faster than any power, or is
/// zero from u = 1 on.
enum class KernelTail { Power, Exponential, Compact };

/// phi = 1 / (1 + u)^2
struct Cauchy {
  static constexpr ::lumen::field::Kernel kKernel = ::lumen::field::Kernel::Cauchy;
  static constexpr const char* kName = "cauchy";
  static constexpr KernelTail kTail = KernelTail::Power;
  static constexpr double kUsualParameter = 0.2;  // s^2: the inflection is at |X - C| = w

  template <class T> LUMEN_FORMULA T root(T u) { return constant(u, 1.0) / (constant(u, 1.0) + u); }
  template <class T> LUMEN_FORMULA T phi(T u) { const T q = root(u); return q * q; }
  template <class T> LUMEN_FORMULA T first(T u) { return constant(u, -2.0) * phi(u) * root(u); }
  template <class T> LUMEN_FORMULA T second(T u) { return constant(u, 6.0) * phi(u) * phi(u); }

  /// Computes each derivative from the previous one, with other roundings than phi(), first() and
  /// second(); fits rest on them.
  template <class T> LUMEN_FORMULA KernelChain<T> chain(T u, T s) {
    const T q = root(u), phi = q * q;
    const T d1 = constant(u, -2.0) * s * phi * q, d2 = constant(u, -3.0) * s * d1 * q;
    return {phi, d1, d2, constant(u, -4.0) * s * d2 * q};
  }
  template <class T> LUMEN_FORMULA BlobTerm<T> term(T u, T a, T w) {
    const T q = root(u), value = w * (q * q);
    return {value, (constant(u, -4.0) * a) * (value * q)};
  }

  LUMEN_FORMULA double inverse(double value, double s) {  // 1 / sqrt(phi) - 1, no cancellation
    const double edge = std::sqrt(value);
    return (1.0 - value) / (edge * (1.0 + edge) * s);
  }

  LUMEN_FORMULA double reach(double ratio) { return std::sqrt(ratio) - 1.0; }

  template <class T> LUMEN_FORMULA T level(T, T inverseF, T) {
    using std::sqrt;
    return sqrt(inverseF);
  }
  template <class T> LUMEN_FORMULA T levelSlope(T h, T relative) {
    return constant(h, 0.5) * h * relative;
  }
};

/// phi = exp(-u)
struct Gaussian {
  static constexpr ::lumen::field::Kernel kKernel = ::lumen::field::Kernel::Gaussian;
  static constexpr const char* kName = "gaussian";
  static constexpr KernelTail kTail = KernelTail::Exponential;
  static constexpr double kUsualParameter = 0.5;  // a^2: the inflection is at |X - C| = w

  template <class T> LUMEN_FORMULA T phi(T u) { return expOfMinus(u); }
  template <class T> LUMEN_FORMULA T first(T u) { return constant(u, -1.0) * expOfMinus(u); }
  template <class T> LUMEN_FORMULA T second(T u) { return expOfMinus(u); }

  template <class T> LUMEN_FORMULA KernelChain<T> chain(T u, T s) {
    const T back = constant(u, -1.0) * s, phi = expOfMinus(u), d1 = back * phi, d2 = back * d1;
    return {phi, d1, d2, back * d2};
  }
  template <class T> LUMEN_FORMULA BlobTerm<T> term(T u, T a, T w) {
    const T value = w * expOfMinus(u);
    return {value, (constant(u, -2.0) * a) * value};
  }

  LUMEN_FORMULA double inverse(double value, double s) { return -::lumen::field::repeatableLog(value) / s; }

  LUMEN_FORMULA double reach(double ratio) { return ::lumen::field::repeatableLog(ratio); }

  template <class T> LUMEN_FORMULA T level(T f, T, T shift) { return shift - naturalLog(f); }
  template <class T> LUMEN_FORMULA T levelSlope(T, T relative) { return relative; }
};

/// phi = (1 - u)^2 for u < 1, else 0
struct Quartic {
  static constexpr ::lumen::field::Kernel kKernel = ::lumen::field::Kernel::Quartic;
  static constexpr const char* kName = "quartic";
  static constexpr KernelTail kTail = KernelTail::Compact;
  static constexpr double kUsualParameter = 0;

  template <class T> LUMEN_FORMULA T rest(T u) { return positivePart(constant(u, 1.0) - u); }
  template <class T> LUMEN_FORMULA T phi(T u) { const T v = rest(u); return v * v; }
  template <class T> LUMEN_FORMULA T first(T u) { return constant(u, -2.0) * rest(u); }
  template <class T> LUMEN_FORMULA T second(T u) { return ifPositive(rest(u), constant(u, 2.0)); }

  template <class T> LUMEN_FORMULA KernelChain<T> chain(T u, T) {
    return {phi(u), first(u), second(u), constant(u, 0.0)};
  }
  template <class T> LUMEN_FORMULA BlobTerm<T> term(T u, T a, T w) {
    const T v = rest(u);
    return {w * (v * v), (constant(u, -4.0) * a) * (w * v)};
  }

  LUMEN_FORMULA double inverse(double value, double) {
    return (1.0 - value) / (1.0 + std::sqrt(value));
  }

  LUMEN_FORMULA double reach(double) { return 1.0; }

  template <class T> LUMEN_FORMULA T level(T f, T, T) {
    using std::sqrt;
    return constant(f, 0.0) - sqrt(f);
  }
  template <class T> LUMEN_FORMULA T levelSlope(T h, T relative) {
    return constant(h, -0.5) * h * relative;
  }
};

/// phi = 1 - (4/9) u^3 + (17/9) u^2 - (22/9) u for u < 1, else 0. Written in v = 1 - u it loses no
/// digits at the edge: v^2 (5 + 4 v) / 9.
struct SoftObject {
  static constexpr ::lumen::field::Kernel kKernel = ::lumen::field::Kernel::SoftObject;
  static constexpr const char* kName = "soft-object";
  static constexpr KernelTail kTail = KernelTail::Compact;
  static constexpr double kUsualParameter = 0;

  template <class T> LUMEN_FORMULA T rest(T u) { return positivePart(constant(u, 1.0) - u); }
  template <class T> LUMEN_FORMULA T phi(T u) {
    const T v = rest(u);
    return v * v * (constant(u, 5.0) + constant(u, 4.0) * v) / constant(u, 9.0);
  }
  template <class T> LUMEN_FORMULA T first(T u) {
    const T v = rest(u);
    return constant(u, -1.0) * v * (constant(u, 10.0) + constant(u, 12.0) * v) / constant(u, 9.0);
  }
  template <class T> LUMEN_FORMULA T second(T u) {
    const T v = rest(u);
    return ifPositive(v, (constant(u, 10.0) + constant(u, 24.0) * v) / constant(u, 9.0));
  }

  template <class T> LUMEN_FORMULA KernelChain<T> chain(T u, T) {
    return {phi(u), first(u), second(u), ifPositive(rest(u), constant(u, -24.0 / 9.0))};
  }
  template <class T> LUMEN_FORMULA BlobTerm<T> term(T u, T a, T w) {
    const T v = rest(u);
    return {w * (v * v) * (constant(u, 5.0) + constant(u, 4.0) * v) * constant(u, 1.0 / 9.0),
            (constant(u, -2.0 / 9.0) * a) * (w * v) * (constant(u, 10.0) + constant(u, 12.0) * v)};
  }

  // Newton's method from above, where v^2 (5 + 4 v) / 9 is convex
  LUMEN_FORMULA double inverse(double value, double) {
    const double bound = std::sqrt(1.8 * value);
    double v = bound < 1.0 ? bound : 1.0;
    for (;;) {
      const double excess = v * v * (5.0 + 4.0 * v) / 9.0 - value;
      const double next = v - excess / (v * (10.0 + 12.0 * v) / 9.0);
      if (!(next < v)) return 1.0 - v;
      v = next;
    }
  }

  LUMEN_FORMULA double reach(double) { return 1.0; }

  template <class T> LUMEN_FORMULA T level(T f, T, T) { return Quartic::level(f, f, f); }
  template <class T> LUMEN_FORMULA T levelSlope(T h, T relative) {
    return Quartic::levelSlope(h, relative);
  }
};

// clang-format on

/// use(K{}) for the structure K of a kernel. A value that is no kernel counts as the last.
template <class Use>
[[gnu::always_inline]] constexpr decltype(auto) withKernel(::lumen::field::Kernel kernel,
                                                           Use&& use) {
  switch (kernel) {
    case ::lumen::field::Kernel::Cauchy:
      return use(Cauchy{});
    case ::lumen::field::Kernel::Gaussian:
      return use(Gaussian{});
    case ::lumen::field::Kernel::Quartic:
      return use(Quartic{});
    case ::lumen::field::Kernel::SoftObject:
      break;
  }
  return use(SoftObject{});
}

#undef LUMEN_FORMULA
