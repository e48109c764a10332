// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/adaptive_lattice.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "converters/geometry/box.h"

namespace lumen::convert {
namespace {

constexpr std::int32_t kMaxPosition = 1 << 19;           // keys have 19 bits an axis
constexpr std::size_t kMaxCubes = std::size_t{1} << 25;  // 2 GB with their vertices
constexpr std::size_t kMaxNodes = std::size_t{1} << 29;  // near the cubes of a level, in all: 2 GB
constexpr std::size_t kCubeBatch = 256;                  // cubes between two looks at the progress
constexpr double kModelRadii = 2.4;  // radii from its centre to which a node's model is followed
constexpr double kFineRadii = 1.35;  // radii in which a node decides the lattice's fineness
constexpr double kSafety = 1.5;      // the distance is an estimate: of half a cube's diagonal
constexpr double kHalfDiagonal = 0.8660254037844386;

}  // namespace

std::uint64_t AdaptiveLattice::keyOf(const Position& corner, std::int32_t size) {
  const auto level = static_cast<std::uint64_t>(std::countr_zero(static_cast<std::uint32_t>(size)));
  std::uint64_t key = level;
  for (const std::int32_t c : corner) key = key << 19 | static_cast<std::uint64_t>(c >> level);
  return key;
}

AdaptiveLattice::Neighbour AdaptiveLattice::neighbour(const LatticeCube& cube, int side) const {
  Position corner = cube.corner;
  const auto axis = static_cast<std::size_t>(side / 2);
  corner[axis] += side % 2 == 0 ? -cube.size : cube.size;
  if (corner[axis] < 0) return {};
  if (const auto at = m_index.find(keyOf(corner, cube.size)); at != m_index.end()) {
    if (at->second < 0) return {Kind::Finer, 0};
    return {Kind::Same, static_cast<std::uint32_t>(at->second)};
  }
  const auto at = m_index.find(keyOf(corner, 2 * cube.size));
  if (at == m_index.end() || at->second < 0) return {};
  return {Kind::Coarser, static_cast<std::uint32_t>(at->second)};
}

std::uint32_t AdaptiveLattice::cubeAt(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d steps = (point - m_origin) / m_step;
  if (!(steps.minCoeff() >= 0) || !(steps.maxCoeff() < kMaxPosition)) return kNone;
  const Position position{static_cast<std::int32_t>(steps.x()),
                          static_cast<std::int32_t>(steps.y()),
                          static_cast<std::int32_t>(steps.z())};
  for (std::int32_t size = 2; size <= m_largest; size *= 2) {
    const auto at = m_index.find(keyOf(position, size));
    if (at != m_index.end() && at->second >= 0) return static_cast<std::uint32_t>(at->second);
  }
  return kNone;
}

// Makes the leaves: level by level from the coarsest, then the balance.
class LatticeBuilder {
public:
  LatticeBuilder(AdaptiveLattice& lattice, const SeparatedField& field, const LatticeEdge& edge,
                 Progress& progress)
      : m_lattice(lattice),
        m_field(field),
        m_tree(field.source().tree),
        m_edge(edge),
        m_progress(progress) {}

  void run() {
    m_progress.begin("cells", 0);
    layOut();
    std::vector<Cube> level = coarsest();
    while (!level.empty()) {
      m_progress.check();
      level = refine(level);
    }
    balance();
    dropParents();
    m_progress.end();
  }

private:
  using Position = AdaptiveLattice::Position;
  struct Cube {
    LatticeCube cube;
    std::vector<std::uint32_t> near;  // nodes whose reach meets it
  };

  [[nodiscard]] Error tooFine() const {
    const bool hasWall = m_field.options().offset > 0 || m_field.options().offsetShare > 0;
    return invalidInput(
        (hasWall ? "the wall is too thick for the lattice that the thinnest vessels need"
                 : "the case is too large for the lattice that its thinnest vessels need") +
        std::string("; expected less than ") + std::to_string(kMaxCubes) + " cubes" +
        (hasWall ? ": a thinner wall" : ""));
  }

  [[nodiscard]] double nodeReach(std::uint32_t node) const {
    return (kModelRadii + m_field.options().offsetShare) * m_tree.radius[node] +
           0.5 * m_tree.height[node] + m_field.options().offset;
  }
  [[nodiscard]] double edgeOf(const LatticeCube& cube) const {
    return cube.size * m_lattice.m_step;
  }
  [[nodiscard]] Eigen::Vector3d middleOf(const LatticeCube& cube) const {
    const std::int32_t half = cube.size / 2;
    return m_lattice.place({cube.corner[0] + half, cube.corner[1] + half, cube.corner[2] + half});
  }

  void layOut() {
    const auto [least, greatest] = std::minmax_element(m_tree.radius.begin(), m_tree.radius.end());
    const double finest = m_edge.at(double{*least});
    Box3d box;
    for (std::uint32_t i = 0; i < m_tree.nodeCount(); ++i)
      box.add(toEigen(m_tree.centre[i]), nodeReach(i));
    m_lattice.m_step = 0.5 * finest;
    std::int32_t size = 2;
    while (size * m_lattice.m_step < m_edge.at(double{*greatest}) && size < kMaxPosition) size *= 2;
    m_lattice.m_largest = size;
    const double edge = size * m_lattice.m_step;
    for (int a = 0; a < 3; ++a) box.low[a] = edge * (std::floor(box.low[a] / edge) - 1);
    m_lattice.m_origin = box.low;
    if (!(box.size().maxCoeff() + 2 * edge < kMaxPosition * m_lattice.m_step)) throw tooFine();
  }

  std::vector<Cube> coarsest() {
    std::map<Position, std::vector<std::uint32_t>> found;
    const std::int32_t size = m_lattice.m_largest;
    const double edge = size * m_lattice.m_step;
    double entries = 0;
    for (std::uint32_t i = 0; i < m_tree.nodeCount(); ++i)
      entries += std::pow(2 * nodeReach(i) / edge + 2, 3);
    if (!(entries < static_cast<double>(kMaxNodes))) throw tooFine();
    for (std::uint32_t i = 0; i < m_tree.nodeCount(); ++i) {
      m_progress.check();
      const Eigen::Vector3d c = toEigen(m_tree.centre[i]) - m_lattice.m_origin;
      const double reach = nodeReach(i);
      Position first{}, last{};
      for (std::size_t a = 0; a < 3; ++a) {
        const auto e = static_cast<Eigen::Index>(a);
        first[a] = static_cast<std::int32_t>(std::floor((c[e] - reach) / edge));
        last[a] = static_cast<std::int32_t>(std::floor((c[e] + reach) / edge));
      }
      for (std::int32_t z = first[2]; z <= last[2]; ++z)
        for (std::int32_t y = first[1]; y <= last[1]; ++y)
          for (std::int32_t x = first[0]; x <= last[0]; ++x)
            found[{x * size, y * size, z * size}].push_back(i);
    }
    std::vector<Cube> cubes;
    for (auto& [corner, nodes] : found) cubes.push_back({{corner, size, 0}, std::move(nodes)});
    return cubes;
  }

  // From a node's centre to the nearest point of a cube, mm.
  [[nodiscard]] double distanceTo(const LatticeCube& cube, std::uint32_t node) const {
    const double half = 0.5 * edgeOf(cube);
    const Eigen::Vector3d apart = (toEigen(m_tree.centre[node]) - middleOf(cube)).cwiseAbs();
    return (apart.array() - half).max(0.0).matrix().norm();
  }

  // Keeps the nodes that reach the cube; the one of least power at its centre becomes its node.
  void chooseNodes(Cube& cube) const {
    const Eigen::Vector3d middle = middleOf(cube.cube);
    double least = INFINITY;
    std::erase_if(cube.near, [&](std::uint32_t i) {
      if (distanceTo(cube.cube, i) > nodeReach(i)) return true;
      const double square = (toEigen(m_tree.centre[i]) - middle).squaredNorm();
      const double r = m_tree.radius[i];
      if (square - r * r < least) {
        least = square - r * r;
        cube.cube.node = i;
      }
      return false;
    });
  }

  [[nodiscard]] bool isFineEnough(const Cube& cube) const {
    const Eigen::Vector3d middle = middleOf(cube.cube);
    const double edge = edgeOf(cube.cube), half = kHalfDiagonal * edge;
    double thinnest = INFINITY;
    for (const std::uint32_t i : cube.near) {
      const double r = m_tree.radius[i];
      const double near =
          (kFineRadii + m_field.options().offsetShare) * r + m_field.options().offset;
      if (r < thinnest && distanceTo(cube.cube, i) < near) thinnest = r;
    }
    if (edge <= m_edge.at(thinnest) || cube.cube.size <= 2) return true;
    if (edge > 2 * thinnest) return false;  // a vessel might be missed
    return std::abs(m_field.deepest(middle, cube.cube.node).distance) > kSafety * half;
  }

  std::vector<Cube> refine(std::vector<Cube>& level) {
    std::vector<std::uint8_t> isSplit(level.size(), 0);
    tbb::parallel_for(std::size_t{0}, level.size(), [&](std::size_t i) {
      if (i % kCubeBatch == 0) m_progress.check();
      chooseNodes(level[i]);
      isSplit[i] = !level[i].near.empty() && !isFineEnough(level[i]) ? 1 : 0;
    });
    std::size_t cubes = 0, nodes = 0;
    for (std::size_t i = 0; i < level.size(); ++i) {
      cubes += isSplit[i] != 0 ? 8 : 0;
      nodes += isSplit[i] != 0 ? 8 * level[i].near.size() : 0;
    }
    if (m_lattice.m_cubes.size() + cubes > kMaxCubes || nodes > kMaxNodes) throw tooFine();
    std::vector<Cube> next;
    next.reserve(cubes);
    for (std::size_t i = 0; i < level.size(); ++i) {
      if (isSplit[i] == 0) {
        addLeaf(level[i].cube);
        continue;
      }
      markParent(level[i].cube);
      for (int octant = 0; octant < 8; ++octant)
        next.push_back({childOf(level[i].cube, octant), level[i].near});
      level[i].near = {};
    }
    return next;
  }

  static LatticeCube childOf(const LatticeCube& cube, int octant) {
    LatticeCube child = cube;
    child.size /= 2;
    for (std::size_t a = 0; a < 3; ++a)
      if ((octant >> a & 1) != 0) child.corner[a] += child.size;
    return child;
  }

  void addLeaf(const LatticeCube& cube) {
    m_lattice.m_index[AdaptiveLattice::keyOf(cube.corner, cube.size)] =
        static_cast<std::int32_t>(m_lattice.m_cubes.size());
    m_lattice.m_cubes.push_back(cube);
  }
  void markParent(const LatticeCube& cube) {
    m_lattice.m_index[AdaptiveLattice::keyOf(cube.corner, cube.size)] = -1;
  }

  // Splits the leaves that are more than twice as wide as one that they touch. Neighbours in one
  // cell of four times the size are in the same wider leaf.
  void balance() {
    for (std::size_t i = 0; i < m_lattice.m_cubes.size(); ++i) {
      if (i % kCubeBatch == 0) m_progress.check();
      const LatticeCube cube = m_lattice.m_cubes[i];
      if (cube.size * 4 > m_lattice.m_largest) continue;
      const auto isNewCell = [&](std::size_t axis, std::int32_t step) {
        const std::int32_t at = cube.corner[axis] + step * cube.size, cell = 4 * cube.size;
        return step < 0 || at - cube.size < 0 || at / cell != (at - cube.size) / cell;
      };
      for (std::int32_t z = -1; z <= 1; ++z)
        for (std::int32_t y = -1; isNewCell(2, z) && y <= 1; ++y)
          for (std::int32_t x = -1; isNewCell(1, y) && x <= 1; ++x)
            if (isNewCell(0, x))
              splitWiderAt({cube.corner[0] + x * cube.size, cube.corner[1] + y * cube.size,
                            cube.corner[2] + z * cube.size},
                           cube.size);
      if (m_lattice.m_cubes.size() > kMaxCubes) throw tooFine();
    }
  }

  void splitWiderAt(const Position& corner, std::int32_t size) {
    if (std::min({corner[0], corner[1], corner[2]}) < 0) return;
    for (std::int32_t wider = 4 * size; wider <= m_lattice.m_largest; wider *= 2) {
      const auto at = m_lattice.m_index.find(AdaptiveLattice::keyOf(corner, wider));
      if (at == m_lattice.m_index.end() || at->second < 0) continue;
      const LatticeCube cube = m_lattice.m_cubes[static_cast<std::size_t>(at->second)];
      m_lattice.m_index[AdaptiveLattice::keyOf(corner, wider)] = -1;
      for (int octant = 0; octant < 8; ++octant) addLeaf(childOf(cube, octant));
      if (wider > 4 * size) splitWiderAt(corner, size);
      return;
    }
  }

  // Leaves that the balance has split are still in the list.
  void dropParents() {
    std::vector<LatticeCube> leaves;
    for (std::size_t i = 0; i < m_lattice.m_cubes.size(); ++i) {
      const LatticeCube& cube = m_lattice.m_cubes[i];
      std::int32_t& index = m_lattice.m_index[AdaptiveLattice::keyOf(cube.corner, cube.size)];
      if (index < 0) continue;
      index = static_cast<std::int32_t>(leaves.size());
      leaves.push_back(cube);
    }
    m_lattice.m_cubes = std::move(leaves);
  }

  AdaptiveLattice& m_lattice;
  const SeparatedField& m_field;
  const formats::CenterlineTree& m_tree;
  LatticeEdge m_edge;
  Progress& m_progress;
};

AdaptiveLattice::AdaptiveLattice(const SeparatedField& field, const LatticeEdge& edge,
                                 Progress& progress) {
  LatticeBuilder(*this, field, edge, progress).run();
}

}  // namespace lumen::convert
