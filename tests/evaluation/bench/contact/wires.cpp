// SPDX-License-Identifier: Apache-2.0
#include "wires.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <tbb/parallel_for.h>

namespace lumen::bench {
namespace {

using formats::CenterlineTree;

// The nodes from a root to a leaf, and how far each is along.
struct Path {
  std::vector<std::uint32_t> node;
  std::vector<double> at;  // mm
};

struct Wire {
  std::size_t path = 0;
  double tip = 0, spacing = 0, phase = 0;
};

double between(const CenterlineTree& tree, std::uint32_t a, std::uint32_t b) {
  return std::hypot(tree.centre[a].x - tree.centre[b].x, tree.centre[a].y - tree.centre[b].y,
                    tree.centre[a].z - tree.centre[b].z);
}

Path pathTo(const CenterlineTree& tree, std::uint32_t leaf) {
  Path path;
  path.node.push_back(leaf);
  while (tree.parent[path.node.back()] >= 0)
    path.node.push_back(static_cast<std::uint32_t>(tree.parent[path.node.back()]));
  std::reverse(path.node.begin(), path.node.end());
  path.at.push_back(0);
  for (std::size_t i = 1; i < path.node.size(); ++i)
    path.at.push_back(path.at.back() + between(tree, path.node[i - 1], path.node[i]));
  return path;
}

std::vector<Path> allPaths(const CenterlineTree& tree) {
  std::vector<bool> isLeaf(tree.nodeCount(), true);
  for (const std::int32_t parent : tree.parent)
    if (parent >= 0) isLeaf[static_cast<std::size_t>(parent)] = false;
  std::vector<Path> paths;
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i)
    if (isLeaf[i] && tree.parent[i] >= 0) paths.push_back(pathTo(tree, i));
  return paths;
}

std::vector<Wire> drawWires(const std::vector<Path>& paths, const WireOptions& options) {
  std::mt19937_64 random(options.seed);
  const auto share = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const double travel = options.advance * static_cast<double>(options.frames);
  std::vector<Wire> wires(options.environments);
  for (Wire& wire : wires) {
    wire.path = random() % paths.size();
    const double length = paths[wire.path].at.back();
    const auto gaps = static_cast<double>(options.points - 1);
    wire.spacing = std::min(options.spacing, std::max(0.0, length - travel) / gaps);
    const double shallowest = wire.spacing * gaps;
    wire.tip = shallowest + share() * std::max(0.0, length - travel - shallowest);
    wire.phase = 2 * std::numbers::pi * share();
  }
  return wires;
}

// Where a wire's point is that lies `s` mm along its path.
void placePoint(const CenterlineTree& tree, const blob_model* model, const Path& path, double phase,
                double s, double* point, std::uint32_t& station) {
  const auto next = std::upper_bound(path.at.begin() + 1, path.at.end() - 1, s);
  const auto i = static_cast<std::size_t>(next - path.at.begin());
  const std::uint32_t from = path.node[i - 1], to = path.node[i];
  const double length = std::max(path.at[i] - path.at[i - 1], 1e-9);
  const double t = std::clamp((s - path.at[i - 1]) / length, 0.0, 1.0);
  station = t < 0.5 ? from : to;
  const formats::Vec3f &a = tree.centre[from], &b = tree.centre[to];
  const double along[3] = {(b.x - a.x) / length, (b.y - a.y) / length, (b.z - a.z) / length};
  const double axis[3] = {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
  constexpr double kTurn = 0.3, kWave = 1.1;  // radians per mm
  double direction[3];
  across(along, phase + kTurn * s, direction);
  const double off =
      (0.55 + 0.5 * std::sin(kWave * s + 2 * phase)) * wallAlong(model, station, axis, direction);
  for (int k = 0; k < 3; ++k) point[k] = axis[k] + off * direction[k];
}

}  // namespace

void across(const double* along, double angle, double* result) {
  const double any[3] = {0.36, 0.48, 0.8}, other[3] = {0.8, -0.6, 0.0};
  const auto dot = [&](const double* v) {
    return along[0] * v[0] + along[1] * v[1] + along[2] * v[2];
  };
  const double* start = std::abs(dot(any)) < 0.9 ? any : other;
  double e[3], square = 0;
  for (int k = 0; k < 3; ++k) {
    e[k] = start[k] - dot(start) * along[k];
    square += e[k] * e[k];
  }
  for (double& x : e) x /= std::sqrt(square);
  const double f[3] = {along[1] * e[2] - along[2] * e[1], along[2] * e[0] - along[0] * e[2],
                       along[0] * e[1] - along[1] * e[0]};
  for (int k = 0; k < 3; ++k) result[k] = std::cos(angle) * e[k] + std::sin(angle) * f[k];
}

double wallAlong(const blob_model* model, std::uint32_t station, const double* axis,
                 const double* direction) {
  const double radius = blob_model_node(model, station).radius;
  double end[3];
  for (int k = 0; k < 3; ++k) end[k] = axis[k] + 4 * radius * direction[k];
  blob_hit hit;
  blob_segment_hit(model, BLOB_BLENDED, axis, end, &station, 0, 0, &hit);
  return hit.hit != 0 ? 4 * radius * hit.t : radius;
}

Wires makeWires(const CenterlineTree& tree, const blob_model* model, const WireOptions& options) {
  const std::vector<Path> paths = allPaths(tree);
  Wires result;
  if (paths.empty()) return result;
  const std::vector<Wire> wires = drawWires(paths, options);
  result.environments = options.environments;
  result.points = options.points;
  result.position.assign(options.frames, std::vector<double>(3 * result.count()));
  result.station.assign(options.frames, std::vector<std::uint32_t>(result.count()));
  tbb::parallel_for(std::size_t{0}, wires.size(), [&](std::size_t e) {
    const Wire& wire = wires[e];
    for (std::size_t frame = 0; frame < options.frames; ++frame)
      for (std::size_t n = 0; n < options.points; ++n) {
        const std::size_t i = e * options.points + n;
        const double s = wire.tip + options.advance * static_cast<double>(frame) -
                         wire.spacing * static_cast<double>(n);
        placePoint(tree, model, paths[wire.path], wire.phase, s, &result.position[frame][3 * i],
                   result.station[frame][i]);
      }
  });
  return result;
}

}  // namespace lumen::bench
