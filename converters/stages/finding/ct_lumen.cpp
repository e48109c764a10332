// SPDX-License-Identifier: Apache-2.0
// Declared in bright_voxels.h.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <tbb/parallel_for.h>

#include "converters/stages/finding/bright_voxels.h"
#include "converters/stages/finding/ridge_marks.h"
#include "converters/voxels/neighbourhood.h"

namespace lumen::convert {
namespace {

/// Voxels from the last one whose neighbourhood is calm to the wall: half of a neighbourhood, and
/// blur.
constexpr int kRim = 2;
constexpr int kSurroundings = 4;   // voxels from a ridge to the tissue beside it
constexpr float kSoftRange = 50;   // Hounsfield units on either side of it
constexpr int kLeastReach = 10;    // voxels from end to end of a core
constexpr float kAboveTissue = 4;  // standard deviations of the noise
constexpr float kBloodStep = 20;   // Hounsfield units of a level of blood
constexpr int kBloodLevels = 200;
constexpr double kCrestShare = 0.95;  // of the voxels along the middle of thin vessels
/// Hounsfield units below soft tissue, as of air, that bone is made in place of bright.
constexpr float kMostBelowSoft = 1000;

/// Finds lumen in a volume of computed tomography.
class CtLumen {
public:
  CtLumen(const Volume& volume, const CtLevels& levels, const Prior& prior, BesideBone beside,
          const Progress& progress)
      : m_volume(volume),
        m_levels(levels),
        m_prior(prior),
        m_beside(beside),
        m_progress(progress),
        m_cells(volume.geometry.cells()),
        m_mark(m_cells.count()),
        m_isSoft(m_cells.count()),
        m_half(levels.soft + CtLevels::kLeastContrast) {}

  BrightVoxels find() {
    markCalm();
    keepLargeCores();
    measureBlood();
    growToWalls();
    if (m_blood)
      markThin(*m_blood + kAboveTissue * m_levels.noise);
    else
      markThinAlone();
    return collect();
  }

private:
  [[nodiscard]] float value(std::size_t i) const {
    return std::visit([i](const auto& voxels) { return static_cast<float>(voxels[i]); },
                      m_volume.voxels);
  }

  /// Whether a voxel is known to be no vessel, or is no image.
  [[nodiscard]] bool isNone(std::size_t i) const {
    return m_prior.isNoVessel(i) || !m_volume.geometry.isImage(i);
  }

  /// Calm voxels are lumen or soft tissue by their level; all others are neither so far.
  void markCalm() {
    forEachNeighbourhood(
        m_volume, m_levels.soft, m_progress, [&](std::size_t i, const Neighbourhood& around) {
          const bool isCalm = m_levels.isCalm(around);
          m_isSoft[i] = isCalm && std::abs(around.mean - m_levels.soft) < kSoftRange ? 1 : 0;
          const bool isLumen = isCalm && around.mean > m_half && !isNone(i);
          m_mark[i] = isLumen ? kLumen : m_isSoft[i] != 0 ? kBackground : kOtherTissue;
        });
  }

  /// Steps from end to end of connected voxels, along the axis on which there are most.
  [[nodiscard]] int reach(const std::vector<std::size_t>& part) const {
    Cell low = m_cells.cell(part[0]), high = low;
    for (const std::size_t i : part) {
      low = low.cwiseMin(m_cells.cell(i));
      high = high.cwiseMax(m_cells.cell(i));
    }
    return (high - low).maxCoeff();
  }

  /// Fewer connected voxels than a cube of three are calm by chance; short ones lie in marrow.
  void keepLargeCores() {
    std::vector<bool> isSeen(m_mark.size(), false);
    std::vector<std::size_t> part;
    for (std::size_t first = 0; first < m_mark.size(); ++first) {
      if (m_mark[first] != kLumen || isSeen[first]) continue;
      m_progress.check();
      part.assign(1, first);
      isSeen[first] = true;
      for (std::size_t k = 0; k < part.size(); ++k)
        m_cells.forEachNeighbour(m_cells.cell(part[k]), [&](const Cell& cell) {
          const std::size_t j = m_cells.index(cell);
          if (m_mark[j] != kLumen || isSeen[j]) return;
          isSeen[j] = true;
          part.push_back(j);
        });
      if (part.size() >= kSpeck && reach(part) >= kLeastReach) continue;
      for (const std::size_t i : part) m_mark[i] = kOtherTissue;
    }
  }

  /// The level of blood is the one above soft tissue that most voxels of cores have, those with
  /// more contrast counting more. Cores of less than half of its contrast are organs.
  void measureBlood() {
    std::vector<double> weight(static_cast<std::size_t>(kBloodLevels), 0.0);
    const auto levelOf = [&](std::size_t i) {
      return static_cast<std::size_t>(std::clamp((value(i) - m_levels.soft) / kBloodStep, 0.0F,
                                                 static_cast<float>(kBloodLevels - 1)));
    };
    for (std::size_t i = 0; i < m_mark.size(); ++i)
      if (m_mark[i] == kLumen) weight[levelOf(i)] += static_cast<double>(levelOf(i));
    std::vector<double> around = weight;
    for (std::size_t b = 1; b + 1 < weight.size(); ++b)
      around[b] = weight[b - 1] + weight[b] + weight[b + 1];
    const auto most = std::max_element(around.begin(), around.end());
    if (*most == 0) return;
    const auto level = static_cast<float>(most - around.begin()) + 0.5F;
    m_blood = m_levels.soft + level * kBloodStep;
    m_half = std::max(m_half, 0.5F * (m_levels.soft + *m_blood));
    for (std::size_t i = 0; i < m_mark.size(); ++i)
      if (m_mark[i] == kLumen && !(value(i) > m_half)) m_mark[i] = kOtherTissue;
  }

  /// Adds the voxels between calm lumen and its walls.
  void growToWalls() {
    std::vector<std::size_t> layer, next;
    const auto from = [&](std::size_t i) {
      m_cells.forEachNeighbour(m_cells.cell(i), [&](const Cell& cell) {
        const std::size_t j = m_cells.index(cell);
        if (m_mark[j] == kLumen || isNone(j) || !(value(j) > m_half)) return;
        m_mark[j] = kLumen;
        next.push_back(j);
      });
    };
    for (std::size_t i = 0; i < m_mark.size(); ++i)
      if (m_mark[i] == kLumen) layer.push_back(i);
    for (int step = 0; step < kRim; ++step, layer.swap(next), next.clear()) {
      m_progress.check();
      for (const std::size_t i : layer) from(i);
    }
  }

  /// Adds the voxels of known vessels that have the contrast of blood, even or not.
  void addKnown(float brightest) {
    const float bright = m_levels.soft + CtLevels::kLeastContrast;
    for (std::size_t i = 0; i < m_prior.systems.size(); ++i)
      if (m_prior.isLumen(i) && !isNone(i) && value(i) > bright && value(i) < boneAbove(brightest))
        m_mark[i] = kLumen;
  }

  /// The level that no place in a vessel has, even if it is blurred with bone beside it.
  [[nodiscard]] float boneAbove(float brightest) const { return 2 * brightest - m_levels.soft; }

  /// Adds thin vessels where no wide one shows the level of blood: those amid soft tissue show it,
  /// and then those that run on beside bone are found.
  void markThinAlone() {
    const std::vector<std::uint8_t> before(m_mark.data(), m_mark.data() + m_mark.size());
    markThin(m_levels.soft + CtLevels::kMostContrast);
    const std::optional<float> level = crestLevel();
    if (!level || m_beside == BesideBone::Refused || !m_prior.systems.empty()) return;
    std::copy(before.begin(), before.end(), m_mark.data());
    const float brightest = *level + kAboveTissue * m_levels.noise;
    m_rim = std::make_shared<const BoneRim>(m_volume, m_levels.soft, brightest);
    markThin(brightest);
  }

  /// Adds thin vessels, which are ridges of the volume in which all that is brighter than blood is
  /// as much darker.
  void markThin(float brightest) {
    m_folded = fold(brightest);
    addKnown(brightest);
    m_strength =
        std::make_shared<const ZeroedArray<float>>(ridgeStrength(*m_folded, 1, m_progress));
    markRidges(UsualRidges(m_cells, *m_strength, m_mark, m_progress), brightest);
    growIntoWeak(m_cells, m_mark, m_progress);
  }

  [[nodiscard]] std::shared_ptr<const Volume> fold(float brightest) const {
    auto out = std::make_shared<Volume>(m_volume);
    std::visit(
        [&](auto& voxels) {
          using Value = typename std::decay_t<decltype(voxels)>::value_type;
          tbb::parallel_for(std::size_t{0}, voxels.size(), [&](std::size_t i) {
            const float above = value(i) - brightest;
            if (!(above > 0) || m_mark[i] == kLumen) return;
            voxels[i] =
                static_cast<Value>(std::max(brightest - above, m_levels.soft - kMostBelowSoft));
          });
        },
        out->voxels);
    return out;
  }

  /// The level that few voxels along the middle of vessels exceed; empty if there are none.
  [[nodiscard]] std::optional<float> crestLevel() const {
    std::vector<float> crest;
    for (std::size_t i = 0; i < m_mark.size(); ++i) {
      if (m_mark[i] != kLumen) continue;
      bool isHighest = true;
      m_cells.forEachNeighbour(m_cells.cell(i), [&](const Cell& cell) {
        const std::size_t j = m_cells.index(cell);
        isHighest = isHighest && !(m_mark[j] == kLumen && value(j) > value(i));
      });
      if (isHighest) crest.push_back(value(i));
    }
    if (crest.empty()) return {};
    const auto at = crest.begin() + static_cast<std::ptrdiff_t>(
                                        kCrestShare * static_cast<double>(crest.size() - 1));
    std::nth_element(crest.begin(), at, crest.end());
    return *at;
  }

  /// Marks ridges: strong ones amid soft tissue are lumen, others may lead on from it.
  void markRidges(const UsualRidges& usual, float brightest) {
    const float noise = m_levels.soft + kAboveTissue * m_levels.noise,
                bright = m_levels.soft + CtLevels::kLeastContrast,
                most = std::max(m_levels.soft + CtLevels::kMostContrast, brightest);
    const ZeroedArray<float>& strength = *m_strength;
    tbb::parallel_for(0, m_cells.size[2], [&](int z) {
      m_progress.check();
      for (int y = 0; y < m_cells.size[1]; ++y)
        for (int x = 0; x < m_cells.size[0]; ++x) {
          const Cell cell(x, y, z);
          const std::size_t i = m_cells.index(cell);
          if (m_mark[i] == kLumen || isNone(i)) continue;
          if (!(strength[i] > kWeakRidge * usual.at(cell)) || !(value(i) > noise)) continue;
          const bool isStrong = value(i) > bright && strength[i] > kStrongRidge * usual.at(cell);
          const bool isKnown = m_prior.isLumen(i) && value(i) < boneAbove(brightest);
          if (isKnown || (isStrong && isAmidSoft(cell)))
            m_mark[i] = kLumen;
          else if (!isBeside(cell, most) || isBesideBone(cell, brightest))
            m_mark[i] = kWeak;
        }
    });
  }

  /// Whether soft tissue of one level lies on both sides of a voxel, in most directions. An edge of
  /// bone has it on one side.
  [[nodiscard]] bool isAmidSoft(const Cell& cell) const {
    const auto isSoft = [&](const Cell& other) {
      return m_cells.contains(other) && m_isSoft[m_cells.index(other)] != 0;
    };
    const CellBox around = CellBox::between(-Cell::Ones(), Cell::Ones());
    int both = 0, all = 0;
    around.forEach([&](const Cell& direction) {
      if (around.index(direction) <= around.count() / 2) return;  // once each
      const Cell away = kSurroundings * direction;
      ++all;
      both += isSoft(cell + away) && isSoft(cell - away) ? 1 : 0;
    });
    return 2 * both > all;
  }

  /// Whether a voxel, or one that touches it, is brighter than blood.
  [[nodiscard]] bool isBeside(const Cell& cell, float most) const {
    bool is = value(m_cells.index(cell)) > most;
    m_cells.forEachNeighbour(
        cell, [&](const Cell& other) { is = is || value(m_cells.index(other)) > most; });
    return is;
  }

  /// Whether a voxel beside bone is lumen where no vessel is wide: brighter than halfway to blood,
  /// not as bright as bone, and not on its rim.
  [[nodiscard]] bool isBesideBone(const Cell& cell, float brightest) const {
    const float level = value(m_cells.index(cell));
    return m_rim && level > 0.5F * (m_levels.soft + brightest) && level < boneAbove(brightest) &&
           !m_rim->isOn(cell);
  }

  BrightVoxels collect() {
    BrightVoxels out;
    out.noise = static_cast<double>(m_levels.noise);
    out.isBoneKnown = true;
    for (std::size_t i = 0; i < m_mark.size(); ++i) {
      if (m_mark[i] == kLumen)
        out.indices.push_back(i);
      else if (value(i) > m_half && m_volume.geometry.isImage(i))
        out.bone.push_back(i);
    }
    out.folded = m_folded;
    out.rim = m_rim;
    if (m_rim) out.strength = m_strength;
    out.contrast = static_cast<double>(2 * (m_half - m_levels.soft));
    return out;
  }

  const Volume& m_volume;
  const CtLevels& m_levels;
  const Prior& m_prior;
  BesideBone m_beside;
  const Progress& m_progress;
  CellBox m_cells;
  ZeroedArray<std::uint8_t> m_mark, m_isSoft;
  float m_half;  ///< least level of lumen
  std::optional<float> m_blood;
  std::shared_ptr<const Volume> m_folded;
  std::shared_ptr<const ZeroedArray<float>> m_strength;  ///< of the ridges of that
  std::shared_ptr<const BoneRim> m_rim;                  ///< null if wide vessels are known
};

}  // namespace

BrightVoxels findCtLumen(const Volume& volume, const CtLevels& levels, const Prior& prior,
                         BesideBone beside, const Progress& progress) {
  return CtLumen(volume, levels, prior, beside, progress).find();
}

}  // namespace lumen::convert
