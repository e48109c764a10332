// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/upright_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <tbb/parallel_for.h>

#include "converters/base/number_text.h"
#include "converters/base/shown_text.h"
#include "converters/voxels/label_voxels.h"

namespace lumen::convert {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Headers state directions with 6 to 17 digits; beyond this they are no rounding.
constexpr double kRounding = 1e-3;
constexpr double kNoMove = 0.5;      // voxels by which rounded axes may move the farthest voxel
constexpr double kMostLean = 0.707;  // least cosine of a lean: gantries tilt by 30 degrees at most
constexpr double kOnVoxel = 1e-3;    // voxels: headers round
constexpr double kMostVoxels = 1e9;  // along an axis

/// The edges of a voxel, as columns.
Matrix3d edgesOf(const VolumeGeometry& grid) {
  return grid.direction * grid.spacing.asDiagonal();
}

/// The corners of the voxels' centres, as indices.
std::array<Vector3d, 8> cornersOf(const VolumeGeometry& grid) {
  std::array<Vector3d, 8> corners;
  for (int c = 0; c < 8; ++c)
    for (int a = 0; a < 3; ++a)
      corners[static_cast<std::size_t>(c)][a] =
          (c >> a & 1) * (grid.size[static_cast<std::size_t>(a)] - 1);
  return corners;
}

bool isOrthogonal(const VolumeGeometry& grid) {
  const Matrix3d& d = grid.direction;
  const double fault = (d.transpose() * d - Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (fault > kRounding) return false;
  const Eigen::JacobiSVD<Matrix3d> svd(d, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Matrix3d moved =
      (svd.matrixU() * svd.matrixV().transpose() - d) * grid.spacing.asDiagonal();
  double most = 0;
  for (const Vector3d& corner : cornersOf(grid)) most = std::max(most, (moved * corner).norm());
  return most <= kNoMove * grid.spacing.minCoeff();
}

/// The two axes that are nearest to a right angle, and the third one.
std::array<int, 3> uprightOrder(const Matrix3d& d) {
  std::array<int, 3> best = {0, 1, 2};
  const auto lean = [&](const std::array<int, 3>& order) {
    return std::abs(d.col(order[0]).dot(d.col(order[1])));
  };
  for (const std::array<int, 3>& order : {std::array{0, 2, 1}, std::array{1, 2, 0}})
    if (lean(order) < lean(best) - kOnVoxel) best = order;
  return best;
}

/// Orthonormal axes: the first of the order stays, the second stays in their plane.
Matrix3d uprightAxes(const Matrix3d& d, const std::array<int, 3>& order) {
  Matrix3d axes;
  const Vector3d first = d.col(order[0]);
  const Vector3d second = (d.col(order[1]) - first * first.dot(d.col(order[1]))).normalized();
  const Vector3d normal = first.cross(second);
  axes.col(order[0]) = first;
  axes.col(order[1]) = second;
  axes.col(order[2]) = normal.dot(d.col(order[2])) < 0 ? Vector3d(-normal) : normal;
  return axes;
}

/// The four weights of Keys's cubic convolution at a fraction between two voxels.
std::array<double, 4> cubicWeights(double t) {
  return {((-0.5 * t + 1) * t - 0.5) * t, (1.5 * t - 2.5) * t * t + 1,
          ((-1.5 * t + 2) * t + 0.5) * t, (0.5 * t - 0.5) * t * t};
}

/// Voxels beside a place along one axis, with their weights.
struct Taps {
  std::array<int, 4> at{};
  std::array<double, 4> weight{};
};

Taps tapsAt(double place, int size) {
  const double near = std::round(place);
  if (std::abs(place - near) < kOnVoxel) place = near;
  const int below = std::min(static_cast<int>(std::floor(place)), size - 1);
  Taps taps;
  taps.weight = cubicWeights(place - below);
  for (int n = 0; n < 4; ++n)
    taps.at[static_cast<std::size_t>(n)] = std::clamp(below - 1 + n, 0, size - 1);
  return taps;
}

/// The value around labels, 0 or the only negative one, where the voxels are labels, as settleLabels()
/// takes them: within 0.001 of whole numbers. Empty for grey values.
std::optional<double> aroundLabels(const Voxels& all) {
  return std::visit(
      [](const auto& voxels) -> std::optional<double> {
        std::vector<float> labels;
        labels.reserve(voxels.size());
        double around = 0;
        bool hasZero = false;
        for (const auto voxel : voxels) {
          const auto value = static_cast<double>(voxel);
          const double whole = std::round(value);
          if (std::abs(value - whole) > kRounding || (whole < 0 && around < 0 && whole != around))
            return std::nullopt;
          if (whole < 0) around = whole;
          hasZero = hasZero || whole == 0;
          labels.push_back(static_cast<float>(std::max(whole, 0.0)));
        }
        if ((around < -1 && hasZero) || !holdsLabels(Voxels(std::move(labels))))
          return std::nullopt;
        return around;
      },
      all);
}

/// Samples of stored voxels at any place.
template <class T>
class Sampler {
public:
  Sampler(const std::vector<T>& voxels, const VolumeGeometry& stored,
          const std::optional<std::array<float, 2>>& padding)
      : m_voxels(voxels), m_cells(stored.cells()), m_padding(padding) {
    const auto [low, high] = std::minmax_element(voxels.begin(), voxels.end());
    m_low = static_cast<double>(*low);
    m_high = static_cast<double>(*high);
  }

  [[nodiscard]] double low() const { return m_low; }
  [[nodiscard]] bool isInside(const Vector3d& index) const {
    for (int a = 0; a < 3; ++a)
      if (!(index[a] >= -kOnVoxel && index[a] <= m_cells.size[a] - 1 + kOnVoxel)) return false;
    return true;
  }
  [[nodiscard]] T nearest(const Vector3d& index) const {
    const Cell cell = VolumeGeometry::nearestCell(index);
    return m_voxels[m_cells.index(cell.cwiseMax(0).cwiseMin(m_cells.high()))];
  }
  /// False where a voxel of the padding is among those that are interpolated.
  [[nodiscard]] bool cubic(const Vector3d& index, double& value) const {
    const Taps x = tapsAt(index[0], m_cells.size[0]), y = tapsAt(index[1], m_cells.size[1]),
               z = tapsAt(index[2], m_cells.size[2]);
    double sum = 0;
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t b = 0; b < 4; ++b) {
        const double across = z.weight[c] * y.weight[b];
        if (across == 0) continue;
        for (std::size_t a = 0; a < 4; ++a) {
          if (x.weight[a] == 0) continue;
          const T voxel = m_voxels[m_cells.index({x.at[a], y.at[b], z.at[c]})];
          if (isPadding(voxel)) return false;
          sum += across * x.weight[a] * static_cast<double>(voxel);
        }
      }
    value = std::clamp(sum, m_low, m_high);
    return true;
  }

private:
  [[nodiscard]] bool isPadding(T voxel) const {
    return m_padding && static_cast<float>(voxel) >= (*m_padding)[0] &&
           static_cast<float>(voxel) <= (*m_padding)[1];
  }

  const std::vector<T>& m_voxels;
  const CellBox m_cells;
  const std::optional<std::array<float, 2>>& m_padding;
  double m_low = 0, m_high = 0;
};

/// Fills `to` with value(index in the stored grid), slice by slice.
template <class T, class Value>
void fillFrom(const VolumeGeometry& stored, const VolumeGeometry& upright, std::vector<T>& to,
              const Progress& progress, const Value& value) {
  const CellBox cells = upright.cells();
  to.resize(cells.count());
  const Matrix3d toStored = edgesOf(stored).inverse();
  const Vector3d first = toStored * (upright.origin - stored.origin);
  const Matrix3d step = toStored * edgesOf(upright);
  tbb::parallel_for(0, cells.size[2], [&](int k) {
    progress.check();
    for (int j = 0; j < cells.size[1]; ++j)
      for (int i = 0; i < cells.size[0]; ++i)
        to[cells.index({i, j, k})] = value(Vector3d(first + step * Vector3d(i, j, k)));
  });
}

/// The voxels with the value `fill` beyond the stored ones.
template <class T, class From>
std::vector<T> interpolated(const Sampler<From>& sampler, const VolumeGeometry& stored,
                            const VolumeGeometry& upright, double fill, const Progress& progress) {
  std::vector<T> to;
  fillFrom(stored, upright, to, progress, [&](const Vector3d& index) {
    double value = 0;
    if (!sampler.isInside(index) || !sampler.cubic(index, value)) return static_cast<T>(fill);
    return static_cast<T>(std::is_integral_v<T> ? std::round(value) : value);
  });
  return to;
}

template <class T>
bool holds(double value, double most) {
  return value >= static_cast<double>(std::numeric_limits<T>::lowest()) &&
         most <= static_cast<double>(std::numeric_limits<T>::max());
}

/// The greatest float below a value that is a whole number where the value is one.
double valueBelow(double value) {
  const double one = std::floor(value) - 1;
  return static_cast<double>(static_cast<float>(one)) < value
             ? one
             : static_cast<double>(std::nextafter(static_cast<float>(value),
                                                  -std::numeric_limits<float>::infinity()));
}

template <class T>
void resampleGrey(const std::vector<T>& voxels, const VolumeGeometry& stored, Volume& volume,
                  const Progress& progress) {
  const std::optional<std::array<float, 2>> padding = volume.padding;
  const Sampler<T> sampler(voxels, stored, padding);
  const bool isStated =
      padding && holds<T>(static_cast<double>((*padding)[0]), static_cast<double>((*padding)[0]));
  const double fill = isStated ? static_cast<double>((*padding)[0]) : valueBelow(sampler.low());
  const double most = static_cast<double>(*std::max_element(voxels.begin(), voxels.end()));
  const auto into = [&]<class To>(To) {
    volume.voxels = interpolated<To>(sampler, stored, volume.geometry, fill, progress);
  };
  if (!isStated) volume.padding = {static_cast<float>(fill), static_cast<float>(fill)};
  if (std::is_same_v<T, float> || holds<T>(fill, most)) return into(T{});
  if (holds<std::int16_t>(fill, most)) return into(std::int16_t{});
  into(float{});
}

}  // namespace

std::optional<VolumeGeometry> standUpright(VolumeGeometry& geometry) {
  const Matrix3d& d = geometry.direction;
  const bool isSound = d.allFinite() && geometry.origin.allFinite() &&
                       (d.colwise().norm().array() - 1).abs().maxCoeff() <= kRounding &&
                       geometry.spacing.allFinite() && geometry.spacing.minCoeff() > 0;
  if (!isSound || isOrthogonal(geometry)) return std::nullopt;
  const std::array<int, 3> order = uprightOrder(d);
  const Matrix3d axes = uprightAxes(d, order);
  const Vector3d along = (axes.transpose() * d).diagonal();
  if (!axes.allFinite() || !(along.minCoeff() >= kMostLean)) return std::nullopt;
  const VolumeGeometry stored = geometry;
  const Vector3d spacing = along.cwiseProduct(stored.spacing);
  Vector3d low = Vector3d::Zero(), high = Vector3d::Zero();
  for (const Vector3d& corner : cornersOf(stored)) {
    const Vector3d at = (axes.transpose() * edgesOf(stored) * corner).cwiseQuotient(spacing);
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  if (!((high - low).maxCoeff() < kMostVoxels)) return std::nullopt;
  for (int a = 0; a < 3; ++a) {
    const double first = std::floor(low[a] + kOnVoxel), last = std::ceil(high[a] - kOnVoxel);
    geometry.size[static_cast<std::size_t>(a)] = static_cast<int>(last - first) + 1;
    geometry.origin += first * spacing[a] * axes.col(a);
  }
  geometry.direction = axes;
  geometry.spacing = spacing;
  return stored;
}

std::string uprightSentence(const VolumeGeometry& stored, const VolumeGeometry& upright) {
  const double least = (upright.direction.transpose() * stored.direction).diagonal().minCoeff();
  const double degrees = std::acos(std::min(least, 1.0)) * 180 / std::acos(-1.0);
  return "its axes lean by " + shownNumber(degrees, 3) +
         " degrees, as slices under a gantry tilt do; it is resampled to an upright grid of " +
         joinedNumbers(upright.size, " x ") + " voxels, " + spacingText(upright.spacing, 4) +
         " mm apart, and voxels of this grid beyond the file's are no image";
}

void resampleUpright(const VolumeGeometry& stored, Volume& volume, const Progress& progress) {
  const Voxels from = std::exchange(volume.voxels, {});
  const std::optional<double> around = aroundLabels(from);
  std::visit(
      [&]<class T>(const std::vector<T>& voxels) {
        if (!around) return resampleGrey(voxels, stored, volume, progress);
        const Sampler<T> sampler(voxels, stored, volume.padding);
        std::vector<T> to;
        fillFrom(stored, volume.geometry, to, progress, [&](const Vector3d& index) {
          return sampler.isInside(index) ? sampler.nearest(index) : static_cast<T>(*around);
        });
        volume.voxels = std::move(to);
      },
      from);
}

}  // namespace lumen::convert
