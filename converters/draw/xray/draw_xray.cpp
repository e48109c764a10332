// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/xray/draw_xray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include <tbb/parallel_for.h>

#include "converters/base/error.h"
#include "converters/base/random.h"
#include "converters/draw/xray/attenuation.h"
#include "converters/draw/xray/ct_rays.h"
#include "converters/draw/xray/lumen_rays.h"
#include "converters/stages/finding/ct_levels.h"

namespace lumen::convert {

namespace {

constexpr double kCm = 10, kGram = 1000;  // mm, mg
constexpr double kSoftTissue = 40;        // HU
constexpr double kRange = 0.001;          // share of the pixels that are all white, or all black
constexpr double kLeastSignal = 1e-6;

/// The rays of one picture, with what lies on each.
struct RayMatter {
  std::vector<Matter> without, with;  ///< contrast agent
  std::vector<double> path, volume;   ///< in the lumen: mm, mm^3
};

RayMatter matterOn(const LumenRays& rays, const XrayOptions& options, const XrayView& view,
                   const CtRays* ct, Progress& progress) {
  const auto count = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
  RayMatter out{std::vector<Matter>(count), std::vector<Matter>(count), std::vector<double>(count),
                std::vector<double>(count)};
  const Eigen::Vector3d source = view.source();
  rays.cast(view, progress, [&](int x, int y, std::span<const Chord> lumen) {
    const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width) +
                              static_cast<std::size_t>(x);
    double path = 0, cone = 0;
    for (const Chord& chord : lumen) {
      path += chord.to - chord.from;
      cone += (std::pow(chord.to, 3) - std::pow(chord.from, 3)) / 3;
    }
    out.path[pixel] = path;
    out.volume[pixel] = cone * view.solidAngle(x, y);
    Matter& matter = out.without[pixel];
    if (ct) {
      const Eigen::Vector3d ray = view.pixelPlace(x, y) - source;
      matter = ct->along(source, ray.normalized(), ray.norm(), lumen);
    } else {
      matter.water = options.tissue / kCm;
    }
    out.with[pixel] = matter;
    out.with[pixel].iodine = options.iodine / kGram * path / kCm;
  });
  return out;
}

/// The signal of each pixel over that of the bare beam.
std::vector<double> signalsOf(const std::vector<Matter>& matter, const Spectrum& spectrum,
                              const XrayOptions& options, std::uint64_t exposure) {
  std::vector<double> signal(matter.size());
  tbb::parallel_for(std::size_t{0}, signal.size(), [&](std::size_t i) {
    // metres of contrast agent let nothing through, and the logarithm of that is no number
    signal[i] = std::max(spectrum.transmitted(matter[i]), std::numeric_limits<double>::min());
  });
  double scatter = 0;
  for (const double s : signal) scatter += s;
  scatter *= options.scatter / static_cast<double>(signal.size());
  for (double& s : signal) s += scatter;
  if (options.photons == 0) return signal;
  tbb::parallel_for(std::size_t{0}, signal.size(), [&](std::size_t i) {
    // the scatter's photons count as those of the bare beam
    const double variance = (spectrum.variance(matter[i]) + scatter) / options.photons;
    Random random(options.seed, 2 * i + exposure);
    signal[i] = std::max(kLeastSignal, signal[i] + std::sqrt(variance) * random.normal());
  });
  return signal;
}

}  // namespace

double unitOffset(const Volume& volume, const Progress& progress) {
  const std::optional<CtLevels> levels = measureCtLevels(volume, progress);
  if (!levels)
    throw invalidInput(
        "its values are no Hounsfield units: expected computed tomography, of which an X-ray can "
        "be "
        "made");
  const double above = double{levels->soft} - kSoftTissue;
  double best = 0;
  for (const double moved : {0.0, 1000.0, 1024.0})
    if (std::abs(above - moved) < std::abs(above - best)) best = moved;
  return best;
}

XrayImage xrayOf(const formats::Case& source, const XrayOptions& options, const TissueScan& scan,
                 Progress& progress) {
  if (!source.models || source.tree.nodeCount() == 0)
    throw invalidInput(
        "this case has no models, so there is no lumen to X-ray; lumen fit makes them");
  XrayImage image;
  XrayView& view = image.view = options.view;
  view.isocentre = options.isocentre.value_or(middleOf(source.tree));
  if (view.pixel == 0) view.pixel = pixelFor(source.tree, view);
  const LumenRays rays(source);
  std::optional<CtRays> ct;
  if (scan.volume != nullptr) ct.emplace(*scan.volume, scan.offset);
  const RayMatter matter = matterOn(rays, options, view, ct ? &*ct : nullptr, progress);
  const Spectrum spectrum(options.peak, options.filter);
  image.meanEnergy = spectrum.meanEnergy();
  const std::vector<double> with = signalsOf(matter.with, spectrum, options, 0);
  if (options.isSubtracted) {
    const std::vector<double> without = signalsOf(matter.without, spectrum, options, 1);
    for (std::size_t i = 0; i < with.size(); ++i)
      image.attenuation.push_back(static_cast<float>(std::log(without[i] / with[i])));
  } else {
    for (const double signal : with)
      image.attenuation.push_back(static_cast<float>(-std::log(signal)));
  }
  std::size_t seen = 0;
  for (std::size_t i = 0; i < matter.path.size(); ++i) {
    image.longest = std::max(image.longest, matter.path[i]);
    image.lumenVolume += matter.volume[i];
    seen += matter.path[i] > 0 ? 1 : 0;
  }
  image.lumenShare = static_cast<double>(seen) / static_cast<double>(matter.path.size());
  return image;
}

Picture shadedXray(const XrayImage& image) {
  std::vector<float> sorted = image.attenuation;
  std::sort(sorted.begin(), sorted.end());
  const auto cut = static_cast<std::size_t>(kRange * static_cast<double>(sorted.size()));
  const float low = sorted[cut], high = sorted[sorted.size() - 1 - cut];
  const float scale = high > low ? 255 / (high - low) : 0;
  Picture picture(image.view.width, image.view.height, {});
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    const float grey = 255 - (image.attenuation[i] - low) * scale;
    const auto level = static_cast<std::uint8_t>(std::clamp(grey, 0.0F, 255.0F) + 0.5F);
    picture.pixels[i] = {level, level, level};
  }
  return picture;
}

Volume detectorVolume(const XrayImage& image) {
  const XrayView& view = image.view;
  Volume volume;
  volume.geometry.size = {view.width, view.height, 1};
  volume.geometry.spacing.setConstant(view.pixel);
  volume.geometry.direction.col(0) = view.right();
  volume.geometry.direction.col(1) = -view.up();
  volume.geometry.direction.col(2) = view.right().cross(-view.up());
  volume.geometry.origin = view.pixelPlace(0, 0);
  volume.voxels = image.attenuation;
  return volume;
}

}  // namespace lumen::convert
