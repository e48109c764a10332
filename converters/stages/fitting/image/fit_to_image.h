// SPDX-License-Identifier: Apache-2.0
// Walls that make the image of a case's vessels most like a volume (docs/method.md, section 2.11).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "converters/base/progress.h"
#include "converters/stages/fitting/image/sections.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::convert::fitting {

// The sections of a case, fitted to a volume together (docs/method.md, section 2.11).

/// Fits in sweeps: each reads the sections of the sweep before only, so the order of the nodes and the
/// number of threads do not matter. The constructor's arguments must outlive the object.
class ImageFit {
public:
  /// `blur`: as for Sections, to begin with.
  ImageFit(const formats::Case& value, const Volume& volume, bool dark, double blur,
           Progress& progress);

  /// Throws Error(InvalidInput) if no vessel is wide enough to show its contrast, and
  /// Error(Cancelled).
  void run();

  [[nodiscard]] double blur() const { return m_sections.blur(); }
  [[nodiscard]] bool isFitted(std::uint32_t node) const { return m_fits[node].isValid; }
  [[nodiscard]] const NodeSection& section(std::uint32_t node) const { return m_sections[node]; }
  /// Standard deviation of a fitted node's radius, mm.
  [[nodiscard]] double deviation(std::uint32_t node) const { return m_fits[node].radius.deviation; }
  /// Points on the wall of a fitted node, mm, LPS, in rings; none where it is open. Empty if less
  /// than half of it is closed.
  [[nodiscard]] std::vector<formats::Vec3f> wallPoints(std::uint32_t node) const;

private:
  void chooseNodes();
  void guessContrast();
  [[nodiscard]] std::vector<std::uint32_t> widestNodes() const;
  void measureVolume();
  void sweep(const std::vector<std::uint32_t>& nodes);
  void fitNodes(const std::vector<std::uint32_t>& nodes, bool fitsBlur);
  void shareContrast();
  [[nodiscard]] Estimate ownContrast(std::uint32_t node) const;
  [[nodiscard]] std::vector<std::uint32_t> touchingNodes() const;
  [[nodiscard]] bool isBelievable(std::uint32_t node) const;
  [[nodiscard]] bool isNarrow(double radius) const;

  const formats::Case& m_case;
  Sections m_sections;
  Progress& m_progress;
  std::vector<std::uint32_t> m_due;
  std::vector<SectionFit> m_fits;
  std::vector<Estimate> m_expected;  ///< contrasts
  ShapeSpread m_spread;
  bool m_isFirst = true;
};

}  // namespace lumen::convert::fitting

namespace lumen::convert {

struct ImageFitOptions {
  bool dark = false;  ///< vessels are darker than their background
  double blur = 0;    ///< mm, > 0: standard deviation of the point-spread function to begin with
};

struct ImageFitReport {
  double blur = 0;        ///< mm, as measured, along the finest axis of the volume
  std::size_t nodes = 0;  ///< nodes whose walls are now those of the image
  std::size_t kept = 0;   ///< nodes that keep their wall points
};

/// The options for a case that was tracked in `volume`: the polarity of its last "track" step, and a
/// usual blur.
ImageFitOptions recordedImageFit(const formats::Case& value, const Volume& volume);

/// Replaces the wall points of the nodes of vessels, their centres and radii by those of the
/// cross-sections whose blurred images differ least from the volume, gives each node the standard
/// deviation of its radius (LUMEN_image.deviation of spec/lumen.md), and appends the step
/// "fit-image". Nodes keep theirs in forks, in aneurysms, where a person changed the wall, and where
/// the volume does not determine them. Bridged nodes between measured ones become measured. Models
/// stay as they are: fit() comes next. The result does not depend on the number of threads. Throws
/// Error(InvalidInput) if the case has no wall points or no vessel is wide enough to show its
/// contrast, and Error(Cancelled); the case is then as it was.
ImageFitReport fitToImage(formats::Case& target, const Volume& volume,
                          const ImageFitOptions& options, Progress& progress);

}  // namespace lumen::convert
