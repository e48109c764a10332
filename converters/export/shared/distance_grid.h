// SPDX-License-Identifier: Apache-2.0
// The signed distance of a case on regular grids.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "converters/base/field_word.h"
#include "converters/base/progress.h"
#include "converters/export/shared/vessel_distance.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Places of the samples of a grid, mm, LPS; axes are x, y, z.
struct Lattice {
  std::array<int, 3> size{};                        ///< samples along x, y, z
  Eigen::Vector3d first = Eigen::Vector3d::Zero();  ///< place of the first sample
  double spacing = 0;                               ///< along each axis
  std::string word = "grid";                        ///< names the spacing in messages

  [[nodiscard]] Eigen::Vector3d last() const;
  [[nodiscard]] Eigen::Vector3d at(std::size_t i, std::size_t j, std::size_t k) const;
  [[nodiscard]] std::size_t count() const;
};

/// Maximum number of samples of a grid that is held whole: 256 MB.
inline constexpr std::size_t kMostGridSamples = std::size_t{1} << 25;

/// Border of a grid behind the wall, in mm and in samples: contacts look for the wall within it.
inline constexpr double kGridBorder = 1, kGridBorderSamples = 3;

/// The spacing `asked`, mm; for 0 a quarter of the tree's least radius, but at most eight million
/// samples over the box and `margin`.
double gridSpacing(double asked, const Box3d& box, double margin,
                   const formats::CenterlineTree& tree);

/// Sentences about vessels that a grid passes over: those with less than two samples across.
std::vector<std::string> gridLosses(const Lattice& lattice, const formats::CenterlineTree& tree);

/// Over the box and a margin on each side; the spacing is the field "grid". Throws Error(Usage) for more than 2^31 samples along an
/// axis.
Lattice latticeOver(const Box3d& box, double margin, double spacing, const FieldWord& word = {});

/// The samples of `whole` that lie in the box with its margin; at least two along each axis.
Lattice cropLattice(const Lattice& whole, const Box3d& box, double margin);

class FarField;
class NearCells;

/// The source of the answers on a grid, and the greatest distance from the wall that is asked for.
struct GridSource {
  const VesselDistance& vessels;
  const TreeRegion* region = nullptr;  ///< none: all vessels
  /// Distances are clamped to plus and minus this, mm, and not looked for beyond it.
  double band = std::numeric_limits<double>::infinity();
  /// Shortcuts, which sampleGrid() and sampleLayers() make: answers far from all walls, and cells
  /// that lie within the band.
  const FarField* far = nullptr;
  const NearCells* near = nullptr;

  /// The answers of `vessels`, clamped to the band.
  void ask(std::span<const Eigen::Vector3d> points, std::span<WallDistance> answers,
           std::span<WallFoot> feet = {}) const;
};

/// Place of a sample.
using RowPlaces = std::function<Eigen::Vector3d(std::size_t row, std::size_t index)>;

/// `rows` rows of `length` samples near each other, answers[row * length + index], in parallel; the
/// same numbers on any number of threads. Throws Error(Cancelled).
std::vector<WallDistance> sampleRows(const GridSource& source, std::size_t rows, std::size_t length,
                                     const RowPlaces& places, Progress& progress);

/// x fastest.
struct DistanceGrid {
  Lattice lattice;
  std::vector<WallDistance> values;
};

/// Throws Error(Usage) for more than kMostGridSamples, Error(Cancelled).
DistanceGrid sampleGrid(const GridSource& source, const Lattice& lattice, Progress& progress);

/// The distances times `sign`, in a volume along the axes of LPS.
Volume distanceVolume(const DistanceGrid& grid, float sign);

/// sampleGrid() in layers of constant z, `layers` at a time, each handed to `take` with the index
/// of its first layer.
using TakeLayers = std::function<void(const DistanceGrid& part, int firstLayer)>;
void sampleLayers(const GridSource& source, const Lattice& lattice, int layers,
                  const TakeLayers& take, Progress& progress);

/// Throws Error(Usage) that names the spacing and the grid that it would make too large.
[[noreturn]] void refuseSpacing(const Lattice& lattice, const std::string& what);

}  // namespace lumen::convert
