// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/packs/mesh_deviation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>

#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"
#include "converters/export/shared/vessel_distance.h"

namespace lumen::viewer {

namespace {

constexpr double kCellEdge = 4;         // mm: points of one cell are asked for together
constexpr std::size_t kTogether = 128;  // points between two looks whether to go on
constexpr double kFigureShare = 0.9;    // share of the vertices of "percentile90_mm"

/// The order in which points that are near each other follow one another; as they are within a cell.
std::vector<std::uint32_t> orderByCell(std::span<const Eigen::Vector3d> points) {
  std::vector<std::array<double, 3>> cell;
  cell.reserve(points.size());
  for (const Eigen::Vector3d& p : points)
    cell.push_back({std::floor(p.x() / kCellEdge), std::floor(p.y() / kCellEdge),
                    std::floor(p.z() / kCellEdge)});
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return cell[a] < cell[b]; });
  return order;
}

}  // namespace

MeshDeviation meshDeviation(const formats::Case& value, std::span<const Eigen::Vector3d> points,
                            Progress& progress) {
  const convert::VesselDistance wall(value, true);
  const std::vector<std::uint32_t> order = orderByCell(points);
  MeshDeviation result;
  result.distance.resize(points.size());
  tbb::parallel_for(
      std::size_t{0}, (points.size() + kTogether - 1) / kTogether, [&](std::size_t k) {
        progress.check();
        const std::size_t begin = k * kTogether, end = std::min(begin + kTogether, points.size());
        std::vector<Eigen::Vector3d> some;
        for (std::size_t i = begin; i < end; ++i) some.push_back(points[order[i]]);
        std::vector<convert::WallDistance> answers(some.size());
        wall.ofAll(some, std::numeric_limits<double>::infinity(), answers);
        for (std::size_t i = begin; i < end; ++i)
          result.distance[order[i]] = answers[i - begin].distance;
      });
  if (points.empty()) return result;
  std::vector<double> sizes;
  sizes.reserve(points.size());
  for (const float distance : result.distance) sizes.push_back(std::abs(double{distance}));
  result.median = median(sizes);
  result.percentile90 = nearestRank(sizes, kFigureShare);
  result.greatest = *std::max_element(sizes.begin(), sizes.end());
  return result;
}

}  // namespace lumen::viewer
