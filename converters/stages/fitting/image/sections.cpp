// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/image/sections.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <tuple>
#include <variant>
#include <vector>

#include "converters/base/vectors.h"
#include "converters/geometry/box_tree.h"

namespace lumen::convert::fitting {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Half the length of the stretch of a vessel whose voxels count for a section: in voxels of the
/// coarsest axis, and in radii, whichever is more.
constexpr double kStretchVoxels = 2.0, kStretchRadii = 0.4;
/// Distance beyond the wall up to which voxels count: blurs, and voxels.
constexpr double kAroundBlurs = 3.0, kAroundVoxels = 0.75;
/// A section at the end of a vessel reaches this share of its half stretch beyond the last node.
constexpr double kBeyondEnd = 0.25;
/// Edges along the tree within which another branch is joined to a node.
constexpr int kJoinedEdges = 12;
/// Nodes of the same branch that are farther away along it than this are another vessel's: half the
/// outline of the section.
constexpr double kOtherRadii = std::numbers::pi;
/// The share of a joined vessel in a voxel beyond which the voxel does not count, and of a place of
/// the wall beyond which the wall is open.
constexpr double kJoinedShare = 0.03, kOpenShare = 0.2;
/// Voxels of radius for each harmonic beyond the circle.
constexpr double kVoxelsPerHarmonic = 0.55;
/// Voxels that are deeper below the wall than this, in blurs, only show the lumen's level: one of
/// kDeepShare counts.
constexpr double kDeepBlurs = 4;
constexpr int kDeepShare = 8;
/// The most voxels of a section: more are thinned out evenly.
constexpr std::size_t kMostVoxels = 600;
constexpr double kBoxVariance = 1.0 / 12;  ///< of a box, in squares of its edge

int harmonicsOf(double radius, double voxel) {
  return std::clamp(1 + static_cast<int>(radius / voxel / kVoxelsPerHarmonic - 0.5), 1,
                    kMostHarmonics);
}

}  // namespace

Vector3d NodeSection::wall(double a, double h) const {
  const double r = outline.at(a) + outline.taper * h + 0.5 * outline.flare * h * h;
  const Vector2d p = outline.centre + outline.tilt * h + outline.bend * (0.5 * h * h) +
                     r * Vector2d(std::cos(a), std::sin(a));
  return origin + p.x() * u + p.y() * v + h * axis;
}

Sections::Sections(const formats::Case& value, const Volume& volume, bool dark, double blur)
    : m_case(value),
      m_volume(volume),
      m_neighbours(value.tree),
      m_sign(dark ? -1 : 1),
      m_voxel(volume.geometry.voxelSize()),
      m_blur(blur),
      m_sections(value.tree.nodeCount()),
      m_arc(value.tree.nodeCount(), 0.0) {
  const formats::CenterlineTree& tree = value.tree;
  std::vector<Box3d> boxes(tree.nodeCount());
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i) {
    const bool isFirst = tree.branches[tree.branch[i]].firstNode == i;
    if (!isFirst)
      m_arc[i] = m_arc[i - 1] + (toEigen(tree.centre[i]) - toEigen(tree.centre[i - 1])).norm();
    boxes[i].add(toEigen(tree.centre[i]), double{tree.radius[i]});
  }
  m_balls = BoxTree<double>(boxes);
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i) place(i);
}

/// The plane of a node, the curvature of the axis there, and the stretch that counts.
void Sections::place(std::uint32_t node) {
  const formats::CenterlineTree& tree = m_case.tree;
  const formats::Branch& branch = tree.branches[tree.branch[node]];
  NodeSection& s = m_sections[node];
  s.isSac = branch.kind == formats::BranchKind::Aneurysm;
  s.origin = toEigen(tree.centre[node]);
  s.axis = toEigen(tree.direction[node]).normalized();
  s.outline.radius = double{tree.radius[node]};
  s.outline.harmonics = harmonicsOf(s.outline.radius, m_voxel);
  const double half = m_stretch * std::max(kStretchVoxels * m_volume.geometry.spacing.maxCoeff(),
                                           kStretchRadii * s.outline.radius);
  const std::uint32_t last = branch.firstNode + branch.nodeCount - 1;
  std::uint32_t before = node, behind = node;
  while (before > branch.firstNode && m_arc[node] - m_arc[before] < half) --before;
  while (behind < last && m_arc[behind] - m_arc[node] < half) ++behind;
  s.low = -std::min(half, m_arc[node] - m_arc[branch.firstNode] + kBeyondEnd * half);
  s.high = std::min(half, m_arc[last] - m_arc[node] + kBeyondEnd * half);
  s.bend.setZero();
  Vector3d curvature = Vector3d::Zero();
  if (before < node && node < behind) {
    const Vector3d from = s.origin - toEigen(tree.centre[before]),
                   on = toEigen(tree.centre[behind]) - s.origin;
    const Vector3d chord = from + on;
    if (chord.squaredNorm() > 0) s.axis = chord.normalized();
    curvature =
        2 / std::max(from.norm() + on.norm(), m_voxel) * (on.normalized() - from.normalized());
  }
  std::tie(s.u, s.v) = planeBasis(s.axis);
  s.bend = s.inPlane(curvature);
  s.outline.bend = s.bend;
}

void Sections::setStretch(double factor) {
  m_stretch = factor;
  for (std::uint32_t i = 0; i < m_sections.size(); ++i) place(i);
}

Eigen::Matrix2d Sections::covariance(std::uint32_t node) const {
  const VolumeGeometry& g = m_volume.geometry;
  const double finest = g.spacing.minCoeff();
  Vector3d variance;
  for (int a = 0; a < 3; ++a)
    variance[a] = m_blur * m_blur + kBoxVariance * (g.spacing[a] * g.spacing[a] - finest * finest);
  const Eigen::Matrix3d world = g.direction * variance.asDiagonal() * g.direction.transpose();
  Eigen::Matrix<double, 3, 2> plane;
  plane << m_sections[node].u, m_sections[node].v;
  return plane.transpose() * world * plane;
}

std::vector<Sections::Other> Sections::others(std::uint32_t node) const {
  const formats::CenterlineTree& tree = m_case.tree;
  const NodeSection& s = m_sections[node];
  const double half = std::max(-s.low, s.high);
  const double around = s.outline.radius + kAroundBlurs * m_blur + kAroundVoxels * m_voxel;
  const double reach = std::hypot(half, around) + kAroundBlurs * m_blur + s.outline.centre.norm();
  Box3d box;
  box.add(s.origin, reach);
  const std::vector<std::uint32_t> joined = m_neighbours.within(node, kJoinedEdges);
  std::vector<Other> found;
  anyItemNear(m_balls, box, [&](std::uint32_t other) {
    if (tree.branch[other] == tree.branch[node] &&
        std::abs(m_arc[other] - m_arc[node]) < 2 * half + kOtherRadii * s.outline.radius)
      return false;
    const NodeSection& o = m_sections[other];
    if ((o.origin - s.origin).norm() < reach + o.outline.radius)
      found.push_back({other, std::find(joined.begin(), joined.end(), other) != joined.end(), {}});
    return false;
  });
  std::sort(found.begin(), found.end(),
            [](const Other& a, const Other& b) { return a.node < b.node; });
  return found;
}

Sections::Beside Sections::beside(std::vector<Other>& others, const Vector3d& place) const {
  double least = std::numeric_limits<double>::infinity();
  Other* nearest = nullptr;
  for (Other& other : others) {
    const NodeSection& o = m_sections[other.node];
    const double power = (place - o.origin).squaredNorm() - o.outline.radius * o.outline.radius;
    if (power < least) {
      least = power;
      nearest = &other;
    }
  }
  Beside out;
  if (nearest == nullptr) return out;
  const NodeSection& o = m_sections[nearest->node];
  const Vector3d offset = place - o.origin;
  if (o.isSac) {
    out.isJoined = true;
    out.share = offset.norm() < o.outline.radius + kAroundBlurs * m_blur ? 1.0 : 0.0;
    return out;
  }
  const double h = offset.dot(o.axis);
  const Vector2d p = o.inPlane(offset);
  if (std::abs(h) > std::max(o.high, -o.low) + o.outline.radius) return out;
  if (p.norm() > 1.5 * o.outline.radius + o.outline.centre.norm() + 2 * kAroundBlurs * m_blur)
    return out;
  if (!nearest->image) nearest->image.emplace(o.outline, covariance(nearest->node));
  out.share = nearest->image->at(p, std::clamp(h, o.low, o.high)).share;
  out.intensity = out.share * o.contrast;
  out.isJoined = nearest->isJoined;
  return out;
}

bool Sections::isOpen(std::vector<Other>& others, const Vector3d& place) const {
  const Beside other = beside(others, place);
  return other.isJoined && other.share > kOpenShare;
}

std::vector<SectionVoxel> Sections::voxels(std::uint32_t node) const {
  const VolumeGeometry& g = m_volume.geometry;
  const NodeSection& s = m_sections[node];
  std::vector<Other> near = others(node);
  const double around = s.outline.radius + kAroundBlurs * m_blur + kAroundVoxels * m_voxel;
  const double half = std::max(-s.low, s.high);
  const double reach = std::hypot(half, around) + s.outline.centre.norm();
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d at = g.indexFromWorld(
        s.origin + reach * Vector3d(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  std::vector<SectionVoxel> out;
  int deep = 0;
  std::visit(
      [&](const auto& values) {
        g.cellsAround(low, high).forEach([&](const Cell& cell) {
          const Vector3d at = g.position(cell), offset = at - s.origin;
          const double h = offset.dot(s.axis);
          if (h < s.low || h > s.high) return;
          const Vector2d p = s.inPlane(offset);
          const Vector2d from = p - s.outline.centre - s.bend * (0.5 * h * h);
          if (from.squaredNorm() > around * around) return;
          const double value = m_sign * static_cast<double>(values[g.index(cell)]);
          if (!std::isfinite(value)) return;
          const Beside other = beside(near, at);
          if (other.isJoined && other.share > kJoinedShare) return;
          if (from.norm() < s.outline.radius - kDeepBlurs * m_blur && ++deep % kDeepShare != 0)
            return;
          const double t = h / half;
          out.push_back({p, h, value, other.intensity, std::max(1 - t * t, 0.05)});
        });
      },
      m_volume.voxels);
  if (out.size() > kMostVoxels) {
    for (std::size_t i = 0; i < kMostVoxels; ++i) out[i] = out[i * out.size() / kMostVoxels];
    out.resize(kMostVoxels);
  }
  return out;
}

namespace {

/// The least spread, in the units of ShapeSpread: of vessels that differ by noise alone.
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
