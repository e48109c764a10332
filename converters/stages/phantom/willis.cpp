// SPDX-License-Identifier: Apache-2.0
// A synthetic circle of Willis. Radii are those of J. Alastruey, K. H. Parker, J. Peiro, S. M. Byrd
// and S. J. Sherwin, "Modelling the circle of Willis to assess the effects of anatomical variations
// and occlusions on cerebral flows", Journal of Biomechanics 40 (2007), 1794-1805, table 1, and so
// are the lengths of A1 (12 mm), P1 (5 mm) and the communicating arteries (3 mm and 15 mm), about;
// longer vessels are cut at the faces or end within. Courses are plain curves, equal on both sides.
// Where A1 or P1 is missing, its communicating artery feeds what lies behind, as wide as that.
// Places are in mm for an extent of 51 mm, and follow other extents.
#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "converters/stages/phantom/design.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kExtent = 51;  // mm
constexpr double kCarotid = 2.0, kBasilar = 1.62, kMiddle = 1.43, kAnterior = 1.17,
                 kAnterior2 = 1.2, kPosterior = 1.07, kPosterior2 = 1.05, kPosteriorLink = 0.73,
                 kAnteriorLink = 0.74;  // mm

/// Vessels of one side, in mm for the extent above; those of the left side are mirrored.
class Side {
public:
  Side(const Frame& frame, bool isLeft) : m_frame(frame), m_isLeft(isLeft) {}

  [[nodiscard]] std::string name(const std::string& vessel) const {
    return (m_isLeft ? "L-" : "R-") + vessel;
  }
  [[nodiscard]] Vector3d place(Vector3d at) const {
    if (m_isLeft) at.x() = kExtent - at.x();
    return m_frame.extent / kExtent * at;
  }
  /// A chain of cubic Bezier curves through every third of `points`; the radius goes evenly from one end
  /// to the other.
  [[nodiscard]] Path curve(const std::vector<Vector3d>& points, double from, double to) const {
    const double scale = std::clamp(m_frame.extent / kExtent, 0.5, 1.5);
    const std::size_t pieces = (points.size() - 1) / 3;
    return sampleCurve(
        [&, this](double t) -> Vector3d {
          const std::size_t piece =
              std::min(pieces - 1, static_cast<std::size_t>(t * static_cast<double>(pieces)));
          const double u = t * static_cast<double>(pieces) - static_cast<double>(piece), v = 1 - u;
          const Vector3d* p = &points[3 * piece];
          return place(v * v * v * p[0] + 3 * v * v * u * p[1] + 3 * v * u * u * p[2] +
                       u * u * u * p[3]);
        },
        [=](double t) { return scale * (from + t * (to - from)); });
  }

private:
  Frame m_frame;
  bool m_isLeft;
};

using Missing = std::set<std::string>;

/// A branch of the tree, or none where it is missing.
using MaybeBranch = std::optional<std::uint32_t>;

struct SideBranches {
  std::uint32_t carotid = 0;
  MaybeBranch anterior;
};

const std::vector<Vector3d> kFirstAnterior{{17, 20, 24}, {19, 16, 24}, {23, 14, 23}, {24, 12, 27}};
const std::vector<Vector3d> kSecondAnterior{
    {24, 12, 27}, {24.4, 10.8, 29.4}, {23, 9, 40}, {23, 9, 51}};
const std::vector<Vector3d> kFirstPosterior{
    {25.5, 32, 26}, {24, 31.4, 27}, {22.5, 31, 27}, {21, 31.2, 27}};
const std::vector<Vector3d> kSecondPosterior{
    {21, 31.2, 27}, {18, 31.6, 27}, {12, 36, 27}, {12, 51, 29}};

std::vector<Vector3d> joined(std::vector<Vector3d> first, const std::vector<Vector3d>& second) {
  first.insert(first.end(), second.begin() + 1, second.end());
  return first;
}

// Internal carotid, middle and anterior cerebral artery.
SideBranches addFront(const Side& side, const Missing& missing, TreeBuilder& builder) {
  const Vector3d top(17, 20, 24);
  SideBranches made;
  made.carotid = builder.add(
      side.name("ICA"), formats::kNoParent,
      side.curve({{15, 25, 0}, {15, 25, 8}, {18, 23, 16}, top}, kCarotid, 0.9 * kCarotid));
  const auto carotid = static_cast<std::int32_t>(made.carotid);
  builder.add(side.name("MCA"), carotid,
              side.curve({top, {12, 18, 27}, {7, 20, 26}, {0, 20, 26}}, kMiddle, 0.9 * kMiddle));
  if (!missing.contains(side.name("A1")))
    made.anterior =
        builder.add(side.name("ACA"), carotid,
                    side.curve(joined(kFirstAnterior, kSecondAnterior), kAnterior, kAnterior2));
  return made;
}

// Posterior cerebral artery, and the posterior communicating artery, which is linked to it.
void addBack(const Side& side, const Missing& missing, std::uint32_t basilar, std::uint32_t carotid,
             TreeBuilder& builder) {
  MaybeBranch posterior;
  if (!missing.contains(side.name("P1")))
    posterior =
        builder.add(side.name("PCA"), static_cast<std::int32_t>(basilar),
                    side.curve(joined(kFirstPosterior, kSecondPosterior), kPosterior, kPosterior2));
  if (missing.contains(side.name("Pcom"))) return;
  // on the carotid's axis, at four fifths of its curve's parameter
  const double u = 0.8, v = 1 - u;
  const Vector3d start = v * v * v * Vector3d(15, 25, 0) + 3 * v * v * u * Vector3d(15, 25, 8) +
                         3 * v * u * u * Vector3d(18, 23, 16) + u * u * u * Vector3d(17, 20, 24);
  const double radius = posterior ? kPosteriorLink : kPosterior;
  const std::uint32_t link = builder.add(
      side.name("Pcom"), static_cast<std::int32_t>(carotid),
      side.curve({start, {17, 27, 18}, {19.5, 30, 23}, kSecondPosterior.front()}, radius, radius));
  if (posterior)
    builder.link(link, *posterior);
  else
    builder.add(side.name("PCA"), static_cast<std::int32_t>(link),
                side.curve(kSecondPosterior, kPosterior, kPosterior2));
}

// The anterior communicating artery from `from`'s side, and what of the other side it feeds.
void addAcross(const Side& from, const Side& to, std::uint32_t begin, MaybeBranch end,
               TreeBuilder& builder) {
  const Vector3d first = kSecondAnterior.front(), last(kExtent - first.x(), first.y(), first.z());
  const Vector3d along = (last - first) / 3;
  const double radius = end ? kAnteriorLink : kAnterior;
  const std::uint32_t link =
      builder.add("Acom", static_cast<std::int32_t>(begin),
                  from.curve({first, first + along, last - along, last}, radius, radius));
  if (end)
    builder.link(link, *end);
  else
    builder.add(to.name("ACA"), static_cast<std::int32_t>(link),
                to.curve(kSecondAnterior, kAnterior, kAnterior2));
}

}  // namespace

const std::vector<std::string>& willisParts() {
  static const std::vector<std::string> names{"Acom", "L-A1",   "R-A1",  "L-P1",
                                              "R-P1", "L-Pcom", "R-Pcom"};
  return names;
}

Design designWillis(const Frame& frame, const std::set<std::string>& missing) {
  TreeBuilder builder(frame);
  const Side right(frame, false), left(frame, true);
  const SideBranches rightFront = addFront(right, missing, builder);
  const SideBranches leftFront = addFront(left, missing, builder);
  const std::uint32_t basilar = builder.add(
      "BA", formats::kNoParent,
      right.curve({{25, 36, 0}, {25, 36, 8}, {26.5, 33, 18}, {25.5, 32, 26}}, kBasilar, kBasilar));
  addBack(right, missing, basilar, rightFront.carotid, builder);
  addBack(left, missing, basilar, leftFront.carotid, builder);
  if (!missing.contains("Acom") && rightFront.anterior)
    addAcross(right, left, *rightFront.anterior, leftFront.anterior, builder);
  else if (!missing.contains("Acom") && leftFront.anterior)
    addAcross(left, right, *leftFront.anterior, std::nullopt, builder);
  return builder.design();
}

}  // namespace lumen::convert
