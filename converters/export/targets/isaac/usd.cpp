// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/isaac/usd.h"

#include <cstddef>
#include <utility>

#include <Eigen/Geometry>

#include "converters/base/number_text.h"
#include "converters/base/shown_text.h"
#include "converters/base/vectors.h"
#include "converters/export/shared/export_text.h"
#include "converters/export/shared/paths.h"
#include "converters/export/shared/surface.h"
#include "converters/io/mesh/plain_names.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

/// Cells along the longest side of PhysX's distance field: its default.
constexpr int kSdfResolution = 256;

std::string usdTuple(const Eigen::Vector3d& v) {
  return vectorText(v, kFloatDigits);
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

std::string extentText(const SurfaceMesh& mesh) {
  const Box3d box = boundingBox(mesh);
  std::string text = "[";
  text += usdTuple(box.low) + ", " + usdTuple(box.high) + "]";
  return text;
}

/// Nodes of each branch, from the one that it starts at in its parent.
std::vector<std::vector<std::size_t>> collectCurves(const formats::CenterlineTree& tree) {
  std::vector<std::vector<std::size_t>> curves;
  for (const formats::Branch& branch : tree.branches) {
    std::vector<std::size_t> curve;
    if (branch.parentNode >= 0) curve.push_back(static_cast<std::size_t>(branch.parentNode));
    for (std::size_t n = 0; n < branch.nodeCount; ++n) curve.push_back(branch.firstNode + n);
    if (curve.size() > 1) curves.push_back(std::move(curve));
  }
  return curves;
}

/// The branches as polylines, in the frame's unit.
struct Curves {
  std::vector<std::size_t> counts;
  std::vector<Eigen::Vector3d> points;
  std::vector<double> widths;
};

Curves centerline(const formats::CenterlineTree& tree, const ExportFrame& frame) {
  Curves made;
  for (const auto& curve : collectCurves(tree)) {
    made.counts.push_back(curve.size());
    for (const std::size_t place : curve) {
      made.points.push_back(frame.position(toEigen(tree.centre[place])));
      // a branch is as wide at its parent's node as at its own first node
      const bool isOthers = tree.branch[place] != tree.branch[curve[1]];
      const std::size_t node = isOthers ? curve[1] : place;
      made.widths.push_back(2 * frame.length(static_cast<double>(tree.radius[node])));
    }
  }
  return made;
}

std::string endPrim(const NamedEnd& end, const std::string& word, const ExportFrame& frame) {
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), frame.direction(end.direction));
  return exportText("isaac/end.usda",
                    {{"word", word},
                     {"name", usdString(end.name)},
                     {"radius", numberText(frame.length(end.radius))},
                     {"position", usdTuple(frame.position(end.position))},
                     {"turn", numberText(turn.w()) + ", " + numberText(turn.x()) + ", " +
                                  numberText(turn.y()) + ", " + numberText(turn.z())}});
}

std::string endPrims(const std::vector<NamedEnd>& ends, const ExportFrame& frame) {
  std::vector<std::string> names;
  for (const NamedEnd& end : ends) names.push_back(end.name);
  const std::vector<std::string> words = distinct(names, usdWord);
  std::string text;
  for (std::size_t i = 0; i < ends.size(); ++i) text += endPrim(ends[i], words[i], frame);
  return text;
}

}  // namespace

std::string encodeUsda(const SurfaceMesh& mesh, const formats::CenterlineTree& tree,
                       const std::vector<NamedEnd>& ends, const ExportFrame& frame) {
  const Curves curves = centerline(tree, frame);
  const auto index = [&](std::size_t i) { return std::to_string(mesh.triangle[i / 3][i % 3]); };
  const auto point = [&](std::size_t i) {
    const Float3& p = mesh.position[i];
    return usdTuple({p[0], p[1], p[2]});
  };
  return exportText(
      "isaac/vessel.usda",
      {{"axes", std::string(axesText(frame.axes))},
       {"metres", numberText(0.001 / frame.scale())},
       {"up", frame.axes == Axes::Lsa ? "Y" : "Z"},
       {"resolution", std::to_string(kSdfResolution)},
       {"extent", extentText(mesh)},
       {"counts", usdList(mesh.triangle.size(), [](std::size_t) { return std::string("3"); })},
       {"indices", usdList(3 * mesh.triangle.size(), index)},
       {"points", usdList(mesh.position.size(), point)},
       {"curves", usdList(curves.counts.size(),
                          [&](std::size_t i) { return std::to_string(curves.counts[i]); })},
       {"curvePoints",
        usdList(curves.points.size(), [&](std::size_t i) { return usdTuple(curves.points[i]); })},
       {"widths",
        usdList(curves.widths.size(), [&](std::size_t i) { return numberText(curves.widths[i]); })},
       {"ends", endPrims(ends, frame)}});
}

}  // namespace lumen::convert
