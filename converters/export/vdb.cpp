// SPDX-License-Identifier: Apache-2.0
#include "converters/export/vdb.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <sstream>

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Prune.h>

#include "converters/common/sha256.h"

namespace lumen::convert {

namespace {

openvdb::math::Transform::Ptr transformOf(const Lattice& lattice, double unit) {
  auto transform = openvdb::math::Transform::createLinearTransform(lattice.spacing / unit);
  transform->postTranslate(
      {lattice.first[0] / unit, lattice.first[1] / unit, lattice.first[2] / unit});
  return transform;
}

/// Calls visit(voxel, value) of each sample.
template <class Visit>
void forEach(const DistanceGrid& grid, Visit visit) {
  std::size_t at = 0;
  for (int k = 0; k < grid.lattice.size[2]; ++k)
    for (int j = 0; j < grid.lattice.size[1]; ++j)
      for (int i = 0; i < grid.lattice.size[0]; ++i)
        visit(openvdb::Coord(i, j, k), grid.values[at++]);
}

openvdb::FloatGrid::Ptr levelSet(const DistanceGrid& grid, const VdbOptions& options) {
  const auto background = static_cast<float>(options.band / options.unit);
  auto set = openvdb::FloatGrid::create(background);
  set->setName("distance");
  set->setGridClass(openvdb::GRID_LEVEL_SET);
  set->setTransform(transformOf(grid.lattice, options.unit));
  set->setSaveFloatAsHalf(options.half);
  auto voxels = set->getAccessor();
  forEach(grid, [&](const openvdb::Coord& voxel, const WallDistance& value) {
    if (std::abs(value.distance) < options.band)
      voxels.setValueOn(voxel, static_cast<float>(value.distance / options.unit));
    else if (value.distance < 0)
      voxels.setValueOff(voxel, -background);
  });
  openvdb::tools::pruneLevelSet(set->tree());
  return set;
}

openvdb::Int32Grid::Ptr branches(const DistanceGrid& grid, double unit) {
  auto labels = openvdb::Int32Grid::create(0);
  labels->setName("branch");
  labels->setTransform(transformOf(grid.lattice, unit));
  auto voxels = labels->getAccessor();
  forEach(grid, [&](const openvdb::Coord& voxel, const WallDistance& value) {
    if (value.distance < 0) voxels.setValueOn(voxel, static_cast<int>(value.branch) + 1);
  });
  openvdb::tools::prune(labels->tree());
  return labels;
}

/// In place of the random name that the library gives each file, one that its content gives.
void nameByContent(std::string& bytes) {
  // magic number, versions of file and library, and whether there are offsets, stand before it
  constexpr std::size_t kAt = 8 + 4 + 4 + 4 + 1, kLength = 36;
  bytes.replace(kAt, kLength, kLength, '0');
  const std::string digest = sha256(std::as_bytes(std::span(bytes)));
  std::string name = digest.substr(0, 32);
  for (const std::size_t hyphen : {8U, 13U, 18U, 23U}) name.insert(hyphen, "-");
  bytes.replace(kAt, kLength, name);
}

}  // namespace

bool hasVdb() {
  return true;
}

std::string encodeVdb(const DistanceGrid& grid, const VdbOptions& options) {
  openvdb::initialize();
  openvdb::MetaMap about;
  about.insertMeta("unit", openvdb::StringMetadata(options.unit == 1 ? "mm" : "m"));
  about.insertMeta("frame", openvdb::StringMetadata("LPS"));
  std::ostringstream out(std::ios::binary);
  openvdb::io::Stream(out).write(
      openvdb::GridCPtrVec{levelSet(grid, options), branches(grid, options.unit)}, about);
  std::string bytes = std::move(out).str();
  nameByContent(bytes);
  return bytes;
}

}  // namespace lumen::convert
