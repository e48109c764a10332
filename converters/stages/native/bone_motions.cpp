// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/native/bone_motions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"
#include "converters/stages/native/bone_blocks.h"
#include "converters/stages/native/register_rigid.h"

namespace lumen::convert {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr int kRim = 2;                            // voxels around bone that it blurs
constexpr std::array<int, 4> kShrink{8, 4, 2, 1};  // voxels in one of a level, coarse to fine
constexpr std::size_t kFine = 2;                   // level from which one start is left
constexpr std::size_t kMostPoints = 5000;          // of bone, for a registration
/// Voxels of bone and its rim, a cube of ten: fewer hardly hold a motion of six parameters.
constexpr std::size_t kLeastPiece = 1000;
constexpr std::size_t kMostTrials = 32;
constexpr double kMostDifference = 0.5;  // of the excess of bone that lies in its place
constexpr int kRounds = 2;               // of registration with the bone that moved alike
/// Voxels of displacement beyond which another motion is sought, that of bone that lies most astray
/// first, as bone beside it that lies better would hide its motion.
constexpr std::array<double, 3> kAstray{1, 0.5, 0.25};

/// The excess of a scan over soft tissue, the mean over cubes of about `shrink` voxels.
Volume shrunk(const CtScan& scan, int shrink, const Progress& progress) {
  const VolumeGeometry& from = scan.volume.geometry;
  Volume out;
  Cell factor;
  Vector3d first;
  out.geometry = from;
  out.geometry.image = nullptr;
  for (int a = 0; a < 3; ++a) {
    int& size = out.geometry.size[static_cast<std::size_t>(a)];
    factor[a] =
        std::clamp(static_cast<int>(std::lround(shrink * from.voxelSize() / from.spacing[a])), 1,
                   std::max(1, size / 4));
    size /= factor[a];
    out.geometry.spacing[a] *= factor[a];
    first[a] = 0.5 * (factor[a] - 1);
  }
  out.geometry.origin = from.worldFromIndex(first);
  const CellBox cells = out.geometry.cells();
  std::vector<float> means(cells.count());
  tbb::parallel_for(std::size_t{0}, means.size(), [&](std::size_t i) {
    if (i % 4096 == 0) progress.check();
    const Cell low = cells.cell(i).cwiseProduct(factor);
    float sum = 0;
    CellBox{low, factor}.forEach([&](const Cell& cell) {
      sum += std::max(scan.value(from.index(cell)) - scan.levels.soft, 0.0F);
    });
    means[i] = sum / static_cast<float>(factor.prod());
  });
  out.voxels = std::move(means);
  return out;
}

/// Bone of a scan, with its rim.
std::unique_ptr<const VoxelSet> boneOf(const CtScan& scan) {
  const CellBox cells = scan.volume.geometry.cells();
  std::vector<bool> is(cells.count(), false);
  for (std::size_t i = 0; i < is.size(); ++i) {
    if (!(scan.value(i) > scan.levels.soft + CtLevels::kLeastContrast) ||
        !scan.volume.geometry.isImage(i))
      continue;
    const Cell reach = Cell::Constant(kRim), cell = cells.cell(i);
    CellBox::between(cell - reach, cell + reach).meet(cells).forEach([&](const Cell& other) {
      is[cells.index(other)] = true;
    });
  }
  std::vector<std::size_t> rim;
  for (std::size_t i = 0; i < is.size(); ++i)
    if (is[i]) rim.push_back(i);
  return std::make_unique<const VoxelSet>(scan.volume.geometry, std::move(rim));
}

class MotionSearch {
public:
  MotionSearch(const CtScan& native, const CtScan& contrast, const Progress& progress)
      : m_native(native), m_contrast(contrast), m_progress(progress) {
    m_bone.rim = boneOf(native);
    measureBone();
    m_blocks = std::make_unique<const BoneBlocks>(*m_bone.rim);
    m_slope = m_blocks->localMeans(
        [&](std::uint32_t i) {
          const auto slope = static_cast<double>(m_bone.slope[i]);
          return slope * slope;
        },
        progress);
    m_excess = m_blocks->localMeans(
        [&](std::uint32_t i) {
          return std::pow(
              std::max(static_cast<double>(native.value(m_bone.rim->index(i)) - native.levels.soft),
                       0.0),
              2);
        },
        progress);
    for (const int shrink : kShrink) {
      m_fixed.push_back(shrunk(native, shrink, progress));
      m_moving.push_back(shrunk(contrast, shrink, progress));
    }
  }

  MovedBone find() {
    m_piece.assign(m_blocks->size(), MovedBone::kOutside);
    m_square.assign(m_blocks->size(), std::numeric_limits<double>::infinity());
    if (m_bone.rim->size() == 0) return std::move(m_bone);
    std::vector<std::uint32_t> all(m_blocks->size());
    for (std::uint32_t b = 0; b < all.size(); ++b) all[b] = b;
    takeMotion(registered(all, {Isometry3d::Identity(), centresAligned()}));
    for (const double astray : kAstray) findOthers(astray * nativeVoxel());
    for (int round = 0; round < kRounds; ++round) refine();
    return result();
  }

private:
  /// Steepness and kind of each voxel.
  void measureBone() {
    const VoxelSet& rim = *m_bone.rim;
    const CellBox cells = rim.geometry().cells();
    m_bone.slope.resize(rim.size());
    m_bone.isBone.resize(rim.size());
    for (std::uint32_t i = 0; i < rim.size(); ++i) {
      const Cell cell = rim.cell(i);
      Vector3d gradient;
      for (int a = 0; a < 3; ++a) {
        const Cell step = Cell::Unit(a);
        const Cell low = (cell - step).cwiseMax(cells.low),
                   high = (cell + step).cwiseMin(cells.high());
        const double along = rim.geometry().spacing[a] * std::max(1, high[a] - low[a]);
        gradient[a] = static_cast<double>(m_native.value(cells.index(high)) -
                                          m_native.value(cells.index(low))) /
                      along;
      }
      m_bone.slope[i] = static_cast<float>(gradient.norm());
      m_bone.isBone[i] =
          m_native.value(rim.index(i)) > m_native.levels.soft + CtLevels::kLeastContrast;
    }
  }

  /// The shift that moves the centre of what is bright in one scan to that in the other.
  [[nodiscard]] Isometry3d centresAligned() const {
    const auto centre = [](const Volume& excess) {
      Vector3d sum = Vector3d::Zero();
      double weight = 0;
      const auto& values = std::get<std::vector<float>>(excess.voxels);
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (!(values[i] > CtLevels::kLeastContrast)) continue;
        sum += excess.geometry.position(excess.geometry.cell(i));
        ++weight;
      }
      return weight > 0 ? Vector3d(sum / weight) : Vector3d(Vector3d::Zero());
    };
    Isometry3d shift = Isometry3d::Identity();
    shift.translation() = centre(m_moving[1]) - centre(m_fixed[1]);
    return shift;
  }

  /// The mean square of what a motion leaves around each block. Contrast makes places brighter only,
  /// so that those that are darker count, twice.
  [[nodiscard]] std::vector<double> squares(const Isometry3d& motion) const {
    return m_blocks->localMeans(
        [&](std::uint32_t i) {
          return squareAt(m_bone.rim->index(i), motion * m_bone.rim->position(i));
        },
        m_progress);
  }
  /// The squared difference, doubled, of a voxel from a place in the other scan; NaN outside of that.
  [[nodiscard]] double squareAt(std::size_t voxel, const Vector3d& place) const {
    const float there = m_contrast.excessAt(m_contrast.volume.geometry.indexFromWorld(place)),
                here = std::max(m_native.value(voxel) - m_native.levels.soft, 0.0F);
    const double darker = std::min(static_cast<double>(there - here), 0.0);
    return std::isfinite(there) ? 2 * darker * darker : std::numeric_limits<double>::quiet_NaN();
  }

  /// The displacement that is left at a block, mm; not finite outside of the other scan.
  [[nodiscard]] double displacement(std::uint32_t block) const {
    return std::sqrt(beyondNoise(block) / m_slope[block]);
  }
  [[nodiscard]] double beyondNoise(std::uint32_t block) const {
    const double noise = std::pow(static_cast<double>(m_native.levels.noise), 2) +
                         std::pow(static_cast<double>(m_contrast.levels.noise), 2);
    return std::max(0.0, m_square[block] - noise);
  }
  /// Whether a block within the other scan lies farther from its place than `most` mm. Where the
  /// difference is half of the bone's own excess, it says no more of how far.
  [[nodiscard]] bool isAstray(std::uint32_t block, double most) const {
    return std::isfinite(m_square[block]) &&
           (displacement(block) > most ||
            beyondNoise(block) > kMostDifference * kMostDifference * m_excess[block]);
  }

  /// The same over places in this scan; infinite if most of them lie outside of the other scan.
  [[nodiscard]] double meanSquare(const std::vector<Vector3d>& points,
                                  const Isometry3d& motion) const {
    const VolumeGeometry& from = m_native.volume.geometry;
    double sum = 0;
    std::size_t known = 0;
    for (const Vector3d& point : points) {
      const double square = squareAt(
          from.index(VolumeGeometry::nearestCell(from.indexFromWorld(point))), motion * point);
      if (!std::isfinite(square)) continue;
      sum += square;
      ++known;
    }
    return 2 * known > points.size() ? sum / static_cast<double>(known)
                                     : std::numeric_limits<double>::infinity();
  }

  /// A motion of points after registration at levels from `first` up to `end`.
  [[nodiscard]] Isometry3d atLevels(std::size_t first, std::size_t end,
                                    const std::vector<Vector3d>& points, Isometry3d motion) const {
    for (std::size_t l = first; l < end; ++l)
      motion = registerRigid(m_fixed[l], m_moving[l], points, motion, m_progress);
    return motion;
  }

  /// The motion of blocks: from several starts at coarse levels, and from the best one at fine ones.
  [[nodiscard]] Isometry3d registered(const std::vector<std::uint32_t>& blocks,
                                      const std::vector<Isometry3d>& starts) const {
    const std::vector<Vector3d> points = m_blocks->points(blocks, kMostPoints);
    Isometry3d best = starts.front();
    double least = std::numeric_limits<double>::infinity();
    for (const Isometry3d& start : starts) {
      const Isometry3d motion = atLevels(0, kFine, points, start);
      const double left = meanSquare(points, motion);
      if (left >= least) continue;
      least = left;
      best = motion;
    }
    return atLevels(kFine, kShrink.size(), points, best);
  }

  /// The median over blocks; what lies outside of the other scan is worse than all.
  [[nodiscard]] static double medianOf(const std::vector<double>& values,
                                       const std::vector<std::uint32_t>& blocks) {
    std::vector<double> known;
    for (const std::uint32_t b : blocks)
      known.push_back(std::isfinite(values[b]) ? values[b]
                                               : std::numeric_limits<double>::infinity());
    return upperMedian(known);
  }

  /// Adds a motion with the squares that it leaves. Blocks belong to the motion that leaves least.
  void takeMotion(const Isometry3d& motion) { take(motion, squares(motion)); }
  void take(const Isometry3d& motion, const std::vector<double>& left) {
    const auto piece = static_cast<std::uint8_t>(m_bone.motions.size());
    m_bone.motions.push_back(motion);
    for (std::uint32_t b = 0; b < left.size(); ++b) {
      if (!(left[b] < m_square[b])) continue;
      m_square[b] = left[b];
      m_piece[b] = piece;
    }
  }

  [[nodiscard]] double nativeVoxel() const { return m_native.volume.geometry.voxelSize(); }

  /// Finds the motions of connected bone that lies more astray than `most` mm.
  void findOthers(double most) {
    m_isTried.resize(m_blocks->size(), false);
    for (std::size_t trial = 0; trial < kMostTrials; ++trial) {
      const std::vector<std::uint32_t> group = m_blocks->largestGroup(
          [&](std::uint32_t b) { return !m_isTried[b] && isAstray(b, most); });
      if (m_blocks->countVoxels(group) < kLeastPiece) return;
      for (const std::uint32_t b : group) m_isTried[b] = true;
      tryGroup(group);
    }
  }

  /// A group has a motion of its own if most of it lies better by that.
  void tryGroup(const std::vector<std::uint32_t>& group) {
    const Isometry3d motion =
        registered(group, {m_bone.motions[m_piece[group.front()]], Isometry3d::Identity()});
    const std::vector<double> left = squares(motion);
    if (medianOf(left, group) < 0.5 * medianOf(m_square, group)) take(motion, left);
  }

  /// Registers each motion again with the bone that it leads to within a voxel of its place.
  void refine() {
    const std::vector<Isometry3d> before = std::exchange(m_bone.motions, {});
    std::vector<std::vector<std::uint32_t>> own(before.size());
    for (std::uint32_t b = 0; b < m_piece.size(); ++b)
      if (m_piece[b] < before.size() && !isAstray(b, nativeVoxel())) own[m_piece[b]].push_back(b);
    m_square.assign(m_blocks->size(), std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < before.size(); ++k)
      takeMotion(own[k].empty() ? before[k]
                                : atLevels(kFine, kShrink.size(),
                                           m_blocks->points(own[k], kMostPoints), before[k]));
  }

  MovedBone result() {
    const VoxelSet& rim = *m_bone.rim;
    const double most =
        std::max(m_native.volume.geometry.voxelSize(), m_contrast.volume.geometry.voxelSize());
    for (std::uint32_t i = 0; i < rim.size(); ++i) {
      const std::uint32_t b = m_blocks->blockOf(i);
      m_bone.error.push_back(static_cast<float>(displacement(b)));
      m_bone.piece.push_back(isAstray(b, most) ? MovedBone::kUnmatched : m_piece[b]);
    }
    return std::move(m_bone);
  }

  const CtScan &m_native, &m_contrast;
  const Progress& m_progress;
  MovedBone m_bone;
  std::unique_ptr<const BoneBlocks> m_blocks;
  std::vector<Volume> m_fixed, m_moving;  ///< of the levels
  std::vector<double> m_slope;            ///< mean square around each block
  std::vector<double> m_excess;           ///< the same of the excess
  std::vector<double> m_square;           ///< that the best motion leaves around each block
  std::vector<std::uint8_t> m_piece;      ///< that motion
  std::vector<bool> m_isTried;            ///< for a motion of its own
};

}  // namespace

MovedBone findMotions(const CtScan& native, const CtScan& contrast, const Progress& progress) {
  return MotionSearch(native, contrast, progress).find();
}

}  // namespace lumen::convert
