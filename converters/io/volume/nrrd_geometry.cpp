// SPDX-License-Identifier: Apache-2.0
// Declared in image_header.h.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string_view>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/options/parsed_number.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/io/volume/image_header.h"
#include "converters/io/volume/volume_checks.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Summed in Teem's order, so that the last bit is equal.
double lengthOf(const Vector3d& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

struct Axis {
  std::size_t number = 0;  ///< in the header, from 0
  std::int64_t size = 0;
  std::optional<Vector3d> direction;  ///< in the header's space and unit
  bool isOfVolumes = false;           ///< its kind is no axis of space
};

/// Coordinate system that the field "space" states.
struct Space {
  std::size_t dimension = 0;  ///< 0: none
  Vector3d toLps = Vector3d::Ones();
};

Space anatomicalSpace(const TextHeader& header, std::vector<std::string>& assumptions) {
  std::string name = lowerCase(header.text("space"));
  std::erase_if(name, [](char c) { return c == '-' || c == ' '; });
  Space space{3};
  if (name.ends_with("time")) {
    space.dimension = 4;
    name.resize(name.size() - 4);
  } else if (name == "rast" || name == "last" || name == "lpst") {
    space.dimension = 4;
    name.pop_back();
  }
  if (name == "leftposteriorsuperior" || name == "lps") return space;
  if (name == "rightanteriorsuperior" || name == "ras") {
    space.toLps = Vector3d(-1, -1, 1);
  } else if (name == "leftanteriorsuperior" || name == "las") {
    space.toLps = Vector3d(1, -1, 1);
  } else if (name == "scannerxyz" || name == "3drighthanded" || name == "3dlefthanded") {
    assumptions.push_back("its space is " + quotedText(header.text("space")) +
                          ", which does not state where the patient's left, back and head are; its "
                          "axes are taken to run there (LPS)");
  } else {
    throw header.refusal("space",
                         "left-posterior-superior, right-anterior-superior or another of NRRD's");
  }
  return space;
}

Space readSpace(const TextHeader& header, std::vector<std::string>& assumptions) {
  const std::int64_t dimension = header.integer("space dimension", 1, 8, 0);
  Space space{static_cast<std::size_t>(dimension)};
  if (header.has("space")) {
    space = anatomicalSpace(header, assumptions);
    if (dimension != 0 && static_cast<std::size_t>(dimension) != space.dimension)
      throw header.refusal("space dimension",
                           "that of its space " + quotedText(header.text("space")));
  } else {
    assumptions.emplace_back(
        "its header states no space, so its axes are taken as left, posterior and superior");
  }
  if (space.dimension != 0 && space.dimension != 3 && space.dimension != 4)
    throw header.refusal("space dimension", "3");
  return space;
}

/// The vectors of "(1,0,0) none (0,0,1)", `dimension` numbers each; empty for none and for NaN.
std::vector<std::optional<Vector3d>> readVectors(const TextHeader& header, const std::string& field,
                                                 std::size_t dimension) {
  const std::string& text = header.text(field);
  const auto refused = [&] {
    return header.refusal(
        field, "vectors such as (1,0,0), of " + std::to_string(dimension) + " finite numbers");
  };
  std::vector<std::optional<Vector3d>> vectors;
  for (std::size_t at = 0; (at = text.find_first_not_of(" \t", at)) != std::string::npos;) {
    if (text.compare(at, 4, "none") == 0) {
      vectors.emplace_back();
      at += 4;
      continue;
    }
    const std::size_t end = text.find(')', at);
    if (text[at] != '(' || end == std::string::npos) throw refused();
    std::vector<double> values;
    for (const std::string& word : splitWords(text.substr(at + 1, end - at - 1), ", \t"))
      values.push_back(parsedNumber(word).value_or(std::numeric_limits<double>::infinity()));
    if (values.size() != dimension) throw refused();
    const bool none = std::all_of(values.begin(), values.end(), [](double v) { return v != v; });
    for (const double value : values)
      if (!none && !std::isfinite(value)) throw refused();
    vectors.emplace_back();
    const Vector3d vector(values[0], values[1], values[2]);
    const bool isOfTime = dimension == 4 && field != "space origin" && values[3] != 0;
    if (isOfTime && !vector.isZero(0)) throw refused();  // space that moves with time
    if (!none && !isOfTime) vectors.back() = vector;
    at = end + 1;
  }
  return vectors;
}

/// Kinds of axes whose entries are volumes, and of those that are volumes to whoever chooses one.
constexpr std::array<std::string_view, 2> kVolumeKinds = {"list", "time"};
constexpr std::array<std::string_view, 3> kVectorKinds = {"vector", "point", "covariant-vector"};

template <std::size_t count>
bool isKind(const std::string& kind, const std::array<std::string_view, count>& kinds) {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

/// The axes without the axes of a voxel's components.
std::vector<Axis> domainAxes(const TextHeader& header, const std::vector<std::int64_t>& sizes,
                             const ReadVolumeOptions& options) {
  const std::vector<std::string> kinds = splitWords(header.text("kinds"));
  if (!kinds.empty() && kinds.size() != sizes.size())
    throw header.refusal("kinds", std::to_string(sizes.size()) + " kinds");
  std::vector<Axis> axes;
  for (std::size_t a = 0; a < sizes.size(); ++a) {
    const std::string kind = kinds.empty() ? "???" : lowerCase(kinds[a]);
    const bool domain =
        kind == "domain" || kind == "space" || kind == "time" || kind == "???" || kind == "none";
    const bool isVector = isKind(kind, kVectorKinds);
    const bool isOfVolumes =
        isKind(kind, kVolumeKinds) || (isVector && options.volumeIndex.has_value());
    if (domain || (isOfVolumes && sizes[a] != 1)) axes.push_back({a, sizes[a], {}, isOfVolumes});
    if (!domain && !isOfVolumes && sizes[a] != 1)
      throw invalidInput(
          header.path().string() + ": each voxel has " + std::to_string(sizes[a]) +
          " components (" + formats::printable(kind) + "); expected one number" +
          (isVector ? ", or a choice of one with " + options.word("volume-index") : std::string()));
  }
  return axes;
}

/// The three axes of the volume. Further axes are dropped: those of one entry without a direction
/// first, those of volumes, others without a direction where axes have some, then the slowest.
std::vector<Axis> spatialAxes(const TextHeader& header, const std::vector<std::int64_t>& sizes,
                              const Space& space, const ReadVolumeOptions& options) {
  std::vector<Axis> axes = domainAxes(header, sizes, options);
  const auto dropExtra = [&](const auto& isDropped) {
    std::size_t extra = axes.size() > 3 ? axes.size() - 3 : 0;
    std::erase_if(axes,
                  [&](const Axis& axis) { return isDropped(axis) && extra > 0 && extra-- > 0; });
  };
  if (header.has("space directions")) {
    if (space.dimension == 0)
      throw invalidInput(header.path().string() +
                         ": its header states space directions, but no space; expected one, such "
                         "as left-posterior-superior");
    const auto vectors = readVectors(header, "space directions", space.dimension);
    if (vectors.size() != sizes.size())
      throw header.refusal("space directions", std::to_string(sizes.size()) + " vectors");
    for (Axis& axis : axes) axis.direction = vectors[axis.number];
    dropExtra([](const Axis& axis) { return !axis.direction && axis.size == 1; });
  }
  dropExtra([](const Axis& axis) { return axis.isOfVolumes && !axis.direction; });
  if (header.has("space directions")) dropExtra([](const Axis& axis) { return !axis.direction; });
  while (axes.size() > 3 && (axes.back().size == 1 || !axes.back().direction)) axes.pop_back();
  if (axes.size() == 3) return axes;
  refuseDimensions(header.path(), static_cast<unsigned>(axes.size()), joinedNumbers(sizes, " x "));
}

/// Voxels of one volume that lie together: those before the first axis of several entries that is
/// none of the volume's `axes`; 0 if such axes come last. Refuses such axes in two places.
std::uint64_t togetherOf(const TextHeader& header, const std::vector<std::int64_t>& sizes,
                         const std::vector<Axis>& axes) {
  std::uint64_t before = 1;
  std::size_t changes = 0;  // between axes of the volume and others
  std::uint64_t together = 0;
  bool wasOther = false;
  for (std::size_t a = 0; a < sizes.size(); ++a) {
    if (sizes[a] == 1) continue;
    const bool isOther =
        std::none_of(axes.begin(), axes.end(), [&](const Axis& axis) { return axis.number == a; });
    if (isOther && !wasOther) together = before;
    if (a > 0) changes += isOther != wasOther ? 1 : 0;
    wasOther = isOther;
    before *= static_cast<std::uint64_t>(sizes[a]);
  }
  const bool isLast = wasOther || together == 0;
  if (changes > 2 || (isLast && changes > 1))
    refuseDimensions(header.path(), static_cast<unsigned>(sizes.size()),
                     joinedNumbers(sizes, " x "));
  return isLast ? 0 : together;
}

/// The mm of the units that `field` quotes for the `numbers`; NaN for an unknown unit.
std::vector<double> readUnits(const TextHeader& header, const std::string& field,
                              const std::vector<std::size_t>& numbers, const FieldWord& word,
                              std::vector<std::string>& assumptions) {
  std::vector<std::string> names;
  const std::string& text = header.text(field);
  for (std::size_t at = text.find('"'); at != std::string::npos; at = text.find('"', at)) {
    const std::size_t end = text.find('"', at + 1);
    if (end == std::string::npos) throw header.refusal(field, "names in quotes");
    names.push_back(text.substr(at + 1, end - at - 1));
    at = end + 1;
  }
  std::vector<double> units;
  for (const std::size_t number : numbers) {
    if (number >= names.size()) throw header.refusal(field, "a name in quotes for each axis");
    if (trimmed(names[number]).empty()) continue;
    const auto unit = millimetresPer(names[number]);
    units.push_back(unit.value_or(kNaN));
  }
  const bool known = std::none_of(units.begin(), units.end(), [](double u) { return u != u; });
  if (known && (units.empty() || units.size() == numbers.size())) return units;
  assumptions.push_back(
      "its " + field + " are " + formats::printable(text) +
      ", which are not all known as lengths, so they are taken to be mm; state the unit with " +
      word("unit"));
  return {};
}

/// Scales everything to mm if the header states its units.
void settleUnits(const TextHeader& header, std::vector<Axis>& axes, const FieldWord& word,
                 StatedGeometry& stated, std::vector<std::string>& assumptions) {
  // units of axes beside directions, which NRRD does not foresee, are those of the axes, too
  const bool oriented = axes[0].direction.has_value() && header.has("space units");
  const std::string field = oriented ? "space units" : "units";
  if (!header.has(field)) return;
  std::vector<std::size_t> numbers = {0, 1, 2};
  if (!oriented) numbers = {axes[0].number, axes[1].number, axes[2].number};
  const auto units = readUnits(header, field, numbers, word, assumptions);
  if (units.empty()) return;
  if (units[0] != units[1] || units[0] != units[2])
    throw header.refusal(field, "one unit for all axes; state it with " + word("unit"));
  stated.unit = units[0];
}

/// The place of the first voxel along axes without directions: in the middle of its cell, unless
/// the header states that positions are those of voxels (Teem's rule).
void originOfAxisMins(const TextHeader& header, const std::vector<Axis>& axes, std::size_t count,
                      StatedGeometry& stated) {
  const auto mins = header.numbers("axis mins", count);
  const auto maxs = header.numbers("axis maxs", count);
  const auto centers = splitWords(lowerCase(header.text("centers")));
  if (mins.empty()) return;
  Vector3d origin;
  for (std::size_t a = 0; a < 3; ++a) {
    const Axis& axis = axes[a];
    const auto e = static_cast<Eigen::Index>(a);
    const bool node = axis.number < centers.size() && centers[axis.number] == "node";
    double& spacing = stated.geometry.spacing[e];
    if (std::isnan(spacing) && !maxs.empty())
      spacing = (maxs[axis.number] - mins[axis.number]) /
                static_cast<double>(node ? std::max<std::int64_t>(axis.size - 1, 1) : axis.size);
    origin[e] = mins[axis.number] + (node ? 0 : spacing / 2);
  }
  if (origin.allFinite()) stated.geometry.origin = origin;
}

void settleSpacings(const TextHeader& header, const std::vector<Axis>& axes, std::size_t count,
                    const ReadVolumeOptions& options, StatedGeometry& stated) {
  const auto spacings = header.numbers("spacings", count);
  for (std::size_t a = 0; a < 3; ++a) {
    const auto e = static_cast<Eigen::Index>(a);
    double& spacing = stated.geometry.spacing[e];
    const bool has = !spacings.empty() && !std::isnan(spacings[axes[a].number]);
    if (has && axes[a].direction)
      throw invalidInput(header.path().string() +
                         ": its header states both spacings and space "
                         "directions; expected one of them");
    const bool directed = axes[a].direction.has_value();
    if (directed)
      spacing = lengthOf(*axes[a].direction);
    else if (has)
      spacing = spacings[axes[a].number];
    if (!options.spacing && (has || directed))
      checkStatedSpacing(header.path(), directed ? "space directions" : "spacings",
                         static_cast<int>(a) + 1, spacing, options.word);
  }
}

void settleDirections(const TextHeader& header, const std::vector<Axis>& axes, const Space& space,
                      VolumeGeometry& geometry) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (!axes[a].direction) throw header.refusal("space directions", "vectors for three axes");
    const Vector3d& v = *axes[a].direction;
    geometry.direction.col(static_cast<Eigen::Index>(a)) =
        space.toLps.cwiseProduct(v) * (1.0 / lengthOf(v));
  }
}

void settleOrigin(const TextHeader& header, const Space& space, VolumeGeometry& geometry,
                  std::vector<std::string>& assumptions) {
  if (space.dimension == 0)
    throw invalidInput(header.path().string() +
                       ": its header states a space origin, but no space; expected one, such as "
                       "left-posterior-superior");
  const auto origins = readVectors(header, "space origin", space.dimension);
  if (origins.size() != 1) throw header.refusal("space origin", "one vector");
  if (origins[0])
    geometry.origin = space.toLps.cwiseProduct(*origins[0]);
  else
    assumptions.emplace_back(
        "its space origin is not known, so the first voxel is taken to be at 0, 0, 0 mm");
}

}  // namespace

StatedGeometry nrrdGeometry(const TextHeader& header, const std::vector<std::int64_t>& sizes,
                            const ReadVolumeOptions& options,
                            std::vector<std::string>& assumptions) {
  const Space space = readSpace(header, assumptions);
  std::vector<Axis> axes = spatialAxes(header, sizes, space, options);
  StatedGeometry stated;
  (void)volumeSize(header.path(), sizes);  // only checks
  stated.geometry.size = volumeSize(header.path(), {axes[0].size, axes[1].size, axes[2].size});
  stated.together = togetherOf(header, sizes, axes);
  stated.geometry.spacing.setConstant(kNaN);
  settleSpacings(header, axes, sizes.size(), options, stated);
  const bool oriented = std::any_of(axes.begin(), axes.end(),
                                    [](const Axis& axis) { return axis.direction.has_value(); });
  if (oriented) settleDirections(header, axes, space, stated.geometry);
  if (header.has("space origin"))
    settleOrigin(header, space, stated.geometry, assumptions);
  else if (!oriented)
    originOfAxisMins(header, axes, sizes.size(), stated);
  if (!options.unit) settleUnits(header, axes, options.word, stated, assumptions);
  return stated;
}

}  // namespace lumen::convert
