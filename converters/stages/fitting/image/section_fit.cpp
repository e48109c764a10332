// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/image/section_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Dense>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"

namespace lumen::convert::fitting {

namespace {

/// Prior standard deviation of the centre, in radii or blurs, and of the radius, in radii.
constexpr double kCentreShare = 0.5, kRadiusShare = 1.0;
/// Prior standard deviations of the background's level and of its slope, as shares of the contrast.
constexpr double kBackgroundShare = 10, kBackgroundSlope = 0.1;
/// Prior standard deviation of the logarithm of the blur's width.
constexpr double kBlurShare = 1.0;
/// Tukey's limit in robust standard deviations, and the least such deviation in contrasts: voxels
/// are rounded, and no section is exactly of the model.
constexpr double kTukey = 4.685, kLeastNoise = 0.03;
/// The least noise by which voxels are judged while the shape is still found, in contrasts.
constexpr double kFirstNoise = 0.15;
constexpr double kRobust = 1.4826;  ///< median deviations to standard deviations
constexpr int kRounds = 10;
/// A step ends the rounds when the radius and the centre move by less, in blurs.
constexpr double kSmallStep = 1e-2;
/// The largest step of radius and centre in a round, in blurs.
constexpr double kLargeStep = 1.5;
/// Voxels for each unknown, at least.
constexpr double kVoxelsPerUnknown = 2;

class Minimiser {
public:
  Minimiser(const std::vector<SectionVoxel>& voxels, const SectionPrior& prior)
      : m_voxels(voxels),
        m_prior(prior),
        m_shape(parameterCount(prior.outline)),
        m_levels(m_shape),
        m_count(m_shape + 4 + (prior.fitsBlur ? 1 : 0)),
        m_blurMm(std::sqrt(0.5 * prior.covariance.trace())) {
    m_start = Eigen::VectorXd::Zero(m_count);
    m_start[m_levels + 3] = prior.contrast.value;
    m_at = m_start;
    // the shapes that the prior expects: round, even, and bent as the axis is
    const Outline& o = prior.outline;
    m_start.segment<2>(kTilt) = -o.tilt;
    m_start.segment<2>(kBend) = prior.bend - o.bend;
    m_start[kTaper] = -o.taper;
    m_start[kFlare] = -o.flare;
    for (int m = 2; m <= o.harmonics; ++m) {
      const auto i = static_cast<std::size_t>(m - 2);
      m_start[kWaves + 2 * (m - 2)] = -o.cosine[i];
      m_start[kWaves + 2 * (m - 2) + 1] = -o.sine[i];
    }
    m_precision = precision();
  }

  SectionFit run() {
    SectionFit fit;
    if (static_cast<double>(m_voxels.size()) < kVoxelsPerUnknown * m_count) return fit;
    m_residual.resize(m_voxels.size());
    m_jacobian.resize(static_cast<Eigen::Index>(m_voxels.size()), m_count);
    startLevels();
    bool isDone = false;
    for (int round = 0; round < kRounds && !isDone; ++round) {
      evaluate();
      weigh(round);
      isDone = step() && (round > 1 || !m_prior.isFirst);
    }
    evaluate();
    weigh(kRounds);
    return result();
  }

private:
  /// Inverse prior variances. Waves change the outline's curvature by (m^2 - 1) / R^2 times their
  /// height.
  [[nodiscard]] Eigen::VectorXd precision() const {
    const double r = std::max(m_prior.outline.radius, m_blurMm), c = m_prior.contrast.value;
    Eigen::VectorXd deviation(m_count);
    deviation.segment<2>(kCentre).setConstant(kCentreShare * r);
    deviation.segment<2>(kTilt).setConstant(m_prior.spread.tilt);
    deviation.segment<2>(kBend).setConstant(m_prior.spread.bend / r);
    deviation[kRadius] = kRadiusShare * r;
    deviation[kTaper] = m_prior.spread.taper;
    deviation[kFlare] = m_prior.spread.flare / r;
    for (int m = 2; m <= m_prior.outline.harmonics; ++m)
      deviation.segment<2>(kWaves + 2 * (m - 2))
          .setConstant(m_prior.spread.wave[static_cast<std::size_t>(m - 2)] * r / (m * m - 1));
    deviation[m_levels] = kBackgroundShare * c;
    deviation.segment<2>(m_levels + 1).setConstant(kBackgroundSlope * c / (r + m_blurMm));
    deviation[m_levels + 3] = m_prior.contrast.deviation;
    if (m_prior.fitsBlur) deviation[m_levels + 4] = kBlurShare;
    return deviation.array().square().inverse();
  }

  /// The background is first taken as the lower quartile of the differences from the vessels.
  void startLevels() {
    const BlurredSection image(m_prior.outline, m_prior.covariance);
    std::vector<double> rest;
    for (const SectionVoxel& v : m_voxels)
      rest.push_back(v.value - v.beside -
                     m_prior.contrast.value * image.at(v.place, v.height).share);
    m_at[m_levels] = m_start[m_levels] = median(rest);
  }

  [[nodiscard]] Outline outline() const {
    Outline now = m_prior.outline;
    addTo(now, m_at.head(m_shape));
    return now;
  }

  [[nodiscard]] Eigen::Matrix2d covariance() const {
    return m_prior.covariance * (m_prior.fitsBlur ? std::exp(2 * m_at[m_levels + 4]) : 1.0);
  }

  [[nodiscard]] double rest(const SectionVoxel& v, double share) const {
    return v.value - v.beside - m_at[m_levels] - m_at.segment<2>(m_levels + 1).dot(v.place) -
           m_at[m_levels + 3] * share;
  }

  void evaluate() {
    const BlurredSection image(outline(), covariance());
    double shape[kMostParameters];
    for (std::size_t i = 0; i < m_voxels.size(); ++i) {
      const SectionVoxel& v = m_voxels[i];
      const auto value = image.derivatives(v.place, v.height, shape);
      const auto row = static_cast<Eigen::Index>(i);
      const double c = m_at[m_levels + 3];
      for (int k = 0; k < m_shape; ++k) m_jacobian(row, k) = c * shape[k];
      m_jacobian(row, m_levels) = 1;
      m_jacobian(row, m_levels + 1) = v.place.x();
      m_jacobian(row, m_levels + 2) = v.place.y();
      m_jacobian(row, m_levels + 3) = value.share;
      if (m_prior.fitsBlur) m_jacobian(row, m_levels + 4) = c * value.wider;
      m_residual[i] = rest(v, value.share);
    }
  }

  /// Noise and robust weights.
  void weigh(int round) {
    std::vector<double> size;
    for (const double r : m_residual) size.push_back(std::abs(r));
    m_noise = std::max(kRobust * upperMedian(size), kLeastNoise * m_prior.contrast.value);
    const double limit = kTukey * (m_prior.isFirst && round < 3
                                       ? std::max(m_noise, kFirstNoise * m_prior.contrast.value)
                                       : m_noise);
    m_weight.resize(m_voxels.size());
    for (std::size_t i = 0; i < m_voxels.size(); ++i) {
      const double t = m_residual[i] / limit;
      m_weight[i] = std::abs(t) < 1 ? m_voxels[i].weight * (1 - t * t) * (1 - t * t) : 0.0;
    }
  }

  void assemble(Eigen::MatrixXd& normal, Eigen::VectorXd& right) const {
    const double scale = 1 / (m_noise * m_noise);
    Eigen::Map<const Eigen::VectorXd> weight(m_weight.data(), m_jacobian.rows());
    Eigen::Map<const Eigen::VectorXd> residual(m_residual.data(), m_jacobian.rows());
    const Eigen::MatrixXd weighted = scale * (weight.asDiagonal() * m_jacobian);
    normal = m_jacobian.transpose() * weighted;
    normal.diagonal() += m_precision;
    right = m_precision.cwiseProduct(m_start - m_at) + weighted.transpose() * residual;
  }

  /// One Gauss-Newton step, shortened to keep the outline; whether it was small.
  bool step() {
    Eigen::MatrixXd normal;
    Eigen::VectorXd right;
    assemble(normal, right);
    Eigen::VectorXd move = normal.ldlt().solve(right);
    if (!move.allFinite()) return true;
    const double radius = outline().radius;
    const double moved = std::max(move.segment<2>(kCentre).norm(), std::abs(move[kRadius]));
    double share = std::min(1.0, kLargeStep * m_blurMm / std::max(moved, 1e-12));
    const double most = 0.5 * radius;  // a radius is at most halved in a round
    if (move[kRadius] < 0) share = std::min(share, most / -move[kRadius]);
    m_at += share * move;
    return share == 1 && moved < kSmallStep * m_blurMm;
  }

  [[nodiscard]] SectionFit result() const {
    SectionFit fit;
    fit.outline = outline();
    Eigen::MatrixXd normal;
    Eigen::VectorXd right;
    assemble(normal, right);
    const Eigen::LDLT<Eigen::MatrixXd> factors(normal);
    const Eigen::MatrixXd spread = factors.solve(Eigen::MatrixXd::Identity(m_count, m_count));
    if (!spread.allFinite() || !m_at.allFinite()) return fit;
    const auto deviation = [&](int i) { return std::sqrt(std::max(spread(i, i), 0.0)); };
    fit.background = m_at[m_levels];
    fit.contrast = {m_at[m_levels + 3], deviation(m_levels + 3)};
    fit.radius = {fit.outline.radius, deviation(kRadius)};
    fit.centre = {deviation(kCentre), deviation(kCentre + 1)};
    fit.noise = m_noise;
    fit.variance = spread.diagonal().head(m_shape);
    if (m_prior.fitsBlur) fit.blur = std::exp(m_at[m_levels + 4]);
    fit.isValid = fit.outline.radius > 0;
    return fit;
  }

  const std::vector<SectionVoxel>& m_voxels;
  const SectionPrior& m_prior;
  int m_shape, m_levels, m_count;
  double m_blurMm, m_noise = 0;
  Eigen::VectorXd m_start, m_at, m_precision;
  std::vector<double> m_residual, m_weight;
  Eigen::MatrixXd m_jacobian;
};

}  // namespace

SectionFit fitSection(const std::vector<SectionVoxel>& voxels, const SectionPrior& prior) {
  return Minimiser(voxels, prior).run();
}

namespace {

/// Standard deviation of the change of the contrast over kWalk voxels, and from a vessel to its
/// branch, as shares of the contrast.
constexpr double kChange = 0.1, kWalk = 10, kAtFork = 0.03;
/// Standard deviation of the contrasts of a tree, as a share of their median.
constexpr double kAmongVessels = 0.3;

/// A Gaussian as its precision and precision times mean.
struct Message {
  double precision = 0, weighted = 0;
  Message& operator+=(const Message& other) {
    precision += other.precision;
    weighted += other.weighted;
    return *this;
  }
  friend Message operator-(Message a, const Message& b) {
    return {a.precision - b.precision, a.weighted - b.weighted};
  }
  /// After a step of this variance.
  [[nodiscard]] Message over(double variance) const {
    if (!(precision > 0)) return {};
    const double p = 1 / (1 / precision + variance);
    return {p, p * weighted / precision};
  }
};

}  // namespace

std::vector<Estimate> contrastAlong(const formats::CenterlineTree& tree,
                                    const std::vector<Estimate>& measured, double voxel) {
  std::vector<double> values;
  for (const Estimate& e : measured)
    if (e.deviation > 0) values.push_back(e.value);
  if (values.empty()) return {};
  const double usual = upperMedian(values);
  const std::size_t count = tree.nodeCount();
  std::vector<Message> own(count), below(count), toParent(count), fromParent(count);
  std::vector<double> step(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    if (const Estimate& e = measured[i]; e.deviation > 0) {
      const double p = 1 / (e.deviation * e.deviation);
      own[i] = {p, p * e.value};
    }
    if (tree.parent[i] == formats::kNoParent) continue;
    const auto parent = static_cast<std::size_t>(tree.parent[i]);
    const double length = (toEigen(tree.centre[i]) - toEigen(tree.centre[parent])).norm();
    step[i] = usual * usual *
              (kChange * kChange * length / (kWalk * voxel) +
               (tree.branch[i] != tree.branch[parent] ? kAtFork * kAtFork : 0.0));
  }
  const double p = 1 / (kAmongVessels * kAmongVessels * usual * usual);
  for (std::size_t i = count; i-- > 0;) {
    Message sum = below[i];
    sum += own[i];
    if (tree.parent[i] == formats::kNoParent) {
      fromParent[i] = {p, p * usual};
      continue;
    }
    toParent[i] = sum.over(step[i]);
    below[static_cast<std::size_t>(tree.parent[i])] += toParent[i];
  }
  std::vector<Estimate> expected(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (tree.parent[i] != formats::kNoParent) {
      const auto parent = static_cast<std::size_t>(tree.parent[i]);
      Message sum = own[parent];
      sum += below[parent];
      sum += fromParent[parent];
      fromParent[i] = (sum - toParent[i]).over(step[i]);
    }
    Message rest = below[i];
    rest += fromParent[i];
    expected[i] = {rest.weighted / rest.precision, 1 / std::sqrt(rest.precision)};
  }
  return expected;
}

}  // namespace lumen::convert::fitting
