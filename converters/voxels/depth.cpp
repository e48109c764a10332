// SPDX-License-Identifier: Apache-2.0
#include "converters/voxels/depth.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>

#include <tbb/parallel_for.h>

namespace lumen::convert {
namespace {

constexpr double kNoPlace = std::numeric_limits<double>::infinity();
/// Units of work between two polls of cancellation: well below 100 ms.
constexpr std::size_t kLines = 4096, kVoxels = 16384, kDistances = 1024;

/// Squared distances along one line to the nearest place, where f is each place's own squared
/// distance.
class LineTransform {
public:
  void apply(std::vector<double>& f, double spacing) {
    m_parabola.clear();
    m_from.clear();
    for (std::size_t i = 0; i < f.size(); ++i) {
      if (f[i] == kNoPlace) continue;
      double from = -kNoPlace;
      while (!m_parabola.empty()) {
        from = meeting(f, m_parabola.back(), i, spacing);
        if (from > m_from.back()) break;
        m_parabola.pop_back();
        m_from.pop_back();
        from = -kNoPlace;
      }
      m_parabola.push_back(i);
      m_from.push_back(from);
    }
    if (m_parabola.empty()) return;
    m_out.resize(f.size());
    std::size_t k = 0;
    for (std::size_t i = 0; i < f.size(); ++i) {
      while (k + 1 < m_parabola.size() && m_from[k + 1] < static_cast<double>(i)) ++k;
      const double along = (static_cast<double>(i) - static_cast<double>(m_parabola[k])) * spacing;
      m_out[i] = along * along + f[m_parabola[k]];
    }
    std::swap(f, m_out);
  }

private:
  /// The position at which the parabola of a later place falls below that of an earlier one.
  static double meeting(const std::vector<double>& f, std::size_t a, std::size_t b,
                        double spacing) {
    const double p = static_cast<double>(a), q = static_cast<double>(b), s2 = spacing * spacing;
    return ((f[b] / s2 + q * q) - (f[a] / s2 + p * p)) / (2 * (q - p));
  }
  std::vector<std::size_t> m_parabola;
  std::vector<double> m_from, m_out;
};

/// True if the voxel shares a face with one that is not bright.
bool isRim(const VoxelSet& set, std::uint32_t i, const std::function<bool(std::size_t)>& isBright) {
  const Cell at = set.cell(i);
  const CellBox cells = set.geometry().cells();
  for (int a = 0; a < 3; ++a) {
    if (at[a] > 0 && !isBright(set.index(i) - cells.stride(a))) return true;
    if (at[a] + 1 < cells.size[a] && !isBright(set.index(i) + cells.stride(a))) return true;
  }
  return false;
}

}  // namespace

std::vector<float> distancesTo(const CellBox& box, const Eigen::Vector3d& spacing,
                               std::span<const std::uint8_t> mark, std::uint8_t target,
                               const Progress& progress) {
  std::vector<double> squared(mark.size());
  for (std::size_t i = 0; i < mark.size(); ++i) squared[i] = mark[i] == target ? 0 : kNoPlace;
  LineTransform transform;
  std::vector<double> line;
  for (int axis = 0; axis < 3; ++axis) {
    CellBox starts = box;
    starts.size[axis] = 1;
    const std::size_t stride = box.stride(axis);
    line.resize(static_cast<std::size_t>(box.size[axis]));
    for (std::size_t l = 0; l < starts.count(); ++l) {
      if (l % kLines == 0) progress.check();
      const std::size_t start = box.index(starts.cell(l));
      for (std::size_t i = 0; i < line.size(); ++i) line[i] = squared[start + i * stride];
      transform.apply(line, spacing[axis]);
      for (std::size_t i = 0; i < line.size(); ++i) squared[start + i * stride] = line[i];
    }
  }
  std::vector<float> out(squared.size());
  std::transform(squared.begin(), squared.end(), out.begin(),
                 [](double d) { return static_cast<float>(std::sqrt(d)); });
  return out;
}

std::vector<float> measureDepths(const VoxelSet& set,
                                 const std::function<bool(std::size_t)>& isBright,
                                 const Progress& progress) {
  const auto half = static_cast<float>(0.5 * set.geometry().voxelSize());
  std::vector<float> depths(set.size(), std::numeric_limits<float>::infinity());
  std::vector<Eigen::Vector3f> fromRim(set.size());
  std::deque<std::uint32_t> queue;
  for (std::uint32_t i = 0; i < set.size(); ++i)
    if (isRim(set, i, isBright)) {
      fromRim[i].setZero();
      depths[i] = half;
      queue.push_back(i);
    }
  for (; !queue.empty(); queue.pop_front()) {
    if (queue.front() % kVoxels == 0) progress.check();
    const Eigen::Vector3f here = fromRim[queue.front()];
    set.eachBeside(queue.front(), [&](std::uint32_t j, const Eigen::Vector3d& step) {
      const Eigen::Vector3f there = here + step.cast<float>();
      const float depth = half + there.norm();
      if (!(depth < depths[j])) return;
      depths[j] = depth;
      fromRim[j] = there;
      queue.push_back(j);
    });
  }
  return depths;
}

std::vector<float> depthsBy(const VoxelSet& set,
                            const std::function<double(const Eigen::Vector3d&)>& distance,
                            const Progress& progress) {
  std::vector<float> depths(set.size());
  tbb::parallel_for(std::uint32_t{0}, static_cast<std::uint32_t>(set.size()), [&](std::uint32_t i) {
    if (i % kDistances == 0) progress.check();
    depths[i] = static_cast<float>(distance(set.position(i)));
  });
  return depths;
}

}  // namespace lumen::convert
