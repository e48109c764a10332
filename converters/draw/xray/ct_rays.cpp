// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/xray/ct_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <variant>
#include <vector>

namespace lumen::convert {

namespace {

using Eigen::Vector3d;

constexpr double kStepVoxels = 0.5;    // of the least spacing
constexpr double kBoneDensity = 1.92;  // g/cm^3, ICRU's cortical bone
constexpr double kScanEnergy = 70;     // keV: mean energy of computed tomography at 120 kV
constexpr double kMmPerCm = 10;

/// Hounsfield units of cortical bone at the scan's energy.
double boneUnits() {
  const double bone = massAttenuation(Material::Bone, kScanEnergy) * kBoneDensity;
  return 1000 * (bone / massAttenuation(Material::Water, kScanEnergy) - 1);
}

/// The stretch of a ray, in mm, between the outermost centres of a volume.
Chord within(const VolumeGeometry& geometry, const Vector3d& from, const Vector3d& step,
             double length) {
  Chord chord{0, length};
  for (Eigen::Index a = 0; a < 3; ++a) {
    const double high = geometry.size[static_cast<std::size_t>(a)] - 1;
    if (step[a] == 0) {
      if (from[a] < 0 || from[a] > high) return {0, 0};
      continue;
    }
    const double one = -from[a] / step[a], two = (high - from[a]) / step[a];
    chord.from = std::max(chord.from, std::min(one, two));
    chord.to = std::min(chord.to, std::max(one, two));
  }
  return chord.from < chord.to ? chord : Chord{0, 0};
}

/// Trilinear values in a volume's interior, by strides.
template <class Pixel>
class Values {
public:
  Values(const VolumeGeometry& geometry, const std::vector<Pixel>& voxels)
      : m_voxels(voxels.data()) {
    std::size_t stride = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      m_last[a] = std::max(geometry.size[a] - 2, 0);
      m_stride[a] = geometry.size[a] > 1 ? stride : 0;
      stride *= static_cast<std::size_t>(geometry.size[a]);
    }
  }

  [[nodiscard]] double at(const Vector3d& p) const {
    std::size_t base = 0;
    std::array<double, 3> share{};
    for (std::size_t a = 0; a < 3; ++a) {
      const double place = p[static_cast<Eigen::Index>(a)];
      const int below = std::clamp(static_cast<int>(place), 0, m_last[a]);
      share[a] = place - below;
      base += static_cast<std::size_t>(below) * m_stride[a];
    }
    const Pixel* v = m_voxels + base;
    const auto edge = [&](std::size_t at) {
      const auto a = static_cast<double>(v[at]), b = static_cast<double>(v[at + m_stride[0]]);
      return a + share[0] * (b - a);
    };
    const auto face = [&](std::size_t at) {
      const double a = edge(at), b = edge(at + m_stride[1]);
      return a + share[1] * (b - a);
    };
    const double a = face(0), b = face(m_stride[2]);
    return a + share[2] * (b - a);
  }

private:
  const Pixel* m_voxels;
  std::array<int, 3> m_last{};
  std::array<std::size_t, 3> m_stride{};
};

}  // namespace

CtRays::CtRays(const Volume& volume, double offset) : m_volume(volume), m_offset(offset) {}

Matter CtRays::along(const Vector3d& source, const Vector3d& direction, double length,
                     std::span<const Chord> lumen) const {
  const VolumeGeometry& geometry = m_volume.geometry;
  const Vector3d from = geometry.indexFromWorld(source);
  const Vector3d step = geometry.indexFromWorld(source + direction) - from;
  Matter matter;
  double blood = 0;
  for (const Chord& chord : lumen) blood += chord.to - chord.from;
  matter.water = blood / kMmPerCm;
  const Chord chord = within(geometry, from, step, length);
  if (!(chord.from < chord.to)) return matter;
  static const double kBoneUnits = boneUnits();
  const double least = geometry.spacing.minCoeff() * kStepVoxels;
  const auto steps = static_cast<int>(std::ceil((chord.to - chord.from) / least));
  const double mm = (chord.to - chord.from) / steps;
  std::visit(
      [&](const auto& voxels) {
        const Values values(geometry, voxels);
        auto next = lumen.begin();
        for (int i = 0; i < steps; ++i) {
          const double begin = chord.from + i * mm, end = begin + mm;
          while (next != lumen.end() && next->to <= begin) ++next;
          double free = mm;
          for (auto in = next; in != lumen.end() && in->from < end; ++in)
            free -= std::min(in->to, end) - std::max(in->from, begin);
          if (!(free > 0)) continue;
          const double units = values.at(from + (begin + 0.5 * mm) * step) - m_offset;
          const double bone = std::clamp(units / kBoneUnits, 0.0, 1.0);
          matter.bone += bone * kBoneDensity * free / kMmPerCm;
          matter.water +=
              (units > 0 ? 1 - bone : std::max(0.0, 1 + units / 1000)) * free / kMmPerCm;
        }
      },
      m_volume.voxels);
  return matter;
}

}  // namespace lumen::convert
