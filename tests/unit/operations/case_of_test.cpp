// SPDX-License-Identifier: Apache-2.0
// Sources of every kind become cases, and a case a surface, without a file.
#include "converters/operations/case_of.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "converters/operations/surface_of.h"
#include "converters/stages/phantom/phantom.h"
#include "formats/case/validate.h"

namespace lumen::operations {
namespace {

convert::Phantom phantom(const std::string& name) {
  convert::PhantomOptions options;
  options.name = name;
  options.size = 64;
  Progress progress;
  return convert::makePhantom(options, progress);
}

/// 1 where a phantom's voxels are more vessel than not, else 0.
convert::Volume labelsOf(const convert::Volume& volume) {
  constexpr std::int16_t kHalf = 600;
  std::vector<std::uint8_t> voxels;
  for (const std::int16_t value : std::get<std::vector<std::int16_t>>(volume.voxels))
    voxels.push_back(value > kHalf ? 1 : 0);
  return {volume.geometry, std::move(voxels)};
}

convert::LabelMeaning meaning(std::int64_t value, const std::string& name) {
  convert::LabelMeaning named;
  named.value = value;
  named.name = name;
  return named;
}

/// A straight vessel of 1 mm along z with a point every mm.
convert::CenterlineFile straightLine() {
  convert::CenterlineFile file;
  for (int z = 0; z <= 10; ++z) file.points.push_back({{0, 0, double(z)}, 1, z - 1});
  file.unit = 1;
  file.axes = convert::CenterlineAxes::Lps;
  return file;
}

class CaseWarnings : public Progress {
public:
  void warn(std::string_view message) override { texts.emplace_back(message); }
  std::vector<std::string> texts;
};

class CaseOfTest : public testing::Test {
protected:
  [[nodiscard]] static Source grey(const convert::Phantom& phantom) {
    Source source;
    source.name = "tube";
    source.grey = phantom.volume;
    return source;
  }

  /// The message of the error that the source ends in.
  [[nodiscard]] std::string fault(Source source, const CaseOptions& options,
                                  const Context& context) const {
    try {
      (void)caseOf(std::move(source), options, context);
    } catch (const Error& error) {
      return error.what();
    }
    return "none";
  }

  Progress m_progress;
  Context m_context{m_progress};
};

TEST_F(CaseOfTest, SeededVoxelsBecomeACaseWithModelsAndAClosedSurface) {
  const convert::Phantom tube = phantom("tube");
  CaseOptions options;
  options.vessels.seeds = tube.seeds;
  options.models.emplace();
  const MadeCase made = caseOf(grey(tube), options, m_context);
  EXPECT_TRUE(formats::validate(made.value));
  ASSERT_TRUE(made.value.models);
  EXPECT_EQ(made.value.tree.branches.front().label, tube.seeds.front().label);
  const Surface surface = surfaceOf(made.value, {}, "tube", m_context);
  ASSERT_TRUE(surface.report);
  EXPECT_EQ(surface.report->trees, 1U);
  EXPECT_EQ(surface.levels.front().triangle.size(), surface.report->triangles);
}

TEST_F(CaseOfTest, VesselsAreFoundWithoutSeedsAndGetNoModelsUnlessAskedFor) {
  const MadeCase made = caseOf(grey(phantom("tube")), {}, m_context);
  EXPECT_EQ(made.value.tree.branches.size(), 1U);
  EXPECT_FALSE(made.value.models);
  EXPECT_TRUE(made.value.points);
}

TEST_F(CaseOfTest, ARootThatLiesInNoVesselIsReportedByItsFieldWithTheDistanceToTheNearest) {
  CaseOptions options;
  options.vessels.roots.emplace_back(-100, 0, 0);
  const std::string text = fault(grey(phantom("tube")), options, m_context);
  EXPECT_TRUE(
      text.starts_with("tube: root[0] lies in no vessel that is found: the wall of the "
                       "nearest vessel, \"A.0\", is 10"))
      << text;
  EXPECT_TRUE(text.ends_with(" mm away; nothing is written")) << text;
  Context other = m_context.within(m_progress);
  other.fieldWord = [](std::string_view field, std::optional<std::size_t>) {
    return "the " + std::string(field);
  };
  EXPECT_TRUE(fault(grey(phantom("tube")), options, other)
                  .starts_with("tube: the root lies in no vessel that is found: "));
}

TEST_F(CaseOfTest, AHintInTheDarkStartsNoVesselAndIsReportedWithItsDistance) {
  convert::Phantom tube = phantom("tube");
  // as in an angiogram whose background was cut off
  for (std::int16_t& value : std::get<std::vector<std::int16_t>>(tube.volume.voxels))
    if (value < 300) value = 0;
  CaseOptions options;
  options.vessels.seeds = tube.seeds;
  const std::string parent = tube.seeds.front().label;
  const std::vector<formats::Vec3f>& axis = tube.truth.tree.centre;
  convert::SeedBranch dark;
  dark.label = "dark";
  dark.parent = parent;
  dark.points.push_back({toEigen(axis[axis.size() / 2]) + Eigen::Vector3d(3, 0, 0), std::nullopt});
  options.vessels.seeds.push_back(dark);
  CaseWarnings heard;
  const MadeCase made = caseOf(grey(tube), options, m_context.within(heard));
  ASSERT_EQ(made.value.tree.branches.size(), 1U);
  EXPECT_EQ(made.value.tree.branches[0].label, parent);
  ASSERT_EQ(made.remarks.failures.size(), 1U);
  const std::string& reason = made.remarks.failures[0].reason;
  EXPECT_NE(reason.find("it has 0 around the seed, and in the background 0"), std::string::npos)
      << reason;
  EXPECT_NE(reason.find("nearest vessel, \"" + parent + "\", is 2."), std::string::npos) << reason;
  ASSERT_EQ(heard.texts.size(), 1U);
  EXPECT_NE(heard.texts[0].find("\"dark\" started no track"), std::string::npos);
}

TEST_F(CaseOfTest, RootsAtOneEndAreReported) {
  const convert::Phantom tube = phantom("tube");
  CaseOptions options;
  const Eigen::Vector3d root = tube.seeds.front().points.front().position;
  options.vessels.roots = {root, root + Eigen::Vector3d(0, 0, 0.3)};
  CaseWarnings heard;
  (void)caseOf(grey(tube), options, m_context.within(heard));
  ASSERT_EQ(heard.texts.size(), 1U);
  EXPECT_NE(heard.texts[0].find("no tree begins at root[1]: an earlier root"), std::string::npos);
}

TEST_F(CaseOfTest, LabelsAreVesselsWithTheirNames) {
  Source source;
  source.labels = LabelPart{labelsOf(phantom("tube").volume), "mask", {meaning(1, "trunk")}};
  const MadeCase made = caseOf(std::move(source), {}, m_context);
  ASSERT_EQ(made.value.tree.branches.size(), 1U);
  EXPECT_EQ(made.value.tree.branches.front().label, "trunk");
}

TEST_F(CaseOfTest, MapsNameTheVesselsOfGreyVoxels) {
  const convert::Phantom tube = phantom("tube");
  Source source = grey(tube);
  source.maps.push_back({labelsOf(tube.volume), "map", {meaning(1, "trunk")}});
  const MadeCase made = caseOf(std::move(source), {}, m_context);
  EXPECT_EQ(made.value.tree.branches.front().label, "trunk");
}

TEST_F(CaseOfTest, TheFirstMapNamesAndALabelStatedToBeNoVesselHasNone) {
  const convert::Phantom tube = phantom("tube");
  convert::LabelMeaning bone = meaning(1, "rib");
  const auto sourceWith = [&](bool isStated) {
    bone.role = convert::LabelRole::Bone;
    bone.isStated = isStated;
    Source source = grey(tube);
    source.maps.push_back({labelsOf(tube.volume), "first", {bone}});
    source.maps.push_back({labelsOf(tube.volume), "second", {meaning(1, "trunk")}});
    return source;
  };
  EXPECT_EQ(caseOf(sourceWith(false), {}, m_context).value.tree.branches.front().label, "rib");
  EXPECT_TRUE(fault(sourceWith(true), {}, m_context).starts_with("tube: no vessels are found"));
}

TEST_F(CaseOfTest, AMapThatRenamesAVesselOfASeedIsReported) {
  const convert::Phantom tube = phantom("tube");
  Source source = grey(tube);
  source.maps.push_back({labelsOf(tube.volume), "map", {meaning(1, "trunk")}});
  CaseOptions options;
  options.vessels.seeds = tube.seeds;
  CaseWarnings heard;
  const MadeCase made = caseOf(std::move(source), options, m_context.within(heard));
  EXPECT_EQ(made.value.tree.branches.front().label, "trunk");
  ASSERT_EQ(heard.texts.size(), 1U);
  EXPECT_EQ(heard.texts[0], "the seeds: seed \"" + tube.seeds.front().label +
                                "\" names no vessel: a label map names it; it lies in \"trunk\" "
                                "[seed-unused]");
}

TEST_F(CaseOfTest, MapsThatAreNoLabelsAreRefusedByName) {
  const convert::Phantom tube = phantom("tube");
  Source source = grey(tube);
  source.maps.push_back({tube.volume, "map", {}});
  EXPECT_TRUE(fault(std::move(source), {}, m_context).starts_with("map: its voxels are no labels"));
}

TEST_F(CaseOfTest, ACenterlineBecomesACaseWhoseMeshBecomesACaseAgain) {
  Source line;
  line.centerline = CenterlinePart{straightLine(), "line"};
  CaseOptions options;
  options.models.emplace();
  const MadeCase made = caseOf(std::move(line), options, m_context);
  ASSERT_TRUE(made.value.models);
  const Surface surface = surfaceOf(made.value, {}, "line", m_context);

  Source mesh;
  mesh.mesh.emplace();
  constexpr double kCentimetre = 10;
  for (const auto& p : surface.levels.front().position)
    mesh.mesh->file.mesh.position.push_back(
        Eigen::Vector3d(double{p[0]}, double{p[1]}, double{p[2]}) / kCentimetre);
  mesh.mesh->file.mesh.triangle = surface.levels.front().triangle;
  options.meshUnit = kCentimetre;
  const MadeCase again = caseOf(std::move(mesh), options, m_context);
  ASSERT_TRUE(again.meshFrame);
  EXPECT_EQ(again.meshFrame->unitFrom, "option");
  EXPECT_EQ(again.value.tree.branches.size(), 1U);
  const std::vector<float>& radii = again.value.tree.radius;
  EXPECT_NEAR(radii[radii.size() / 2], 1.0F, 0.05F);
}

TEST_F(CaseOfTest, ACaseWithModelsStaysAsItIs) {
  Source line;
  line.centerline = CenterlinePart{straightLine(), "line"};
  CaseOptions options;
  options.models.emplace();
  const formats::Case made = caseOf(std::move(line), options, m_context).value;
  Source source;
  source.value = made;
  const formats::Case same = caseOf(std::move(source), options, m_context).value;
  EXPECT_EQ(same.metadata.steps.size(), made.metadata.steps.size());
  EXPECT_TRUE(same.models == made.models);
}

TEST_F(CaseOfTest, ItEndsWhenItsListenerIsCancelled) {
  m_progress.cancel();
  EXPECT_EQ(fault(grey(phantom("tube")), {}, m_context), "interrupted");
}

}  // namespace
}  // namespace lumen::operations
