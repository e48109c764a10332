// SPDX-License-Identifier: Apache-2.0
#include "converters/io/seeds/place_seeds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <unordered_set>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/shown_text.h"
#include "converters/geometry/far_origin.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Voxels: the distance beyond the outermost centres at which a point is still in the outermost
/// voxel, and the distance inside of it at which the point is put, more than rounding takes back.
constexpr double kOutermost = 0.5, kJustInside = 1e-6;
/// The largest radius of a vessel as a share of the volume's longest side, and the smallest as a
/// share of its finest voxel edge.
constexpr double kWidest = 0.5, kThinnest = 0.1;
/// Share of the points: if at least this share lies inside, the others are mistakes of their own.
constexpr double kMostlyInside = 0.75;
/// mm: a smaller volume may be stated in metres.
constexpr double kSmallVolume = 10.0;

struct RadiusRange {
  double least, most;  ///< mm
  [[nodiscard]] bool has(double radius) const { return radius >= least && radius <= most; }
};

RadiusRange radiusRange(const VolumeGeometry& geometry) {
  double longest = 0;
  for (int a = 0; a < 3; ++a)
    longest = std::max(longest, geometry.spacing[a] * geometry.size[static_cast<std::size_t>(a)]);
  return {kThinnest * geometry.spacing.minCoeff(), kWidest * longest};
}

/// Indices held within the voxel centres' box, `margin` voxels from its faces.
Vector3d heldInside(const VolumeGeometry& geometry, Vector3d index, double margin) {
  for (int a = 0; a < 3; ++a) {
    const double last = geometry.size[static_cast<std::size_t>(a)] - 1;
    index[a] = last > 2 * margin ? std::clamp(index[a], margin, last - margin) : 0.5 * last;
  }
  return index;
}

bool isWithinVoxels(const VolumeGeometry& geometry, const Vector3d& index) {
  return ((index - heldInside(geometry, index, 0)).cwiseAbs().array() <= kOutermost).all();
}

/// Position in LPS mm, as stored in the branch; within a volume that was moved near 0, in its place.
Vector3d worldOf(const SeedBranch& branch, const Vector3d& position,
                 const VolumeGeometry& geometry) {
  if (branch.frame.system == SeedSystem::Voxel) return geometry.worldFromIndex(position);
  const Vector3d near = placeNear(geometry.origin, position);
  return isWithinVoxels(geometry, geometry.indexFromWorld(near)) ? near : position;
}

std::string outsideText(const Vector3d& world, const VolumeGeometry& geometry) {
  const Vector3d index = geometry.indexFromWorld(world);
  Vector3d low = geometry.origin, high = geometry.origin;
  for (int corner = 1; corner < 8; ++corner) {
    Vector3d at;
    for (int a = 0; a < 3; ++a)
      at[a] = (corner >> a & 1) != 0 ? geometry.size[static_cast<std::size_t>(a)] - 1 : 0;
    low = low.cwiseMin(geometry.worldFromIndex(at));
    high = high.cwiseMax(geometry.worldFromIndex(at));
  }
  const Vector3d nearest = geometry.worldFromIndex(heldInside(geometry, index, 0));
  return "lies " + shownNumber((world - nearest).norm()) + " mm outside of the volume: it is at " +
         vectorText(world) + " mm LPS (voxel " + vectorText(index) +
         "), and the volume reaches from " + vectorText(low) + " to " + vectorText(high) +
         " mm, in " + joinedNumbers(geometry.size, " x ") + " voxels";
}

std::string radiusText(double radius, const RadiusRange& range) {
  std::string text = "has a radius of " + shownNumber(radius) + " mm; expected " +
                     shownNumber(range.least) + " to " + shownNumber(range.most) +
                     " mm in this volume (a tenth of its finest voxel edge, half of its longest "
                     "side)";
  if (range.has(1e-3 * radius))
    text += "; in micrometres it would be one of " + shownNumber(1e-3 * radius) + " mm";
  if (range.has(1e3 * radius))
    text += "; in metres it would be one of " + shownNumber(1e3 * radius) + " mm";
  return text;
}

/// The reason why a point cannot be tracked; empty if it can.
std::optional<std::string> findFault(const Vector3d& world, const SeedPoint& point,
                                     const VolumeGeometry& geometry, const RadiusRange& range) {
  if (!isWithinVoxels(geometry, geometry.indexFromWorld(world)))
    return outsideText(world, geometry);
  if (point.radius && !range.has(*point.radius)) return radiusText(*point.radius, range);
  return std::nullopt;
}

// ---- other readings ----

/// Another reading of coordinates: in a stated system, in m or mm, or both.
struct OtherReading {
  std::optional<SeedSystem> system;
  std::optional<double> unit;  ///< mm
  const char* words;
};

constexpr double kMetre = 1000;
/// Metres first: as voxels, or flipped, all points may lie in the first voxel.
const std::array kOtherReadings = {
    OtherReading{{}, kMetre, "as metres"},
    OtherReading{SeedSystem::Ras, kMetre, "as metres in RAS (x and y flipped)"},
    OtherReading{SeedSystem::Lps, kMetre, "as metres in LPS (x and y flipped)"},
    OtherReading{SeedSystem::Ras, {}, "as RAS (x and y flipped)"},
    OtherReading{SeedSystem::Lps, {}, "as LPS (x and y flipped)"},
    OtherReading{SeedSystem::Voxel, {}, "as voxel indices"},
    OtherReading{{}, 1.0, "as millimetres"},
};

const char* frameWord(SeedSystem system) {
  switch (system) {
    case SeedSystem::Lps:
      return "lps";
    case SeedSystem::Ras:
      return "ras";
    case SeedSystem::Voxel:
      break;
  }
  return "voxel";
}

/// The fields that select a reading: "seeds-frame ras seeds-unit m".
std::string optionsOf(const OtherReading& reading, const FieldWord& word) {
  std::string text;
  if (reading.system) text = word("seeds-frame") + " " + frameWord(*reading.system);
  if (!reading.unit) return text;
  return text + (text.empty() ? "" : " ") + word("seeds-unit") +
         (*reading.unit == kMetre ? " m" : " mm");
}

Vector3d asInFile(const SeedFrame& frame, const Vector3d& position) {
  return frame.direction(position) / (frame.system == SeedSystem::Voxel ? 1.0 : frame.unit);
}

/// Position in LPS mm, under another reading of the branch's file.
Vector3d reread(const SeedBranch& branch, const Vector3d& position, const OtherReading& reading,
                const VolumeGeometry& geometry) {
  SeedBranch read;
  read.frame = {reading.system.value_or(branch.frame.system),
                reading.unit.value_or(branch.frame.unit)};
  return worldOf(read, read.frame.position(asInFile(branch.frame, position)), geometry);
}

template <class WorldOf>
std::size_t countInside(const std::vector<SeedBranch>& seeds, const VolumeGeometry& geometry,
                        WorldOf world) {
  std::size_t inside = 0;
  for (const SeedBranch& branch : seeds)
    for (const SeedPoint& point : branch.points)
      if (isWithinVoxels(geometry, geometry.indexFromWorld(world(branch, point.position))))
        ++inside;
  return inside;
}

std::string insideText(std::size_t inside, std::size_t points) {
  if (points == 1) return "its point would lie inside; if that is what it is, add ";
  return (inside == points ? "all " + std::to_string(points)
                           : std::to_string(inside) + " of the " + std::to_string(points)) +
         " points would lie inside; if that is what they are, add ";
}

bool isAtZero(const SeedBranch& branch) {
  return std::all_of(branch.points.begin(), branch.points.end(),
                     [](const SeedPoint& point) { return point.position.isZero(0); });
}

/// True if all points lie within a voxel of the origin: metres taken for millimetres do, and that
/// place may be inside of the volume. Points at 0, 0, 0 lie there in every unit.
bool allAtOrigin(const std::vector<SeedBranch>& seeds, const VolumeGeometry& geometry) {
  const double edge = geometry.spacing.maxCoeff();
  if (std::all_of(seeds.begin(), seeds.end(), isAtZero)) return false;
  return std::all_of(seeds.begin(), seeds.end(), [&](const SeedBranch& branch) {
    return branch.frame.system != SeedSystem::Voxel &&
           std::all_of(branch.points.begin(), branch.points.end(),
                       [&](const SeedPoint& point) { return point.position.norm() < edge; });
  });
}

/// The reading under which most points lie inside, if their number exceeds `inside`; only metres
/// are tried if the caller asks for these alone.
std::string adviceFor(const std::vector<SeedBranch>& seeds, const VolumeGeometry& geometry,
                      std::size_t points, std::size_t inside, bool onlyMetres,
                      const FieldWord& word) {
  const std::size_t asStated = inside;
  std::string advice;
  for (const OtherReading& other : kOtherReadings) {
    if (onlyMetres && other.unit != kMetre) continue;
    const std::size_t count =
        countInside(seeds, geometry, [&](const SeedBranch& branch, const Vector3d& position) {
          return reread(branch, position, other, geometry);
        });
    if (count <= inside) continue;
    inside = count;
    advice = std::string("read ") + other.words + " " + insideText(count, points) +
             optionsOf(other, word);
  }
  const double side = 2 * radiusRange(geometry).most;
  if (onlyMetres || asStated > 0 || side >= kSmallVolume) return advice;
  VolumeGeometry metres = geometry;
  metres.spacing *= kMetre;
  metres.origin *= kMetre;
  const std::size_t count =
      countInside(seeds, metres, [&](const SeedBranch& branch, const Vector3d& position) {
        return worldOf(branch, position, metres);
      });
  if (count <= inside) return advice;
  return "the volume is only " + shownNumber(side) + " mm long; with its header read as metres " +
         insideText(count, points) + word("unit") + " m";
}

// ---- placing ----

class Placing {
public:
  Placing(const std::vector<SeedBranch>& seeds, const VolumeGeometry& geometry,
          const FieldWord& word)
      : m_geometry(geometry), m_range(radiusRange(geometry)) {
    std::size_t points = 0;
    for (const SeedBranch& branch : seeds) {
      place(branch);
      points += branch.points.size();
    }
    const std::size_t inside =
        countInside(seeds, geometry, [&](const SeedBranch& branch, const Vector3d& position) {
          return worldOf(branch, position, geometry);
        });
    if (static_cast<double>(inside) < kMostlyInside * static_cast<double>(points))
      placed.advice = adviceFor(seeds, geometry, points, inside, false, word);
    else if (inside == points && allAtOrigin(seeds, geometry))
      placed.advice = adviceFor(seeds, geometry, points, 0, true, word);
  }

  PlacedSeeds placed;
  std::string firstFault;  ///< fault of a branch, with its label

private:
  void place(const SeedBranch& branch) {
    if (branch.parent && m_leftOut.contains(*branch.parent))
      return leaveOut(branch, "its parent " + quotedText(*branch.parent) + " is left out");
    SeedBranch out = branch;
    out.points.clear();
    out.frame = {};
    toMillimetres(branch, out);
    std::vector<std::string> faults;
    for (std::size_t i = 0; i < branch.points.size(); ++i) placePoint(branch, i, out, faults);
    if (out.points.empty()) return leaveOut(branch, faults.front());
    for (std::string& fault : faults) placed.leftPoints.push_back({branch.label, std::move(fault)});
    placed.seeds.push_back(std::move(out));
  }

  /// The direction of `branch`; a direction in voxels is converted by the volume.
  void toMillimetres(const SeedBranch& branch, SeedBranch& out) const {
    if (branch.frame.system != SeedSystem::Voxel || !branch.direction) return;
    out.direction =
        (m_geometry.direction * m_geometry.spacing.cwiseProduct(*branch.direction)).normalized();
  }

  void placePoint(const SeedBranch& branch, std::size_t i, SeedBranch& out,
                  std::vector<std::string>& faults) {
    SeedPoint point = branch.points[i];
    point.position = worldOf(branch, point.position, m_geometry);
    if (const auto fault = findFault(point.position, point, m_geometry, m_range)) {
      faults.push_back("point " + std::to_string(i + 1) + " " + *fault);
      if (firstFault.empty())
        firstFault = "branch " + quotedText(branch.label) + ": " + faults.back();
      return;
    }
    const Vector3d index = m_geometry.indexFromWorld(point.position);
    if (!m_geometry.containsIndex(index))
      point.position = m_geometry.worldFromIndex(heldInside(m_geometry, index, kJustInside));
    out.points.push_back(point);
  }

  void leaveOut(const SeedBranch& branch, const std::string& reason) {
    m_leftOut.insert(branch.label);
    placed.leftOut.push_back({branch.label, reason});
  }

  const VolumeGeometry& m_geometry;
  RadiusRange m_range;
  std::unordered_set<std::string> m_leftOut;
};

}  // namespace

std::vector<RereadSeeds> otherReadings(const std::vector<SeedBranch>& seeds,
                                       const VolumeGeometry& geometry, const FieldWord& word) {
  std::vector<RereadSeeds> all;
  for (const OtherReading& other : kOtherReadings) {
    all.push_back({other.words, optionsOf(other, word), seeds});
    for (SeedBranch& branch : all.back().seeds) {
      for (SeedPoint& point : branch.points)
        point.position = reread(branch, point.position, other, geometry);
      branch.frame = {};
    }
  }
  return all;
}

PlacedSeeds placeSeeds(const std::vector<SeedBranch>& seeds, const VolumeGeometry& geometry,
                       const std::filesystem::path& file, const FieldWord& word) {
  Placing placing(seeds, geometry, word);
  PlacedSeeds& placed = placing.placed;
  const std::string advice = placed.advice.empty() ? "" : "; " + placed.advice;
  const std::string name = formats::printable(file.string()) + ": ";
  const std::string none = seeds.size() == 1 ? "its seed cannot be tracked: "
                                             : "none of its " + std::to_string(seeds.size()) +
                                                   " seeds can be tracked; the first, ";
  if (placed.seeds.empty()) throw invalidInput(name + none + placing.firstFault + advice);
  return std::move(placed);
}

}  // namespace lumen::convert
