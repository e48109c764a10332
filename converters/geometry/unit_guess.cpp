// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/unit_guess.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "converters/base/number_text.h"
#include "converters/geometry/disjoint_sets.h"
#include "converters/geometry/mesh_edges.h"
#include "converters/geometry/mesh_measures.h"

namespace lumen::convert {

namespace {

/// Mean radii of whole models and the diagonals of their boxes, mm.
struct KnownVessels {
  double leastRadius, mostRadius, leastDiagonal, mostDiagonal;
};
/// Diameters by Caro et al., The mechanics of the circulation, 2012; of an aneurysm the mean counts;
/// lengths from a single fork to the whole of the region.
constexpr std::array<KnownVessels, 3> kKnown = {{
    {0.3, 3, 5, 250},   // arteries of the brain, the heart and the organs
    {1.5, 6, 20, 700},  // arteries of the neck and the limbs
    {4, 16, 50, 700},   // the aorta with its branches
}};
constexpr double kLeastRadius = 0.2, kMostRadius = 30;      // mm, of any vessel
constexpr double kLeastDiagonal = 3, kMostDiagonal = 2000;  // mm

struct Unit {
  const char* name;
  double millimetres;
};
constexpr std::array<Unit, 3> kUnits = {{{"mm", 1}, {"m", 1000}, {"cm", 10}}};
/// Units of microscopes, for vessels that have no possible size in the others: vessels of any size, or
/// those of a microscope's field, from capillaries on.
constexpr std::array<Unit, 2> kSmallUnits = {{{"um", 1e-3}, {"nm", 1e-6}}};
constexpr double kLeastSeenRadius = 1e-3, kLeastSeenDiagonal = 0.01;  // mm

bool isKnown(const VesselSize& size, double mm) {
  return std::any_of(kKnown.begin(), kKnown.end(), [&](const KnownVessels& known) {
    return size.radius * mm >= known.leastRadius && size.radius * mm <= known.mostRadius &&
           size.diagonal * mm >= known.leastDiagonal && size.diagonal * mm <= known.mostDiagonal;
  });
}

/// Without a radius the box alone counts.
bool isBetween(const VesselSize& size, double mm, double leastRadius, double leastDiagonal) {
  return size.diagonal * mm >= leastDiagonal && size.diagonal * mm <= kMostDiagonal &&
         (std::isnan(size.radius) ||
          (size.radius * mm >= leastRadius && size.radius * mm <= kMostRadius));
}

bool isPossible(const VesselSize& size, double mm) {
  return isBetween(size, mm, kLeastRadius, kLeastDiagonal);
}

bool isSeen(const VesselSize& size, double mm) {
  return isBetween(size, mm, kLeastSeenRadius, kLeastSeenDiagonal);
}

double millimetresOf(const std::string& unit) {
  for (const Unit& one : kUnits)
    if (unit == one.name) return one.millimetres;
  return 1;
}

/// The signed volume with a fan over each opening, from the middle of the ends of its edges.
double volumeWithFans(const TriangleMesh& mesh) {
  std::vector<std::array<std::uint32_t, 2>> rim;  // edges against the direction of their triangles
  forEachEdge(edgeUses(mesh.triangle), [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 1)
      rim.push_back({endOf(mesh.triangle, edge[0].side), startOf(mesh.triangle, edge[0].side)});
  });
  DisjointSets loops(mesh.position.size());
  for (const auto& [a, b] : rim) loops.join(a, b);
  std::map<std::uint32_t, std::pair<Eigen::Vector3d, double>> sums;
  for (const auto& [a, b] : rim) {
    auto& [sum, count] =
        sums.try_emplace(loops.find(a), Eigen::Vector3d::Zero(), 0.0).first->second;
    sum += mesh.position[a];
    count += 1;
  }
  double volume = signedVolume(mesh);
  for (const auto& [a, b] : rim) {
    const auto& [sum, count] = sums.at(loops.find(a));
    volume += mesh.position[a].cross(mesh.position[b]).dot(sum / count) / 6;
  }
  return volume;
}

/// "vessels of 9.1 mm radius in a box of 250 mm".
std::string sizeText(const VesselSize& size, double mm) {
  if (std::isnan(size.radius))
    return "vessels in a box of " + shownNumber(size.diagonal * mm, 3) + " mm";
  return "vessels of " + shownNumber(size.radius * mm, 3) + " mm radius in a box of " +
         shownNumber(size.diagonal * mm, 3) + " mm";
}

}  // namespace

VesselSize vesselSize(const TriangleMesh& mesh) {
  Eigen::Vector3d low = mesh.position[mesh.triangle.front()[0]], high = low;
  double area = 0;
  for (const Triangle& t : mesh.triangle) {
    const Eigen::Vector3d& a = mesh.position[t[0]];
    area += 0.5 * (mesh.position[t[1]] - a).cross(mesh.position[t[2]] - a).norm();
    for (const std::uint32_t v : t) {
      low = low.cwiseMin(mesh.position[v]);
      high = high.cwiseMax(mesh.position[v]);
    }
  }
  return {area > 0 ? 2 * std::abs(volumeWithFans(mesh)) / area : 0, (high - low).norm()};
}

UnitGuess guessUnit(const VesselSize& size, bool isSimVascular) {
  std::vector<Unit> fit;
  for (const Unit& unit : kUnits)
    if (isKnown(size, unit.millimetres)) fit.push_back(unit);
  if (isSimVascular)  // whose usual units are cm, g and s
    std::stable_partition(fit.begin(), fit.end(),
                          [](const Unit& unit) { return unit.millimetres == 10; });
  if (!fit.empty())
    return {fit.front().millimetres, fit.front().name, true, fit.size() > 1 ? fit[1].name : ""};
  for (const Unit& unit : kUnits)
    if (isPossible(size, unit.millimetres)) return {unit.millimetres, unit.name, true, ""};
  for (const Unit& unit : kSmallUnits)
    if (isSeen(size, unit.millimetres)) return {unit.millimetres, unit.name, true, ""};
  return {1, "mm", false, ""};
}

std::string unitWarning(const UnitGuess& guess, const VesselSize& size, bool isSimVascular,
                        const FieldWord& word) {
  const std::string taken = "the file states no unit; taken to be in " + guess.unit;
  const std::string option = "; " + word("unit") + " states the unit";
  if (!guess.plausible)
    return taken + ", although " + sizeText(size, 1) + " are implausible, and in cm and m, too" +
           option;
  const std::string why =
      isSimVascular && guess.unit == "cm" ? ", as models of SimVascular usually are" : "";
  if (!guess.other.empty())
    return taken + why + ": " + sizeText(size, guess.millimetres) + "; in " + guess.other +
           " they would be plausible, too: " + sizeText(size, millimetresOf(guess.other)) + option;
  if (guess.millimetres == 1) return "";
  return taken + why + ": " + sizeText(size, guess.millimetres) + "; in mm they would be " +
         sizeText(size, 1) + option;
}

std::string statedWarning(const VesselSize& numbers, double millimetres, UnitBy by,
                          const FieldWord& word) {
  const bool isStandard = by == UnitBy::StandardOfGltf;
  if (isPossible(numbers, millimetres) || (!isStandard && isSeen(numbers, millimetres))) return "";
  const UnitGuess guess = guessUnit(numbers);
  const std::string taken =
      std::string("by the ") + (isStandard ? "standard of glTF" : "unit that it states") +
      " it holds " + sizeText(numbers, millimetres) + ", which are implausible";
  const std::string option = "; " + word("unit") + " states the unit";
  if (!guess.plausible || guess.millimetres == millimetres) return taken + option;
  return taken + "; in " + guess.unit + " they would be " + sizeText(numbers, guess.millimetres) +
         option;
}

}  // namespace lumen::convert
