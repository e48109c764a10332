// SPDX-License-Identifier: Apache-2.0
// Hundreds of edits in random order, on cases of every kind: whatever was done, the case obeys the rules
// of the format, and nodes that nobody touched are as they were.
#include <algorithm>
#include <filesystem>
#include <set>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/base/random.h"
#include "converters/base/vectors.h"
#include "converters/io/centerline/case_of_centerline.h"
#include "converters/io/centerline/centerline_readers.h"
#include "converters/stages/editing/edit.h"
#include "converters/stages/editing/wall_edits.h"
#include "converters/stages/phantom/phantom.h"
#include "formats/case/case_file.h"
#include "formats/case/topology.h"
#include "formats/case/validate.h"
#include "unit/formats/sample_case.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::Case;

/// With one blob for each node.
Case withModels(Case value) {
  const formats::CenterlineTree& tree = value.tree;
  formats::BlobbyModels models;
  models.offset.push_back(0);
  for (std::size_t i = 0; i < tree.nodeCount(); ++i) {
    models.centre.push_back(tree.centre[i]);
    models.width.push_back(tree.radius[i]);
    models.offset.push_back(static_cast<std::uint32_t>(i + 1));
  }
  value.models = std::move(models);
  return value;
}

/// One edit with arguments that may be wrong.
Change randomEdit(Case& value, Random& random) {
  const auto branch = [&] {
    return random.below(static_cast<std::uint32_t>(value.tree.branches.size() + 1));
  };
  const auto node = [&] {
    return random.below(static_cast<std::uint32_t>(value.tree.nodeCount() + 1));
  };
  const bool coin = random.uniform() < 0.5;
  switch (random.below(14)) {
    case 0:
      return deleteBranch(value, branch(), coin ? Hanging::Stay : Hanging::Go);
    case 1:
    case 2:
      return cutBefore(value, node(), coin ? Rest::OwnTree : Rest::Child);
    case 3:
    case 4:
      return joinBranch(value, branch(), node());
    case 5:
      return mergeIntoParent(value, branch());
    case 6:
      return reverseBranch(value, branch());
    case 7:
      return makeRoot(value, branch());
    case 8:
      return coin ? setKind(value, branch(), formats::BranchKind::Aneurysm)
                  : renameBranch(value, branch(), "name " + std::to_string(random.below(20)));
    case 9:
      return addNodeBehind(value, node());
    case 10:
      return deleteNode(value, node());
    case 11:
      return widenAround(value, node(), 0.5 + random.uniform(), 3 * random.uniform());
    case 12: {
      const std::uint32_t at = node();
      const formats::Vec3f centre =
          at < value.tree.nodeCount() ? value.tree.centre[at] : formats::Vec3f{};
      return pushWall(
          value, at,
          {toEigen(centre) + Vector3d(0, 1, 0), Vector3d(0.1, 0.3, -0.2), 2 * random.uniform()});
    }
    default: {
      const std::uint32_t moved = node();
      if (moved == value.tree.nodeCount()) return moveNode(value, moved, Vector3d::Zero(), 1);
      const double radius = double{value.tree.radius[moved]};
      return moveNode(value, moved,
                      toEigen(value.tree.centre[moved]) + radius * Vector3d(0.3, -0.2, 0.1),
                      1.2 * radius);
    }
  }
}

template <class Array>
Array partOf(const std::vector<std::uint32_t>& offset, const Array& values, std::uint32_t node) {
  return {values.begin() + offset[node], values.begin() + offset[node + 1]};
}

std::multiset<std::uint32_t> oldAround(const formats::Neighbours& around, std::uint32_t node,
                                       const std::vector<std::uint32_t>& before) {
  std::multiset<std::uint32_t> out;
  for (const std::uint32_t n : around.of(node)) out.insert(before.empty() ? n : before[n]);
  return out;
}

/// Expects the values that every edit leaves as they were.
void expectKept(const Case& was, const Case& now, const Change& change) {
  ASSERT_EQ(change.before.size(), now.tree.nodeCount());
  ASSERT_TRUE(std::is_sorted(change.stale.begin(), change.stale.end()));
  const formats::Neighbours aroundWas(was.tree), aroundNow(now.tree);
  std::set<std::uint32_t> seen;
  for (std::uint32_t n = 0; n < now.tree.nodeCount(); ++n) {
    const std::uint32_t old = change.before[n];
    const bool isStale = std::binary_search(change.stale.begin(), change.stale.end(), n);
    if (old == kNewNode) {
      ASSERT_TRUE(isStale || !now.models);
      continue;
    }
    ASSERT_TRUE(seen.insert(old).second) << "node " << old << " is there twice";
    if (now.models) {
      ASSERT_EQ(partOf(now.models->offset, now.models->centre, n),
                partOf(was.models->offset, was.models->centre, old));
    }
    if (isStale || !now.models) continue;
    ASSERT_EQ(now.tree.centre[n], was.tree.centre[old]);
    ASSERT_EQ(now.tree.radius[n], was.tree.radius[old]);
    ASSERT_EQ(oldAround(aroundNow, n, change.before), oldAround(aroundWas, old, {}));
    if (now.points) {
      ASSERT_EQ(partOf(now.points->offset, now.points->position, n),
                partOf(was.points->offset, was.points->position, old));
    }
  }
}

/// So many edits that were done. The case begins anew when little of it is left.
void expectEditsToKeepRules(const Case& start, int count, std::uint64_t seed) {
  Random random(seed);
  Case value = start;
  int done = 0, refused = 0;
  while (done < count && refused < 100 * count) {
    if (value.tree.branches.size() < 2 && start.tree.branches.size() > 1) value = start;
    if (value.tree.nodeCount() > 3 * start.tree.nodeCount() + 1000) value = start;
    const Case before = value;
    try {
      const Change change = randomEdit(value, random);
      const auto valid = formats::validate(value);
      ASSERT_TRUE(valid) << change.sentence << ": " << valid.error().text();
      expectKept(before, value, change);
      if (testing::Test::HasFatalFailure()) FAIL() << change.sentence;
      ++done;
    } catch (const Error& error) {
      ASSERT_EQ(error.kind(), ErrorKind::InvalidInput) << error.what();
      ASSERT_EQ(value, before) << error.what();
      ++refused;
    }
  }
  ASSERT_EQ(done, count);
  const auto decoded = formats::decodeBinary(formats::encodeBinary(value));
  ASSERT_TRUE(decoded) << decoded.error().text();
  EXPECT_EQ(*decoded, value);
}

TEST(RandomEdits, OfACaseWithEverythingThatAFileCanHold) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed)
    expectEditsToKeepRules(formats::test::fullCase(), 50, seed);
}

TEST(RandomEdits, OfAPhantomsTree) {
  PhantomOptions options;
  options.name = "patient";
  options.size = 128;
  Progress silent;
  expectEditsToKeepRules(withModels(makePhantom(options, silent).truth), 15, 3);
}

TEST(RandomEdits, OfRealArteries) {
  const auto folder = std::filesystem::path(LUMEN_SHARED_DATA) / "arteries";
  std::filesystem::path file;
  if (std::filesystem::exists(folder))
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".swc" && (file.empty() || entry.path() < file))
        file = entry.path();
  if (file.empty()) GTEST_SKIP() << "no arteries/*.swc in the shared data";
  expectEditsToKeepRules(withModels(caseOfCenterline(readSwc(file), file.string())), 10, 4);
}

}  // namespace
}  // namespace lumen::convert
