// SPDX-License-Identifier: Apache-2.0
#include "formats/case/topology.h"

#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include "formats/container/bytes.h"
#include "formats/view/case_chunks.h"
#include "unit/formats/sample_case.h"

namespace lumen::formats {
namespace {

using Nodes = std::vector<std::uint32_t>;

// 0 - 1 - 2 - 5, and 1 - 3 - 4.
CenterlineTree tree() {
  return test::richCase().tree;
}

Nodes neighboursOf(const CenterlineTree& of, std::uint32_t node) {
  const Neighbours neighbours(of);
  const auto found = neighbours.of(node);
  return {found.begin(), found.end()};
}

TEST(Neighbours, AreParentAndChildrenInAscendingOrder) {
  EXPECT_EQ(neighboursOf(tree(), 0), (Nodes{1}));
  EXPECT_EQ(neighboursOf(tree(), 1), (Nodes{0, 2, 3}));
  EXPECT_EQ(neighboursOf(tree(), 4), (Nodes{3}));
  EXPECT_EQ(neighboursOf(tree(), 5), (Nodes{2}));
}

TEST(Neighbours, DoNotLinkTheTreesOfAForest) {
  CenterlineTree forest = tree();
  forest.parent[3] = kNoParent;
  EXPECT_EQ(neighboursOf(forest, 1), (Nodes{0, 2}));
  EXPECT_EQ(neighboursOf(forest, 3), (Nodes{4}));
}

TEST(Neighbours, WithinADistanceCrossBranchesNearestFirst) {
  const Neighbours neighbours(tree());
  EXPECT_EQ(neighbours.within(4, 0), (Nodes{4}));
  EXPECT_EQ(neighbours.within(4, 1), (Nodes{4, 3}));
  EXPECT_EQ(neighbours.within(4, 2), (Nodes{4, 3, 1}));
  EXPECT_EQ(neighbours.within(1, 2), (Nodes{1, 0, 2, 3, 5, 4}));
  EXPECT_EQ(neighbours.within(4, 100), (Nodes{4, 3, 1, 0, 2, 5}));
}

// spec: M5
TEST(Neighbours, AreJoinedByLinksToo) {
  CenterlineTree linked = tree();
  const auto count = static_cast<std::uint32_t>(linked.nodeCount());
  linked.links = {{0, count - 1}};
  const Neighbours neighbours(linked);
  EXPECT_EQ(neighbours.of(0).back(), count - 1);
  EXPECT_EQ(neighbours.of(count - 1).front(), 0u);
}

TEST(Neighbours, WithinADistanceAreFoundOnceAroundALoop) {
  CenterlineTree ring;
  ring.centre.resize(4);
  ring.parent = {-1, 0, 1, 2};
  ring.links = {{0, 3}};
  EXPECT_EQ(Neighbours(ring).within(0, 9), (std::vector<std::uint32_t>{0, 1, 3, 2}));
}

TEST(Neighbours, OfASingleNodeAreNone) {
  const Neighbours neighbours(test::smallestCase().tree);
  EXPECT_TRUE(neighbours.of(0).empty());
  EXPECT_EQ(neighbours.within(0, 5), (Nodes{0}));
}

TEST(BranchLength, OfARootIsItsPolyline) {
  EXPECT_DOUBLE_EQ(branchLength(tree(), tree().branches[0]), 2.5);
}

TEST(BranchLength, CountsTheLinkBeyondTheParentsRadius) {
  CenterlineTree t = tree();
  t.centre[3] = {0, 3, 1};  // 3 mm from node 1, whose radius is 2 mm; then 1 mm to node 4
  t.centre[4] = {0, 4, 1};
  EXPECT_DOUBLE_EQ(branchLength(t, t.branches[1]), 2.0);
}

TEST(BranchLength, CountsNoLinkThatEndsInsideTheParent) {
  CenterlineTree t = tree();
  t.centre[3] = {0, 1, 1};
  t.centre[4] = {0, 4, 1};
  EXPECT_DOUBLE_EQ(branchLength(t, t.branches[1]), 3.0);
}

// A fault is reported where it is: every field of a file is changed in turn, and the place that is
// named must be that field, or the one that contradicts it.
using test::Bytes;
using test::dataOf;

struct Range {
  std::uint64_t first, size;
  [[nodiscard]] bool holds(std::uint64_t at) const { return at >= first && at < first + size; }
};

// Places that the new values are compared with: another place may be at fault as well.
std::vector<Range> otherPlaces(const Bytes& file, const Issue& issue, const Range& changed) {
  std::vector<Range> others;
  const auto data = [&](const char* type) { return Range{dataOf(file, type), 6 * 24}; };
  switch (issue.code) {
    case ErrorCode::BranchParent:  // the record and the node state the same
    case ErrorCode::NodeBranch:
      return {data("NPAR"), data("NBRA"), data("BREC")};
    case ErrorCode::BranchRange:  // or the record before has the wrong number of nodes
    case ErrorCode::NodeChain:
      return {data("BREC"), data("NPAR")};
    case ErrorCode::LabelDuplicate:  // either of the two
      return {data("BLAB")};
    case ErrorCode::OffsetOrder:  // or the entry before is too large
    case ErrorCode::LinkOrder:
      return {{changed.first, 2 * changed.size}};
    default:
      return others;
  }
}

void expectPlace(const Bytes& good, const Range& field, const Range& element,
                 const std::vector<std::byte>& value) {
  Bytes file = good;
  std::copy(value.begin(), value.end(), file.begin() + static_cast<std::ptrdiff_t>(field.first));
  test::resign(file);
  const auto report = validateBytes(file, 1);
  if (report.valid()) return;
  const Issue& issue = report.issues.front();
  ASSERT_TRUE(issue.offset) << issue.text();
  bool right = element.holds(*issue.offset);
  for (const Range& other : otherPlaces(good, issue, element)) right |= other.holds(*issue.offset);
  EXPECT_TRUE(right) << issue.text() << ", but byte " << field.first << " was changed";
}

std::vector<std::byte> littleBytes(std::uint64_t value, std::size_t size) {
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i < size; ++i)
    bytes.push_back(static_cast<std::byte>(i < 8 ? value >> (8 * i) : 0));
  return bytes;
}

void sweep(const Bytes& file, const Range& field, const Range& element) {
  std::uint64_t old = 0;
  std::memcpy(&old, &file[field.first], std::min<std::size_t>(field.size, 8));
  const std::uint64_t highest = std::uint64_t{1} << (8 * field.size - 1);
  const std::uint64_t nan = 0x7fc00000, all = ~std::uint64_t{0};
  for (const std::uint64_t value :
       std::initializer_list<std::uint64_t>{old + 1, old - 1, old ^ highest, 0, all, nan})
    expectPlace(file, field, element, littleBytes(value, field.size));
}

TEST(Places, OfEveryValueInAChunkAreThoseOfItsElement) {
  const Bytes file = encodeBinary(test::fullCase());
  const auto container = readContainer(file);
  ASSERT_TRUE(container);
  constexpr std::array<Range, 8> kRecord = {
      {{0, 4}, {4, 4}, {8, 4}, {12, 4}, {16, 2}, {18, 1}, {19, 1}, {20, 4}}};
  constexpr std::array<Range, 4> kKernel = {{{0, 1}, {1, 7}, {8, 8}, {16, 8}}};
  std::size_t fields = 0;
  for (const Chunk& chunk : container->chunks) {
    const std::size_t index = chunkRuleIndex(chunk.type);
    if (index == kChunkRules.size() || chunk.type == chunk::kMetadata) continue;
    const std::uint64_t stride = kChunkRules[index].stride;
    for (std::uint64_t at = 0; at < chunk.stored.size(); at += stride) {
      // the place of a text is its first byte; the message counts from there
      const bool text = stride == 1;
      const Range element{text ? chunk.offset : chunk.offset + at,
                          text ? chunk.stored.size() : stride};
      const auto field = [&](const Range& f) {
        sweep(file, {chunk.offset + at + f.first, f.size}, element);
        ++fields;
      };
      if (chunk.type == chunk::kBranchRecords)
        for (const Range& f : kRecord) field(f);
      else if (chunk.type == chunk::kModelKernel)
        for (const Range& f : kKernel) field({f.first, f.size});
      else if (text)
        field({0, 1});
      else
        for (std::uint64_t f = 0; f < stride; f += 4) field({f, 4});
    }
  }
  EXPECT_GE(fields, 150u);
}

TEST(Places, OfEveryFieldOfTheTableAreInItsEntry) {
  const Bytes file = encodeBinary(test::fullCase());
  const auto container = readContainer(file);
  ASSERT_TRUE(container);
  constexpr std::array<Range, 5> kFields = {{{4, 2}, {6, 1}, {7, 1}, {36, 8}, {60, 4}}};
  for (const Chunk& chunk : container->chunks)
    for (const Range& f : kFields) {
      Bytes changed = file;
      for (std::uint64_t i = 0; i < f.size; ++i)
        changed[chunk.entryOffset + f.first + i] = std::byte{0xff};
      test::resign(changed);
      const auto report = validateBytes(changed, 1);
      if (report.valid()) continue;
      const Range entry{chunk.entryOffset, kTableEntrySize};
      const Range body{chunk.offset, 1};  // of an encoding
      const Issue& issue = report.issues.front();
      EXPECT_TRUE(issue.offset && (entry.holds(*issue.offset) || body.holds(*issue.offset)))
          << issue.text() << " for byte " << chunk.entryOffset + f.first;
    }
}

// Sizes in messages are those of the file, not of the field that could not hold them.
TEST(Places, OfALabelBeyondItsFieldAreToldWithItsSize) {
  Case value = test::smallestCase();
  value.tree.branches[0].label = std::string(100'000, 'a');
  const auto valid = validate(value);
  ASSERT_FALSE(valid);
  EXPECT_EQ(valid.error().text(),
            "TEXT_LENGTH at /tree/branches/0/label: found 100000, the limit is 255");
  const auto read = decodeJson(encodeJson(value));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().text(),
            "TEXT_LENGTH at /tree/branches/0/label: found 100000, the limit is 255");
}

TEST(Places, OfANumberBeyondItsTypeAreToldWithItsText) {
  for (const char* number : {"1e+39", "-1e+39", "1e400"}) {
    std::string text = encodeJson(test::smallestCase());
    const std::string kind = "\"kind\"";
    text.replace(text.find(kind), kind.size(),
                 std::string("\"meanInlierRate\": ") + number + ", " + kind);
    const auto read = decodeJson(text);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().text(),
              std::string("NUMBER_RANGE at /tree/branches/0/meanInlierRate: found ") + number +
                  ", expected a number that rounds to an f32");
  }
}

}  // namespace
}  // namespace lumen::formats
