// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/patches/polygonise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <tbb/parallel_for.h>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/vectors.h"
#include "converters/geometry/marching_cubes.h"
#include "converters/geometry/surface_projection.h"
#include "converters/stages/surface/patches/node_field.h"
#include "converters/stages/surface/patches/patch.h"
#include "converters/stages/surface/to_surface_mesh.h"
#include "formats/case/case_field.h"
#include "formats/case/topology.h"
#include "formats/case/vessel_system.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {

namespace {

/// A vessel narrower than this many cells gets a finer lattice, halved up to kMaxHalvings times.
constexpr double kMinRadiusCells = 2;
constexpr int kMaxHalvings = 3;
/// Rows of a node's lattice, and triangles of a mesh: about a hundred bytes each while it is made.
constexpr double kMaxRows = 1 << 23, kMaxTriangles = 1 << 26;
/// Extent of a node's grid around it, in radii.
constexpr double kGridRadii = 2.4;
/// The factor by which the search for a sufficient cell proceeds.
constexpr double kCoarser = 1.1;

/// Length of vessel that a node draws, mm: at least to its parent.
double lengthAt(const formats::CenterlineTree& tree, std::size_t node) {
  const double own = tree.height[node];
  const std::int32_t parent = tree.parent[node];
  if (parent < 0) return own;
  return std::max(
      own,
      (toEigen(tree.centre[node]) - toEigen(tree.centre[static_cast<std::size_t>(parent)])).norm());
}

bool isFeasible(const formats::Case& source, double cell) {
  const formats::CenterlineTree& tree = source.tree;
  double triangles = 0;
  for (std::size_t node = 0; node < tree.nodeCount(); ++node) {
    if (source.models->offset[node] == source.models->offset[node + 1]) continue;
    const double radius = tree.radius[node], length = lengthAt(tree, node);
    const double size = cellForRadius(cell, radius);
    const double across = 2 * (kGridRadii * radius + 0.5 * double{tree.height[node]}) / size;
    const double samples =
        4 * radius * radius * std::min(length, across * size) / (size * size * size);
    triangles += 4 * std::numbers::pi * radius * length / (size * size);
    const double farthest = toEigen(tree.centre[node]).cwiseAbs().maxCoeff();
    if (across > kMaxAcross || across * across > kMaxRows ||
        samples > static_cast<double>(kMaxSamples) || farthest > kMaxPosition * size)
      return false;
  }
  return triangles <= kMaxTriangles;
}

/// Two digits, rounded up.
double twoDigitsUp(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return std::ceil(value / unit) * unit;
}

}  // namespace

double cellForRadius(double cell, double radius) {
  for (int i = 0; i < kMaxHalvings && radius < kMinRadiusCells * cell; ++i) cell *= 0.5;
  return cell;
}

double coarsestCellFor(double radius) {
  return radius / kMinRadiusCells * (1 << kMaxHalvings);
}

void checkCell(const formats::Case& source, double cell) {
  if (isFeasible(source, cell)) return;
  double enough = cell;
  while (std::isfinite(enough) && !isFeasible(source, enough)) enough *= kCoarser;
  throw invalidInput("a cell of " + shownNumber(cell) +
                     " mm is too small for this case: its mesh would not fit into memory; "
                     "expected a cell of " +
                     shownNumber(twoDigitsUp(enough)) + " mm or more");
}

namespace {

// A cell that straddles a plane has every corner nearer to it than this many cells: over sqrt(3).
constexpr double kCellDiagonal = 1.74;
// Extent of a node's surface from its centre along each axis. Its points lie within 2.4 radii,
// because its rays are sampled no farther; a surface beyond runs away from them.
constexpr double kPatchRadii = 2.4, kPatchHeights = 0.5;
// A part of the cut patch that nowhere comes this near to the node, in radii, is not its lumen's.
constexpr double kLumenRadii = 2;
// Vertices this near to a plane, in cells, are on it.
constexpr double kSnap = 1e-4;
// Largest move, in radii, of a vertex of a local surface onto the surface of the case.
constexpr double kMaxShift = 0.5;

struct NodePatch {
  TriangleMesh patch;
  std::vector<Float3> normal;
  bool hasModel = false, isMissed = false;
  std::size_t lostTriangles = 0;
};

// The common input of all patches.
struct Source {
  const formats::Case& value;
  const formats::Neighbours& edges;
  const field::BlendedField& surface;
};

struct Interval {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

// The part of the line (., y, z) that is in every half-space, or less than `pad` outside.
Interval lineInside(const std::vector<HalfSpace>& spaces, double y, double z, double pad) {
  Interval result;
  for (const HalfSpace& space : spaces) {
    const double room = space.offset + pad - space.normal.y() * y - space.normal.z() * z;
    const double slope = space.normal.x();
    if (slope > 0) result.high = std::min(result.high, room / slope);
    if (slope < 0) result.low = std::max(result.low, room / slope);
    if (slope == 0 && room < 0) return {0, -1};
  }
  return result;
}

int latticeFloor(double position, double cell) {
  return static_cast<int>(std::floor(position / cell));
}

Error cellTooSmall(double cell) {
  return invalidInput("a cell of " + formats::shortText(cell) +
                      " mm is too small for this case; expected a larger cell");
}

// The rows of the lattice within `low` .. `high` that may meet the surface inside the half-spaces.
SampleGrid layOutGrid(const NodeField& field, const std::vector<HalfSpace>& spaces,
                      const Eigen::Vector3d& low, const Eigen::Vector3d& high, double cell) {
  if (low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff() > kMaxPosition * cell ||
      (high - low).maxCoeff() > kMaxAcross * cell)
    throw cellTooSmall(cell);
  SampleGrid grid;
  grid.cell = cell;
  grid.lowY = latticeFloor(low.y(), cell) - 1;
  grid.lowZ = latticeFloor(low.z(), cell) - 1;
  grid.rowsY = std::max(0, latticeFloor(high.y(), cell) + 3 - grid.lowY);
  grid.rowsZ = std::max(0, latticeFloor(high.z(), cell) + 3 - grid.lowZ);
  std::size_t samples = 0;
  for (int iz = 0; iz < grid.rowsZ; ++iz)
    for (int iy = 0; iy < grid.rowsY; ++iy) {
      const double y = cell * (grid.lowY + iy), z = cell * (grid.lowZ + iz);
      Interval part = lineInside(spaces, y, z, kCellDiagonal * cell);
      part.low = std::max(part.low, low.x() - cell);
      part.high = std::min(part.high, high.x() + cell);
      SampleGrid::SampleRow& row = grid.rows.emplace_back();
      row.offset = samples;
      if (part.low > part.high) continue;
      const NodeField::Range near = field.rangeNearInside(cell, y, z);
      row.first = std::max(near.first, latticeFloor(part.low, cell));
      row.count =
          std::max(0, std::min(near.last, latticeFloor(part.high, cell) + 1) - row.first + 1);
      samples += static_cast<std::size_t>(row.count);
    }
  if (samples > kMaxSamples) throw cellTooSmall(cell);
  grid.value.resize(samples);
  return grid;
}

void sampleField(const NodeField& field, SampleGrid& grid) {
  for (std::size_t r = 0; r < grid.rows.size(); ++r) {
    const SampleGrid::SampleRow& row = grid.rows[r];
    const int y = grid.lowY + static_cast<int>(r % static_cast<std::size_t>(grid.rowsY));
    const int z = grid.lowZ + static_cast<int>(r / static_cast<std::size_t>(grid.rowsY));
    field.sampleRow(row.first, grid.cell, grid.cell * y, grid.cell * z,
                    std::span(grid.value).subspan(row.offset, static_cast<std::size_t>(row.count)));
  }
}

// The plane among those of `spaces` that a point lies on; null if it is on none.
const HalfSpace* planeThrough(const std::vector<HalfSpace>& spaces, const Eigen::Vector3d& point,
                              double snap) {
  const auto found = std::find_if(spaces.begin(), spaces.end(), [&](const HalfSpace& space) {
    return std::abs(space.distance(point)) <= snap;
  });
  return found == spaces.end() ? nullptr : &*found;
}

// Moves vertices from the surface of the node's own model onto that of the case, where patches
// meet. Vertices that a plane has cut stay in that plane, unless the surface is so oblique to it
// that it lies far away there; ends always stay flat. Where there is no surface of the case near
// by, as where a model draws a wall within the lumen of its neighbours, triangles are dropped;
// returns their number.
std::size_t moveOntoSurface(const Source& source, std::uint32_t node, const NodeCell& cell,
                            double snap, TriangleMesh& patch) {
  const double radius = source.value.tree.radius[node];
  const auto move = [&](Eigen::Vector3d& p, const HalfSpace* plane) {
    const auto found = projectOnSurface(source.surface, p, node, radius,
                                        plane != nullptr ? &plane->normal : nullptr);
    const bool isNear = found && (found->position - p).norm() <= kMaxShift * radius;
    if (isNear) p = found->position;
    return isNear;
  };
  std::vector<bool> isLost(patch.position.size(), false);
  for (std::size_t v = 0; v < patch.position.size(); ++v) {
    Eigen::Vector3d& p = patch.position[v];
    if (const HalfSpace* end = planeThrough(cell.ends, p, snap)) {
      move(p, end);
      continue;
    }
    const HalfSpace* radical = planeThrough(cell.radical, p, snap);
    isLost[v] = !move(p, radical) && (radical == nullptr || !move(p, nullptr));
  }
  return std::erase_if(patch.triangle, [&](const Triangle& t) {
    return isLost[t[0]] || isLost[t[1]] || isLost[t[2]];
  });
}

std::vector<Float3> outwardNormals(const Source& source, std::uint32_t node,
                                   const TriangleMesh& patch) {
  const Eigen::Vector3d centre = toEigen(source.value.tree.centre[node]);
  std::vector<Float3> normals;
  normals.reserve(patch.position.size());
  for (const Eigen::Vector3d& p : patch.position) {
    const field::Vec point{p.x(), p.y(), p.z()};
    const std::uint32_t current = source.surface.follow(point, node);
    Eigen::Vector3d outward = -Eigen::Vector3d(source.surface.blended(point, current).gradient);
    if (outward.squaredNorm() < 1e-200)
      outward = p - centre;  // a flat spot has no normal of its own
    if (outward.squaredNorm() < 1e-200) outward = Eigen::Vector3d::UnitZ();
    const Eigen::Vector3f n = outward.normalized().cast<float>();
    normals.push_back({n.x(), n.y(), n.z()});
  }
  return normals;
}

// The surface of the node's own model around its lumen, before it is cut.
TriangleMesh polygoniseModel(const formats::Case& source, std::uint32_t node,
                             const NodeField& field, const std::vector<HalfSpace>& spaces,
                             double cell) {
  const formats::CenterlineTree& tree = source.tree;
  const Eigen::Vector3d centre = toEigen(tree.centre[node]);
  const double radius = tree.radius[node];
  const double reach = kPatchRadii * radius + kPatchHeights * double(tree.height[node]) + 2 * cell;
  const Eigen::Vector3d low = field.low().cwiseMax((centre.array() - reach).matrix());
  const Eigen::Vector3d high = field.high().cwiseMin((centre.array() + reach).matrix());
  SampleGrid grid = layOutGrid(field, spaces, low, high, cell);
  sampleField(field, grid);
  const auto state = markLumen(grid, field.isoLevel(), centre, radius + cell);
  return marchingCubes(grid, state,
                       [&field](const Eigen::Vector3d& a, double fa, const Eigen::Vector3d& b,
                                double fb) { return field.crossing(a, fa, b, fb); });
}

NodePatch polygoniseNode(const Source& source, std::uint32_t node, double voxel) {
  const NodeField field(*source.value.models, node);
  const formats::CenterlineTree& tree = source.value.tree;
  const double radius = tree.radius[node], size = cellForRadius(voxel, radius);
  const auto cell = nodeCell(source.value, source.edges, source.surface.neighbours(node), node);
  if (field.empty() || !cell) return {};
  std::vector<HalfSpace> spaces = cell->radical;
  spaces.insert(spaces.end(), cell->ends.begin(), cell->ends.end());
  NodePatch result;
  TriangleMesh& patch = result.patch;
  patch = polygoniseModel(source.value, node, field, spaces, size);
  result.hasModel = true;
  result.isMissed = patch.triangle.empty();
  for (const HalfSpace& space : spaces) clip(patch, space, kSnap * size);
  dropFarParts(patch, toEigen(tree.centre[node]), kLumenRadii * radius);
  result.lostTriangles = moveOntoSurface(source, node, *cell, kSnap * size, patch);
  roundToFloat(patch);
  separateFans(patch);
  result.normal = outwardNormals(source, node, patch);
  return result;
}

void count(const NodePatch& part, double radius, BranchLosses& losses) {
  losses.nodes += part.hasModel ? 1 : 0;
  losses.missedNodes += part.isMissed ? 1 : 0;
  losses.lostTriangles += part.lostTriangles;
  if (part.isMissed || part.lostTriangles > 0)
    losses.thinnest = losses.thinnest == 0 ? radius : std::min(losses.thinnest, radius);
}

void append(const Source& source, const NodePatch& part, std::uint32_t node, SurfaceMesh& mesh) {
  const auto base = static_cast<std::uint32_t>(mesh.position.size());
  const std::uint32_t branch = source.value.tree.branch[node];
  for (const Eigen::Vector3d& p : part.patch.position) {
    const Eigen::Vector3f q = p.cast<float>();
    mesh.position.push_back({q.x(), q.y(), q.z()});
    const VesselValues values = vesselAt(source.value.tree, source.edges, p, node);
    mesh.radius.push_back(values.radius);
    if (values.confidence) mesh.confidence.push_back(*values.confidence);
  }
  mesh.normal.insert(mesh.normal.end(), part.normal.begin(), part.normal.end());
  mesh.branch.resize(mesh.position.size(), branch);
  for (const Triangle& t : part.patch.triangle)
    mesh.triangle.push_back({base + t[0], base + t[1], base + t[2]});
  mesh.group.resize(mesh.triangle.size(), branch);
}

Patches join(const Source& source, std::vector<NodePatch>& parts, Progress& progress) {
  const formats::CenterlineTree& tree = source.value.tree;
  Patches result;
  for (const formats::Branch& branch : tree.branches) {
    result.surface.groups.push_back({branch.label, FaceKind::Wall});
    result.surface.labels.push_back(branch.label);
  }
  result.surface.systems = formats::knownBranchSystems(source.value);
  result.losses.resize(tree.branches.size());
  for (std::uint32_t node = 0; node < parts.size(); ++node) {
    progress.check();
    append(source, parts[node], node, result.surface);
    BranchLosses& losses = result.losses[tree.branch[node]];
    count(parts[node], double(tree.radius[node]), losses);
    losses.triangles += parts[node].patch.triangle.size();
    parts[node] = {};
  }
  if (result.surface.position.size() > std::numeric_limits<std::uint32_t>::max())
    throw cellTooSmall(source.value.metadata.voxelSize.value_or(0));
  return result;
}

}  // namespace

double chooseCell(const formats::Case& source, const PolygoniseOptions& options) {
  if (!source.models)
    throw invalidInput(
        "the case has no models, and a mesh is made from them; lumen fit makes them");
  const double cell = options.cell > 0 ? options.cell : source.metadata.voxelSize.value_or(0);
  if (!(options.cell >= 0) || !(cell > 0) || !std::isfinite(cell))
    throw invalidInput("the mesh needs a cell size: found a cell of " +
                       formats::shortText(options.cell) +
                       " mm and no voxel size in the case; expected a cell above 0");
  return cell;
}

Patches polygonise(const formats::Case& source, const PolygoniseOptions& options,
                   Progress& progress) {
  const double cell = chooseCell(source, options);
  checkCell(source, cell);
  const formats::Neighbours edges(source.tree);
  const field::BlendedField surface = formats::caseField(source);
  const Source all{source, edges, surface};
  std::vector<NodePatch> parts(source.tree.nodeCount());
  progress.begin("mesh", parts.size());
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
    progress.check();
    parts[i] = polygoniseNode(all, static_cast<std::uint32_t>(i), cell);
    progress.advance();
  });
  Patches result = join(all, parts, progress);
  progress.end();
  return result;
}

}  // namespace lumen::convert
