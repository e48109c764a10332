// SPDX-License-Identifier: Apache-2.0
// The volume as the page takes it: 8 or 16 bits a voxel, and no more voxels than it can hold.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include "converters/io/volume/read_volume_options.h"
#include "converters/voxels/volume.h"

namespace lumen::viewer {

/// The part of a volume that is sent.
struct VolumeSending {
  /// More voxels than that are averaged in blocks, first along the axis of the least spacing.
  std::size_t mostVoxels = std::size_t{512} * 512 * 512;
  bool eightBits = false;  ///< whatever the volume has
  bool isLabels = false;   ///< of blocks one voxel is sent, none is averaged
  convert::CellBox crop{};
  bool cropped = false;
};

/// The pack `volume`, made slice by slice as it is sent. Never changed after construction: any
/// number of threads may ask.
class VolumePack {
public:
  /// `name` is a label.
  VolumePack(std::shared_ptr<const convert::Volume> volume, const std::string& name,
             const VolumeSending& sending = {});

  [[nodiscard]] std::size_t size() const { return m_before.size() + m_voxels * m_bytes; }

  /// Up to `length` bytes from `offset` on; no fewer than one, if there are any.
  [[nodiscard]] std::string bytes(std::size_t offset, std::size_t length) const;

private:
  [[nodiscard]] std::string slices(int first, int count) const;
  [[nodiscard]] std::pair<double, double> greyRange() const;
  void chooseScale();
  void choosePlace(const VolumeSending& sending);

  std::shared_ptr<const convert::Volume> m_volume;
  std::array<int, 3> m_low{}, m_source{};  ///< the box of the volume that is sent, voxels
  std::array<int, 3> m_reduction{1, 1, 1}, m_size{};
  std::size_t m_voxels = 0, m_bytes = 1;
  bool m_isLabels = false;
  double m_scale = 1, m_offset = 0;  ///< intensity = scale * stored + offset
  std::string m_before;
};

}  // namespace lumen::viewer
