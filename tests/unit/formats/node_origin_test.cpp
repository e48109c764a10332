// SPDX-License-Identifier: Apache-2.0
#include "formats/case/node_origin.h"

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

const std::vector<NodeOrigin> kMixed = {NodeOrigin::Measured, NodeOrigin::Bridged,
                                        NodeOrigin::Given};

Case threeNodes() {
  Case value = test::noBeads();
  addBeads(value, "a", alongX(0, 0.5F, 3), 1);
  return value;
}

Case mixedNodes() {
  Case value = threeNodes();
  setNodeOrigins(value, kMixed);
  return value;
}

TEST(NodeOrigin, IsMeasuredWhereTheCaseDoesNotSay) {
  EXPECT_EQ(readNodeOrigins(threeNodes()), std::vector<NodeOrigin>(3, NodeOrigin::Measured));
}

TEST(NodeOrigin, IsGivenBackByBothEncodings) {
  const Case value = mixedNodes();
  EXPECT_EQ(readNodeOrigins(value), kMixed);
  const auto binary = decodeCase(encodeBinary(value));
  ASSERT_TRUE(binary);
  EXPECT_EQ(readNodeOrigins(*binary), kMixed);
  const std::string text = encodeJson(value);
  const auto bytes = std::as_bytes(std::span(text));
  const auto decoded = decodeCase(bytes);
  ASSERT_TRUE(decoded);
  EXPECT_EQ(readNodeOrigins(*decoded), kMixed);
}

TEST(NodeOrigin, LeavesNothingBehindWhenAllNodesAreMeasured) {
  Case value = mixedNodes();
  value.metadata.extensionsRequired = {kOriginExtension};
  setNodeOrigins(value, std::vector<NodeOrigin>(3, NodeOrigin::Measured));
  EXPECT_EQ(value, threeNodes());
}

TEST(NodeOrigin, IsReplacedAndNotAddedTwice) {
  Case value = mixedNodes();
  setNodeOrigins(value, kMixed);
  EXPECT_EQ(value, mixedNodes());
}

TEST(NodeOrigin, LeavesOtherArraysAlone) {
  Case value = test::fullCase();
  const std::vector<NodeArray> before = value.nodeArrays;
  setNodeOrigins(value, std::vector<NodeOrigin>(value.tree.nodeCount(), NodeOrigin::Given));
  EXPECT_EQ(value.nodeArrays.size(), before.size() + 1);
  setNodeOrigins(value, std::vector<NodeOrigin>(value.tree.nodeCount(), NodeOrigin::Measured));
  EXPECT_EQ(value, test::fullCase());
}

TEST(NodeOrigin, MayBeRequiredOfAReader) {
  Case value = mixedNodes();
  value.metadata.extensionsRequired = {kOriginExtension};
  EXPECT_TRUE(validate(value));
}

// spec: M48
TEST(NodeOrigin, OfNoKnownKindIsRefusedAtItsPlace) {
  struct Wrong {
    const char* code;
    const char* pointer;
    NodeArray array;
  };
  using Integers = std::vector<std::uint32_t>;
  const Wrong wrongs[] = {
      {"ENUM_VALUE", "/nodeArrays/LUMEN_node.origin/2", {kOriginArray, 1, "", Integers{0, 1, 3}}},
      {"ENUM_VALUE",
       "/metadata/nodeArrays/0/type",
       {kOriginArray, 1, "", std::vector<std::int32_t>{0, 1, 2}}},
      {"NODE_ARRAY_COMPONENTS",
       "/metadata/nodeArrays/0/components",
       {kOriginArray, 2, "", Integers(6)}},
      {"ARRAY_LENGTH", "/nodeArrays/LUMEN_node.origin", {kOriginArray, 1, "", Integers(2)}}};
  for (const Wrong& wrong : wrongs) {
    Case value = mixedNodes();
    value.nodeArrays = {wrong.array};
    const auto result = validate(value);
    ASSERT_FALSE(result) << wrong.pointer;
    EXPECT_EQ(test::codeOf(result), wrong.code);
    EXPECT_EQ(result.error().pointer, wrong.pointer);
  }
}

TEST(NodeOrigin, OfAnotherExtensionMeansNothing) {
  Case value = threeNodes();
  value.metadata.extensionsUsed = {"ACME_node"};
  value.nodeArrays = {{"ACME_node.origin", 1, "", std::vector<std::uint32_t>{7, 8, 9}}};
  EXPECT_TRUE(validate(value));
  EXPECT_EQ(readNodeOrigins(value), std::vector<NodeOrigin>(3, NodeOrigin::Measured));
}

}  // namespace
}  // namespace lumen::formats
