// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/trees_from_surfaces/label_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <type_traits>
#include <utility>
#include <variant>

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/geometry/disjoint_sets.h"
#include "converters/geometry/marching_cubes.h"
#include "converters/geometry/mesh_measures.h"
#include "converters/stages/trees_from_surfaces/thin_voxels.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kMostLabels = 255;
constexpr std::size_t kMostListed = 10;
constexpr double kSpread = 0.7;   // voxels: the standard deviation that takes the steps away
constexpr int kKernelVoxels = 3;  // voxels: where its kernel ends
constexpr int kHalo = 2 * kKernelVoxels;  // reach of the kernel applied twice
constexpr int kSlab = 32;                 // slices that are smoothed at a time
// Least distance from the half level: a voxel's centre stays on its side, and no triangle vanishes.
constexpr float kLeastFromLevel = 0.05F;
// Least distance from the half level for lines one voxel wide, whose wall stays about half a voxel
// away, as it was drawn.
constexpr float kThin = 0.25F;

std::string listOf(const std::set<std::int64_t>& values) {
  std::string text;
  std::size_t count = 0;
  for (const std::int64_t value : values) {
    if (count++ == kMostListed) return text + " and so on";
    text.append(text.empty() ? "" : ", ").append(std::to_string(value));
  }
  return text;
}

/// The values but 0 that occur; beyond 255 of them, those that are wanted.
template <class T>
std::set<std::int64_t> collectValues(const std::vector<T>& voxels, const LabelNames& wanted,
                                     const std::string& name) {
  std::set<std::int64_t> values;
  T last{};
  for (const T voxel : voxels) {
    if (!(voxel < last) && !(voxel > last)) continue;
    last = voxel;
    if constexpr (std::is_floating_point_v<T>)
      if (std::abs(voxel) > T(1 << 24) || std::round(voxel) != voxel)
        throw invalidInput(name + ": has a voxel of " + foundNumber(double{voxel}) +
                           "; expected labels, which are whole numbers up to 2^24");
    const auto value = static_cast<std::int64_t>(voxel);
    if (value != 0 && (values.size() <= kMostLabels || wanted.contains(value)))
      values.insert(value);
    if (wanted.empty() && values.size() > kMostLabels)
      throw invalidInput(
          name + ": has more than " + std::to_string(kMostLabels) +
          " different values; expected labels, or a choice of them by label or labels");
  }
  return values;
}

/// Samples of the labels' voxels for marching cubes, slab by slab.
class LabelSamples {
public:
  LabelSamples(const LabelMask& mask, const Progress& progress)
      : m_mask(mask), m_progress(progress), m_size(mask.geometry.size) {
    for (std::size_t k = 0; k < m_kernel.size(); ++k) {
      const double x = (static_cast<double>(k) - kKernelVoxels) / kSpread;
      m_kernel[k] = static_cast<float>(std::exp(-0.5 * x * x));
    }
    float sum = 0;
    for (const float weight : m_kernel) sum += weight;
    for (float& weight : m_kernel) weight /= sum;
  }

  /// One sample beyond the volume on each side, cell 1.
  SampleGrid grid() {
    m_grid.cell = 1;
    m_grid.lowY = m_grid.lowZ = -1;
    m_grid.rowsY = m_size[1] + 2;
    m_grid.rowsZ = m_size[2] + 2;
    findRows();
    for (int z = -1; z <= m_size[2]; z += kSlab) {
      m_progress.check();
      addSlab(z, std::min(z + kSlab, m_size[2] + 1));
    }
    return std::move(m_grid);
  }

private:
  [[nodiscard]] std::size_t rowOf(int y, int z) const {
    return static_cast<std::size_t>(z + 1) * static_cast<std::size_t>(m_grid.rowsY) +
           static_cast<std::size_t>(y + 1);
  }
  [[nodiscard]] bool isIn(int x, int y, int z) const {
    return m_mask.geometry.contains({x, y, z}) && m_mask.label[index(x, y, z)] != 0;
  }
  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    return m_mask.geometry.index({x, y, z});
  }

  /// Each row reaches a sample beyond the labels of the rows around it.
  void findRows() {
    const std::size_t rows =
        static_cast<std::size_t>(m_grid.rowsY) * static_cast<std::size_t>(m_grid.rowsZ);
    std::vector<std::pair<int, int>> hull(rows, {m_size[0], -1});
    for (int z = 0; z < m_size[2]; ++z)
      for (int y = 0; y < m_size[1]; ++y) {
        const std::uint8_t* row = m_mask.label.data() + index(0, y, z);
        int first = 0, last = m_size[0] - 1;
        while (first <= last && row[first] == 0) ++first;
        while (last >= first && row[last] == 0) --last;
        if (first > last) continue;
        for (int dz = -1; dz <= 1; ++dz)
          for (int dy = -1; dy <= 1; ++dy) {
            auto& [low, high] = hull[rowOf(y + dy, z + dz)];
            low = std::min(low, first - 1);
            high = std::max(high, last + 1);
          }
      }
    m_grid.rows.resize(rows);
    std::size_t offset = 0;
    for (std::size_t r = 0; r < rows; ++r) {
      const auto [low, high] = hull[r];
      m_grid.rows[r] = {low, std::max(0, high - low + 1), offset};
      offset += static_cast<std::size_t>(m_grid.rows[r].count);
    }
    m_grid.value.resize(offset);
  }

  [[nodiscard]] bool isEmpty(int from, int to) const {
    for (int z = from; z < to; ++z)
      for (int y = -1; y <= m_size[1]; ++y)
        if (m_grid.rows[rowOf(y, z)].count > 0) return false;
    return true;
  }

  /// The samples with z in [from, to).
  void addSlab(int from, int to) {
    if (isEmpty(from, to)) return;
    m_low = from - kHalo;
    m_slices = to - from + 2 * kHalo;
    std::vector<float> once(static_cast<std::size_t>(m_slices) * index(0, 0, 1));
    std::size_t at = 0;
    for (int k = 0; k < m_slices; ++k) {
      const int z = std::clamp(m_low + k, 0, m_size[2] - 1);
      for (std::size_t i = 0; i < index(0, 0, 1); ++i)
        once[at++] = m_mask.label[index(0, 0, z) + i] != 0 ? 1.0F : 0.0F;
    }
    smooth(once);
    std::vector<float> twice = once;
    smooth(twice);
    tbb::parallel_for(from, to, [&](int z) {
      for (int y = -1; y <= m_size[1]; ++y) {
        const SampleGrid::SampleRow& row = m_grid.rows[rowOf(y, z)];
        for (int i = 0; i < row.count; ++i)
          m_grid.value[row.offset + static_cast<std::size_t>(i)] =
              sample(once, twice, row.first + i, y, z);
      }
    });
  }

  /// The smoothed labels, which beyond the volume continue the outermost values.
  [[nodiscard]] double sample(const std::vector<float>& once, const std::vector<float>& twice,
                              int x, int y, int z) const {
    const int nearX = std::clamp(x, 0, m_size[0] - 1), nearY = std::clamp(y, 0, m_size[1] - 1),
              nearZ = std::clamp(z, 0, m_size[2] - 1);
    const std::size_t at = index(nearX, nearY, z - m_low);
    const float smoothed = 2 * once[at] - twice[at];
    const std::array<int, 3> voxel{nearX, nearY, nearZ};
    const auto isIn = [this](int i, int j, int k) { return this->isIn(i, j, k); };
    if (!isIn(nearX, nearY, nearZ))
      return joinsThinVoxels(voxel, isIn) ? 0.5F + kLeastFromLevel
                                          : std::min(smoothed, 0.5F - kLeastFromLevel);
    if (smoothed >= 0.5F + kThin) return smoothed;
    return std::max(smoothed, 0.5F + (isThinVoxel(voxel, isIn) ? kThin : kLeastFromLevel));
  }

  /// Smooths along each axis; beyond the volume the outermost values continue.
  void smooth(std::vector<float>& values) const {
    const std::array<int, 3> size{m_size[0], m_size[1], m_slices};
    std::size_t stride = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto length = static_cast<std::size_t>(size[axis]);
      // lines in groups that share the places on the axes above
      tbb::parallel_for(std::size_t{0}, values.size() / (stride * length), [&](std::size_t group) {
        if (group % 256 == 0) m_progress.check();
        std::vector<float> line(length + kHalo);
        for (std::size_t s = 0; s < stride; ++s)
          smoothLine(values.data() + group * stride * length + s, stride, length, line);
      });
      stride *= length;
    }
  }

  void smoothLine(float* first, std::size_t stride, std::size_t length,
                  std::vector<float>& line) const {
    bool isEven = true;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const std::size_t from = std::min(i < kKernelVoxels ? 0 : i - kKernelVoxels, length - 1);
      line[i] = first[from * stride];
      isEven = isEven && !(line[i] < line[0]) && !(line[i] > line[0]);
    }
    if (isEven) return;
    for (std::size_t i = 0; i < length; ++i) {
      float sum = 0;
      for (std::size_t k = 0; k < m_kernel.size(); ++k) sum += m_kernel[k] * line[i + k];
      first[i * stride] = sum;
    }
  }

  const LabelMask& m_mask;
  const Progress& m_progress;
  std::array<int, 3> m_size;
  std::array<float, 2 * kKernelVoxels + 1> m_kernel{};
  SampleGrid m_grid;
  int m_low = 0, m_slices = 0;  // range of the slab
};

/// Drops the closed parts that surround voxels outside the labels, and counts them. Parts that
/// reach beyond half a voxel outside of the volume, where they are open, stay. Positions are
/// indices.
std::size_t dropCavities(TriangleMesh& mesh, const Vector3d& low, const Vector3d& high) {
  DisjointSets parts(mesh.position.size());
  for (const Triangle& t : mesh.triangle) {
    parts.join(t[0], t[1]);
    parts.join(t[0], t[2]);
  }
  std::vector<double> volume(mesh.position.size(), 0.0);
  for (const Triangle& t : mesh.triangle) {
    const std::uint32_t part = parts.find(t[0]);
    const Vector3d origin = mesh.position[part];
    volume[part] += tetrahedronVolume(mesh.position[t[0]] - origin, mesh.position[t[1]] - origin,
                                      mesh.position[t[2]] - origin);
  }
  for (std::uint32_t i = 0; i < mesh.position.size(); ++i)
    if ((mesh.position[i].array() < low.array()).any() ||
        (mesh.position[i].array() > high.array()).any())
      volume[parts.find(i)] = 0;
  std::erase_if(mesh.triangle, [&](const Triangle& t) { return volume[parts.find(t[0])] < 0; });
  return static_cast<std::size_t>(
      std::count_if(volume.begin(), volume.end(), [](double v) { return v < 0; }));
}

/// Drops vertices that no triangle has.
void dropUnused(TriangleMesh& mesh) {
  std::vector<std::uint32_t> to(mesh.position.size(), 0);
  for (const Triangle& t : mesh.triangle)
    for (const std::uint32_t i : t) to[i] = 1;
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (to[i] == 0) continue;
    mesh.position[count] = mesh.position[i];
    to[i] = count++;
  }
  mesh.position.resize(count);
  for (Triangle& t : mesh.triangle)
    for (std::uint32_t& i : t) i = to[i];
}

}  // namespace

LabelMask makeLabelMask(const Volume& volume, const LabelNames& wanted, const std::string& name) {
  if (wanted.size() > kMostLabels)
    throw invalidInput(name + ": " + std::to_string(wanted.size()) +
                       " labels are wanted; expected at most " + std::to_string(kMostLabels));
  LabelMask mask{volume.geometry, {}, {}, {}, false};
  std::visit(
      [&](const auto& voxels) {
        const std::set<std::int64_t> values = collectValues(voxels, wanted, name);
        mask.isGrey = isGrey(voxels);
        LabelNames named = wanted;
        if (wanted.empty())
          for (const std::int64_t value : values)
            named[value].append("label-").append(std::to_string(value));
        std::map<std::int64_t, std::uint8_t> places;
        for (const auto& [value, text] : named) {
          if (!values.contains(value))
            throw invalidInput(name + ": no voxel has the label " + std::to_string(value) +
                               "; it has " + listOf(values));
          mask.values.push_back(value);
          mask.names.push_back(text);
          places[value] = static_cast<std::uint8_t>(mask.names.size());
        }
        mask.label.resize(voxels.size());
        std::int64_t last = 0;
        std::uint8_t place = 0;
        for (std::size_t i = 0; i < voxels.size(); ++i) {
          if (const auto value = static_cast<std::int64_t>(voxels[i]); value != last) {
            const auto found = places.find(value);
            place = found == places.end() ? std::uint8_t{0} : found->second;
            last = value;
          }
          mask.label[i] = place;
        }
      },
      volume.voxels);
  return mask;
}

LabelSurface makeLabelSurface(const LabelMask& mask, const Progress& progress) {
  const SampleGrid grid = LabelSamples(mask, progress).grid();
  std::vector<SampleState> state(grid.value.size());
  std::transform(grid.value.begin(), grid.value.end(), state.begin(), [](double value) {
    return value > 0.5 ? SampleState::Inside : SampleState::Outside;
  });
  LabelSurface out;
  out.mesh = marchingCubes(grid, state, [](const Vector3d&, double a, const Vector3d&, double b) {
    return (0.5 - a) / (b - a);
  });
  const Vector3d low = Vector3d::Constant(-0.5);
  const Vector3d high = mask.geometry.cells().size.cast<double>() + low;
  out.cavities = dropCavities(out.mesh, low, high);
  dropUnused(out.mesh);
  for (Vector3d& p : out.mesh.position)
    p = mask.geometry.worldFromIndex(p.cwiseMax(low).cwiseMin(high));
  if (mask.geometry.direction.determinant() < 0)
    for (Triangle& t : out.mesh.triangle) std::swap(t[1], t[2]);
  return out;
}

}  // namespace lumen::convert
