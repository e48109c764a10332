// SPDX-License-Identifier: Apache-2.0
// Declared in mesh_readers.h.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include "converters/base/length_unit.h"
#include "converters/io/mesh/mesh_builder.h"
#include "converters/io/mesh/read_mesh.h"
#include "converters/io/vtk/vtk_legacy.h"
#include "converters/io/vtk/vtk_poly_data.h"
#include "converters/io/vtk/vtk_xml.h"

namespace lumen::convert {
namespace {

constexpr std::string_view kFaceId = "ModelFaceID";

/// The name of the group of a cell: its number, if that is a whole number.
std::string groupName(const VtkArray* ids, std::size_t cell) {
  if (ids == nullptr || cell >= ids->values.size()) return {};
  const double id = ids->values[cell];
  if (id != std::floor(id) || std::abs(id) > 1e9) return {};
  return std::to_string(static_cast<std::int64_t>(id));
}

/// Unit and axes by field data, or by a legacy file's title.
StatedFrame frameOf(const VtkPolyData& data) {
  StatedFrame frame;
  frame.look(data.title);
  if (const StatedAxes axes = axesIn(data.space); axes != StatedAxes::None) {
    frame.ras = axes == StatedAxes::Ras;
    frame.lps = axes == StatedAxes::Lps;
  }
  if (const auto unit = millimetresPer(data.unit)) {
    frame.unit = *unit;
    frame.notes.clear();
  }
  for (std::string& sentence : data.unknownWords()) frame.notes.push_back(std::move(sentence));
  return frame;
}

MeshFile makeMesh(const VtkPolyData& data, const StatedFrame& frame, MeshBuilder& builder) {
  builder.file.mesh.position.reserve(data.position.size());
  for (const Eigen::Vector3d& p : data.position)
    builder.addPoint(p, [&] { return "point " + std::to_string(builder.points()); });
  const VtkArray* ids = data.cellArray(kFaceId);
  if (ids != nullptr && ids->components != 1) ids = nullptr;
  const std::size_t firstPoly = data.verts.size() + data.lines.size();
  std::size_t thin = 0;
  for (std::size_t c = 0; c < data.polys.size(); ++c) {
    const std::uint32_t begin = data.polys.begin(c), count = data.polys.end[c] - begin;
    thin += count < 3 ? 1 : 0;
    builder.beginGroup(groupName(ids, firstPoly + c));
    builder.addPolygon(data.polys.point.data() + begin, count);
  }
  for (std::size_t c = 0; c < data.strips.size(); ++c) {
    const std::uint32_t begin = data.strips.begin(c), end = data.strips.end[c];
    builder.beginGroup(groupName(ids, firstPoly + data.polys.size() + c));
    for (std::uint32_t i = begin; i + 2 < end; ++i) {
      const std::uint32_t* p = data.strips.point.data() + i;
      // every other triangle of a strip has the opposite orientation
      builder.addTriangle((i - begin) % 2 == 0 ? Triangle{p[0], p[1], p[2]}
                                               : Triangle{p[1], p[0], p[2]});
    }
  }
  const auto passed = [&](std::size_t count, const char* what) {
    if (count > 0) builder.file.notes.push_back(std::to_string(count) + what);
  };
  passed(thin, " polygons of fewer than 3 points were passed over");
  passed(data.lines.size(), " lines were passed over");
  return finishStated(builder, frame);
}

}  // namespace

MeshFile parseVtp(std::string_view bytes, const std::string& name) {
  MeshBuilder builder(name);
  const VtkPolyData data = parseVtkXml(bytes, name, std::array{kFaceId});
  return makeMesh(data, frameOf(data), builder);
}

MeshFile parseVtk(std::string_view bytes, const std::string& name) {
  MeshBuilder builder(name);
  const VtkPolyData data = parseVtkLegacy(bytes, name, std::array{kFaceId});
  return makeMesh(data, frameOf(data), builder);
}

}  // namespace lumen::convert
