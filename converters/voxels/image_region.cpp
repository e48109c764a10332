// SPDX-License-Identifier: Apache-2.0
#include "converters/voxels/image_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <variant>

#include "converters/base/shown_text.h"
#include "converters/base/statistics.h"

namespace lumen::convert {
namespace {

/// Voxels in a row on either side of a border that are looked at: a vessel of fewer has no inside.
constexpr std::size_t kRun = 4;
/// The least number of such rows, so that medians over them are known to some percent.
constexpr std::size_t kLeastRows = 100;
/// Share of its greatest distance from the fill's value that the image has beside the fill. A cut
/// knows nothing of the image, which is as far from that value beside the cut as anywhere. The wall
/// of a vessel, an organ or a body fades: its first voxel has half of the distance in the mean.
constexpr float kSharp = 0.8F;
/// The least thickness of the image, voxels for each face of a voxel on its border: .39 radii of a
/// tube, .22 of a ball. Vessels around which all else has one value are thinner.
constexpr double kImageThickness = 4;
/// The same for the fill: equal voxels that noise makes have .3 or less.
constexpr double kFillThickness = 1;
constexpr std::size_t kVoxelsAtOnce = 1 << 16;  // between two polls of cancellation

/// Intensities beside the border of a fill.
class BorderLevels {
public:
  void add(const std::array<float, kRun>& image, float fill) {
    for (std::size_t k = 0; k < kRun; ++k) m_distance[k].push_back(std::abs(image[k] - fill));
    m_change.push_back(std::abs(image[1] - image[0]));
  }
  /// Whether the image is noisy, and does not fade into the fill.
  [[nodiscard]] bool isCut() {
    if (m_change.size() < kLeastRows || upperMedian(m_change) == 0) return false;
    std::array<float, kRun> level{};
    for (std::size_t k = 0; k < kRun; ++k) level[k] = upperMedian(m_distance[k]);
    return level[0] >= kSharp * *std::max_element(level.begin(), level.end());
  }

private:
  std::array<std::vector<float>, kRun> m_distance;  ///< from the fill, by depth in the image
  std::vector<float> m_change;  ///< from the first voxel of the image to the second
};

/// Finds the voxels that are no image, and continues the image over them.
template <class T>
class ImageLimits {
public:
  ImageLimits(const std::vector<T>& voxels, const CellBox& cells, const Progress& progress)
      : m_voxels(voxels), m_cells(cells), m_progress(progress), m_isImage(voxels.size(), true) {}

  /// Takes the voxels of a fill away from the image, if there is evidence of one. Returns their
  /// number.
  std::size_t takeAway(T fill) {
    if (!isCut(fill)) return 0;
    const std::vector<std::size_t> found = connectedToFaces(fill);
    std::size_t faces = 0;
    for (const std::size_t i : found)
      eachBeside(i, [&](std::size_t j) { faces += m_isImage[j] ? 1 : 0; });
    const auto fillSize = static_cast<double>(found.size()),
               all = static_cast<double>(m_voxels.size()), border = static_cast<double>(faces);
    if (faces > 0 && fillSize >= kFillThickness * border &&
        all - fillSize >= kImageThickness * border)
      return found.size();
    for (const std::size_t i : found) m_isImage[i] = true;
    return 0;
  }

  [[nodiscard]] std::vector<bool> isImage() const { return m_isImage; }

  /// The voxels with the image continued: voxel by voxel outward from its border, each is the mean
  /// of its neighbours that are nearer to it.
  [[nodiscard]] std::vector<T> continued() const {
    std::vector<T> out = m_voxels;
    std::vector<bool> isKnown = m_isImage, isDue(m_voxels.size(), false);
    std::vector<std::size_t> layer, next;
    const auto queue = [&](std::size_t i, std::vector<std::size_t>& into) {
      m_cells.forEachNeighbour(m_cells.cell(i), [&](const Cell& cell) {
        const std::size_t j = m_cells.index(cell);
        if (isKnown[j] || isDue[j]) return;
        isDue[j] = true;
        into.push_back(j);
      });
    };
    for (std::size_t i = 0; i < isKnown.size(); ++i)
      if (m_isImage[i] && isAtBorder(i)) queue(i, layer);
    for (; !layer.empty(); layer.swap(next), next.clear()) {
      m_progress.check();
      for (const std::size_t i : layer) out[i] = meanAround(i, out, isKnown);
      for (const std::size_t i : layer) isKnown[i] = true;
      for (const std::size_t i : layer) queue(i, next);
    }
    return out;
  }

private:
  template <class Visit>
  void eachBeside(std::size_t i, const Visit& visit) const {
    const Cell cell = m_cells.cell(i);
    for (const Cell& step : kFaceSteps)
      if (m_cells.contains(cell + step)) visit(m_cells.index(cell + step));
  }

  [[nodiscard]] bool isAtBorder(std::size_t i) const {
    bool isBeside = false;
    eachBeside(i, [&](std::size_t j) { isBeside = isBeside || !m_isImage[j]; });
    return isBeside;
  }

  /// Whether the image is cut where it borders on a fill, along all axes.
  [[nodiscard]] bool isCut(T fill) const {
    BorderLevels levels;
    for (int axis = 0; axis < 3; ++axis) {
      m_progress.check();
      const auto stride = static_cast<std::ptrdiff_t>(m_cells.stride(axis));
      const auto length = static_cast<std::size_t>(m_cells.size[axis]);
      for (std::size_t i = 0; i + static_cast<std::size_t>(stride) < m_voxels.size(); ++i) {
        const bool isHere = m_voxels[i] == fill;
        if (isHere == (m_voxels[i + static_cast<std::size_t>(stride)] == fill)) continue;
        const std::size_t at = i / static_cast<std::size_t>(stride) % length;
        if (at + 1 < kRun || at + kRun >= length) continue;
        addRow(fill, isHere ? i : i + static_cast<std::size_t>(stride), isHere ? stride : -stride,
               levels);
      }
    }
    return levels.isCut();
  }

  /// Adds the row of voxels across a border: `last` is the last one of the fill.
  void addRow(T fill, std::size_t last, std::ptrdiff_t step, BorderLevels& levels) const {
    const auto at = [&](std::ptrdiff_t k) {
      return m_voxels[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(last) + k * step)];
    };
    std::array<float, kRun> image{};
    for (std::size_t k = 0; k < kRun; ++k) {
      const auto steps = static_cast<std::ptrdiff_t>(k);
      if (at(-steps) != fill || at(steps + 1) == fill) return;
      image[k] = static_cast<float>(at(steps + 1));
    }
    levels.add(image, static_cast<float>(fill));
  }

  /// Takes the voxels of a fill that reach a face away from the image, and returns them.
  std::vector<std::size_t> connectedToFaces(T fill) {
    std::vector<std::size_t> found;
    const auto take = [&](std::size_t i) {
      if (!m_isImage[i] || m_voxels[i] != fill) return;
      m_isImage[i] = false;
      found.push_back(i);
    };
    m_cells.forEach([&](const Cell& cell) {
      if ((cell.array() == 0).any() || (cell.array() == m_cells.high().array()).any())
        take(m_cells.index(cell));
    });
    for (std::size_t k = 0; k < found.size(); ++k) {
      if (k % kVoxelsAtOnce == 0) m_progress.check();
      eachBeside(found[k], take);
    }
    return found;
  }

  [[nodiscard]] T meanAround(std::size_t i, const std::vector<T>& values,
                             const std::vector<bool>& isKnown) const {
    double sum = 0, count = 0;
    m_cells.forEachNeighbour(m_cells.cell(i), [&](const Cell& cell) {
      const std::size_t j = m_cells.index(cell);
      if (!isKnown[j]) return;
      sum += static_cast<double>(values[j]);
      ++count;
    });
    return static_cast<T>(std::is_integral_v<T> ? std::round(sum / count) : sum / count);
  }

  const std::vector<T>& m_voxels;
  const CellBox m_cells;
  const Progress& m_progress;
  std::vector<bool> m_isImage;
};

/// The values of the corners from which a row of equal voxels leads along each axis.
template <class T>
std::vector<T> cornerValues(const std::vector<T>& voxels, const CellBox& cells) {
  std::vector<T> values;
  for (int corner = 0; corner < 8; ++corner) {
    const Cell side(corner % 2, corner / 2 % 2, corner / 4);
    const Cell at = cells.high().cwiseProduct(side), inward = Cell::Ones() - 2 * side;
    const T value = voxels[cells.index(at)];
    bool isFilled = std::find(values.begin(), values.end(), value) == values.end();
    for (int axis = 0; axis < 3; ++axis)
      for (int k = 1; isFilled && k < static_cast<int>(kRun); ++k) {
        const Cell next = at + k * inward[axis] * Cell::Unit(axis);
        isFilled = cells.contains(next) && voxels[cells.index(next)] == value;
      }
    if (isFilled) values.push_back(value);
  }
  return values;
}

}  // namespace

bool ImageRegion::isBeside(const CellBox& cells, const Cell& cell) const {
  return std::any_of(kFaceSteps.begin(), kFaceSteps.end(), [&](const Cell& step) {
    return cells.contains(cell + step) && !holds(cells.index(cell + step));
  });
}

ImageRegion findImage(const Volume& volume, const Progress& progress) {
  ImageRegion out;
  std::visit(
      [&]<class T>(const std::vector<T>& voxels) {
        const CellBox cells = volume.geometry.cells();
        ImageLimits<T> limits(voxels, cells, progress);
        for (const T fill : cornerValues(voxels, cells))
          if (const std::size_t count = limits.takeAway(fill); count > 0)
            out.sentences.push_back(std::to_string(count) + " voxels of " +
                                    shownNumber(static_cast<double>(fill)) + " are no image");
        if (out.sentences.empty()) return;
        out.isImage = limits.isImage();
        out.continued = Volume{volume.geometry, limits.continued(), volume.assumptions};
      },
      volume.voxels);
  return out;
}

}  // namespace lumen::convert
