// SPDX-License-Identifier: Apache-2.0
// Declared in centerline_readers.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/length_unit.h"
#include "converters/base/number_text.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/base/vectors.h"
#include "converters/io/centerline/centerline_readers.h"
#include "converters/io/centerline/network.h"
#include "converters/io/centerline/spatial_graph_data.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

constexpr double kLargestAmira = 1e9;  // far beyond any plausible length

// Fields that hold radii: thickness is one, by Amira's documentation (Eval On Lines).
struct AmiraRadii {
  const AmiraField* field = nullptr;
  double factor = 1;

  [[nodiscard]] double at(std::size_t index) const {
    if (field == nullptr || field->components != 1 || index >= field->values.size()) return 0;
    const double value = factor * field->values[index];
    return value > 0 && value <= kLargestAmira ? value : 0;
  }
};

AmiraRadii amiraRadiiOf(const AmiraFile& file, const std::string& location) {
  for (const auto& [name, factor] :
       std::array<std::pair<const char*, double>, 6>{{{"thickness", 1.0},
                                                      {"radius", 1.0},
                                                      {"radii", 1.0},
                                                      {"meanradius", 1.0},
                                                      {"diameter", 0.5},
                                                      {"diameters", 0.5}}})
    for (const AmiraField& field : file.fields)
      if (field.location == location && lowerCase(field.name) == name) return {&field, factor};
  return {};
}

class GraphOfAmira {
public:
  GraphOfAmira(const AmiraFile& file, std::string name) : m_file(file), m_name(std::move(name)) {}

  Network network() {
    const AmiraField& vertices = require("VERTEX", "VertexCoordinates", 3);
    const AmiraField& ends = require("EDGE", "EdgeConnectivity", 2);
    const AmiraField& counts = require("EDGE", "NumEdgePoints", 1);
    const AmiraField& points = require("POINT", "EdgePointCoordinates", 3);
    const AmiraRadii ofNodes = amiraRadiiOf(m_file, "VERTEX"),
                     ofEdges = amiraRadiiOf(m_file, "EDGE"),
                     ofPoints = amiraRadiiOf(m_file, "POINT");
    hasRadii = ofNodes.field || ofEdges.field || ofPoints.field;
    Network network;
    for (std::size_t n = 0; n * 3 < vertices.values.size(); ++n)
      network.nodes.push_back(pointAt(vertices, n, ofNodes.at(n)));
    std::size_t first = 0;
    const std::size_t count = points.values.size() / 3;
    for (std::size_t e = 0; e * 2 < ends.values.size(); ++e) {
      NetworkEdge edge;
      edge.from = nodeAt(ends.values[2 * e], network);
      edge.to = nodeAt(ends.values[2 * e + 1], network);
      edge.radius = ofEdges.at(e);
      const double size = counts.values[e];
      if (!(size >= 0) || size > static_cast<double>(count - first))
        refuse("edge " + std::to_string(e) + " has " + foundNumber(size) +
               " points (NumEdgePoints), more than are left; expected " + std::to_string(count) +
               " points of all edges");
      for (const std::size_t end = first + static_cast<std::size_t>(size); first < end; ++first)
        edge.course.push_back(
            pointAt(points, first, ofPoints.field ? ofPoints.at(first) : edge.radius));
      network.edges.push_back(std::move(edge));
    }
    return network;
  }

  bool hasRadii = false;

private:
  [[nodiscard]] const AmiraField& require(const char* location, const char* name,
                                          std::size_t components) const {
    const AmiraField* field = m_file.field(location, name);
    if (field == nullptr || field->components != components)
      refuse(std::string("has no ") + location + " { " + name + " } of " +
             std::to_string(components) + " numbers; expected that of a spatial graph");
    return *field;
  }

  [[nodiscard]] CurvePoint pointAt(const AmiraField& field, std::size_t index,
                                   double radius) const {
    const double* at = &field.values[3 * index];
    const Eigen::Vector3d place(at[0], at[1], at[2]);
    if (!isWithin(place, kLargestAmira))
      refuse(field.name + " has a number beyond 1e9; expected coordinates");
    return {place, radius};
  }

  [[nodiscard]] std::int32_t nodeAt(double index, const Network& network) const {
    if (!(index >= 0) || index >= static_cast<double>(network.nodes.size()) ||
        index != std::floor(index))
      refuse("EdgeConnectivity has the vertex " + foundNumber(index) +
             "; expected whole numbers below " + std::to_string(network.nodes.size()) +
             ", the number of vertices");
    return static_cast<std::int32_t>(index);
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw invalidInput(m_name + ": " + what);
  }

  const AmiraFile& m_file;
  std::string m_name;
};

// Applies the transform of the file; a remark reports it.
void applyTransform(const AmiraFile& data, CenterlineFile& file, const std::string& name) {
  if (data.transform.size() != 16) return;
  const Eigen::Map<const Eigen::Matrix4d> matrix(data.transform.data());
  if (matrix.isIdentity(0)) return;
  const Eigen::Matrix3d turn = matrix.topLeftCorner<3, 3>();
  const double scale = std::cbrt(std::abs(turn.determinant()));
  if (!matrix.allFinite() || !(matrix.cwiseAbs().maxCoeff() <= kLargestAmira) || !(scale > 0))
    throw invalidInput(name +
                       ": TransformationMatrix turns space into a plane, or is not finite; "
                       "expected that of a placed graph");
  for (CenterlinePoint& point : file.points) {
    point.position = turn * point.position + matrix.topRightCorner<3, 1>();
    point.radius *= scale;
    if (!isWithin(point.position, kLargestAmira))
      throw invalidInput(name + ": TransformationMatrix places points beyond 1e9");
  }
  file.remarks.emplace_back("its TransformationMatrix is applied, as Amira shows the graph");
}

}  // namespace

CenterlineFile parseSpatialGraph(std::string_view bytes, const std::string& name) {
  const std::string shown = formats::printable(name);
  const AmiraFile data = parseAmira(bytes, shown);
  GraphOfAmira graph(data, shown);
  CenterlineFile file = treeOfNetwork(graph.network(), shown);
  applyTransform(data, file, shown);
  const std::optional<double> unit = millimetresPer(data.unit);
  file.unit = unit.value_or(0);
  takeOwnFrame(bytes, file);
  if (!data.unit.empty() && !unit)
    file.remarks.push_back("states the unit " + quotedText(data.unit) + ", which is unknown");
  if (graph.hasRadii)
    fillRadii(file, shown, "a positive thickness of its points");
  else
    file.remarks.emplace_back("has no field thickness, radius or diameter");
  return file;
}

CenterlineFile readSpatialGraph(const InputFile& file) {
  return parseSpatialGraph(file.read("centerline", kMostText), file.path().string());
}

}  // namespace lumen::convert
