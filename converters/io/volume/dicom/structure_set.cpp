// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/dicom/structure_set.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include <Eigen/Geometry>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/base/vectors.h"
#include "converters/io/volume/dicom/dicom_stack.h"
#include "converters/io/volume/dicom/dicom_tree.h"
#include "converters/io/volume/dicom/painted_labels.h"
#include "converters/io/volume/upright_grid.h"
#include "converters/io/volume/volume_checks.h"

namespace lumen::convert {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr DicomTag kRoiFrames = 0x30060010, kStudies = 0x30060012, kReferredItems = 0x30060014,
                   kReferredSeries = 0x0020000e, kRois = 0x30060020, kRoiNumber = 0x30060022,
                   kContoursOfRois = 0x30060039, kRoiOfContours = 0x30060084,
                   kContours = 0x30060040, kGeometry = 0x30060042, kPoints = 0x30060050;

constexpr double kParallel = 1e-3;  // of a unit normal, and of a contour's size off its plane
constexpr double kOnePlane = 1e-3;  // mm
constexpr double kOnCentre = 0.01;  // pixels: positions are rounded
// Voxels of a grid of contours' own, as many as 512 x 512 x 1024, and its slices, those of 2 m at 0.2 mm.
constexpr double kMostOwnVoxels = 1 << 28, kMostPlanes = 1e4;

using Contour = std::vector<Vector3d>;

struct Structure {
  std::size_t label = 0;
  std::vector<Contour> contours;
};

struct StructureSet {
  std::vector<Structure> structures;
  std::vector<std::string> series;  ///< that the file refers to
  std::size_t left = 0;             ///< contours that enclose nothing
};

Contour pointsOf(const DicomItem& item, const InputFile& file) {
  const std::vector<double> numbers = parseNumbers(item.text(kPoints));
  if (numbers.empty() || numbers.size() % 3 != 0)
    throw invalidInput(file.path().string() + ": its contour data " + tagText(kPoints) + " have " +
                       std::to_string(numbers.size()) +
                       " numbers; expected x, y and z of each point");
  Contour points;
  for (std::size_t n = 0; n < numbers.size(); n += 3) {
    points.emplace_back(numbers[n], numbers[n + 1], numbers[n + 2]);
    if (!isWithin(points.back(), 1e9))
      throw invalidInput(file.path().string() + ": its contour data " + tagText(kPoints) +
                         " have a point that is not finite or beyond 1e9 mm; expected places of a "
                         "body");
  }
  return points;
}

StructureSet readSet(const InputFile& file) {
  const DicomTree tree = readDicomTree(file, {kRoiFrames, kRois, kContoursOfRois});
  StructureSet set;
  for (const DicomItem& frame : tree.top.items(kRoiFrames))
    for (const DicomItem& study : frame.items(kStudies))
      for (const DicomItem& series : study.items(kReferredItems))
        set.series.push_back(series.text(kReferredSeries));
  std::map<std::string, std::size_t> labels;
  const std::vector<DicomSegment> segments = dicomSegments(file);
  const std::vector<DicomItem>& rois = tree.top.items(kRois);
  for (std::size_t n = 0; n < rois.size() && n < segments.size(); ++n)
    labels[rois[n].text(kRoiNumber)] = segments[n].number;
  for (const DicomItem& item : tree.top.items(kContoursOfRois)) {
    const auto label = labels.find(item.text(kRoiOfContours));
    if (label == labels.end())
      throw invalidInput(file.path().string() + ": has contours of the structure \"" +
                         formats::printable(item.text(kRoiOfContours)) + "\" " +
                         tagText(kRoiOfContours) + ", which its list of structures " +
                         tagText(kRois) + " lacks");
    Structure structure{label->second, {}};
    for (const DicomItem& contour : item.items(kContours)) {
      Contour points = pointsOf(contour, file);
      if (contour.text(kGeometry).starts_with("CLOSED_PLANAR") && points.size() > 2)
        structure.contours.push_back(std::move(points));
      else
        ++set.left;
    }
    if (!structure.contours.empty()) set.structures.push_back(std::move(structure));
  }
  return set;
}

/// The normal of a contour, as long as twice its area (Newell's).
Vector3d normalOf(const Contour& contour) {
  Vector3d normal = Vector3d::Zero();
  for (std::size_t n = 0; n < contour.size(); ++n)
    normal += (contour[n] - contour[0]).cross(contour[(n + 1) % contour.size()] - contour[0]);
  return normal;
}

/// The normal of all contours, with a positive greatest component.
Vector3d commonNormal(const StructureSet& set, const InputFile& file) {
  Vector3d sum = Vector3d::Zero();
  for (const Structure& structure : set.structures)
    for (const Contour& contour : structure.contours) {
      const Vector3d normal = normalOf(contour);
      sum += sum.dot(normal) < 0 ? Vector3d(-normal) : normal;
    }
  if (!(sum.norm() > 0))
    throw invalidInput(file.path().string() + ": its contours " + tagText(kPoints) +
                       " enclose nothing; expected closed ones in a plane each");
  sum.normalize();
  Eigen::Index most = 0;
  (void)sum.cwiseAbs().maxCoeff(&most);
  if (sum[most] < 0) sum = -sum;
  for (const Structure& structure : set.structures)
    for (const Contour& contour : structure.contours) {
      double size = 0, off = 0;
      for (const Vector3d& p : contour) {
        size = std::max(size, (p - contour[0]).norm());
        off = std::max(off, std::abs(sum.dot(p - contour[0])));
      }
      if (off > kParallel * size + kOnePlane)
        throw invalidInput(file.path().string() + ": a contour of the structure " +
                           std::to_string(structure.label) + " " + tagText(kPoints) +
                           " lies up to " + shownNumber(off) +
                           " mm off the plane of the others; expected contours "
                           "in parallel planes");
    }
  return sum;
}

/// Places along the normal, ascending and apart.
std::vector<double> planesOf(const std::vector<Contour>& contours, const Vector3d& normal) {
  std::vector<double> planes;
  for (const Contour& contour : contours) planes.push_back(normal.dot(contour[0]));
  std::sort(planes.begin(), planes.end());
  planes.erase(std::unique(planes.begin(), planes.end(),
                           [](double a, double b) { return b - a < kOnePlane; }),
               planes.end());
  return planes;
}

double leastGap(const std::vector<double>& planes) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t n = 1; n < planes.size(); ++n)
    least = std::min(least, planes[n] - planes[n - 1]);
  return least;
}

/// A grid around all contours: slices at their planes, and pixels as large as the median distance of
/// neighbouring points, but no larger than the distance of slices.
VolumeGeometry ownGrid(const StructureSet& set, const Vector3d& normal, const InputFile& file) {
  std::vector<Contour> all;
  std::vector<double> steps;
  for (const Structure& structure : set.structures)
    for (const Contour& contour : structure.contours) {
      all.push_back(contour);
      for (std::size_t n = 1; n < contour.size(); ++n)
        if (const double step = (contour[n] - contour[n - 1]).norm(); step > 0)
          steps.push_back(step);
    }
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2),
                   steps.end());
  double pixel = steps[steps.size() / 2];
  const std::vector<double> planes = planesOf(all, normal);
  const double gap = leastGap(planes);
  const double slice = std::isfinite(gap) ? gap : pixel;
  VolumeGeometry grid;
  Vector3d first = Vector3d::UnitX() - normal * normal.x();
  if (first.norm() < 0.5) first = Vector3d::UnitY() - normal * normal.y();
  grid.direction.col(0) = first.normalized();
  grid.direction.col(1) = normal.cross(grid.direction.col(0));
  grid.direction.col(2) = normal;
  Eigen::AlignedBox3d box;
  for (const Contour& contour : all)
    for (const Vector3d& p : contour) box.extend(grid.direction.transpose() * p);
  const Vector3d span = box.sizes();
  const double slices = std::round((planes.back() - planes.front()) / slice) + 1;
  if (!(slices <= kMostPlanes))
    throw invalidInput(file.path().string() + ": its contours lie in planes " + shownNumber(gap) +
                       " to " + shownNumber(planes.back() - planes.front()) +
                       " mm apart; expected those of an image");
  const double most = kMostOwnVoxels / slices;  // of a slice
  pixel = std::max({std::min(pixel, slice), 2 * std::max(span[0], span[1]) / most,
                    2 * std::sqrt(span[0] * span[1] / most)});
  grid.spacing = Vector3d(pixel, pixel, slice);
  grid.size = {static_cast<int>(std::ceil(span[0] / pixel)) + 3,
               static_cast<int>(std::ceil(span[1] / pixel)) + 3,
               std::max(2, static_cast<int>(slices))};
  grid.origin = grid.direction * (box.min() - Vector3d(pixel, pixel, 0));
  return grid;
}

/// The grid of the series that the file refers to, among the files of its folder; empty without one.
std::optional<VolumeGeometry> referredGrid(const InputFile& file, const StructureSet& set,
                                           const Progress& progress) {
  if (file.isInMemory()) return std::nullopt;
  DicomFolder folder = scanDicomFolder(folderOf(file), progress, true);
  for (const std::string& uid : set.series) {
    const auto found = folder.series.find(uid);
    if (found == folder.series.end()) continue;
    try {
      VolumeGeometry grid = stackOf({std::move(found->second), {}}, {}, file.path()).geometry;
      (void)standUpright(grid);
      checkGeometry(grid, file.path());
      return grid;
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::Cancelled) throw;
      return std::nullopt;  // a grid of its own serves as well
    }
  }
  return std::nullopt;
}

bool isParallel(const VolumeGeometry& grid, const Vector3d& normal) {
  return std::abs(grid.direction.col(2).dot(normal)) > 1 - kParallel * kParallel;
}

/// The first whole number from a place on, within 0 and `size`.
int firstFrom(double place, int size) {
  return static_cast<int>(std::clamp(std::ceil(place), 0.0, static_cast<double>(size)));
}

/// Marks the pixels whose centres lie on an edge of a contour: writers that outline pixels put its points
/// at the centres of those at the border.
void markEdge(const Vector3d& from, const Vector3d& to, const VolumeGeometry& grid,
              std::vector<bool>& marked) {
  const auto [low, high] = std::minmax(from.y(), to.y());
  const int end = firstFrom(high + kOnCentre, grid.size[1]);
  for (int j = firstFrom(low - kOnCentre, grid.size[1]); j < end; ++j) {
    const bool isAlong = high - low < kOnCentre;
    const double part = isAlong ? 0 : (j - from.y()) / (to.y() - from.y());
    const double at = from.x() + (to.x() - from.x()) * std::clamp(part, 0.0, 1.0);
    const double left = isAlong ? std::min(from.x(), to.x()) : at;
    const double right = isAlong ? std::max(from.x(), to.x()) : at;
    const int last = firstFrom(right + kOnCentre, grid.size[0]);
    for (int i = firstFrom(left - kOnCentre, grid.size[0]); i < last; ++i)
      marked[grid.index({i, j, 0})] = true;
  }
}

/// Calls fill(voxel) for the pixels of slice k whose centres lie within an odd number of contours, or on
/// one.
void fillSlice(const std::vector<const Contour*>& contours, const VolumeGeometry& grid, int k,
               const std::function<void(std::size_t)>& fill) {
  std::vector<std::vector<double>> crossings(static_cast<std::size_t>(grid.size[1]));
  std::vector<bool> marked(grid.index({0, 0, 1}), false);
  for (const Contour* const contour : contours) {
    Vector3d from = grid.indexFromWorld(contour->back());
    for (const Vector3d& point : *contour) {
      const Vector3d to = grid.indexFromWorld(point);
      const auto [low, high] = std::minmax(from.y(), to.y());
      const int end = firstFrom(high, grid.size[1]);
      for (int j = firstFrom(low, grid.size[1]); j < end; ++j)
        crossings[static_cast<std::size_t>(j)].push_back(
            from.x() + (to.x() - from.x()) * (j - from.y()) / (to.y() - from.y()));
      markEdge(from, to, grid, marked);
      from = to;
    }
  }
  for (int j = 0; j < grid.size[1]; ++j) {
    std::vector<double>& at = crossings[static_cast<std::size_t>(j)];
    std::sort(at.begin(), at.end());
    for (std::size_t n = 0; n + 1 < at.size(); n += 2)
      for (int i = firstFrom(at[n], grid.size[0]); i < firstFrom(at[n + 1], grid.size[0]); ++i)
        marked[grid.index({i, j, 0})] = true;
  }
  for (std::size_t i = 0; i < marked.size(); ++i)
    if (marked[i]) fill(static_cast<std::size_t>(k) * marked.size() + i);
}

/// Calls fill(voxel) for those of a structure.
void fillStructure(const Structure& structure, const VolumeGeometry& grid, const Vector3d& normal,
                   const Progress& progress, const std::function<void(std::size_t)>& fill) {
  const std::vector<double> planes = planesOf(structure.contours, normal);
  const double gap = leastGap(planes), slice = grid.spacing[2];
  const double reach = 0.5 * (std::isfinite(gap) ? std::max(gap, slice) : slice) + kOnePlane;
  for (int k = 0; k < grid.size[2]; ++k) {
    progress.check();
    const double at = normal.dot(grid.position({0, 0, k}));
    const double plane = *std::min_element(planes.begin(), planes.end(), [&](double a, double b) {
      return std::abs(a - at) < std::abs(b - at);
    });
    if (std::abs(plane - at) > reach) continue;
    std::vector<const Contour*> here;
    for (const Contour& contour : structure.contours)
      if (std::abs(normal.dot(contour[0]) - plane) < kOnePlane) here.push_back(&contour);
    fillSlice(here, grid, k, fill);
  }
}

/// The grid to draw on, with a sentence.
VolumeGeometry chosenGrid(const InputFile& file, const StructureSet& set, const Vector3d& normal,
                          const ReadVolumeOptions& options, const Progress& progress,
                          std::vector<std::string>& assumptions) {
  if (options.grid && isParallel(*options.grid, normal)) return *options.grid;
  if (const auto grid = referredGrid(file, set, progress); grid && isParallel(*grid, normal)) {
    assumptions.emplace_back(
        "its contours are filled on the grid of the series in its folder that it refers to");
    return *grid;
  }
  VolumeGeometry grid = ownGrid(set, normal, file);
  assumptions.push_back(
      "its folder has no series that it refers to, so its contours are filled on a grid of their "
      "own, voxels " +
      spacingText(grid.spacing, 4) + " mm apart");
  return grid;
}

}  // namespace

OpenVolume openStructures(const InputFile& file, const ReadVolumeOptions& options,
                          const Progress& progress) {
  const auto set = std::make_shared<const StructureSet>(readSet(file));
  if (set->structures.empty())
    throw invalidInput(file.path().string() +
                       ": has no closed contour (3006,0050); expected structures in slices");
  const Vector3d normal = commonNormal(*set, file);
  OpenVolume open;
  VolumeHeader& header = open.header;
  if (set->left > 0)
    header.assumptions.push_back(counted(set->left, "of its contours is", "of its contours are") +
                                 " points or open lines, which enclose nothing, and left out");
  header.geometry = chosenGrid(file, *set, normal, options, progress, header.assumptions);
  header.storedType = "contours";
  header.encoding = counted(set->structures.size(), "structure", "structures");
  header.storedBytes = header.voxelBytes = file.size();
  const VolumeGeometry grid = header.geometry;
  open.readVoxels = [set, grid, normal](const Progress& running,
                                        std::vector<std::string>& assumptions) {
    std::vector<PaintedStructure> painted;
    for (const Structure& structure : set->structures)
      painted.push_back({structure.label, [&](const std::function<void(std::size_t)>& fill) {
                           fillStructure(structure, grid, normal, running, fill);
                         }});
    return paintedLabels(grid.voxelCount(), painted, assumptions);
  };
  return open;
}

}  // namespace lumen::convert
