// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/anatomical_names.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/error.h"

namespace lumen::operations {
namespace {

/// One vessel of twelve nodes, called so.
formats::Case straightVessel(const std::string& label) {
  formats::Case value;
  formats::CenterlineTree& tree = value.tree;
  for (int n = 0; n < 12; ++n) {
    tree.centre.push_back({0, 0, static_cast<float>(n)});
    tree.direction.push_back({0, 0, 1});
    tree.radius.push_back(1);
    tree.height.push_back(1);
    tree.inlierRate.push_back(1);
    tree.parent.push_back(n - 1);
    tree.branch.push_back(0);
  }
  formats::Branch branch;
  branch.label = label;
  branch.nodeCount = 12;
  tree.branches.push_back(branch);
  return value;
}

std::vector<std::string> labels(const formats::Case& value) {
  std::vector<std::string> out;
  for (const formats::Branch& branch : value.tree.branches) out.push_back(branch.label);
  return out;
}

TEST(AnatomicalNames, ABranchIsCutWhereItsNameChanges) {
  const std::vector<convert::ArteryStretch> arteries = {
      {0, 0, 3, "L-MCA", 0.9}, {0, 3, 5, "L-ICA", 0.9}, {0, 7, 12, "L-MCA", 0.9}};
  const AnatomicallyNamed named = anatomicallyNamed(straightVessel("A.1-2"), arteries);
  EXPECT_EQ(named.renamed, 3U);
  const auto found = labels(named.value);
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(found[0], "L-MCA");  // along the flow, though the other one is longer
  EXPECT_EQ(found[1], "L-ICA");
  EXPECT_EQ(found[2], "A.1-4");
  EXPECT_EQ(found[3], "L-MCA-2");
  // one lumen: each part hangs on the one before it
  const formats::CenterlineTree& tree = named.value.tree;
  EXPECT_EQ(tree.branches[1].parentNode, 2);
  EXPECT_EQ(tree.branches[3].parentNode, 6);
  for (int n = 0; n < 12; ++n)
    EXPECT_FLOAT_EQ(tree.centre[static_cast<std::size_t>(n)].z, static_cast<float>(n));
}

TEST(AnatomicalNames, ANameThatSomebodyGaveStays) {
  for (const char* const label : {"siphon", "vessel-a", "R-ICA", "A1", "M2-1"}) {
    const AnatomicallyNamed named = anatomicallyNamed(
        straightVessel(label), std::vector<convert::ArteryStretch>{{0, 0, 6, "L-ICA", 0.9}});
    EXPECT_EQ(named.renamed, 0U);
    EXPECT_EQ(labels(named.value), std::vector<std::string>{label});
  }
}

TEST(AnatomicalNames, ACaseWithoutAVolumeShowsNoSides) {
  try {
    (void)anatomicalNames(straightVessel("vessel-1"), "head.lumen");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    EXPECT_TRUE(std::string(error.what()).starts_with("head.lumen: has no source volume"));
  }
}

}  // namespace
}  // namespace lumen::operations
