// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/native/subtract_native.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numbers>
#include <type_traits>
#include <utility>
#include <variant>

#include <tbb/parallel_for.h>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/statistics.h"
#include "converters/stages/finding/ct_levels.h"
#include "converters/stages/native/bone_motions.h"
#include "converters/stages/native/register_rigid.h"
#include "converters/voxels/neighbourhood.h"

namespace lumen::convert {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr float kSoftRange = 50;        // Hounsfield units on either side of soft tissue
constexpr std::size_t kLeastGain = 27;  // voxels with contrast: a cube of three

CtLevels levelsOf(const Volume& volume, const std::string& name, const Progress& progress) {
  if (const auto levels = measureCtLevels(volume, progress)) return *levels;
  throw invalidInput(name +
                     ": its levels are not those of computed tomography, whose bone alone can be "
                     "taken away by a scan without contrast");
}

/// Whether each voxel is soft tissue of one level.
std::vector<std::uint8_t> softTissue(const CtScan& scan, const Progress& progress) {
  std::vector<std::uint8_t> is(scan.volume.geometry.voxelCount());
  forEachNeighbourhood(
      scan.volume, scan.levels.soft, progress, [&](std::size_t i, const Neighbourhood& around) {
        is[i] = scan.levels.isCalm(around) && std::abs(around.mean - scan.levels.soft) < kSoftRange;
      });
  return is;
}

/// Bone of the native scan in the place of each voxel with contrast.
class BoneInPlace {
public:
  BoneInPlace(const CtScan& contrast, const CtScan& native, const MovedBone& bone)
      : m_contrast(contrast),
        m_native(native),
        m_bone(bone),
        m_excess(contrast.volume.geometry.voxelCount()),
        m_doubt(m_excess.size()) {}

  void add(std::uint8_t piece, const Progress& progress) {
    const VolumeGeometry &to = m_contrast.volume.geometry, &from = m_native.volume.geometry;
    const Isometry3d back = m_bone.motions[piece].inverse();
    const CellBox box = boxOf(piece);
    tbb::parallel_for(box.low[2], box.low[2] + box.size[2], [&](int z) {
      progress.check();
      CellBox slice = box;
      slice.low[2] = z;
      slice.size[2] = 1;
      slice.forEach([&](const Cell& cell) {
        const Vector3d at = from.indexFromWorld(back * to.position(cell));
        const auto nearest = from.cells().nearest(at);
        if (!nearest) return;
        const std::uint32_t i = m_bone.rim->find(from.index(*nearest));
        if (i == VoxelSet::kNone || m_bone.piece[i] != piece) return;
        const float excess = m_native.excessAt(at);
        if (!std::isfinite(excess)) return;
        const std::size_t voxel = to.index(cell);
        m_excess[voxel] += excess;
        m_doubt[voxel] = std::max(m_doubt[voxel], m_bone.slope[i] * m_bone.error[i]);
      });
    });
  }

  /// The difference. Voxels that the displacement left may change by as much as contrast does
  /// become soft tissue; returns their number.
  std::size_t subtractFrom(Volume& volume) const {
    std::size_t doubtful = 0;
    std::visit(
        [&](auto& voxels) {
          using Value = typename std::decay_t<decltype(voxels)>::value_type;
          for (std::size_t i = 0; i < voxels.size(); ++i) {
            const bool isDoubtful = m_doubt[i] > CtLevels::kLeastContrast;
            doubtful += isDoubtful ? 1 : 0;
            float level = static_cast<float>(voxels[i]) - m_excess[i];
            if (isDoubtful) level = std::min(level, m_contrast.levels.soft);
            if constexpr (std::is_integral_v<Value>)
              level = std::clamp(std::round(level),
                                 static_cast<float>(std::numeric_limits<Value>::min()),
                                 static_cast<float>(std::numeric_limits<Value>::max()));
            if (m_excess[i] > 0 || isDoubtful) voxels[i] = static_cast<Value>(level);
          }
        },
        volume.voxels);
    return doubtful;
  }

private:
  /// The cells in which a piece may lie.
  [[nodiscard]] CellBox boxOf(std::uint8_t piece) const {
    const VolumeGeometry& to = m_contrast.volume.geometry;
    Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (std::uint32_t i = 0; i < m_bone.rim->size(); ++i) {
      if (m_bone.piece[i] != piece) continue;
      const Vector3d at = to.indexFromWorld(m_bone.motions[piece] * m_bone.rim->position(i));
      low = low.cwiseMin(at);
      high = high.cwiseMax(at);
    }
    if (!(low.array() <= high.array()).all()) return {};
    const Vector3d reach =
        Vector3d::Constant(m_native.volume.geometry.spacing.norm()).cwiseQuotient(to.spacing);
    return to.cellsAround(low - reach, high + reach);
  }

  const CtScan &m_contrast, &m_native;
  const MovedBone& m_bone;
  std::vector<float> m_excess, m_doubt;
};

/// Rotation, shift and residual of a motion, and the bone that it moved.
NativePiece describe(const MovedBone& bone, std::uint8_t piece, const CtScan& native,
                     const CtScan& contrast) {
  const Isometry3d& motion = bone.motions[piece];
  std::vector<float> left, difference;
  Vector3d middle = Vector3d::Zero();
  for (std::uint32_t i = 0; i < bone.rim->size(); ++i) {
    if (bone.piece[i] != piece || !bone.isBone[i]) continue;
    const Vector3d at = bone.rim->position(i);
    middle += at;
    left.push_back(bone.error[i]);
    const float there = contrast.excessAt(contrast.volume.geometry.indexFromWorld(motion * at));
    if (std::isfinite(there))
      difference.push_back(
          std::abs(there - (native.value(bone.rim->index(i)) - native.levels.soft)));
  }
  NativePiece out;
  if (left.empty()) return out;
  middle /= static_cast<double>(left.size());
  out.volume = static_cast<double>(left.size()) * native.volume.geometry.spacing.prod();
  out.shift = motion * middle - middle;
  out.rotation = Eigen::AngleAxisd(motion.linear()).angle() * 180 / std::numbers::pi;
  out.residual = static_cast<double>(upperMedian(left));
  out.difference =
      difference.empty() ? 0 : kDeviationOfMedian * static_cast<double>(upperMedian(difference));
  return out;
}

double volumeOf(const MovedBone& bone, std::uint8_t piece) {
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < bone.rim->size(); ++i)
    count += bone.piece[i] == piece && bone.isBone[i] ? 1 : 0;
  return static_cast<double>(count) * bone.rim->geometry().spacing.prod();
}

/// Refuses scans of which most bone does not match.
void requireMatch(const MovedBone& bone, const std::string& contrastName,
                  const std::string& nativeName) {
  const auto countOf = [&](std::uint8_t piece) {
    return std::count(bone.piece.begin(), bone.piece.end(), piece);
  };
  const std::ptrdiff_t inside = std::ssize(bone.piece) - countOf(MovedBone::kOutside);
  if (inside > 0 && 2 * countOf(MovedBone::kUnmatched) < inside) return;
  throw invalidInput(nativeName +
                     (inside == 0 ? ": it has no bone where " + contrastName + " lies"
                                  : ": less than half of its bone comes to lie within a voxel of "
                                    "that of " +
                                        contrastName) +
                     "; expected a scan of the same body without contrast");
}

/// Refuses scans unless the first has contrast where the other has none: soft tissue of one scan is
/// compared with what is left in its place.
void requireContrast(const CtScan& contrast, const std::string& contrastName, const CtScan& native,
                     const std::string& nativeName, const CtScan& left, const Isometry3d& motion,
                     const Progress& progress) {
  const VolumeGeometry &to = contrast.volume.geometry, &from = native.volume.geometry;
  const std::vector<std::uint8_t> softThere = softTissue(contrast, progress),
                                  softHere = softTissue(native, progress);
  const Isometry3d back = motion.inverse();
  std::size_t gained = 0, lost = 0;
  for (std::size_t i = 0; i < softThere.size(); ++i) {
    if (i % 65536 == 0) progress.check();
    const float change = left.value(i) - contrast.levels.soft;
    if (change < -CtLevels::kLeastContrast) {
      lost += softThere[i] != 0 ? 1 : 0;
    } else if (change > CtLevels::kLeastContrast) {
      const auto at = from.cells().nearest(from.indexFromWorld(back * to.position(to.cell(i))));
      gained += at && softHere[from.index(*at)] != 0 ? 1 : 0;
    }
  }
  if (gained < kLeastGain || gained < 2 * lost)
    throw invalidInput(nativeName + ": no blood has less contrast in it than in " + contrastName +
                       "; expected a scan without contrast beside one with it");
}

}  // namespace

NativeSubtraction subtractNative(const Volume& contrastVolume, const std::string& contrastName,
                                 const Volume& nativeVolume, const std::string& nativeName,
                                 Progress& progress) {
  if (!canRegister())
    throw unsupported(
        nativeName +
        ": this lumen was built without ITK (on Debian libinsighttoolkit5-dev), which "
        "registers scans without contrast");
  progress.begin("register", 0);
  const CtScan contrast(contrastVolume, levelsOf(contrastVolume, contrastName, progress)),
      native(nativeVolume, levelsOf(nativeVolume, nativeName, progress));
  const MovedBone bone = findMotions(native, contrast, progress);
  requireMatch(bone, contrastName, nativeName);
  NativeSubtraction out;
  NativeReport& report = out.report;
  report.name = nativeName;
  report.unmatched = volumeOf(bone, MovedBone::kUnmatched);
  report.outside = volumeOf(bone, MovedBone::kOutside);
  BoneInPlace inPlace(contrast, native, bone);
  for (std::uint8_t k = 0; k < bone.motions.size(); ++k) {
    const NativePiece piece = describe(bone, k, native, contrast);
    if (piece.volume == 0) continue;
    inPlace.add(k, progress);
    report.pieces.push_back(piece);
  }
  std::stable_sort(report.pieces.begin(), report.pieces.end(),
                   [](const NativePiece& a, const NativePiece& b) { return a.volume > b.volume; });
  out.volume = contrastVolume;
  report.doubtful = static_cast<double>(inPlace.subtractFrom(out.volume)) *
                    contrastVolume.geometry.spacing.prod();
  requireContrast(contrast, contrastName, native, nativeName, CtScan(out.volume, contrast.levels),
                  bone.motions.front(), progress);
  progress.end();
  return out;
}

}  // namespace lumen::convert
