// SPDX-License-Identifier: Apache-2.0
// Vessels of a surface that comes with a centerline.
#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/base/error.h"
#include "converters/geometry/automatic_names.h"
#include "converters/stages/trees_from_surfaces/vessel_line.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kLeastInside = 0.5;  // share of the points: below, another frame or surface
constexpr double kLineEndDepths = 2;  // depths from a line's last point to the vessel's end

std::vector<std::uint8_t> markInside(const CenterlineFile& file, const LumenGeometry& lumen,
                                     const Vector3d& scale) {
  std::vector<std::uint8_t> inside(file.points.size());
  tbb::parallel_for(std::size_t{0}, inside.size(), [&](std::size_t i) {
    inside[i] = lumen.tree().contains(scale.cwiseProduct(file.points[i].position)) ? 1 : 0;
  });
  return inside;
}

std::size_t countOf(const std::vector<std::uint8_t>& inside) {
  return static_cast<std::size_t>(std::count(inside.begin(), inside.end(), 1));
}

/// A possible intended meaning of a centerline, and its remedy.
struct Meant {
  Vector3d scale;
  const char* how;
  const char* remedy;
};
const std::array<Meant, 5> kMeant = {{
    {{-1, -1, 1}, "with x and y negated", "centerline-frame ras reads it so"},
    {{10, 10, 10}, "if they were centimetres", "centerline-unit cm reads them so"},
    {{1000, 1000, 1000}, "if they were metres", "centerline-unit m reads them so"},
    {{-10, -10, 10},
     "if they were centimetres with x and y negated",
     "centerline-unit cm and centerline-frame ras read them so"},
    {{-1000, -1000, 1000},
     "if they were metres with x and y negated",
     "centerline-unit m and centerline-frame ras read them so"},
}};

/// Refuses a centerline that is not one of this surface.
void requireInside(const CenterlineFile& file, const std::string& name, const LumenGeometry& lumen,
                   std::size_t inside) {
  const std::size_t all = file.points.size();
  const auto least = static_cast<std::size_t>(kLeastInside * static_cast<double>(all));
  if (inside > least || inside == all) return;
  std::string text = name + ": " + std::to_string(inside) + " of its " + std::to_string(all) +
                     " points lie inside of the surface; expected most of them";
  for (const Meant& meant : kMeant) {
    const std::size_t would = countOf(markInside(file, lumen, meant.scale));
    if (would <= least) continue;
    throw invalidInput(text + "; " + meant.how + ", " +
                       (would == all ? "all" : std::to_string(would)) + " would: " + meant.remedy);
  }
  throw invalidInput(text + ": it belongs to another surface, or one of them is in another frame");
}

/// The part of a chain from its first point inside to its last.
std::vector<Vector3d> pointsInside(const CenterlineFile& file, const CenterlineChain& chain,
                                   const std::vector<std::uint8_t>& inside) {
  std::vector<Vector3d> points;
  std::size_t keep = 0;
  for (const std::int32_t i : chain.points) {
    const auto at = static_cast<std::size_t>(i);
    if (points.empty() && !inside[at]) continue;
    if (!points.empty() && points.back() == file.points[at].position) continue;
    points.push_back(file.points[at].position);
    if (inside[at]) keep = points.size();
  }
  points.resize(keep);
  return points;
}

}  // namespace

VesselLines clipLines(const CenterlineFile& centerline, const std::string& name,
                      const LumenGeometry& lumen) {
  const auto inside = markInside(centerline, lumen, Vector3d::Ones());
  const std::size_t count = countOf(inside);
  requireInside(centerline, name, lumen, count);
  VesselLines out;
  if (count < inside.size())
    out.notes.push_back(name + ": " + std::to_string(inside.size() - count) + " of its " +
                        std::to_string(inside.size()) +
                        " points lie outside of the surface; vessels end where they leave it");
  std::vector<int> lineOfChain;
  for (const CenterlineChain& chain : centerlineChains(centerline)) {
    VesselLine line;
    line.parent = chain.parent < 0 ? -1 : lineOfChain[static_cast<std::size_t>(chain.parent)];
    line.point = pointsInside(centerline, chain, inside);
    const VesselLine* parent =
        line.parent < 0 ? nullptr : &out.lines[static_cast<std::size_t>(line.parent)];
    if (parent && !line.point.empty())
      line.point.insert(line.point.begin(),
                        parent->point[distanceTo(parent->point, line.point.front()).second]);
    const double length = line.point.empty() ? 0 : lengthsAlong(line.point).back();
    if (line.point.size() < 2 || !(length > lumen.depth(line.point.front()))) {
      lineOfChain.push_back(line.parent);  // nothing of it leaves its parent
      continue;
    }
    lineOfChain.push_back(static_cast<int>(out.lines.size()));
    line.label = provisionalName(out.lines.size() + 1);
    centre(line, parent, lumen);
    if (!parent) extend(line, true, kLineEndDepths, lumen);
    extend(line, false, kLineEndDepths, lumen);
    measureDepths(line, lumen);
    out.lines.push_back(std::move(line));
  }
  if (out.lines.empty())
    throw invalidInput(name + ": no part of it is a way through the surface's inside");
  return out;
}

}  // namespace lumen::convert
