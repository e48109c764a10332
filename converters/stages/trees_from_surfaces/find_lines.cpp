// SPDX-License-Identifier: Apache-2.0
// Vessels of a surface that comes without a centerline.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/base/number_text.h"
#include "converters/geometry/automatic_names.h"
#include "converters/stages/trees_from_surfaces/closed_mesh.h"
#include "converters/stages/trees_from_surfaces/vessel_line.h"
#include "converters/voxels/depth.h"
#include "converters/voxels/vessel_paths.h"
#include "converters/voxels/voxel_set.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kNowhere = VesselPath::kNone;
constexpr std::size_t kLeastPart = 27;  // voxels of a part that may be a vessel
constexpr double kEndDepths = 4;        // depths from where a path is trimmed to the vessel's end

/// From the inside as voxels to lines.
class LineFinder {
public:
  LineFinder(const LumenGeometry& lumen, const VolumeGeometry& grid, bool allOpenings,
             Progress& progress)
      : m_lumen(lumen),
        m_allOpenings(allOpenings),
        m_set(grid, insideVoxels(lumen.surface().mesh, grid, progress)),
        m_depths(depths(progress)),
        m_isOpen(
            [&lumen](const Vector3d& a, const Vector3d& b) { return lumen.tree().isFree(a, b); }),
        m_paths(m_set, m_depths, m_isOpen, progress),
        m_progress(progress) {}

  VesselLines find() {
    const std::vector<std::uint32_t> atEnd = voxelsAtEnds();
    std::vector<bool> isSeen(m_set.size(), false);
    std::size_t small = 0;
    for (std::uint32_t i = 0; i < m_set.size(); ++i) {
      if (isSeen[i]) continue;
      const std::vector<std::uint32_t> part = m_paths.connectedPart(i);
      for (const std::uint32_t j : part) isSeen[j] = true;
      if (part.size() < kLeastPart) {
        ++small;
        continue;
      }
      addPart(findRoot(atEnd, part), atEnd, part);
    }
    if (small > 0)
      m_out.notes.push_back(std::to_string(small) + " part" + (small == 1 ? "" : "s") +
                            " of the inside smaller than " + std::to_string(kLeastPart) +
                            " voxels of " + fixedText(m_set.geometry().voxelSize(), 6) +
                            " mm left out");
    return std::move(m_out);
  }

private:
  std::vector<float> depths(Progress& progress) const {
    progress.begin("depth", 0);
    std::vector<float> depths = depthsBy(
        m_set, [&](const Vector3d& at) { return m_lumen.tree().nearest(at).distance; }, progress);
    progress.end();
    return depths;
  }

  /// For each flat end the nearest voxel inside, or kNowhere.
  [[nodiscard]] std::vector<std::uint32_t> voxelsAtEnds() const {
    const VolumeGeometry& grid = m_set.geometry();
    std::vector<std::uint32_t> out;
    for (const MeshEnd& end : m_lumen.surface().ends) {
      const Vector3d at = grid.indexFromWorld(end.centre - 1.5 * grid.voxelSize() * end.normal);
      std::uint32_t best = kNowhere;
      double least = 0;
      for (int k = 0; k < 125; ++k) {
        const Vector3d near(std::round(at.x()) + k % 5 - 2, std::round(at.y()) + k / 5 % 5 - 2,
                            std::round(at.z()) + k / 25 - 2);
        if (!grid.containsIndex(near)) continue;
        const std::uint32_t voxel = m_set.find(grid.index(near.cast<int>()));
        if (voxel == VoxelSet::kNone) continue;
        const double away = (near - at).squaredNorm();
        if (best != kNowhere && away >= least) continue;
        best = voxel;
        least = away;
      }
      out.push_back(best);
    }
    return out;
  }

  /// The place where the widest vessel of a part enters it.
  std::uint32_t findRoot(const std::vector<std::uint32_t>& atEnd,
                         const std::vector<std::uint32_t>& part) {
    std::vector<std::uint32_t> sorted = part;
    std::sort(sorted.begin(), sorted.end());
    std::uint32_t best = kNowhere;
    double widest = 0;
    for (std::size_t e = 0; e < atEnd.size(); ++e)
      if (std::binary_search(sorted.begin(), sorted.end(), atEnd[e]) &&
          m_lumen.surface().ends[e].radius > widest) {
        widest = m_lumen.surface().ends[e].radius;
        best = atEnd[e];
      }
    if (best != kNowhere) return best;
    return m_paths.widestTip(part.front(), m_progress);
  }

  /// Adds paths to the openings of a part that no path leads to.
  void reachOpenings(std::vector<VesselPath>& paths, const std::vector<std::uint32_t>& atEnd,
                     const std::vector<std::uint32_t>& part) {
    std::vector<std::uint32_t> sorted = part;
    std::sort(sorted.begin(), sorted.end());
    const std::vector<MeshEnd>& ends = m_lumen.surface().ends;
    std::vector<const MeshEnd*> reached;
    const auto reach = [&](std::uint32_t voxel) {
      reached.push_back(endAt(m_set.position(voxel), m_lumen.surface()));
    };
    for (const VesselPath& path : paths) {
      if (path.parent == kNowhere) reach(path.voxels.front());
      if (path.meets == kNowhere) reach(path.voxels.back());
    }
    for (std::size_t e = 0; e < ends.size(); ++e)
      if (ends[e].wasOpen && std::binary_search(sorted.begin(), sorted.end(), atEnd[e]) &&
          std::find(reached.begin(), reached.end(), &ends[e]) == reached.end())
        m_paths.addPath(atEnd[e], paths);
  }

  void addPart(std::uint32_t root, const std::vector<std::uint32_t>& atEnd,
               const std::vector<std::uint32_t>& part) {
    std::vector<VesselPath> paths = m_paths.find(root, m_progress);
    const std::size_t found = paths.size();
    if (m_allOpenings) reachOpenings(paths, atEnd, part);
    const std::size_t first = m_out.lines.size();
    m_out.lines.resize(first + paths.size());
    for (const std::vector<std::size_t>& generation : generations(paths))
      tbb::parallel_for(std::size_t{0}, generation.size(), [&](std::size_t i) {
        m_progress.check();
        const std::size_t w = generation[i];
        m_out.lines[first + w] = makeLine(paths, w, first, w >= found);
      });
  }

  /// The paths by generations: lines of one generation rest on those of earlier ones alone.
  static std::vector<std::vector<std::size_t>> generations(const std::vector<VesselPath>& paths) {
    std::vector<std::size_t> age(paths.size(), 0);
    std::vector<std::vector<std::size_t>> out;
    for (std::size_t w = 0; w < paths.size(); ++w) {
      // a path comes after its parent and after the path that it meets
      for (const std::uint32_t other : {paths[w].parent, paths[w].meets})
        if (other != kNowhere) age[w] = std::max(age[w], age[other] + 1);
      out.resize(std::max(out.size(), age[w] + 1));
      out[age[w]].push_back(w);
    }
    return out;
  }

  /// Whether another path comes to the tip of this one round a loop.
  [[nodiscard]] bool isMetAtTip(const std::vector<VesselPath>& paths, std::size_t w) const {
    const Vector3d tip = m_set.position(paths[w].voxels.back());
    return std::any_of(paths.begin(), paths.end(), [&](const VesselPath& other) {
      if (other.meets != w) return false;
      const std::uint32_t at = paths[w].voxels[other.meetsVoxel];
      return (m_set.position(at) - tip).norm() < 2 * static_cast<double>(m_depths[at]);
    });
  }

  /// The nearest point of a line that no wall hides from `from`; `from` itself if there is none.
  [[nodiscard]] Vector3d nearestSeen(const VesselLine& line, const Vector3d& from) const {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < line.point.size(); ++i)
      order.emplace_back((line.point[i] - from).squaredNorm(), i);
    std::sort(order.begin(), order.end());
    const auto seen = std::find_if(order.begin(), order.end(), [&](const auto& entry) {
      return m_isOpen(from, line.point[entry.second]);
    });
    return seen == order.end() ? from : line.point[seen->second];
  }

  /// The line of a path; that of a stub, which is too short to be found as a vessel, is straight.
  VesselLine makeLine(const std::vector<VesselPath>& paths, std::size_t w, std::size_t first,
                      bool isStub) const {
    const VesselPath& path = paths[w];
    VesselLine line;
    line.label = provisionalName(first + w + 1);
    line.isSac = path.isSac;
    for (const std::uint32_t i : path.voxels) line.point.push_back(m_set.position(i));
    const VesselLine* parent = nullptr;
    if (path.parent != kNowhere) {
      line.parent = static_cast<int>(first + path.parent);
      parent = &m_out.lines[first + path.parent];
      const Vector3d tip = line.point.back(), seen = nearestSeen(*parent, tip);
      if (isStub && seen != tip)
        line.point = {seen, tip};
      else
        line.point.front() = nearestSeen(*parent, line.point.front());
    } else {
      trim(line, true, m_lumen);
    }
    if (path.meets != kNowhere) {
      line.meets = static_cast<int>(first + path.meets);
      const Vector3d tip = line.point.back();
      const Vector3d meeting = nearestSeen(m_out.lines[first + path.meets], tip);
      if (meeting != tip) line.point.push_back(meeting);
    }
    const bool goesOn = path.meets != kNowhere || isMetAtTip(paths, w);
    if (!goesOn) trim(line, false, m_lumen);
    centre(line, parent, m_lumen);
    if (!parent) extend(line, true, kEndDepths, m_lumen);
    if (!goesOn) extend(line, false, kEndDepths, m_lumen);
    measureDepths(line, m_lumen);
    return line;
  }

  const LumenGeometry& m_lumen;
  bool m_allOpenings;
  VoxelSet m_set;
  std::vector<float> m_depths;
  VesselPaths::IsOpen m_isOpen;
  VesselPaths m_paths;
  Progress& m_progress;
  VesselLines m_out;
};

}  // namespace

VesselLines findLines(const LumenGeometry& lumen, const VolumeGeometry& grid, bool allOpenings,
                      Progress& progress) {
  return LineFinder(lumen, grid, allOpenings, progress).find();
}

}  // namespace lumen::convert
