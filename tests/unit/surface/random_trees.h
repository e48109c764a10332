// SPDX-License-Identifier: Apache-2.0
// Random trees whose vessels touch, cross, bend tighter than their radius, and change their radius at once.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "../mesh/mesh_facts.h"
#include "../mesh/synthetic.h"
#include "converters/base/error.h"
#include "converters/base/random.h"
#include "converters/geometry/self_intersections.h"
#include "converters/stages/surface/closing/closed_surface.h"

namespace lumen::test {

/// One vessel as it grows; lengths in mm.
class RandomVessel {
public:
  RandomVessel(Random& random, const Eigen::Vector3d& start, double radius)
      : m_random(random), m_place(start), m_radius(radius), m_along(direction()) {}

  /// Half of the vessels are drawn to a place, and meet what is there.
  void aimAt(const Eigen::Vector3d& place) {
    m_aim = place;
    m_isAiming = true;
  }

  void grow(int nodes) {
    for (int i = 0; i < nodes; ++i) {
      path.push_back(m_place);
      radii.push_back(m_radius);
      turn();
      if (m_random.uniform() < 0.1) jump();
      m_place += m_random.uniform(0.5, 1) * m_radius * m_along;
    }
  }

  std::vector<Eigen::Vector3d> path;
  std::vector<double> radii;

private:
  Eigen::Vector3d direction() {
    const double z = m_random.uniform(-1, 1), angle = m_random.uniform(0, 2 * std::numbers::pi);
    const double across = std::sqrt(1 - z * z);
    return {across * std::cos(angle), across * std::sin(angle), z};
  }

  // A quarter of the turns are sharp: steps are shorter than the radius, so the bend is tighter.
  void turn() {
    const double share = m_random.uniform() < 0.25 ? 1.2 : 0.3;
    m_along = (m_along + m_random.uniform(0, share) * direction()).normalized();
    if (!m_isAiming || (m_aim - m_place).norm() < 0.1 * m_radius) return;
    m_along = (m_along + 0.5 * (m_aim - m_place).normalized()).normalized();
  }

  void jump() {
    const double factor = m_random.uniform(1, 5);
    m_radius =
        std::clamp(m_random.uniform() < 0.5 ? m_radius * factor : m_radius / factor, 0.2, 3.0);
  }

  Random& m_random;
  Eigen::Vector3d m_place, m_aim = Eigen::Vector3d::Zero();
  double m_radius = 1;
  Eigen::Vector3d m_along;
  bool m_isAiming = false;
};

/// A forest of one to three trees with up to seven vessels, by its number.
inline formats::Case randomTrees(std::uint64_t number) {
  Random random(number);
  formats::Case result;
  result.metadata.voxelSize = 0.2;
  formats::CenterlineTree& tree = result.tree;
  const std::uint32_t trees = 1 + random.below(3), vessels = trees + random.below(5);
  const auto nodePlace = [&](std::uint32_t node) {
    return Eigen::Vector3d(tree.centre[node].x, tree.centre[node].y, tree.centre[node].z);
  };
  for (std::uint32_t b = 0; b < vessels; ++b) {
    const double radius = 0.4 * std::pow(5, random.uniform());
    std::int32_t parent = formats::kNoParent;
    const double x = random.uniform(0, 12), y = random.uniform(0, 12), z = random.uniform(0, 12);
    Eigen::Vector3d start(x, y, z);
    const auto nodes = static_cast<std::uint32_t>(tree.nodeCount());
    if (b >= trees) {
      const std::uint32_t at = random.below(nodes);
      parent = static_cast<std::int32_t>(at);
      start = nodePlace(at) + 0.7 * double{tree.radius[at]} * (start - nodePlace(at)).normalized();
    }
    RandomVessel vessel(random, start, radius);
    if (nodes > 0 && random.uniform() < 0.5) vessel.aimAt(nodePlace(random.below(nodes)));
    vessel.grow(5 + static_cast<int>(random.below(14)));
    // not in one sum, in which gcc 12 sees copies that overlap
    std::string label = std::to_string(b);
    label.insert(label.begin(), 'b');
    addVessel(result, label, vessel.path, radius, 0.5 * radius, parent);
    for (std::size_t i = 0; i < vessel.radii.size(); ++i) {
      tree.radius[nodes + i] = static_cast<float>(vessel.radii[i]);
      tree.height[nodes + i] = static_cast<float>(0.5 * vessel.radii[i]);
    }
  }
  addModels(result);
  return result;
}

/// Faults of the closed surface of a case without links, as a sentence; empty if there are none.
inline std::string faultOf(const formats::Case& source,
                           const convert::ClosedSurfaceOptions& options = {}) {
  Progress silent;
  convert::ClosedSurface made;
  try {
    made = convert::closedSurface(source, options, silent);
  } catch (const Error& error) {
    return std::string("no surface: ") + error.what();
  }
  const convert::TriangleMesh mesh = toPatch(made.levels[0]);
  const MeshFacts facts = measureFacts(mesh);
  std::string fault;
  if (facts.boundaryEdges > 0) fault += std::to_string(facts.boundaryEdges) + " open edges; ";
  if (facts.badEdges > 0) fault += std::to_string(facts.badEdges) + " edges of no manifold; ";
  const auto roots =
      std::count(source.tree.parent.begin(), source.tree.parent.end(), formats::kNoParent);
  if (!options.thickness && facts.euler != 2 * roots)
    fault += "Euler characteristic " + std::to_string(facts.euler) + ", expected is " +
             std::to_string(2 * roots) + "; ";
  const std::size_t crossings = convert::selfIntersections(mesh).pairs.size();
  if (crossings > 0) fault += std::to_string(crossings) + " crossings; ";
  return fault;
}

}  // namespace lumen::test
