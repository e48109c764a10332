// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/packs/volume_pack.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <type_traits>
#include <variant>
#include <vector>

#include <tbb/parallel_for.h>

#include "viewer/session/packs/pack.h"

namespace lumen::viewer {

namespace {

// The first window of a page: shares of the voxels that are darker, from the middle of the
// background to the brightest vessels.
constexpr double kWindowLow = 0.5, kWindowHigh = 0.9995;
constexpr std::size_t kSampled = 1 << 20;  // voxels from which the window is chosen

template <class T>
std::pair<double, double> measureRange(const std::vector<T>& voxels) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const T value : voxels) {
    const auto v = static_cast<double>(value);
    if (!std::isfinite(v)) continue;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  return low <= high ? std::pair{low, high} : std::pair{0.0, 1.0};
}

}  // namespace

VolumePack::VolumePack(std::shared_ptr<const convert::Volume> volume, const std::string& name,
                       const VolumeSending& sending)
    : m_volume(std::move(volume)), m_isLabels(sending.isLabels) {
  choosePlace(sending);
  m_bytes = sending.eightBits || std::holds_alternative<std::vector<std::uint8_t>>(m_volume->voxels)
                ? 1
                : 2;
  chooseScale();
  const convert::VolumeGeometry& geometry = m_volume->geometry;
  Eigen::Vector3d first, spacing = geometry.spacing;
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    first[a] = m_low[axis] + (m_reduction[axis] - 1) / 2.0;
    spacing[a] *= m_reduction[axis];
  }
  const Eigen::Vector3d origin = geometry.worldFromIndex(first);
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> direction = geometry.direction;
  const auto window = greyRange();
  PackWriter pack;
  pack.set("size", m_size);
  pack.set("spacing_mm", engine::vectorJson(spacing));
  pack.set("origin", engine::vectorJson(origin));
  pack.set("direction", std::vector<double>(direction.data(), direction.data() + 9));
  pack.set("source_size", geometry.size);
  pack.set("reduction", m_reduction);
  pack.set("scale", m_scale);
  pack.set("offset", m_offset);
  pack.set("window", {window.first, window.second});
  pack.set("name", name);
  const auto along = [this](std::size_t a) { return static_cast<std::size_t>(m_size[a]); };
  m_before = pack.bytesBefore("voxel", m_bytes == 1 ? NumberType::U8 : NumberType::U16,
                              {along(2), along(1), along(0)});
}

void VolumePack::choosePlace(const VolumeSending& sending) {
  const convert::VolumeGeometry& geometry = m_volume->geometry;
  m_source = geometry.size;
  if (sending.cropped)
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<Eigen::Index>(a);
      m_low[a] = sending.crop.low[axis];
      m_source[a] = sending.crop.size[axis];
    }
  const auto count = [this] {
    std::size_t product = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      // the last voxels of an axis that do not fill a block are left out
      m_size[a] = std::max(1, m_source[a] / m_reduction[a]);
      product *= static_cast<std::size_t>(m_size[a]);
    }
    return product;
  };
  while ((m_voxels = count()) > std::max<std::size_t>(sending.mostVoxels, 1)) {
    std::size_t finest = 3;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < 3; ++a) {
      const double edge = geometry.spacing[static_cast<int>(a)] * m_reduction[a];
      if (m_size[a] > 1 && edge < least) {
        least = edge;
        finest = a;
      }
    }
    ++m_reduction[finest];
  }
}

void VolumePack::chooseScale() {
  const bool isByte = std::holds_alternative<std::vector<std::uint8_t>>(m_volume->voxels);
  if (isByte) return;
  if (m_bytes == 2 && std::holds_alternative<std::vector<std::uint16_t>>(m_volume->voxels)) return;
  if (m_bytes == 2 && std::holds_alternative<std::vector<std::int16_t>>(m_volume->voxels)) {
    m_offset = std::numeric_limits<std::int16_t>::min();
    return;
  }
  const auto [low, high] =
      std::visit([](const auto& v) { return measureRange(v); }, m_volume->voxels);
  m_offset = low;
  if (high > low) m_scale = (high - low) / (m_bytes == 1 ? 255 : 65535);
}

std::pair<double, double> VolumePack::greyRange() const {
  return std::visit(
      [](const auto& voxels) -> std::pair<double, double> {
        std::vector<double> sample;
        const std::size_t step = std::max<std::size_t>(1, voxels.size() / kSampled);
        for (std::size_t i = 0; i < voxels.size(); i += step)
          if (const auto v = static_cast<double>(voxels[i]); std::isfinite(v)) sample.push_back(v);
        if (sample.empty()) return {0, 1};
        const auto at = [&sample](double share) {
          const auto place = sample.begin() + static_cast<std::ptrdiff_t>(
                                                  share * static_cast<double>(sample.size() - 1));
          std::nth_element(sample.begin(), place, sample.end());
          return *place;
        };
        const double low = at(kWindowLow), high = at(kWindowHigh);
        if (high > low) return {low, high};
        const auto [least, most] = std::minmax_element(sample.begin(), sample.end());
        return *most > *least ? std::pair{*least, *most} : std::pair{*least, *least + 1};
      },
      m_volume->voxels);
}

std::string VolumePack::slices(int first, int count) const {
  const auto row = static_cast<std::size_t>(m_size[0]),
             plane = row * static_cast<std::size_t>(m_size[1]);
  std::string text(plane * static_cast<std::size_t>(count) * m_bytes, '\0');
  const auto& full = m_volume->geometry.size;
  const double blocks = double{1} * m_reduction[0] * m_reduction[1] * m_reduction[2];
  const double most = m_bytes == 1 ? 255 : 65535;
  std::visit(
      [&](const auto& voxels) {
        const auto at = [&](int i, int j, int k) {
          const auto n = [](int v) { return static_cast<std::size_t>(v); };
          return voxels.data() + (n(k) * n(full[1]) + n(j)) * n(full[0]) + n(i);
        };
        using T = typename std::decay_t<decltype(voxels)>::value_type;
        const bool asTheyAre = sizeof(T) == m_bytes && !std::is_same_v<T, std::int16_t> &&
                               m_scale == 1 && m_offset == 0 && blocks == 1;
        tbb::parallel_for(0, count * m_size[1], [&](int line) {
          const int j = line % m_size[1], k = first + line / m_size[1];
          char* const out = text.data() + static_cast<std::size_t>(line) * row * m_bytes;
          const auto from = [&](int a, int i) {
            const auto axis = static_cast<std::size_t>(a);
            return m_low[axis] + i * m_reduction[axis];
          };
          if (asTheyAre) {
            std::memcpy(out, at(from(0, 0), from(1, j), from(2, k)), row * m_bytes);
            return;
          }
          if (m_isLabels) {
            const auto middle = [&](int a, int i) {
              return from(a, i) + m_reduction[static_cast<std::size_t>(a)] / 2;
            };
            for (int i = 0; i < m_size[0]; ++i)
              out[i] = static_cast<char>(*at(middle(0, i), middle(1, j), middle(2, k)));
            return;
          }
          for (int i = 0; i < m_size[0]; ++i) {
            double sum = 0;
            for (int c = 0; c < m_reduction[2]; ++c)
              for (int b = 0; b < m_reduction[1]; ++b) {
                const T* v = at(from(0, i), from(1, j) + b, from(2, k) + c);
                for (int a = 0; a < m_reduction[0]; ++a) sum += static_cast<double>(v[a]);
              }
            double stored = std::round((sum / blocks - m_offset) / m_scale);
            if (!(stored > 0)) stored = 0;  // not a number, too
            const auto value = static_cast<std::uint16_t>(std::min(stored, most));
            if (m_bytes == 1)
              out[i] = static_cast<char>(static_cast<unsigned char>(value));
            else
              std::memcpy(out + 2 * i, &value, 2);
          }
        });
      },
      m_volume->voxels);
  return text;
}

std::string VolumePack::bytes(std::size_t offset, std::size_t length) const {
  if (offset >= size()) return {};
  if (offset < m_before.size()) return m_before.substr(offset, length);
  const std::size_t plane =
      static_cast<std::size_t>(m_size[0]) * static_cast<std::size_t>(m_size[1]) * m_bytes;
  const std::size_t inside = offset - m_before.size();
  const std::size_t end =
      std::min(inside + std::max<std::size_t>(length, 1), size() - m_before.size());
  const std::size_t first = inside / plane, last = (end - 1) / plane;
  const std::string made = slices(static_cast<int>(first), static_cast<int>(last - first + 1));
  return made.substr(inside - first * plane, end - inside);
}

}  // namespace lumen::viewer
