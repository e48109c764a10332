// SPDX-License-Identifier: Apache-2.0
// Declared in grid_files.h.
#include <cmath>
#include <cstdint>
#include <span>
#include <sstream>
#include <utility>

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Prune.h>

#include "converters/base/sha256.h"
#include "converters/export/shared/grid_files.h"

namespace lumen::convert {

namespace {

openvdb::math::Transform::Ptr makeTransform(const Lattice& lattice, double unit) {
  auto transform = openvdb::math::Transform::createLinearTransform(lattice.spacing / unit);
  transform->postTranslate(
      {lattice.first[0] / unit, lattice.first[1] / unit, lattice.first[2] / unit});
  return transform;
}

/// The two grids while samples come in.
struct VdbGrids {
  VdbGrids(const GridSource& source, const Lattice& lattice, const VdbOptions& options)
      : unit(options.unit),
        band(static_cast<float>(source.band)),
        background(static_cast<float>(source.band / options.unit)),
        set(openvdb::FloatGrid::create(background)),
        labels(openvdb::Int32Grid::create(0)) {
    set->setName("distance");
    set->setGridClass(openvdb::GRID_LEVEL_SET);
    set->setSaveFloatAsHalf(options.half);
    labels->setName("branch");
    set->setTransform(makeTransform(lattice, options.unit));
    labels->setTransform(makeTransform(lattice, options.unit));
  }

  void add(const DistanceGrid& part, int firstLayer) {
    auto distances = set->getAccessor();
    auto branches = labels->getAccessor();
    std::size_t at = 0;
    for (int k = 0; k < part.lattice.size[2]; ++k)
      for (int j = 0; j < part.lattice.size[1]; ++j)
        for (int i = 0; i < part.lattice.size[0]; ++i) {
          const WallDistance value = part.values[at++];
          const openvdb::Coord voxel(i, j, firstLayer + k);
          if (std::abs(value.distance) < band)
            distances.setValueOn(voxel,
                                 static_cast<float>(static_cast<double>(value.distance) / unit));
          else if (value.distance < 0)
            distances.setValueOff(voxel, -background);
          if (value.distance < 0) branches.setValueOn(voxel, static_cast<int>(value.branch) + 1);
        }
    openvdb::tools::pruneLevelSet(set->tree());
    openvdb::tools::prune(labels->tree());
  }

  double unit;
  float band, background;
  openvdb::FloatGrid::Ptr set;
  openvdb::Int32Grid::Ptr labels;
};

/// Replaces the random name that the library gives each file by one that follows from its content.
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

void requireVdb(const FieldWord& /*word*/) {}

std::string encodeVdb(const GridSource& source, const Lattice& lattice, const VdbOptions& options,
                      Progress& progress) {
  constexpr int kLayers = 8;  // layers of a leaf of the tree, so that no leaf is opened again
  openvdb::initialize();
  VdbGrids grids(source, lattice, options);
  sampleLayers(
      source, lattice, kLayers,
      [&](const DistanceGrid& part, int firstLayer) { grids.add(part, firstLayer); }, progress);
  openvdb::MetaMap about;
  about.insertMeta("unit", openvdb::StringMetadata(options.unit == 1 ? "mm" : "m"));
  about.insertMeta("frame", openvdb::StringMetadata("LPS"));
  std::ostringstream out(std::ios::binary);
  openvdb::io::Stream(out).write(openvdb::GridCPtrVec{grids.set, grids.labels}, about);
  std::string bytes = std::move(out).str();
  nameByContent(bytes);
  return bytes;
}

}  // namespace lumen::convert
