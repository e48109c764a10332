// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/image/shape_spread.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace lumen::convert::fitting {
namespace {

/// The least spread, in the units of ShapeSpread: of vessels that noise alone tells apart.
constexpr double kLeastSpread = 0.02;
/// The share of a prior variance beyond which a variance shows that the prior decided.
constexpr double kDecided = 0.5;
constexpr std::size_t kFewestValues = 8;
/// Number of values for each one, the greatest, that is left out: it comes from a fork that was not recognised.
constexpr std::size_t kWildest = 50;

/// The squares, less their variances, of one kind of parameter.
class Pool {
public:
  explicit Pool(double usual) : m_usual(usual) {}

  /// `unit`: the parameter that a spread of 1 stands for.
  void add(double value, double variance, double unit) {
    const double own = variance / (unit * unit);
    if (own < kDecided * m_usual * m_usual)
      m_squares.push_back(value * value / (unit * unit) - own);
  }

  [[nodiscard]] double spread() {
    if (m_squares.size() < kFewestValues) return m_usual;
    std::sort(m_squares.begin(), m_squares.end());
    m_squares.resize(m_squares.size() - m_squares.size() / kWildest);
    double sum = 0;
    for (const double square : m_squares) sum += square;
    const double mean = sum / static_cast<double>(m_squares.size());
    return std::clamp(std::sqrt(std::max(mean, 0.0)), kLeastSpread, m_usual);
  }

private:
  double m_usual;
  std::vector<double> m_squares;
};

}  // namespace

ShapeSpread measureSpread(const Sections& sections, std::span<const SectionFit> fits,
                          std::span<const std::uint32_t> nodes) {
  ShapeSpread spread;
  Pool tilt(spread.tilt), bend(spread.bend), taper(spread.taper), flare(spread.flare);
  std::vector<Pool> waves(spread.wave.begin(), spread.wave.end());
  for (const std::uint32_t node : nodes) {
    const SectionFit& f = fits[node];
    if (!f.isValid) continue;
    const Outline& o = f.outline;
    const double curved = 1 / std::max(o.radius, sections.blur());
    for (int i = 0; i < 2; ++i) {
      tilt.add(o.tilt[i], f.variance[kTilt + i], 1);
      bend.add(o.bend[i] - sections[node].bend[i], f.variance[kBend + i], curved);
    }
    taper.add(o.taper, f.variance[kTaper], 1);
    flare.add(o.flare, f.variance[kFlare], curved);
    for (int m = 2; m <= o.harmonics; ++m) {
      const auto i = static_cast<std::size_t>(m - 2);
      const int at = kWaves + 2 * (m - 2);
      const double unit = o.radius / (m * m - 1);
      waves[i].add(o.cosine[i], f.variance[at], unit);
      waves[i].add(o.sine[i], f.variance[at + 1], unit);
    }
  }
  spread.tilt = tilt.spread();
  spread.bend = bend.spread();
  spread.taper = taper.spread();
  spread.flare = flare.spread();
  for (std::size_t i = 0; i < waves.size(); ++i) spread.wave[i] = waves[i].spread();
  return spread;
}

}  // namespace lumen::convert::fitting
