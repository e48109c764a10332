// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/automatic_names.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/stages/editing/edit.h"
#include "tests/unit/formats/beads.h"

namespace lumen::convert {
namespace {

using formats::Case;
using formats::test::addBeads;
using formats::test::alongX;
using Labels = std::vector<std::string>;

Labels namesIn(const Case& value) {
  Labels out;
  for (const formats::Branch& branch : value.tree.branches) out.push_back(branch.label);
  return out;
}

/// A short tree before a long one, whose root has two limbs, the first of them the smaller one. On the
/// larger limb hangs a vessel, and on that another.
Case twoTrees() {
  Case value;
  addBeads(value, "vessel-1", alongX(0, 1, 10, 50), 1);
  addBeads(value, "vessel-2", alongX(0, 1, 30), 2);
  addBeads(value, "vessel-3", alongX(5, 1, 10, 4), 1, 15);
  addBeads(value, "vessel-4", alongX(9, 1, 20, 8), 1, 20);
  addBeads(value, "vessel-5", alongX(12, 1, 9, 12), 1, 55);
  addBeads(value, "vessel-6", alongX(12, 1, 5, 16), 1, 75);
  return value;
}

TEST(AutomaticNames, AreOfTreesLimbsAndNumbersTheLargestFirst) {
  Case value = twoTrees();
  nameAutomatically(value.tree);
  EXPECT_EQ(namesIn(value), (Labels{"B.0", "A.0", "A.2", "A.1", "A.1.1", "A.1.2"}));
  nameAutomatically(value.tree);  // they are no names of a tree that is being made
  EXPECT_EQ(namesIn(value)[0], "B.0");
}

TEST(AutomaticNames, ASmallVesselMoreRenamesNone) {
  Case value = twoTrees();
  addBeads(value, "vessel-7", alongX(0, 1, 4, -9), 0.5F, 12);
  addBeads(value, "vessel-8", alongX(0, 1, 4, -12), 0.5F, 50);
  nameAutomatically(value.tree);
  EXPECT_EQ(namesIn(value), (Labels{"B.0", "A.0", "A.2", "A.1", "A.1.1", "A.1.2", "A.3", "A.1.3"}));
}

TEST(AutomaticNames, WidthCountsAsItsSquare) {
  Case value;
  addBeads(value, "vessel-1", alongX(0, 1, 21), 1);
  addBeads(value, "vessel-2", alongX(0, 1, 11, 9), 1.5F);
  addBeads(value, "vessel-3", alongX(0, 1, 8, 20), 1.5F);
  nameAutomatically(value.tree);
  EXPECT_EQ(namesIn(value), (Labels{"B.0", "A.0", "C.0"}));
}

TEST(AutomaticNames, NamesOfPeopleStayAndHoldTheirPlace) {
  Case value = twoTrees();
  value.tree.branches[3].label = "L-MCA";
  value.tree.branches[4].label = "A1";
  nameAutomatically(value.tree, 0, {"vessel-1"});
  EXPECT_EQ(namesIn(value), (Labels{"vessel-1", "A.0", "A.2", "L-MCA", "A1", "A.1.2"}));
}

TEST(AutomaticNames, FurtherVesselsGetNamesBesideThoseThatAre) {
  Case value = twoTrees();
  nameAutomatically(value.tree);
  value.tree.branches[1].label = "trunk";
  addBeads(value, "vessel-1", alongX(0, 1, 40, -9), 3, 12);
  addBeads(value, "vessel-2", alongX(0, 1, 40, -12), 3, 55);
  addBeads(value, "vessel-3", alongX(0, 1, 40, 90), 9);
  nameAutomatically(value.tree, 6);
  EXPECT_EQ(namesIn(value),
            (Labels{"B.0", "trunk", "A.2", "A.1", "A.1.1", "A.1.2", "A.3", "A.1.3", "C.0"}));
}

TEST(AutomaticNames, LettersGoOnBehindZ) {
  Case value;
  for (int k = 0; k < 28; ++k)
    addBeads(value, "vessel-" + std::to_string(k + 1), alongX(0, 1, 40 - k, float(k)), 1);
  nameAutomatically(value.tree);
  EXPECT_EQ(value.tree.branches[25].label, "Z.0");
  EXPECT_EQ(value.tree.branches[27].label, "AB.0");
}

TEST(AutomaticNames, ANestOfVesselsHasShortNames) {
  Case value;
  addBeads(value, "vessel-1", alongX(0, 1, 5), 1);
  for (int k = 1; k < 600; ++k)
    addBeads(value, "vessel-" + std::to_string(k + 1), alongX(float(k), 1, 5, float(k)), 1,
             5 * k - 1);
  nameAutomatically(value.tree);
  EXPECT_EQ(value.tree.branches.back().label, "A.1.598");
}

TEST(AutomaticNames, AreNeverThoseOfPeople) {
  for (const char* const label :
       {"A.0", "A.1", "B.1.23", "AA.4-2", "A.1.2-3", "vessel-4", "vessel-4-2-2"})
    EXPECT_TRUE(isAutomaticName(label)) << label;
  for (const char* const label :
       {"", "A", "A1", "A1.2", "M2", "a.1", "A.", "A.x", "A.1.", "A.1.2.3", "A.1-", "A.1-b", "ICA",
        "L-PCA-2", "vessel", "vessel-", "vessel-b", "vessel-1b", "my A.1"})
    EXPECT_FALSE(isAutomaticName(label)) << label;
}

TEST(AutomaticNames, PiecesAreNumberedAlongTheFlow) {
  Case value;
  addBeads(value, "A.0", alongX(0, 1, 20), 1);
  addBeads(value, "A.0-b", alongX(0, 1, 5, 9), 1);
  cutBefore(value, 10, Rest::Child, "");
  cutBefore(value, 15, Rest::Child, "");
  cutBefore(value, 5, Rest::Child, "");
  EXPECT_EQ(namesIn(value), (Labels{"A.0", "A.0-2", "A.0-3", "A.0-4", "A.0-b"}));
}

TEST(AutomaticNames, NamesOfOlderCasesMayHaveSeveralNumbers) {
  Case value;
  addBeads(value, "vessel-1", alongX(0, 1, 20), 1);
  addBeads(value, "vessel-1-2", alongX(0, 1, 20, 9), 1);
  addBeads(value, "vessel-1-2-2", alongX(0, 1, 5, 18), 1);
  addBeads(value, "vessel-1-1", alongX(0, 1, 5, 27), 1);
  cutBefore(value, 30, Rest::Child, "");
  cutBefore(value, 10, Rest::Child, "");
  EXPECT_EQ(namesIn(value), (Labels{"vessel-1", "vessel-1-2", "vessel-1-3", "vessel-1-4",
                                    "vessel-1-2-2", "vessel-1-1"}));
}

TEST(AutomaticNames, AFreeNameIsTheFirstPieceThatIsNot) {
  EXPECT_EQ(freeName("ICA", {"MCA"}), "ICA");
  EXPECT_EQ(freeName("ICA", {"ICA", "ICA-2"}), "ICA-3");
  EXPECT_EQ(freeName("ICA-2", {"ICA-2"}), "ICA-2-2");
  EXPECT_EQ(freeName("A.1-2", {"A.1-2"}), "A.1-3");
}

}  // namespace
}  // namespace lumen::convert
