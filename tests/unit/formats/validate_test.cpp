// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "formats/view/limits.h"
#include "unit/formats/sample_case.h"

namespace lumen::formats {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

// A change that breaks one rule, and what validate() must say.
struct CaseBreach {
  const char* name;
  void (*change)(Case&);
  const char* code;
  const char* place;
};

void setLabel(Case& c, const std::string& label) {
  c.tree.branches[1].label = label;
}
SourceVolume& source(Case& c) {
  return *c.metadata.source;
}

const CaseBreach kTreeBreaches[] = {
    {"no_node",
     [](Case& c) {
       c.tree = {};
       c.nodeArrays.clear();
     },
     "TREE_EMPTY", "/tree/centre"},
    {"direction_count", [](Case& c) { c.tree.direction.pop_back(); }, "ARRAY_LENGTH",
     "/tree/direction"},
    {"radius_count", [](Case& c) { c.tree.radius.push_back(1); }, "ARRAY_LENGTH", "/tree/radius"},
    {"height_count", [](Case& c) { c.tree.height.clear(); }, "ARRAY_LENGTH", "/tree/height"},
    {"parent_count", [](Case& c) { c.tree.parent.pop_back(); }, "ARRAY_LENGTH", "/tree/parent"},
    {"branch_count", [](Case& c) { c.tree.branch.pop_back(); }, "ARRAY_LENGTH", "/tree/branch"},
    {"rate_count", [](Case& c) { c.tree.inlierRate.pop_back(); }, "ARRAY_LENGTH",
     "/tree/inlierRate"},
    {"centre_nan", [](Case& c) { c.tree.centre[2].y = test::kNan; }, "NOT_FINITE",
     "/tree/centre/2/1"},
    {"centre_infinite", [](Case& c) { c.tree.centre[0].z = -kInf; }, "NOT_FINITE",
     "/tree/centre/0/2"},
    {"direction_nan", [](Case& c) { c.tree.direction[1].x = test::kNan; }, "NOT_FINITE",
     "/tree/direction/1/0"},
    {"direction_zero",
     [](Case& c) {
       c.tree.direction[1] = {0, 0, 0};
     },
     "DIRECTION_LENGTH", "/tree/direction/1"},
    {"direction_long", [](Case& c) { c.tree.direction[1].z = 1.002f; }, "DIRECTION_LENGTH",
     "/tree/direction/1"},
    {"radius_zero", [](Case& c) { c.tree.radius[5] = 0; }, "RADIUS_RANGE", "/tree/radius/5"},
    {"radius_negative", [](Case& c) { c.tree.radius[5] = -1; }, "RADIUS_RANGE", "/tree/radius/5"},
    {"radius_infinite", [](Case& c) { c.tree.radius[5] = kInf; }, "NOT_FINITE", "/tree/radius/5"},
    {"height_negative", [](Case& c) { c.tree.height[3] = -0.1f; }, "HEIGHT_RANGE",
     "/tree/height/3"},
    {"height_nan", [](Case& c) { c.tree.height[3] = test::kNan; }, "NOT_FINITE", "/tree/height/3"},
    {"rate_above_one", [](Case& c) { c.tree.inlierRate[0] = 1.01f; }, "INLIER_RATE_RANGE",
     "/tree/inlierRate/0"},
    {"rate_negative", [](Case& c) { c.tree.inlierRate[0] = -0.5f; }, "INLIER_RATE_RANGE",
     "/tree/inlierRate/0"},
    {"parent_is_itself", [](Case& c) { c.tree.parent[3] = 3; }, "NODE_PARENT", "/tree/parent/3"},
    {"parent_is_later", [](Case& c) { c.tree.parent[0] = 5; }, "NODE_PARENT", "/tree/parent/0"},
    {"parent_below_minus_one", [](Case& c) { c.tree.parent[0] = -2; }, "NODE_PARENT",
     "/tree/parent/0"},
    {"node_in_other_branch", [](Case& c) { c.tree.branch[1] = 1; }, "NODE_BRANCH",
     "/tree/branch/1"},
    {"chain_broken", [](Case& c) { c.tree.parent[2] = 0; }, "NODE_CHAIN", "/tree/parent/2"},
    {"second_root_in_branch", [](Case& c) { c.tree.parent[4] = -1; }, "NODE_CHAIN",
     "/tree/parent/4"},
    {"branch_parent_differs", [](Case& c) { c.tree.branches[1].parentNode = 0; }, "BRANCH_PARENT",
     "/tree/branches/1/parentNode"},
    {"range_gap", [](Case& c) { c.tree.branches[1].firstNode = 4; }, "BRANCH_RANGE",
     "/tree/branches/1/firstNode"},
    {"range_empty", [](Case& c) { c.tree.branches[1].nodeCount = 0; }, "BRANCH_RANGE",
     "/tree/branches/1/nodeCount"},
    {"range_too_long", [](Case& c) { c.tree.branches[2].nodeCount = 2; }, "BRANCH_RANGE",
     "/tree/branches/2/nodeCount"},
    {"range_overflow", [](Case& c) { c.tree.branches[2].nodeCount = 0xffffffff; }, "BRANCH_RANGE",
     "/tree/branches/2/nodeCount"},
    {"nodes_without_branch", [](Case& c) { c.tree.branches.pop_back(); }, "BRANCH_RANGE",
     "/tree/branches"},
    {"no_branch", [](Case& c) { c.tree.branches.clear(); }, "BRANCH_RANGE", "/tree/branches"},
    {"too_many_branches", [](Case& c) { c.tree.branches.resize(65536); }, "LIMIT",
     "/tree/branches"},
    {"label_empty", [](Case& c) { setLabel(c, ""); }, "LABEL_EMPTY", "/tree/branches/1/label"},
    {"label_twice", [](Case& c) { setLabel(c, "ICA left"); }, "LABEL_DUPLICATE",
     "/tree/branches/1/label"},
    {"label_long", [](Case& c) { setLabel(c, std::string(256, 'x')); }, "TEXT_LENGTH",
     "/tree/branches/1/label"},
    {"label_control", [](Case& c) { setLabel(c, "a\nb"); }, "TEXT_CONTROL",
     "/tree/branches/1/label"},
    {"label_c1_control", [](Case& c) { setLabel(c, "a\xc2\x85"); }, "TEXT_CONTROL",
     "/tree/branches/1/label"},
    {"label_delete", [](Case& c) { setLabel(c, "\x7f"); }, "TEXT_CONTROL",
     "/tree/branches/1/label"},
    {"label_zero_byte", [](Case& c) { setLabel(c, std::string(1, '\0')); }, "TEXT_CONTROL",
     "/tree/branches/1/label"},
    {"label_latin1", [](Case& c) { setLabel(c, "caf\xe9"); }, "TEXT_UTF8",
     "/tree/branches/1/label"},
    {"label_overlong", [](Case& c) { setLabel(c, "\xc0\xaf"); }, "TEXT_UTF8",
     "/tree/branches/1/label"},
    {"label_overlong_three", [](Case& c) { setLabel(c, "\xe0\x80\xaf"); }, "TEXT_UTF8",
     "/tree/branches/1/label"},
    {"label_surrogate", [](Case& c) { setLabel(c, "\xed\xa0\x80"); }, "TEXT_UTF8",
     "/tree/branches/1/label"},
    {"label_beyond_unicode", [](Case& c) { setLabel(c, "\xf4\x90\x80\x80"); }, "TEXT_UTF8",
     "/tree/branches/1/label"},
    {"label_cut_character", [](Case& c) { setLabel(c, "\xe2\x82"); }, "TEXT_UTF8",
     "/tree/branches/1/label"},
    {"kind", [](Case& c) { c.tree.branches[0].kind = BranchKind{2}; }, "ENUM_VALUE",
     "/tree/branches/0/kind"},
    {"stop_reason", [](Case& c) { c.tree.branches[0].stopReason = StopReason{7}; }, "ENUM_VALUE",
     "/tree/branches/0/stopReason"},
    {"mean_rate", [](Case& c) { c.tree.branches[0].meanInlierRate = 2.0f; }, "INLIER_RATE_RANGE",
     "/tree/branches/0/meanInlierRate"},
    {"mean_rate_nan", [](Case& c) { c.tree.branches[0].meanInlierRate = test::kNan; }, "NOT_FINITE",
     "/tree/branches/0/meanInlierRate"},
};

const CaseBreach kPayloadBreaches[] = {
    {"point_offset_count", [](Case& c) { c.points->offset.pop_back(); }, "ARRAY_LENGTH",
     "/points/offset"},
    {"point_offset_none", [](Case& c) { c.points->offset.clear(); }, "ARRAY_LENGTH",
     "/points/offset"},
    {"point_offset_start", [](Case& c) { c.points->offset[0] = 1; }, "OFFSET_START",
     "/points/offset/0"},
    {"point_offset_decreases", [](Case& c) { c.points->offset[3] = 1; }, "OFFSET_ORDER",
     "/points/offset/3"},
    {"point_offset_end", [](Case& c) { c.points->offset[6] = 5; }, "OFFSET_END",
     "/points/offset/6"},
    {"point_nan", [](Case& c) { c.points->position[1].x = test::kNan; }, "NOT_FINITE",
     "/points/position/1/0"},
    {"kernel", [](Case& c) { c.models->kernel = Kernel{4}; }, "ENUM_VALUE", "/models/kernel"},
    {"kernel_parameter_zero", [](Case& c) { c.models->kernelParameter = 0; }, "KERNEL_PARAMETER",
     "/models/kernelParameter"},
    {"kernel_parameter_nan", [](Case& c) { c.models->kernelParameter = test::kNan; }, "NOT_FINITE",
     "/models/kernelParameter"},
    {"unused_kernel_parameter_nan",
     [](Case& c) {
       c.models->kernel = Kernel::Quartic;
       c.models->kernelParameter = test::kNan;
     },
     "NOT_FINITE", "/models/kernelParameter"},
    {"iso_level_zero", [](Case& c) { c.models->isoLevel = 0; }, "ISO_LEVEL", "/models/isoLevel"},
    {"iso_level_infinite", [](Case& c) { c.models->isoLevel = kInf; }, "NOT_FINITE",
     "/models/isoLevel"},
    {"blob_offset_order", [](Case& c) { c.models->offset[1] = 3; }, "OFFSET_ORDER",
     "/models/offset/2"},
    {"blob_width_count", [](Case& c) { c.models->width.pop_back(); }, "ARRAY_LENGTH",
     "/models/width"},
    {"blob_width_zero", [](Case& c) { c.models->width[4] = 0; }, "WIDTH_RANGE", "/models/width/4"},
    {"blob_centre_nan", [](Case& c) { c.models->centre[4].z = test::kNan; }, "NOT_FINITE",
     "/models/centre/4/2"},
    {"voxel_size_zero", [](Case& c) { c.metadata.voxelSize = 0; }, "VOXEL_SIZE",
     "/metadata/voxelSize"},
    {"voxel_size_nan", [](Case& c) { c.metadata.voxelSize = test::kNan; }, "NOT_FINITE",
     "/metadata/voxelSize"},
    {"source_size", [](Case& c) { source(c).size[1] = 0; }, "SOURCE_SIZE",
     "/metadata/source/size/1"},
    {"source_spacing", [](Case& c) { source(c).spacing[2] = -1; }, "SOURCE_SPACING",
     "/metadata/source/spacing/2"},
    {"source_origin", [](Case& c) { source(c).origin[0] = kInf; }, "NOT_FINITE",
     "/metadata/source/origin/0"},
    {"source_axis_scaled", [](Case& c) { source(c).direction[0] = 1.001; }, "SOURCE_DIRECTION",
     "/metadata/source/direction"},
    {"source_axes_skewed", [](Case& c) { source(c).direction[1] = 0.001; }, "SOURCE_DIRECTION",
     "/metadata/source/direction"},
    {"source_digest_short", [](Case& c) { source(c).sha256.pop_back(); }, "SOURCE_SHA256",
     "/metadata/source/sha256"},
    {"source_digest_upper_case", [](Case& c) { source(c).sha256[3] = 'A'; }, "SOURCE_SHA256",
     "/metadata/source/sha256"},
    {"too_many_steps", [](Case& c) { c.metadata.steps.resize(1025); }, "LIMIT", "/metadata/steps"},
    {"step_without_name", [](Case& c) { c.metadata.steps[1].name = ""; }, "TEXT_LENGTH",
     "/metadata/steps/1/name"},
    {"tool_control", [](Case& c) { c.metadata.steps[1].tool = "a\tb"; }, "TEXT_CONTROL",
     "/metadata/steps/1/tool"},
    {"parameter_infinite", [](Case& c) { c.metadata.steps[1].parameters["a/b"] = HUGE_VAL; },
     "NOT_FINITE", "/metadata/steps/1/parameters/a~1b"},
    {"parameter_text", [](Case& c) { c.metadata.steps[0].parameters["t"] = std::string("\xff"); },
     "TEXT_UTF8", "/metadata/steps/0/parameters/t"},
    {"parameter_long",
     [](Case& c) { c.metadata.steps[0].parameters["t"] = std::string(65536, 'x'); }, "TEXT_LENGTH",
     "/metadata/steps/0/parameters/t"},
};

void setExtensions(Case& c, std::vector<std::string> used, std::vector<std::string> required) {
  c.metadata.extensionsUsed = std::move(used);
  c.metadata.extensionsRequired = std::move(required);
}

const CaseBreach kFullBreaches[] = {
    {"link_beyond",
     [](Case& c) {
       c.tree.links[2] = {4, 6};
     },
     "LINK_NODE", "/tree/links/2"},
    {"link_backwards",
     [](Case& c) {
       c.tree.links[1] = {4, 2};
     },
     "LINK_ORDER", "/tree/links/1"},
    {"link_to_itself",
     [](Case& c) {
       c.tree.links[1] = {4, 4};
     },
     "LINK_ORDER", "/tree/links/1"},
    {"link_twice", [](Case& c) { c.tree.links[1] = c.tree.links[0]; }, "LINK_ORDER",
     "/tree/links/1"},
    {"links_unsorted", [](Case& c) { std::swap(c.tree.links[1], c.tree.links[2]); }, "LINK_ORDER",
     "/tree/links/2"},
    {"link_to_parent",
     [](Case& c) {
       c.tree.links[1] = {2, 5};
     },
     "LINK_PARENT", "/tree/links/1"},
    {"too_many_links", [](Case& c) { c.tree.links.resize((std::size_t{1} << 20) + 1); }, "LIMIT",
     "/tree/links"},
    {"parent_digest", [](Case& c) { c.metadata.parentSha256 = "abc"; }, "PARENT_SHA256",
     "/metadata/parentSha256"},
    {"quantisation_bits", [](Case& c) { c.metadata.pointQuantisation->bits = 31; },
     "POINT_QUANTISATION", "/metadata/pointQuantisation/bits"},
    {"quantisation_step", [](Case& c) { c.metadata.pointQuantisation->step = 0; },
     "POINT_QUANTISATION", "/metadata/pointQuantisation/step"},
    {"note_long", [](Case& c) { c.metadata.note = std::string(65536, 'x'); }, "TEXT_LENGTH",
     "/metadata/note"},
    {"note_lines", [](Case& c) { c.metadata.note = "a\nb"; }, "TEXT_CONTROL", "/metadata/note"},
    {"random_seed_negative",
     [](Case& c) { c.metadata.steps[0].parameters["random-seed"] = std::int64_t{-1}; },
     "RANDOM_SEED", "/metadata/steps/0/parameters/random-seed"},
    {"random_seed_real", [](Case& c) { c.metadata.steps[0].parameters["random-seed"] = 1.0; },
     "RANDOM_SEED", "/metadata/steps/0/parameters/random-seed"},
    {"extension_without_vendor",
     [](Case& c) {
       setExtensions(c, {"ACME_flow", "LAB2_tags", "flow"}, {});
     },
     "EXTENSION_NAME", "/metadata/extensionsUsed/2"},
    {"extension_in_lower_case",
     [](Case& c) {
       setExtensions(c, {"ACME_flow", "LAB2_tags", "acme_flow"}, {});
     },
     "EXTENSION_NAME", "/metadata/extensionsUsed/2"},
    {"extension_twice",
     [](Case& c) {
       setExtensions(c, {"ACME_flow", "LAB2_tags", "ACME_flow"}, {});
     },
     "EXTENSION_DUPLICATE", "/metadata/extensionsUsed/2"},
    {"extension_required_unused",
     [](Case& c) {
       setExtensions(c, {"ACME_flow", "LAB2_tags"}, {"ACME_other"});
     },
     "EXTENSION_UNLISTED", "/metadata/extensionsRequired/0"},
    {"extension_required",
     [](Case& c) {
       setExtensions(c, {"ACME_flow", "LAB2_tags"}, {"ACME_flow"});
     },
     "EXTENSION_REQUIRED", "/metadata/extensionsRequired/0"},
    {"array_of_unused_extension", [](Case& c) { setExtensions(c, {"ACME_flow"}, {}); },
     "EXTENSION_UNLISTED", "/metadata/nodeArrays/1/name"},
    {"array_name", [](Case& c) { c.nodeArrays[1].name = "LAB2_tags"; }, "NODE_ARRAY_NAME",
     "/metadata/nodeArrays/1/name"},
    {"array_twice", [](Case& c) { c.nodeArrays[1].name = c.nodeArrays[0].name; }, "NODE_ARRAY_NAME",
     "/metadata/nodeArrays/1/name"},
    {"array_without_components", [](Case& c) { c.nodeArrays[0].components = 0; },
     "NODE_ARRAY_COMPONENTS", "/metadata/nodeArrays/0/components"},
    {"array_of_17_components", [](Case& c) { c.nodeArrays[0].components = 17; },
     "NODE_ARRAY_COMPONENTS", "/metadata/nodeArrays/0/components"},
    {"array_length", [](Case& c) { c.nodeArrays[0].components = 2; }, "ARRAY_LENGTH",
     "/nodeArrays/ACME_flow.velocity"},
    {"array_nan", [](Case& c) { std::get<0>(c.nodeArrays[0].values)[4] = test::kNan; },
     "NOT_FINITE", "/nodeArrays/ACME_flow.velocity/4"},
    {"other_chunk_is_known", [](Case& c) { c.otherChunks[0].type = "NRAD"; }, "JSON_CHUNK_DATA",
     "/otherChunks/0"},
    {"other_chunk_type", [](Case& c) { c.otherChunks[0].type = "a b"; }, "JSON_CHUNK_DATA",
     "/otherChunks/0"},
    {"other_chunk_size", [](Case& c) { c.otherChunks[0].rawSize = 4; }, "JSON_CHUNK_DATA",
     "/otherChunks/0"},
    {"too_many_extensions",
     [](Case& c) { c.metadata.extensionsUsed = std::vector<std::string>(257, "ACME_flow"); },
     "LIMIT", "/metadata/extensionsUsed"},
    {"too_many_arrays", [](Case& c) { c.nodeArrays.resize(257, c.nodeArrays[0]); }, "LIMIT",
     "/metadata/nodeArrays"},
    {"too_many_other_chunks", [](Case& c) { c.otherChunks.resize(3801, c.otherChunks[0]); },
     "LIMIT", "/otherChunks"},
};

class Validate : public testing::TestWithParam<CaseBreach> {};

// spec: M2, M3, M4, M29, M38, M39, M41
TEST_P(Validate, NamesTheBrokenRuleAndItsPlace) {
  Case value = test::fullCase();
  GetParam().change(value);
  const auto result = validate(value);
  ASSERT_FALSE(result);
  EXPECT_EQ(test::codeOf(result), GetParam().code);
  EXPECT_EQ(result.error().place(), GetParam().place);
  EXPECT_FALSE(result.error().message.empty());
}

const auto breachName = [](const auto& instance) { return std::string(instance.param.name); };
INSTANTIATE_TEST_SUITE_P(Tree, Validate, testing::ValuesIn(kTreeBreaches), breachName);
INSTANTIATE_TEST_SUITE_P(Full, Validate, testing::ValuesIn(kFullBreaches), breachName);
INSTANTIATE_TEST_SUITE_P(Payload, Validate, testing::ValuesIn(kPayloadBreaches), breachName);

// Those of motions are in motion_test.cpp.
TEST(ValidateRules, OfTheModelAllHaveABreachAbove) {
  std::set<std::string> covered;
  for (const CaseBreach& breach : kTreeBreaches) covered.insert(breach.code);
  for (const CaseBreach& breach : kPayloadBreaches) covered.insert(breach.code);
  for (const CaseBreach& breach : kFullBreaches) covered.insert(breach.code);
  for (const ErrorRule& rule : errorRules())
    if (rule.code >= ErrorCode::Limit && rule.code < ErrorCode::IoMissing &&
        rule.code != ErrorCode::LabelOffset &&  // of the binary encoding alone
        (rule.code < ErrorCode::MotionTime || rule.code > ErrorCode::MotionFactor) &&
        rule.severity == Severity::Error) {
      EXPECT_TRUE(covered.contains(rule.name)) << rule.name;
    }
}

TEST(ValidateRules, HoldForTheSampleCases) {
  EXPECT_EQ(test::codeOf(validate(test::richCase())), "OK");
  EXPECT_EQ(test::codeOf(validate(test::fullCase())), "OK");
  EXPECT_EQ(test::codeOf(validate(test::smallestCase())), "OK");
  EXPECT_EQ(test::codeOf(validate(test::movingCase())), "OK");
}

TEST(ValidateRules, AllowAForest) {
  Case value = test::richCase();
  value.tree.parent[3] = kNoParent;
  value.tree.branches[1].parentNode = kNoParent;
  EXPECT_EQ(test::codeOf(validate(value)), "OK");
}

TEST(ValidateRules, AllowATreeWithoutRatesPointsAndModels) {
  Case value = test::richCase();
  value.tree.inlierRate.clear();
  value.points.reset();
  value.models.reset();
  value.metadata = {};
  EXPECT_EQ(test::codeOf(validate(value)), "OK");
}

TEST(ValidateRules, AllowNodesWithoutPointsAndBlobs) {
  Case value = test::smallestCase();
  value.points = PointSets{{0, 0}, {}};
  value.models = BlobbyModels{Kernel::Quartic, 0, 0.1, {0, 0}, {}, {}};
  EXPECT_EQ(test::codeOf(validate(value)), "OK");
}

TEST(ValidateRules, AllowTheLimitsThemselves) {
  Case value = test::richCase();
  setLabel(value, std::string(255, 'x'));
  value.tree.radius[0] = std::numeric_limits<float>::denorm_min();
  value.tree.height[0] = 0;
  value.tree.direction[0] = {0, 0, 0.9995f};
  EXPECT_EQ(test::codeOf(validate(value)), "OK");
}

TEST(ValidateRules, AllowLabelsInAnyScript) {
  Case value = test::richCase();
  setLabel(value, "\xe8\xa1\x80\xe7\xae\xa1 \xf0\x9f\xab\x80 \xd1\x81\xd0\xbe\xd1\x81");
  EXPECT_EQ(test::codeOf(validate(value)), "OK");
}

}  // namespace
}  // namespace lumen::formats
