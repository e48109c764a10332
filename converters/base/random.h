// SPDX-License-Identifier: Apache-2.0
// Deterministic random numbers that do not depend on the standard library's distributions.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace lumen {

/// Mixes a 64-bit value into another that looks random (the finaliser of SplitMix64: Steele, Lea
/// and Flood, "Fast splittable pseudorandom number generators", 2014).
constexpr std::uint64_t mix64(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// SplitMix64. Seed one per independent unit of work, from (seed, unit), so that results do not
/// depend on the order in which threads take the units.
class Random {
public:
  explicit constexpr Random(std::uint64_t seed, std::uint64_t stream = 0)
      : m_state(mix64(seed + 0x9e3779b97f4a7c15ULL * (stream + 1))) {}

  constexpr std::uint64_t next() { return mix64(m_state += 0x9e3779b97f4a7c15ULL); }
  /// Uniform in [0, 1).
  constexpr double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  /// Uniform in [low, high).
  constexpr double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform in 0 .. n - 1; n > 0. The bias is below n / 2^32.
  constexpr std::uint32_t below(std::uint32_t n) {
    return static_cast<std::uint32_t>(((next() >> 32) * n) >> 32);
  }
  /// Standard normal (Box and Muller, 1958).
  double normal() {
    const double u = 1.0 - uniform();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * uniform());
  }

private:
  std::uint64_t m_state;
};

}  // namespace lumen
