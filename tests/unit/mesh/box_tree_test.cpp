// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/box_tree.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/random.h"

namespace lumen::convert {
namespace {

struct Boxes {
  std::vector<Box3d> box;
  std::vector<Eigen::Vector3d> middle;
};

Boxes randomBoxes(std::size_t count) {
  Random random(7, count);
  Boxes boxes;
  for (std::size_t i = 0; i < count; ++i) {
    boxes.middle.emplace_back(random.uniform(), random.uniform(), random.uniform());
    boxes.box.emplace_back().add(boxes.middle.back(), 0.1 * random.uniform());
  }
  return boxes;
}

void expectSound(const BoxTree<double>& tree, const std::vector<Box3d>& boxes) {
  std::vector<std::uint32_t> items = tree.items(), all(boxes.size());
  std::sort(items.begin(), items.end());
  std::iota(all.begin(), all.end(), 0U);
  EXPECT_EQ(items, all);
  std::size_t held = 0;
  for (std::uint32_t i = 0; i < tree.nodes().size(); ++i) {
    const BoxTree<double>::Node& node = tree.node(i);
    Box3d around;
    if (node.count == 0) {
      EXPECT_GT(node.at, i + 1);
      around = tree.node(i + 1).box;
      around.add(tree.node(node.at).box);
    }
    for (std::uint32_t k = node.at; k < node.at + node.count; ++k)
      around.add(boxes[tree.items()[k]]);
    EXPECT_EQ(node.box, around) << i;
    EXPECT_LE(node.count, BoxTree<double>::kLeafItems);
    held += node.count;
  }
  EXPECT_EQ(held, boxes.size());
}

TEST(BoxTree, HoldsEveryItemOnceInBoxesThatFit) {
  for (const std::size_t count : {1U, 4U, 5U, 8U, 9U, 100U, 1025U}) {
    const Boxes boxes = randomBoxes(count);
    expectSound(BoxTree<double>(boxes.box), boxes.box);
    expectSound(BoxTree<double>(boxes.box, boxes.middle), boxes.box);
  }
}

TEST(BoxTree, KeepsTheOrderOfItemsThatAreNeighboursAndFillsLeaves) {
  const BoxTree<double> tree(randomBoxes(1025).box);
  EXPECT_TRUE(std::is_sorted(tree.items().begin(), tree.items().end()));
  std::size_t leaves = 0;
  for (const auto& node : tree.nodes()) leaves += node.count > 0 ? 1 : 0;
  EXPECT_EQ(leaves, 257U);  // 256 of four items, and one
}

TEST(BoxTree, OfNothingHasNoNodes) {
  EXPECT_TRUE(BoxTree<float>(std::vector<Box3f>{}).nodes().empty());
}

TEST(Box, IsEmptyUntilAPointIsAdded) {
  Box3d box;
  EXPECT_TRUE(box.isEmpty());
  box.add(Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(box.isEmpty());
  EXPECT_TRUE(box.contains({1, 2, 3}));
}

TEST(Box, MeetsOneThatSharesAFace) {
  Box3d one, other;
  one.add(Eigen::Vector3d(0, 0, 0), 1.0);
  other.add(Eigen::Vector3d(2, 0, 0), 1.0);
  EXPECT_TRUE(one.meets(other));
  other.low.x() += 1e-12;
  EXPECT_FALSE(one.meets(other));
}

TEST(Box, GapIsWhatPointAndBoxAreApart) {
  Box3d box;
  box.add(Eigen::Vector3d(0, 0, 0), 1.0);
  EXPECT_EQ(box.gap({4, 0.5, -3}), Eigen::Vector3d(3, 0, 2));
}

}  // namespace
}  // namespace lumen::convert
