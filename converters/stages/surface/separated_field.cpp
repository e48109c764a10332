// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/separated_field.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lumen::convert {
namespace {

constexpr int kMaxSteps = 40;         // three to five near the wall; the rest is for long ways
constexpr double kTolerance = 1e-4;   // radii
constexpr double kLongestStep = 0.3;  // radii: far from the wall h is not straight
constexpr double kFarthest = 0.5;     // radii: a surface beyond is another one
constexpr double kSheetCore = 0.25;   // radii around the axis, where one sheet goes first
constexpr double kLeastSlope = 0.05;  // share of the slope between two axes that run side by side
constexpr double kVanished = 1e-12;   // share of the level: a lesser f does not locate the wall
// Largest distance, in sums of radii, of nodes whose walls may touch: a model reaches beyond its
// ball.
constexpr double kTouchingReach = 1.5;

field::Vec toVec(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

}  // namespace

SeparatedField::SeparatedField(const formats::Case& source, const field::BlendedField& field,
                               const SeparationOptions& options)
    : m_source(source),
      m_field(field),
      m_options(options),
      m_wall(field::levelTransform(field.kernel(), field.level()).h),
      m_edges(source.tree) {
  if (options.isUnion) {
    m_touchingOffset.assign(source.tree.nodeCount() + 1, 0);
    return;
  }
  findTouchingNodes(source.tree, kTouchingReach + options.offsetShare,
                    options.gap + 2 * options.offset, options.leastPath, m_touchingOffset,
                    m_touching);
}

// docs/method.md, section 4.2, with the node's radius as the scale.
SeparatedField::Wall SeparatedField::nearestWall(const Eigen::Vector3d& point,
                                                 std::uint32_t node) const {
  const field::Jet<1> f = m_field.blended(toVec(point), node);
  const Eigen::Vector3d gradient(f.gradient);
  const double slope = gradient.norm(), level = m_field.level(), r = radius(node);
  const Eigen::Vector3d out = point - Eigen::Map<const Eigen::Vector3d>(m_field.centre(node));
  if (!(f.value > kVanished * level) || !(slope > 0)) {
    const double distance = out.norm();
    const Eigen::Vector3d away =
        distance > 0 ? Eigen::Vector3d(out / distance) : Eigen::Vector3d::UnitX();
    return {f.value > level ? -r : std::max(distance - r, 1e-3 * r), away};
  }
  const field::LevelTransform here = field::levelTransform(m_field.kernel(), f.value, slope);
  const double d = std::abs(m_wall - here.h), g = here.slope;
  const double s = std::sqrt(d * d + r * r * g * g);
  const double k = d * (g * r + s + d) / (g * r + s);
  const bool isInside = f.value > level;
  return {isInside ? -k * r / (d + s) : std::min(k / g, out.norm() + r), -gradient / slope};
}

bool SeparatedField::isLeast(const Eigen::Vector3d& point, std::uint32_t node) const {
  const Eigen::Vector3d x = point - Eigen::Map<const Eigen::Vector3d>(m_field.centre(node));
  return m_field.eachRival(node, [&](const field::Rival& rival) {
    return field::powerDifference(rival, x.data()) >= 0;
  });
}

bool SeparatedField::areOneSheet(const Eigen::Vector3d& point, std::uint32_t a,
                                 std::uint32_t b) const {
  if (a == b) return true;
  const std::span<const std::uint32_t> around = m_field.neighbours(a);
  if (std::binary_search(around.begin(), around.end(), b)) return true;
  bool found = false;
  field::visitActiveNodes(a, [&](std::uint32_t k, field::ActiveNodes& active) {
    if (k == b) found = true;
    return !found && field::blendWeight<1>(m_field, k, point.data(), active).value > 0;
  });
  return found;
}

bool SeparatedField::isReached(const Eigen::Vector3d& point, std::uint32_t from,
                               std::uint32_t to) const {
  return areOneSheet(point, m_field.follow(toVec(point), from), to);
}

template <class Visit>
void SeparatedField::eachOtherSheet(const Eigen::Vector3d& point, std::uint32_t node,
                                    Visit&& visit) const {
  constexpr std::size_t kMostSheets = 8;  // sheets of one point
  std::array<std::uint32_t, kMostSheets> seen{};
  std::size_t count = 0;
  for (std::uint32_t e = m_touchingOffset[node]; e < m_touchingOffset[node + 1]; ++e) {
    const std::uint32_t other = m_touching[e];
    if (count == kMostSheets) return;
    if (!isLeast(point, other) || areOneSheet(point, node, other)) continue;
    const bool isKnown = std::any_of(seen.begin(), seen.begin() + count,
                                     [&](std::uint32_t k) { return areOneSheet(point, k, other); });
    if (isKnown) continue;
    seen[count++] = other;
    visit(other);
  }
}

SeparatedField::Axis SeparatedField::nearestAxis(const Eigen::Vector3d& point,
                                                 std::uint32_t node) const {
  const Eigen::Vector3d centre = Eigen::Map<const Eigen::Vector3d>(m_field.centre(node));
  const Eigen::Vector3d out = point - centre;
  const double r = radius(node);
  Axis best{out.norm() / r, r, out};
  for (const std::uint32_t next : m_edges.of(node)) {
    const Eigen::Vector3d along = Eigen::Map<const Eigen::Vector3d>(m_field.centre(next)) - centre;
    const double square = along.squaredNorm();
    if (!(square > 0)) continue;
    const double t = std::clamp(out.dot(along) / square, 0.0, 1.0);
    const double between = r + t * (radius(next) - r);
    const Eigen::Vector3d away = out - t * along;
    const double share = away.norm() / between;
    if (share < best.share) best = {share, between, away};
  }
  if (best.share > 0) best.gradient /= best.share * best.radius;
  return best;
}

std::pair<SeparatedField::Axis, SeparatedField::Axis> SeparatedField::nearestAxes(
    const Eigen::Vector3d& point, std::uint32_t a, std::uint32_t b) const {
  std::pair<Axis, Axis> axes{nearestAxis(point, a), nearestAxis(point, b)};
  Axis& first = a > b ? axes.first : axes.second;
  if (first.share < kSheetCore) {
    first.share -= 1 - first.share / kSheetCore;
    first.gradient *= 1 + 1 / kSheetCore;
  }
  return axes;
}

void SeparatedField::separate(SeparatedSample& sample, const Eigen::Vector3d& point,
                              std::uint32_t node) const {
  const auto [own, other] = nearestAxes(point, sample.node, node);
  const double harmonic = 1 / (1 / own.radius + 1 / other.radius);
  const Eigen::Vector3d gradient =
      harmonic * (own.gradient / own.radius - other.gradient / other.radius);
  const double slope = std::max(gradient.norm(), kLeastSlope);
  const double apart =
      (own.share - other.share) * harmonic / slope +
      0.5 * (m_options.gap + m_options.gapShare * std::min(own.radius, other.radius));
  if (apart <= sample.distance) return;
  sample.distance = apart;
  sample.gradient = gradient / slope;
  sample.isSeparated = true;
  sample.other = node;
}

SeparatedSample SeparatedField::sampleSheet(const Eigen::Vector3d& point,
                                            std::uint32_t node) const {
  const Wall wall = nearestWall(point, node);
  SeparatedSample sample;
  sample.distance = wall.distance;
  sample.gradient = wall.gradient;
  sample.node = node;
  sample.wall = wall.distance;
  return sample;
}

SeparatedSample SeparatedField::at(const Eigen::Vector3d& point, std::uint32_t node) const {
  SeparatedSample sample = sampleSheet(point, m_field.follow(toVec(point), node));
  eachOtherSheet(point, sample.node, [&](std::uint32_t other) { separate(sample, point, other); });
  return sample;
}

SeparatedSample SeparatedField::deepest(const Eigen::Vector3d& point, std::uint32_t node) const {
  const std::uint32_t here = m_field.follow(toVec(point), node);
  std::uint32_t best = here;
  bool isAlone = true;
  eachOtherSheet(point, here, [&](std::uint32_t other) {
    isAlone = false;
    const auto [nearest, next] = nearestAxes(point, best, other);
    if (next.share < nearest.share) best = other;
  });
  return isAlone ? sampleSheet(point, here) : at(point, best);
}

std::optional<SeparatedField::Foot> SeparatedField::project(const Eigen::Vector3d& start,
                                                            std::uint32_t node,
                                                            const Eigen::Vector3d* plane) const {
  Foot foot{start, {}};
  foot.sample.node = node;
  for (int step = 0; step < kMaxSteps; ++step) {
    foot.sample = at(foot.position, foot.sample.node);
    const double r = radius(foot.sample.node);
    if (std::abs(foot.sample.distance) <= kTolerance * r) return foot;
    Eigen::Vector3d along = foot.sample.gradient;
    if (plane != nullptr) along -= along.dot(*plane) * *plane;
    const double square = along.squaredNorm();
    if (!(square > 1e-4)) return std::nullopt;
    const double longest = kLongestStep * r;
    const double move = std::clamp(-foot.sample.distance / std::sqrt(square), -longest, longest);
    foot.position += move / std::sqrt(square) * along;
    if ((foot.position - start).squaredNorm() > kFarthest * kFarthest * r * r) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace lumen::convert
