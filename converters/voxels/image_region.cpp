// SPDX-License-Identifier: Apache-2.0
#include "converters/voxels/image_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <variant>
#include <vector>

#include "converters/base/statistics.h"

namespace lumen::convert {
namespace {

/// Layers of voxels of the image beside a fill that are looked at: a vessel of fewer has no inside.
constexpr std::size_t kLayers = 4;
/// Share of the greatest distance from a fill's value that a layer of the image has. A cut knows
/// nothing of the image, so a layer of less is blurred by the fill: linear interpolation leaves half
/// of the distance in the mean.
constexpr float kSharp = 0.8F;
/// The least thickness of the image, voxels for each face of a voxel on its border: .39 radii of a
/// tube, .22 of a ball. Vessels around which all else has one value are thinner.
constexpr double kImageThickness = 4;
/// The same for the fill: equal voxels that noise makes have .3 or less.
constexpr double kFillThickness = 1;
/// The least share of a volume that is image: vessels may fill less.
constexpr double kLeastImage = 0.1;
constexpr std::size_t kVoxelsAtOnce = 1 << 16;  // between two polls of cancellation

/// Values that may fill what is no image.
struct Fill {
  float low = 0, high = 0;
  bool isStated = false;  ///< by the file, so that no evidence is needed

  template <class T>
  [[nodiscard]] bool holds(T value) const {
    return static_cast<float>(value) >= low && static_cast<float>(value) <= high;
  }
};

using Voxel = std::size_t;

/// Finds the voxels that are no image, and continues the image over them.
template <class T>
class ImageFinder {
public:
  ImageFinder(const std::vector<T>& voxels, const CellBox& cells, const Progress& progress)
      : m_voxels(voxels), m_cells(cells), m_progress(progress), m_isImage(voxels.size(), true) {}

  /// Takes the voxels of a fill away from the image, if there is evidence of one.
  bool takeAway(const Fill& fill) {
    std::vector<Voxel> taken;
    double faces = 0;  // of voxels, between the fill and the image
    // what another fill took is no image that this one leaves
    const auto all = static_cast<double>(std::count(m_isImage.begin(), m_isImage.end(), true));
    const auto leavesImage = [&] {
      const double rest = all - static_cast<double>(taken.size());
      return fill.isStated || rest >= std::max(kImageThickness * faces, kLeastImage * all);
    };
    const auto isTaken = [&](Voxel i) {
      if (!m_isImage[i]) return true;
      if (!fill.holds(m_voxels[i])) return false;
      m_isImage[i] = false;
      taken.push_back(i);
      return true;
    };
    eachAtFaces(isTaken);
    for (std::size_t k = 0; k < taken.size() && leavesImage(); ++k) {
      if (k % kVoxelsAtOnce == 0) m_progress.check();
      eachBeside(taken[k], [&](Voxel j) { faces += isTaken(j) ? 0 : 1; });
    }
    if (faces > 0 && static_cast<double>(taken.size()) >= kFillThickness * faces && leavesImage() &&
        (fill.isStated || takeBlurred(fill.low, taken)))
      return true;
    for (const Voxel i : taken) m_isImage[i] = true;
    return false;
  }

  [[nodiscard]] const std::vector<bool>& isImage() const { return m_isImage; }

  /// The voxels with the image continued: voxel by voxel outward from its border, each is the mean
  /// of its neighbours that are nearer to it.
  [[nodiscard]] std::vector<T> continued() const {
    std::vector<T> out = m_voxels;
    std::vector<bool> isKnown = m_isImage, isSeen = m_isImage;
    std::vector<Voxel> layer;
    for (Voxel i = 0; i < m_isImage.size(); ++i)
      if (m_isImage[i] && isAtBorder(i)) layer.push_back(i);
    for (layer = around(layer, isSeen); !layer.empty(); layer = around(layer, isSeen)) {
      for (const Voxel i : layer) out[i] = meanAround(i, out, isKnown);
      for (const Voxel i : layer) isKnown[i] = true;
    }
    return out;
  }

private:
  template <class Visit>
  void eachBeside(Voxel i, const Visit& visit) const {
    const Cell cell = m_cells.cell(i);
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t stride = m_strides[static_cast<std::size_t>(axis)];
      if (cell[axis] > 0) visit(i - stride);
      if (cell[axis] + 1 < m_cells.size[axis]) visit(i + stride);
    }
  }

  [[nodiscard]] bool isAtBorder(Voxel i) const {
    bool isBeside = false;
    eachBeside(i, [&](Voxel j) { isBeside = isBeside || !m_isImage[j]; });
    return isBeside;
  }

  /// The voxels around these that are not seen yet, which then are.
  std::vector<Voxel> around(const std::vector<Voxel>& voxels, std::vector<bool>& isSeen) const {
    m_progress.check();
    std::vector<Voxel> out;
    for (const Voxel i : voxels)
      m_cells.forEachNeighbour(m_cells.cell(i), [&](const Cell& cell) {
        const Voxel j = m_cells.index(cell);
        if (isSeen[j]) return;
        isSeen[j] = true;
        out.push_back(j);
      });
    return out;
  }

  /// Calls visit(voxel) for those in the faces of the volume.
  template <class Visit>
  void eachAtFaces(const Visit& visit) const {
    for (int axis = 0; axis < 3; ++axis)
      for (const int end : {0, m_cells.high()[axis]}) {
        CellBox face = m_cells;
        face.low[axis] = end;
        face.size[axis] = 1;
        face.forEach([&](const Cell& cell) { visit(m_cells.index(cell)); });
      }
  }

  /// Takes the layers of the image beside a fill away that are blurred by it. False if the first one
  /// that is not has no noise, so that it is no image.
  bool takeBlurred(float fill, const std::vector<Voxel>& filled) {
    std::vector<bool> isSeen(m_isImage);
    isSeen.flip();
    std::array<std::vector<Voxel>, kLayers> layers;
    std::array<float, kLayers> level{}, noise{};
    for (std::size_t k = 0; k < kLayers; ++k) {
      layers[k] = around(k == 0 ? filled : layers[k - 1], isSeen);
      std::vector<float> distance;
      for (const Voxel i : layers[k])
        distance.push_back(std::abs(static_cast<float>(m_voxels[i]) - fill));
      if (distance.empty()) break;
      level[k] = upperMedian(distance);
      for (float& value : distance) value = std::abs(value - level[k]);
      noise[k] = upperMedian(distance);
    }
    const float whole = kSharp * *std::max_element(level.begin(), level.end());
    std::size_t sharp = 0;
    while (level[sharp] < whole) ++sharp;
    for (std::size_t k = 0; k < sharp && noise[sharp] > 0; ++k)
      for (const Voxel i : layers[k]) m_isImage[i] = false;
    return noise[sharp] > 0;
  }

  [[nodiscard]] T meanAround(Voxel i, const std::vector<T>& values,
                             const std::vector<bool>& isKnown) const {
    double sum = 0, count = 0;
    m_cells.forEachNeighbour(m_cells.cell(i), [&](const Cell& cell) {
      const Voxel j = m_cells.index(cell);
      if (!isKnown[j]) return;
      sum += static_cast<double>(values[j]);
      ++count;
    });
    return static_cast<T>(std::is_integral_v<T> ? std::round(sum / count) : sum / count);
  }

  const std::vector<T>& m_voxels;
  const CellBox m_cells;
  const std::array<std::size_t, 3> m_strides = {m_cells.stride(0), m_cells.stride(1),
                                                m_cells.stride(2)};
  const Progress& m_progress;
  std::vector<bool> m_isImage;
};

/// The padding that a file states, and the value of each corner.
template <class T>
std::vector<Fill> possibleFills(const std::vector<T>& voxels, const Volume& volume) {
  std::vector<Fill> fills;
  if (volume.padding) fills.push_back({(*volume.padding)[0], (*volume.padding)[1], true});
  const CellBox cells = volume.geometry.cells();
  for (int corner = 0; corner < 8; ++corner) {
    const Cell side(corner % 2, corner / 2 % 2, corner / 4);
    const T value = voxels[cells.index(cells.high().cwiseProduct(side))];
    const bool isNew = std::none_of(fills.begin(), fills.end(),
                                    [&](const Fill& fill) { return fill.holds(value); });
    if (isNew) fills.push_back({static_cast<float>(value), static_cast<float>(value), false});
  }
  return fills;
}

}  // namespace

std::shared_ptr<const Volume> continueImage(const Volume& volume, const Progress& progress) {
  if (volume.geometry.image) return nullptr;
  std::shared_ptr<Volume> out;
  std::visit(
      [&]<class T>(const std::vector<T>& voxels) {
        ImageFinder<T> finder(voxels, volume.geometry.cells(), progress);
        bool isAll = true;
        for (const Fill& fill : possibleFills(voxels, volume))
          if (finder.takeAway(fill)) isAll = false;
        if (isAll) return;
        out = std::make_shared<Volume>(
            Volume{volume.geometry, finder.continued(), volume.assumptions});
        out->geometry.image = std::make_shared<const std::vector<bool>>(finder.isImage());
      },
      volume.voxels);
  return out;
}

}  // namespace lumen::convert
