// SPDX-License-Identifier: Apache-2.0
// X-rays against closed forms.
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/base/progress.h"
#include "converters/draw/xray/attenuation.h"
#include "converters/draw/xray/ct_rays.h"
#include "converters/draw/xray/draw_xray.h"
#include "converters/draw/xray/lumen_rays.h"
#include "tests/unit/measure/shapes.h"

namespace lumen::convert::test {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 1.5, kLength = 60;  // mm

formats::Case tubeCase() {
  return caseOf({straightTube({0, 0, -kLength / 2}, {0, 0, 1}, kLength, kRadius)}, 0.4);
}

XrayView viewOf(double lao, double cra, double pixel = 0.1) {
  XrayView view;
  view.primary = lao;
  view.secondary = cra;
  view.width = view.height = 101;
  view.pixel = pixel;
  return view;
}

/// Length of each ray in the lumen, rows from the top.
std::vector<double> pathsOf(const formats::Case& value, const XrayView& view) {
  std::vector<double> paths(static_cast<std::size_t>(view.width * view.height));
  Progress progress;
  LumenRays(value).cast(view, progress, [&](int x, int y, std::span<const Chord> lumen) {
    double before = -1;
    for (const Chord& chord : lumen) {
      if (chord.from < before || chord.to <= chord.from) std::abort();  // apart, and ascending
      before = chord.to;
      paths[static_cast<std::size_t>(y * view.width + x)] += chord.to - chord.from;
    }
  });
  return paths;
}

double middleOf(const std::vector<double>& paths) {
  return paths[paths.size() / 2];
}

TEST(XrayView, TurnsAsTheAnglesOfDicomDo) {
  EXPECT_TRUE(viewOf(0, 0).towards().isApprox(Vector3d(0, -1, 0)));  // the detector is in front
  EXPECT_TRUE(viewOf(0, 0).right().isApprox(Vector3d(1, 0, 0)));     // the patient's left
  EXPECT_TRUE(viewOf(0, 0).up().isApprox(Vector3d(0, 0, 1)));
  EXPECT_TRUE(viewOf(90, 0).towards().isApprox(Vector3d(1, 0, 0)));  // left
  EXPECT_TRUE(viewOf(0, 90).towards().isApprox(Vector3d(0, 0, 1)));  // head
  const XrayView view = viewOf(-35, 20);
  EXPECT_TRUE(view.right().cross(view.up()).isApprox(view.towards()));
  EXPECT_NEAR((view.pixelPlace(50, 50) - view.source() - 1200 * view.towards()).norm(), 0, 1e-9);
  EXPECT_NEAR((view.pixelPlace(51, 50) - view.pixelPlace(50, 50)).dot(view.right()), 0.1, 1e-9);
  EXPECT_NEAR((view.pixelPlace(50, 51) - view.pixelPlace(50, 50)).dot(view.up()), -0.1, 1e-9);
}

TEST(XrayView, HoldsAllVesselsAtAnyAngles) {
  const formats::CenterlineTree tree = tubeCase().tree;
  double farthest = 0;
  for (const double cra : {-80.0, 0.0, 37.0}) {
    XrayView view = viewOf(20, cra, 0);
    view.pixel = pixelFor(tree, view);
    for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
      const Vector3d centre(double{tree.centre[n].x}, double{tree.centre[n].y},
                            double{tree.centre[n].z});
      for (const double side : {-kRadius, kRadius}) {
        const Vector3d from = centre + side * view.up() - view.source();
        const double up = view.up().dot(from) * 1200 / view.towards().dot(from);
        farthest = std::max(farthest, std::abs(up) / view.pixel);
      }
    }
  }
  EXPECT_LT(farthest, 50.5);
  EXPECT_GT(farthest, 45);  // and no smaller than need be
}

TEST(XrayView, RefusesVesselsAtTheSourceAndBehindTheDetector) {
  XrayView view = viewOf(0, 0);
  const formats::Case value = tubeCase();
  view.isocentre = {0, -749, 0};
  EXPECT_THROW(pathsOf(value, view), Error);
  view.isocentre = {0, 449, 0};
  EXPECT_THROW(pathsOf(value, view), Error);
}

TEST(LumenRays, CrossATubeByItsChord) {
  const formats::Case value = tubeCase();
  EXPECT_NEAR(middleOf(pathsOf(value, viewOf(0, 0))), 2 * kRadius, 0.001 * 2 * kRadius);
  EXPECT_NEAR(middleOf(pathsOf(value, viewOf(70, 0))), 2 * kRadius, 0.001 * 2 * kRadius);
  const double tilted = 2 * kRadius / std::cos(40 * std::numbers::pi / 180);
  EXPECT_NEAR(middleOf(pathsOf(value, viewOf(0, 40))), tilted, 0.001 * tilted);
  // beside the axis: the magnification is 1200 / 750
  const std::vector<double> paths = pathsOf(value, viewOf(0, 0));
  for (const int x : {5, 10, 15, 20}) {
    const double away = x * 0.1 / 1.6;
    const double expected = 2 * std::sqrt(kRadius * kRadius - away * away);
    EXPECT_NEAR(paths[paths.size() / 2 + static_cast<std::size_t>(x)], expected, 0.003) << x;
  }
  EXPECT_EQ(paths[paths.size() / 2 + 26], 0);
}

TEST(LumenRays, FindTheVolumeOfTheLumen) {
  XrayOptions options;
  options.view = viewOf(25, 0);
  Progress progress;
  const XrayImage image = xrayOf(tubeCase(), options, {}, progress);
  // a tube between two planes through the source: its section times their mean distance
  const double apart = 101 * 0.1 * 750 / 1200;
  const double volume = std::numbers::pi * kRadius * kRadius * apart;
  EXPECT_NEAR(image.lumenVolume, volume, 0.005 * volume);
}

TEST(LumenRays, LeaveNoGapInAForkAndCountTouchingVesselsBoth) {
  const Tube trunk = straightTube({0, 0, -20}, {0, 0, 1}, 40, 1.5);
  Tube child = straightTube({0, 0, 0}, {1, 0, 1}, 20, 1);
  child.label = "child";
  child.parent = 0;
  child.parentAlong = 20;
  Tube behind = straightTube({0, 2.6, -20}, {0, 0, 1}, 40, 1.1);  // touches the trunk
  behind.label = "behind";
  const formats::Case value = caseOf({trunk, child, behind}, 0.3);
  XrayView view = viewOf(0, 0, 0.15);
  const std::vector<double> paths = pathsOf(value, view);
  const std::size_t middle = paths.size() / 2;
  for (int row = -40; row <= 40; row += 2) {
    const double path = paths[static_cast<std::size_t>(static_cast<int>(middle) + row * 101)];
    EXPECT_GT(path, 2 * 1.5 + 2 * 1.1 - 0.03) << row;
    EXPECT_LT(path, 2 * 1.5 + 2 * 1.1 + 0.6) << row;  // the child begins within the trunk
  }
  for (int i = 0; i <= 40; ++i)  // along the child's axis
    EXPECT_GT(paths[static_cast<std::size_t>(static_cast<int>(middle) - i * 101 + i)], 1.9) << i;
}

TEST(LumenRays, HaveTheSameBitsWhateverTheTilesAre) {
  const formats::Case value = tubeCase();
  XrayView tall = viewOf(10, 20), cut = tall;
  cut.height = 99;  // rows begin one farther down
  const std::vector<double> all = pathsOf(value, tall), some = pathsOf(value, cut);
  for (std::size_t i = 0; i < some.size(); ++i) EXPECT_EQ(some[i], all[i + 101]);
}

TEST(Attenuation, IsThatOfTheTablesAndBetweenThem) {
  EXPECT_DOUBLE_EQ(massAttenuation(Material::Water, 60), 0.2059);
  EXPECT_DOUBLE_EQ(massAttenuation(Material::Bone, 100), 0.1855);
  EXPECT_NEAR(massAttenuation(Material::Water, 70), 0.1937, 0.001);  // NIST's XCOM: 0.1929
  EXPECT_LT(massAttenuation(Material::Iodine, 33), 7);
  EXPECT_GT(massAttenuation(Material::Iodine, 33.3), 35);  // beyond the K edge
}

TEST(Spectrum, IsHardenedByMatterAndByAFilter) {
  const Spectrum tube(80, 2.5), filtered(80, 10);
  EXPECT_DOUBLE_EQ(tube.transmitted({}), 1);
  EXPECT_LT(tube.meanEnergy(), filtered.meanEnergy());
  // a second slab of water takes less of the beam than the first
  const double first = tube.transmitted({5, 0, 0}), both = tube.transmitted({10, 0, 0});
  EXPECT_GT(both / first, 1.05 * first);
  EXPECT_GT(filtered.transmitted({5, 0, 0}), first);
  // mean energy of a tube of 80 kV with 2.5 mm of aluminium: 40 to 47 keV by published spectra
  EXPECT_GT(tube.meanEnergy(), 40);
  EXPECT_LT(tube.meanEnergy(), 47);
  // between the attenuations of its least and its greatest energy
  EXPECT_LT(first, std::exp(-5 * massAttenuation(Material::Water, 80)));
  EXPECT_GT(first, std::exp(-5 * massAttenuation(Material::Water, 25)));
}

/// A box of one value with 2 mm of another around, in Hounsfield units.
Volume boxOf(std::int16_t inside, std::int16_t outside, int voxels) {
  Volume volume;
  volume.geometry.size = {voxels, voxels, voxels};
  volume.geometry.origin.setConstant(-0.5 * (voxels - 1));
  std::vector<std::int16_t> values;
  const auto isIn = [&](int i) { return i >= 2 && i < voxels - 2; };
  for (int k = 0; k < voxels; ++k)
    for (int j = 0; j < voxels; ++j)
      for (int i = 0; i < voxels; ++i)
        values.push_back(isIn(i) && isIn(j) && isIn(k) ? inside : outside);
  volume.voxels = std::move(values);
  return volume;
}

TEST(CtRays, AddUpWaterAndBone) {
  const Vector3d source(0, 500, 0), forward(0, -1, 0);
  const Matter water = CtRays(boxOf(0, -1000, 54), 0).along(source, forward, 1000, {});
  EXPECT_NEAR(water.water, 5, 0.05);
  EXPECT_EQ(water.bone, 0);
  // moved by 1024, as some scanners store it
  const Matter moved = CtRays(boxOf(1024, 24, 54), 1024).along(source, forward, 1000, {});
  EXPECT_NEAR(moved.water, water.water, 1e-9);
  const double units =
      1000 *
      (massAttenuation(Material::Bone, 70) * 1.92 / massAttenuation(Material::Water, 70) - 1);
  const Matter bone = CtRays(boxOf(static_cast<std::int16_t>(units), -1000, 54), 0)
                          .along(source, forward, 1000, {});
  EXPECT_NEAR(bone.bone, 5 * 1.92, 0.1);
  EXPECT_LT(bone.water, 0.15);
  // beside the volume there is nothing
  EXPECT_EQ(CtRays(boxOf(0, 0, 54), 0).along({100, 500, 0}, forward, 1000, {}).water, 0);
}

TEST(CtRays, TakeTheLumenForBloodWhateverTheScanShowsThere) {
  const Vector3d source(0, 500, 0), forward(0, -1, 0);
  const std::vector<Chord> lumen = {{490.3, 503.1}};
  const Matter bright = CtRays(boxOf(900, -1000, 54), 0).along(source, forward, 1000, lumen);
  const Matter plain = CtRays(boxOf(0, -1000, 54), 0).along(source, forward, 1000, lumen);
  const Matter whole = CtRays(boxOf(900, -1000, 54), 0).along(source, forward, 1000, {});
  EXPECT_NEAR(plain.water, 5, 0.05);
  EXPECT_NEAR(whole.bone - bright.bone, whole.bone * 12.8 / 50, 0.02);
}

TEST(Xray, OfContrastFollowsTheLawOfItsSpectrum) {
  XrayOptions options;
  options.view = viewOf(0, 0);
  options.iodine = 250;
  options.tissue = 120;
  Progress progress;
  const XrayImage image = xrayOf(tubeCase(), options, {}, progress);
  const Spectrum spectrum(options.peak, options.filter);
  const double middle = double{image.attenuation[image.attenuation.size() / 2]};
  const Matter matter{12, 0, 0.25 * 0.1 * 2 * kRadius};
  EXPECT_NEAR(middle, -std::log(spectrum.transmitted(matter)), 0.001);
  EXPECT_NEAR(double{image.attenuation[0]}, -std::log(spectrum.transmitted({12, 0, 0})), 1e-5);
  EXPECT_NEAR(image.longest, 2 * kRadius, 0.01);
  options.isSubtracted = true;
  const XrayImage subtracted = xrayOf(tubeCase(), options, {}, progress);
  EXPECT_EQ(subtracted.attenuation[0], 0);
  EXPECT_NEAR(double{subtracted.attenuation[subtracted.attenuation.size() / 2]},
              middle - double{image.attenuation[0]}, 1e-4);
}

/// Mean and standard deviation of the signal.
std::pair<double, double> signalOf(const XrayImage& image) {
  double sum = 0, squares = 0;
  for (const float a : image.attenuation) {
    const double signal = std::exp(-double{a});
    sum += signal, squares += signal * signal;
  }
  const auto count = static_cast<double>(image.attenuation.size());
  return {sum / count, std::sqrt(squares / count - sum * sum / (count * count))};
}

TEST(Xray, HasTheNoiseOfItsPhotonsAndNoOther) {
  XrayOptions options;
  options.view = viewOf(0, 0);
  options.iodine = 0;
  options.tissue = 100;
  Progress progress;
  const auto [bare, none] = signalOf(xrayOf(tubeCase(), options, {}, progress));
  EXPECT_NEAR(none, 0, 1e-6);
  options.photons = 50000;
  const XrayImage noisy = xrayOf(tubeCase(), options, {}, progress);
  const auto [mean, deviation] = signalOf(noisy);
  EXPECT_NEAR(mean, bare, 0.01 * bare);
  const Spectrum spectrum(options.peak, options.filter);
  EXPECT_NEAR(deviation, std::sqrt(spectrum.variance({10, 0, 0}) / 50000), 0.03 * deviation);
  EXPECT_EQ(noisy.attenuation, xrayOf(tubeCase(), options, {}, progress).attenuation);
  options.seed = 2;
  EXPECT_NE(noisy.attenuation, xrayOf(tubeCase(), options, {}, progress).attenuation);
}

TEST(Xray, HasEvenScatter) {
  XrayOptions options;
  options.view = viewOf(0, 0);
  options.iodine = 0;
  Progress progress;
  const auto [primary, none] = signalOf(xrayOf(tubeCase(), options, {}, progress));
  options.scatter = 0.5;
  const auto [both, still] = signalOf(xrayOf(tubeCase(), options, {}, progress));
  EXPECT_NEAR(both, 1.5 * primary, 1e-6);
}

TEST(Xray, LiesInTheDetectorAsAVolume) {
  XrayOptions options;
  options.view = viewOf(30, -20);
  options.view.height = 61;
  Progress progress;
  const XrayImage image = xrayOf(tubeCase(), options, {}, progress);
  const Volume volume = detectorVolume(image);
  EXPECT_EQ(volume.geometry.size, (std::array<int, 3>{101, 61, 1}));
  for (const auto& [x, y] : {std::pair(0, 0), std::pair(100, 60), std::pair(17, 40)})
    EXPECT_NEAR(
        (volume.geometry.worldFromIndex({double(x), double(y), 0}) - image.view.pixelPlace(x, y))
            .norm(),
        0, 1e-9);
  EXPECT_NEAR(volume.geometry.direction.determinant(), 1, 1e-9);
}

TEST(Xray, IsDarkWhereMuchIsAttenuated) {
  XrayOptions options;
  options.view = viewOf(0, 0);
  Progress progress;
  const Picture picture = shadedXray(xrayOf(tubeCase(), options, {}, progress));
  EXPECT_EQ(picture.pixels[0][0], 255);
  EXPECT_LT(picture.pixels[picture.pixels.size() / 2][1], 5);
}

TEST(Xray, OfWhatLetsNothingThroughHasNumbersYet) {
  XrayOptions options;
  options.view = viewOf(0, 0, 0);
  options.view.sourceToIsocentre = 5000;
  options.view.sourceToDetector = 9000;
  options.peak = 30;
  options.iodine = 1000;
  Progress progress;
  const XrayImage image = xrayOf(caseOf({straightTube({0, 0, -900}, {0, 0, 1}, 1800, 900)}, 250),
                                 options, {}, progress);
  EXPECT_GT(image.longest, 1700);
  for (const float a : image.attenuation) EXPECT_TRUE(std::isfinite(a));
}

TEST(Xray, RefusesWhatItCannotTake) {
  Progress progress;
  formats::Case bare = tubeCase();
  bare.models.reset();
  EXPECT_THROW(xrayOf(bare, {}, {}, progress), Error);
  EXPECT_THROW(unitOffset(boxOf(100, 0, 20), progress), Error);  // no air, no fat: no CT
}

}  // namespace
}  // namespace lumen::convert::test
