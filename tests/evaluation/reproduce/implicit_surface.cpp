// SPDX-License-Identifier: Apache-2.0
#include "implicit_surface.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include <tbb/parallel_for.h>

#include "converters/base/vectors.h"
#include "formats/case/blobby.h"
#include "formats/case/topology.h"

namespace lumen::reproduce {
namespace {

constexpr int kNewtonSteps = 60;
constexpr int kSlides = 20;
constexpr int kBisections = 40;
constexpr double kOnSurface = 1e-9;  // mm

}  // namespace

ImplicitSurface::Value ImplicitSurface::at(const Vector3d& p) const {
  const formats::FieldValue value = formats::evaluateField(m_models, m_node, {p.x(), p.y(), p.z()});
  return {value.f, {value.gradient.x, value.gradient.y, value.gradient.z}};
}

double ImplicitSurface::taubinDistance(const Vector3d& p) const {
  const Value value = at(p);
  const double slope = value.gradient.norm();
  return slope > 0 ? std::abs(level() - value.f) / slope : std::numeric_limits<double>::infinity();
}

std::optional<Vector3d> ImplicitSurface::project(const Vector3d& p, double longestStep) const {
  Vector3d q = p;
  for (int i = 0; i < kNewtonSteps; ++i) {
    const Value value = at(q);
    const double slope2 = value.gradient.squaredNorm();
    if (!(slope2 > 1e-20)) return {};
    Vector3d step = value.gradient * ((level() - value.f) / slope2);
    const double length = step.norm();
    if (length > longestStep) step *= longestStep / length;
    q += step;
    if (length <= kOnSurface) return q;
  }
  return {};
}

std::optional<Vector3d> ImplicitSurface::nearest(const Vector3d& p, double longestStep) const {
  std::optional<Vector3d> q = project(p, longestStep);
  for (int i = 0; q && i < kSlides; ++i) {
    const Vector3d normal = at(*q).gradient.normalized(), offset = p - *q;
    const Vector3d slide = offset - normal * normal.dot(offset);
    if (slide.norm() <= 1e-4 * offset.norm() + kOnSurface) break;
    const std::optional<Vector3d> next = project(*q + slide, longestStep);
    if (!next || (p - *next).norm() >= offset.norm()) break;
    q = next;
  }
  return q;
}

std::optional<Vector3d> ImplicitSurface::leave(const Vector3d& p, const Vector3d& direction,
                                               double step, double longest) const {
  double low = 0, high = step;
  while (isInside(p + high * direction)) {
    low = high;
    high += step;
    if (high > longest) return {};
  }
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (isInside(p + middle * direction) ? low : high) = middle;
  }
  return p + 0.5 * (low + high) * direction;
}

namespace {

constexpr int kRays = 32;
constexpr int kCellNeighbourhood = 2;  // edges
constexpr double kLongestRay = 4;      // of the wider node's radius

/// The radical plane of two nodes, and the other nodes that cut it.
class Seam {
public:
  Seam(const formats::Case& value, const formats::Neighbours& neighbours, std::uint32_t first,
       std::uint32_t second)
      : m_tree(value.tree),
        m_first(first),
        m_radius(std::max(double{m_tree.radius[first]}, double{m_tree.radius[second]})) {
    const Vector3d from = toEigen(m_tree.centre[first]);
    const Vector3d chord = toEigen(m_tree.centre[second]) - from;
    const double distance = chord.norm();
    if (!(distance > 0)) return;
    const double r0 = m_tree.radius[first], r1 = m_tree.radius[second];
    const Vector3d normal = chord / distance;
    m_origin = from + 0.5 * (distance + (r0 - r1) * (r0 + r1) / distance) * normal;
    m_side = normal.unitOrthogonal();
    m_up = normal.cross(m_side);
    for (const std::uint32_t end : {first, second}) {
      for (const std::uint32_t node : neighbours.within(end, kCellNeighbourhood)) {
        if (node != first && node != second) m_others.push_back(node);
      }
    }
    m_exists = true;
  }

  [[nodiscard]] bool exists() const { return m_exists; }
  [[nodiscard]] const Vector3d& origin() const { return m_origin; }
  [[nodiscard]] double radius() const { return m_radius; }
  [[nodiscard]] Vector3d direction(int ray) const {
    const double angle = 2 * std::numbers::pi * ray / kRays;
    return std::cos(angle) * m_side + std::sin(angle) * m_up;
  }
  [[nodiscard]] bool owns(const Vector3d& p) const {
    const double own = power(m_first, p);
    return std::none_of(m_others.begin(), m_others.end(),
                        [&](std::uint32_t other) { return power(other, p) < own; });
  }

private:
  [[nodiscard]] double power(std::uint32_t node, const Vector3d& p) const {
    const double r = m_tree.radius[node];
    return (p - toEigen(m_tree.centre[node])).squaredNorm() - r * r;
  }

  const formats::CenterlineTree& m_tree;
  std::uint32_t m_first;
  double m_radius;
  bool m_exists = false;
  Vector3d m_origin, m_side, m_up;
  std::vector<std::uint32_t> m_others;
};

/// Samples of `from` on the seam, and how far `to` is from them.
void compare(const Seam& seam, const ImplicitSurface& from, const ImplicitSurface& to,
             SeamJumps& out) {
  const double step = 0.05 * seam.radius(), longest = kLongestRay * seam.radius();
  const bool startsInside = from.isInside(seam.origin());
  for (int ray = 0; ray < kRays; ++ray) {
    if (!startsInside) {
      ++out.open;
      continue;
    }
    const auto p = from.leave(seam.origin(), seam.direction(ray), step, longest);
    if (!p) {
      ++out.open;
      continue;
    }
    if (!seam.owns(*p)) continue;
    const auto q = to.nearest(*p, 0.3 * seam.radius());
    if (q) {
      out.jump.push_back((*p - *q).norm());
    } else {
      ++out.lost;
    }
  }
}

}  // namespace

SeamJumps measureSeams(const formats::Case& value, Progress& progress) {
  const formats::CenterlineTree& tree = value.tree;
  const formats::Neighbours neighbours(tree);
  std::vector<SeamJumps> perNode(tree.nodeCount());
  progress.begin("seams", tree.nodeCount());
  tbb::parallel_for(std::size_t{0}, tree.nodeCount(), [&](std::size_t i) {
    progress.check();
    progress.advance();
    if (tree.parent[i] == formats::kNoParent) return;
    const auto node = static_cast<std::uint32_t>(i);
    const auto parent = static_cast<std::uint32_t>(tree.parent[i]);
    const Seam seam(value, neighbours, parent, node);
    if (!seam.exists()) return;
    const ImplicitSurface own(*value.models, node), before(*value.models, parent);
    compare(seam, own, before, perNode[i]);
    compare(seam, before, own, perNode[i]);
  });
  progress.end();

  SeamJumps all;
  for (const SeamJumps& one : perNode) {
    all.seams += one.jump.empty() ? 0 : 1;
    all.lost += one.lost;
    all.open += one.open;
    std::copy(one.jump.begin(), one.jump.end(), std::back_inserter(all.jump));
  }
  std::sort(all.jump.begin(), all.jump.end());
  return all;
}

double quantile(const std::vector<double>& ascending, double share) {
  if (ascending.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double rank = std::ceil(share * static_cast<double>(ascending.size()) - 1e-9);
  return ascending[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

}  // namespace lumen::reproduce
