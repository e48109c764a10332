// SPDX-License-Identifier: Apache-2.0
// Tracks of real angiograms from the clicks in tests/data. The vessels that they should find were
// judged on projections of the volumes.
#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/io/volume/read_volume.h"
#include "converters/stages/tracking/cylinders/tracked_branch.h"
#include "converters/stages/tracking/track_case.h"
#include "converters/stages/tracking/tracking_volume.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

struct TrackedFile {
  TrackResult out;
  std::size_t seeds = 0;
};

TrackedFile trackFile(const std::string& volume, VolumeFormat format,
                      const std::string& seedsFile) {
  Progress silent;
  const auto seeds = readSeeds(std::filesystem::path(LUMEN_TEST_DATA) / seedsFile);
  const auto file = std::filesystem::path(LUMEN_SHARED_DATA) / volume;
  const Volume read = readVolume(file, format, ReadVolumeOptions{}, silent);
  return {trackFromSeeds(read, seeds, TrackOptions{}, silent), seeds.size()};
}

std::vector<TrackedNode> chainOf(const formats::Case& tracked, const std::string& label) {
  std::vector<TrackedNode> chain;
  for (const formats::Branch& branch : tracked.tree.branches)
    if (branch.label == label)
      for (std::uint32_t i = branch.firstNode; i < branch.firstNode + branch.nodeCount; ++i) {
        const formats::Vec3f& c = tracked.tree.centre[i];
        TrackedNode node;
        node.centre = Vector3d(c.x, c.y, c.z);
        node.radius = tracked.tree.radius[i];
        chain.push_back(node);
      }
  return chain;
}

double measureLength(const std::vector<TrackedNode>& chain) {
  double length = 0;
  for (std::size_t i = 1; i < chain.size(); ++i)
    length += (chain[i].centre - chain[i - 1].centre).norm();
  return length;
}

bool absent(const char* volume) {
  return !std::filesystem::exists(std::filesystem::path(LUMEN_SHARED_DATA) / volume);
}

class Angiogram3dra : public testing::Test {
protected:
  void SetUp() override {
    if (absent("aneurism-3dra.nrrd")) GTEST_SKIP() << "aneurism-3dra.nrrd is not here";
    static const TrackedFile once =
        trackFile("aneurism-3dra.nrrd", VolumeFormat::Nrrd, "aneurism-3dra.seeds.json");
    tracked = &once;
  }
  const TrackedFile* tracked = nullptr;
};

TEST_F(Angiogram3dra, AtLeastNineInTenClicksTrackAVessel) {
  EXPECT_GE(tracked->out.result.tree.branches.size(), tracked->seeds * 9 / 10);
}

TEST_F(Angiogram3dra, TheCarotidRunsThroughItsSiphonToTheMiddleCerebralArtery) {
  const auto carotid = chainOf(tracked->out.result, "ica");
  EXPECT_GT(measureLength(carotid), 300);
  for (const Vector3d& place : {Vector3d(150, 47, 167), Vector3d(118, 88, 160),
                                Vector3d(126, 94, 183), Vector3d(130, 124, 167)})
    EXPECT_LT(closestOnChain(carotid, place).distance, 5.0) << place.transpose();
}

TEST_F(Angiogram3dra, TheAneurysmHasTheWidthThatItShows) {
  for (const TrackedNode& node : chainOf(tracked->out.result, "aneurysm"))
    EXPECT_NEAR(node.radius, 12, 2.5);
}

TEST_F(Angiogram3dra, NoWallPointLiesWithinTheAneurysmOrItsOutflow) {
  struct Place {
    Vector3d centre;
    double free;  // of walls around it, voxels
  };
  for (const Place& place :
       {Place{{117, 106, 166}, 5}, {{112, 104, 160}, 8}, {{122, 110, 169}, 3.5}})
    for (const formats::Vec3f& p : tracked->out.result.points->position)
      EXPECT_GT((Vector3d(p.x, p.y, p.z) - place.centre).norm(), place.free)
          << p.x << " " << p.y << " " << p.z;
}

TEST_F(Angiogram3dra, TheKissingAnteriorCerebralArteriesAreTwoVessels) {
  const auto first = chainOf(tracked->out.result, "aca-1");
  const auto second = chainOf(tracked->out.result, "aca-2");
  EXPECT_GT(measureLength(first), 200);
  EXPECT_GT(measureLength(second), 150);
  // while they touch, along x = 80 .. 95 from y = 130 to the crest of the corpus callosum at z = 95
  int inContact = 0, merged = 0;
  for (const TrackedNode& node : second) {
    if (node.centre.y() < 130 || node.centre.z() < 95) continue;
    const ChainPoint other = closestOnChain(first, node.centre);
    inContact += other.distance < 1.5 * (node.radius + other.radius);
    merged += other.distance < std::max(node.radius, other.radius);
  }
  EXPECT_GT(inContact, 40);
  EXPECT_EQ(merged, 0);
}

TEST(AngiogramAorta, TheAortaBothIliacsAndBothRenalsAreTracked) {
  if (absent("aorta/aorta.mha")) GTEST_SKIP() << "aorta/aorta.mha is not here";
  const TrackedFile tracked =
      trackFile("aorta/aorta.mha", VolumeFormat::MetaImage, "aorta.seeds.json");
  EXPECT_EQ(tracked.out.result.tree.branches.size(), tracked.seeds);
  EXPECT_GT(measureLength(chainOf(tracked.out.result, "aorta")), 300);
  EXPECT_GT(measureLength(chainOf(tracked.out.result, "left-iliac")), 100);
  EXPECT_GT(measureLength(chainOf(tracked.out.result, "left-renal")), 50);
  EXPECT_GT(measureLength(chainOf(tracked.out.result, "right-renal")), 50);
}

TEST(AngiogramFistula, TheVeinAndTheFistulaAreTracked) {
  if (absent("avf/avf.nii")) GTEST_SKIP() << "avf/avf.nii is not here";
  const TrackedFile tracked = trackFile("avf/avf.nii", VolumeFormat::Nifti, "avf.seeds.json");
  EXPECT_GT(measureLength(chainOf(tracked.out.result, "vein")), 50);
  EXPECT_GT(measureLength(chainOf(tracked.out.result, "fistula")), 55);
}

// One click on a thin artery of a rendered arterial tree: the path turned back at the same place for
// ever, with 223 nodes and nothing given up.
TEST(Tracker, APathThatTurnsBackEnds) {
  const auto folder = std::filesystem::path(LUMEN_SHARED_DATA) / "../hostile";
  const auto file = folder / "track-never-ends.nrrd";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  Progress silent;
  const Volume volume = readVolume(file, VolumeFormat::Nrrd, ReadVolumeOptions{}, silent);
  const auto seeds = readSeeds(folder / "track-never-ends.seeds.json");
  const formats::Case tracked = trackFromSeeds(volume, seeds, TrackOptions{}, silent).result;
  ASSERT_EQ(tracked.tree.branches.size(), 1u);
  EXPECT_GT(tracked.tree.nodeCount(), 150u);
  EXPECT_LT(tracked.tree.nodeCount(), 400u);
}

template <class T>
Volume volumeOf(std::vector<T> voxels) {
  Volume volume;
  volume.geometry.size = {static_cast<int>(voxels.size()), 1, 1};
  volume.voxels = std::move(voxels);
  return volume;
}

TEST(VolumeDoubt, AMaskIsNamedWithItsTwoValues) {
  const auto doubt = doubtAbout(volumeOf<std::uint8_t>({0, 0, 1, 0, 1}));
  ASSERT_TRUE(doubt);
  EXPECT_NE(doubt->find("0 or 1 only"), std::string::npos) << *doubt;
  EXPECT_TRUE(doubtAbout(volumeOf<float>({255, -1.5F, 255})));
}

TEST(VolumeDoubt, ThreeValuesAreNoMask) {
  EXPECT_FALSE(doubtAbout(volumeOf<std::int16_t>({0, 0, 1, 0, 2})));
  EXPECT_FALSE(doubtAbout(volumeOf<float>({0, 1, 0.5F})));
}

TEST(VolumeDoubt, OneValueIsRefused) {
  try {
    (void)doubtAbout(volumeOf<std::uint16_t>({7, 7, 7}));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    EXPECT_NE(std::string(error.what()).find("every voxel is 7"), std::string::npos);
  }
}

}  // namespace
}  // namespace lumen::convert
