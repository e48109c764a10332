// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/isaac/usd.h"

#include <cstddef>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "converters/base/number_text.h"
#include "converters/base/vectors.h"
#include "converters/export/shared/paths.h"
#include "converters/io/mesh/plain_names.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

/// Cells along the longest side of PhysX's distance field: its default.
constexpr int kSdfResolution = 256;

std::string usdTuple(const Eigen::Vector3d& v) {
  std::string text = "(";
  text += numberText(v.x()) + ", " + numberText(v.y()) + ", " + numberText(v.z()) + ")";
  return text;
}

/// Texts of `count` entries in brackets.
template <class TextOf>
std::string usdList(std::size_t count, TextOf textOf) {
  std::string text = "[";
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) text += ", ";
    text += textOf(i);
  }
  return text + "]";
}

std::string usdString(const std::string& text) {
  std::string out = "\"";
  for (const char c : formats::printable(text)) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

/// Letters, digits and "_" of ASCII, not beginning with a digit.
std::string usdWord(const std::string& name) {
  std::string word = openFoamWord(name);
  for (char& c : word)
    if (c == '.' || c == '-') c = '_';
  return word.front() >= '0' && word.front() <= '9' ? "_" + word : word;
}

std::string extentOf(const SurfaceMesh& mesh) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  Eigen::Vector3d low = Eigen::Vector3d::Constant(kInfinite), high = -low;
  for (const Float3& p : mesh.position) {
    const Eigen::Vector3d place(p[0], p[1], p[2]);
    low = low.cwiseMin(place);
    high = high.cwiseMax(place);
  }
  std::string text = "[";
  text += usdTuple(low) + ", " + usdTuple(high) + "]";
  return text;
}

std::string wallPrim(const SurfaceMesh& mesh) {
  std::string text =
      "    def Mesh \"wall\" (\n"
      "        prepend apiSchemas = [\"PhysicsCollisionAPI\", \"PhysicsMeshCollisionAPI\", "
      "\"PhysxSDFMeshCollisionAPI\"]\n"
      "    )\n"
      "    {\n"
      "        uniform token subdivisionScheme = \"none\"\n"
      "        uniform token orientation = \"rightHanded\"\n"
      "        bool physics:collisionEnabled = 1\n"
      "        uniform token physics:approximation = \"none\"\n";
  text += "        int physxSDFMeshCollision:sdfResolution = " + std::to_string(kSdfResolution);
  text += "\n        float3[] extent = " + extentOf(mesh);
  text += "\n        int[] faceVertexCounts = " +
          usdList(mesh.triangle.size(), [](std::size_t) { return std::string("3"); });
  text += "\n        int[] faceVertexIndices = " +
          usdList(3 * mesh.triangle.size(),
                  [&](std::size_t i) { return std::to_string(mesh.triangle[i / 3][i % 3]); });
  text += "\n        point3f[] points = " + usdList(mesh.position.size(), [&](std::size_t i) {
            const Float3& p = mesh.position[i];
            return usdTuple({p[0], p[1], p[2]});
          });
  return text + "\n    }\n";
}

/// Nodes of each branch, from the one that it hangs on.
std::vector<std::vector<std::size_t>> curvesOf(const formats::CenterlineTree& tree) {
  std::vector<std::vector<std::size_t>> curves;
  for (const formats::Branch& branch : tree.branches) {
    std::vector<std::size_t> curve;
    if (branch.parentNode >= 0) curve.push_back(static_cast<std::size_t>(branch.parentNode));
    for (std::size_t n = 0; n < branch.nodeCount; ++n) curve.push_back(branch.firstNode + n);
    if (curve.size() > 1) curves.push_back(std::move(curve));
  }
  return curves;
}

std::string centerlinePrim(const formats::CenterlineTree& tree, const ExportFrame& frame) {
  const auto curves = curvesOf(tree);
  std::vector<Eigen::Vector3d> points;
  std::vector<double> widths;
  for (const auto& curve : curves)
    for (std::size_t k = 0; k < curve.size(); ++k) {
      points.push_back(frame.position(toEigen(tree.centre[curve[k]])));
      // where it hangs on another, a branch is as wide as at its own first node
      const bool isOthers = tree.branch[curve[k]] != tree.branch[curve[1]];
      const std::size_t node = isOthers ? curve[1] : curve[k];
      widths.push_back(2 * frame.length(static_cast<double>(tree.radius[node])));
    }
  std::string text =
      "    def BasisCurves \"centerline\"\n    {\n"
      "        uniform token type = \"linear\"\n"
      "        uniform token wrap = \"nonperiodic\"\n";
  text += "        int[] curveVertexCounts = " +
          usdList(curves.size(), [&](std::size_t i) { return std::to_string(curves[i].size()); });
  text += "\n        point3f[] points = " +
          usdList(points.size(), [&](std::size_t i) { return usdTuple(points[i]); });
  text += "\n        float[] widths = " +
          usdList(widths.size(), [&](std::size_t i) { return numberText(widths[i]); }) +
          " (\n            interpolation = \"vertex\"\n        )\n    }\n";
  return text;
}

std::string endPrim(const NamedEnd& end, const std::string& word, const ExportFrame& frame) {
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), frame.direction(end.direction));
  std::string text = "        def Xform \"" + word + "\"\n        {\n";
  text += "            custom string lumen:name = " + usdString(end.name) + "\n";
  text += "            custom float lumen:radius = " + numberText(frame.length(end.radius)) + "\n";
  text += "            double3 xformOp:translate = " + usdTuple(frame.position(end.position));
  text += "\n            quatf xformOp:orient = (" + numberText(turn.w()) + ", " +
          numberText(turn.x()) + ", " + numberText(turn.y()) + ", " + numberText(turn.z());
  text +=
      ")\n            uniform token[] xformOpOrder = [\"xformOp:translate\", "
      "\"xformOp:orient\"]\n        }\n";
  return text;
}

std::string endsPrim(const std::vector<NamedEnd>& ends, const ExportFrame& frame) {
  std::vector<std::string> names;
  for (const NamedEnd& end : ends) names.push_back(end.name);
  const std::vector<std::string> words = distinct(names, usdWord);
  std::string text = "    def Xform \"ends\"\n    {\n";
  for (std::size_t i = 0; i < ends.size(); ++i) text += endPrim(ends[i], words[i], frame);
  return text + "    }\n";
}

}  // namespace

std::string encodeUsda(const SurfaceMesh& mesh, const formats::CenterlineTree& tree,
                       const std::vector<NamedEnd>& ends, const ExportFrame& frame) {
  std::string text =
      "#usda 1.0\n(\n"
      "    defaultPrim = \"vessel\"\n";
  text += "    doc = \"Vessels in patient coordinates: " + std::string(axesText(frame.axes)) +
          "\"\n    metersPerUnit = " + numberText(0.001 / frame.scale());
  text += "\n    upAxis = \"";
  text += frame.axes == Axes::Lsa ? "Y" : "Z";
  text += "\"\n)\n\ndef Xform \"vessel\"\n{\n";
  text += wallPrim(mesh) + centerlinePrim(tree, frame) + endsPrim(ends, frame);
  return text + "}\n";
}

}  // namespace lumen::convert
