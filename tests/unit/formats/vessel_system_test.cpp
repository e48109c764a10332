// SPDX-License-Identifier: Apache-2.0
#include "formats/case/vessel_system.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "formats/case/case_encoding.h"
#include "formats/case/case_file.h"
#include "formats/case/validate.h"
#include "tests/unit/formats/beads.h"
#include "tests/unit/formats/sample_case.h"

namespace lumen::formats {
namespace {

using test::addBeads;
using test::alongX;

constexpr VesselSystem kNoSystem = VesselSystem::Unknown, kOfArtery = VesselSystem::Artery,
                       kOfVein = VesselSystem::Vein, kOfTrueLumen = VesselSystem::TrueLumen,
                       kOfFalseLumen = VesselSystem::FalseLumen;
const std::vector<VesselSystem> kSixSystems = {kOfArtery, kOfArtery,     kOfVein,
                                               kNoSystem, kOfFalseLumen, kOfTrueLumen};

/// Two vessels of three nodes each.
Case sixNodes() {
  Case value = test::noBeads();
  addBeads(value, "a", alongX(0, 0.5F, 3), 1);
  addBeads(value, "b", alongX(9, 0.5F, 3), 1);
  return value;
}

Case sixNodesOfSystems() {
  Case value = sixNodes();
  setNodeSystems(value, kSixSystems);
  return value;
}

TEST(VesselSystem, IsUnknownWhereTheCaseDoesNotSay) {
  EXPECT_EQ(readNodeSystems(sixNodes()), std::vector<VesselSystem>(6, kNoSystem));
}

TEST(VesselSystem, IsGivenBackByBothEncodings) {
  const Case value = sixNodesOfSystems();
  const auto binary = decodeCase(encodeBinary(value));
  ASSERT_TRUE(binary);
  EXPECT_EQ(readNodeSystems(*binary), kSixSystems);
  const std::string text = encodeJson(value);
  const auto decoded = decodeCase(std::as_bytes(std::span(text)));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(readNodeSystems(*decoded), kSixSystems);
}

TEST(VesselSystem, OfABranchIsThatOfMostOfItsNodes) {
  // of three nodes that differ, the lowest value
  EXPECT_EQ(readBranchSystems(sixNodesOfSystems()), (std::vector{kOfArtery, kNoSystem}));
}

TEST(VesselSystem, LeavesNothingBehindWhereAllAreUnknown) {
  Case value = sixNodesOfSystems();
  value.metadata.extensionsRequired = {kSystemExtension};
  EXPECT_TRUE(validate(value));
  setNodeSystems(value, std::vector<VesselSystem>(6, kNoSystem));
  EXPECT_EQ(value, sixNodes());
}

TEST(VesselSystem, OfArteriesVeinsAndFalseLumensAreApart) {
  const std::vector<std::vector<VesselSystem>> together = {
      {kOfArtery, kOfTrueLumen, kNoSystem}, {kOfVein, kNoSystem}, {kOfFalseLumen, kNoSystem}};
  for (std::size_t i = 0; i < kVesselSystemCount; ++i)
    for (std::size_t k = 0; k < kVesselSystemCount; ++k) {
      const auto a = static_cast<VesselSystem>(i), b = static_cast<VesselSystem>(k);
      const bool isTogether = std::any_of(together.begin(), together.end(), [&](const auto& group) {
        return std::count(group.begin(), group.end(), a) > 0 &&
               std::count(group.begin(), group.end(), b) > 0;
      });
      EXPECT_EQ(areApart(a, b), !isTogether) << i << " " << k;
    }
}

// spec: M55
TEST(VesselSystem, OfNoKnownKindIsRefusedAtItsPlace) {
  struct Wrong {
    const char* code;
    const char* pointer;
    NodeArray array;
  };
  using Integers = std::vector<std::uint32_t>;
  const Wrong wrongs[] = {
      {"ENUM_VALUE",
       "/nodeArrays/LUMEN_vessel.system/2",
       {kSystemArray, 1, "", Integers{0, 4, 5, 0, 0, 0}}},
      {"ENUM_VALUE",
       "/metadata/nodeArrays/0/type",
       {kSystemArray, 1, "", std::vector<std::int32_t>(6)}},
      {"NODE_ARRAY_COMPONENTS",
       "/metadata/nodeArrays/0/components",
       {kSystemArray, 2, "", Integers(12)}},
      {"ARRAY_LENGTH", "/nodeArrays/LUMEN_vessel.system", {kSystemArray, 1, "", Integers(5)}}};
  for (const Wrong& wrong : wrongs) {
    Case value = sixNodesOfSystems();
    value.nodeArrays = {wrong.array};
    const auto result = validate(value);
    ASSERT_FALSE(result) << wrong.pointer;
    EXPECT_EQ(test::codeOf(result), wrong.code);
    EXPECT_EQ(result.error().pointer, wrong.pointer);
  }
}

}  // namespace
}  // namespace lumen::formats
