// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/exact_predicates.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace lumen::convert {
namespace {

constexpr double kHalfUlp = 0x1p-53;
// Error bound of the plain formula, relative to the sum of the sizes of its products.
constexpr double kBound3 = (7 + 56 * kHalfUlp) * kHalfUlp;
constexpr double kBound2 = (3 + 16 * kHalfUlp) * kHalfUlp;

// A number as an exact sum of doubles that do not overlap, by increasing size.
template <std::size_t N>
struct Expansion {
  std::array<double, N> part{};
  std::size_t count = 0;

  [[nodiscard]] int sign() const {
    const double top = count > 0 ? part[count - 1] : 0;
    return (top > 0) - (top < 0);
  }
};

struct Two {
  double sum = 0, rest = 0;
};

Two twoSum(double a, double b) {
  const double sum = a + b, partB = sum - a;
  return {sum, (a - (sum - partB)) + (b - partB)};
}

Two twoProduct(double a, double b) {
  const double product = a * b;
#if defined(__wasm__)
  // WebAssembly has no such instruction: T. Dekker, "A floating-point technique", 1971
  const auto high = [](double x) {
    constexpr double kSplit = 0x1p27 + 1;
    return kSplit * x - (kSplit * x - x);
  };
  const double aHigh = high(a), aLow = a - aHigh, bHigh = high(b), bLow = b - bHigh;
  return {product, aLow * bLow - (product - aHigh * bHigh - aLow * bHigh - aHigh * bLow)};
#else
  return {product, std::fma(a, b, -product)};
#endif
}

// Adds one double; the parts stay sorted and without zeros.
template <std::size_t N>
void grow(Expansion<N>& sum, double value) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < sum.count; ++i) {
    const Two two = twoSum(value, sum.part[i]);
    value = two.sum;
    if (two.rest != 0) sum.part[kept++] = two.rest;
  }
  if (value != 0) sum.part[kept++] = value;
  sum.count = kept;
}

template <std::size_t N, std::size_t M>
Expansion<N + M> add(const Expansion<N>& a, const Expansion<M>& b, double signOfB) {
  Expansion<N + M> sum;
  for (std::size_t i = 0; i < a.count; ++i) sum.part[i] = a.part[i];
  sum.count = a.count;
  for (std::size_t i = 0; i < b.count; ++i) grow(sum, signOfB * b.part[i]);
  return sum;
}

template <std::size_t N, std::size_t M>
Expansion<2 * N * M> multiply(const Expansion<N>& a, const Expansion<M>& b) {
  Expansion<2 * N * M> product;
  for (std::size_t i = 0; i < a.count; ++i)
    for (std::size_t j = 0; j < b.count; ++j) {
      const Two two = twoProduct(a.part[i], b.part[j]);
      grow(product, two.rest);
      grow(product, two.sum);
    }
  return product;
}

Expansion<2> difference(double a, double b) {
  Expansion<2> result;
  grow(result, a);
  grow(result, -b);
  return result;
}

// a x b' - a' x b of two rows of differences.
Expansion<16> minor(const Expansion<2>& ax, const Expansion<2>& ay, const Expansion<2>& bx,
                    const Expansion<2>& by) {
  return add(multiply(ax, by), multiply(ay, bx), -1);
}

int exactOrientation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                     const Eigen::Vector3d& d) {
  std::array<std::array<Expansion<2>, 3>, 3> row;
  const std::array<const Eigen::Vector3d*, 3> point{&a, &b, &c};
  for (std::size_t i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      row[i][static_cast<std::size_t>(k)] = difference((*point[i])[k], d[k]);
  const auto term = [&](std::size_t i, std::size_t j, std::size_t k) {
    return multiply(minor(row[i][0], row[i][1], row[j][0], row[j][1]), row[k][2]);
  };
  return add(add(term(0, 1, 2), term(1, 2, 0), 1), term(2, 0, 1), 1).sign();
}

int exactOrientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return minor(difference(a.x(), c.x()), difference(a.y(), c.y()), difference(b.x(), c.x()),
               difference(b.y(), c.y()))
      .sign();
}

int signOf(double value) {
  return (value > 0) - (value < 0);
}

}  // namespace

int orientation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                const Eigen::Vector3d& d) {
  const double ax = a.x() - d.x(), ay = a.y() - d.y(), az = a.z() - d.z();
  const double bx = b.x() - d.x(), by = b.y() - d.y(), bz = b.z() - d.z();
  const double cx = c.x() - d.x(), cy = c.y() - d.y(), cz = c.z() - d.z();
  const double ab = ax * by, ba = bx * ay, bc = bx * cy, cb = cx * by, ca = cx * ay, ac = ax * cy;
  const double det = cz * (ab - ba) + az * (bc - cb) + bz * (ca - ac);
  const double size = (std::abs(ab) + std::abs(ba)) * std::abs(cz) +
                      (std::abs(bc) + std::abs(cb)) * std::abs(az) +
                      (std::abs(ca) + std::abs(ac)) * std::abs(bz);
  return std::abs(det) > kBound3 * size ? signOf(det) : exactOrientation(a, b, c, d);
}

int orientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const double left = (a.x() - c.x()) * (b.y() - c.y());
  const double right = (a.y() - c.y()) * (b.x() - c.x());
  const double det = left - right;
  return std::abs(det) > kBound2 * (std::abs(left) + std::abs(right)) ? signOf(det)
                                                                      : exactOrientation(a, b, c);
}

}  // namespace lumen::convert
