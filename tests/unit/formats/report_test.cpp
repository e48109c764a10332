// SPDX-License-Identifier: Apache-2.0
// The validator that collects: every issue with its code, severity, arguments and places.
#include <algorithm>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "formats/container/bytes.h"
#include "formats/container/printable.h"
#include "unit/formats/allocation_meter.h"
#include "unit/formats/chunk_source.h"
#include "unit/formats/sample_case.h"

namespace lumen::formats {
namespace {

using test::Bytes;
using test::dataOf;
using test::tamperedFull;

std::vector<std::string> codes(const ValidationReport& report) {
  std::vector<std::string> found;
  for (const Issue& issue : report.issues) found.push_back(errorName(issue.code));
  return found;
}

ValidationReport reportOf(const Bytes& file, std::size_t maxIssues = 100) {
  return validateBytes(file, maxIssues);
}

ValidationReport reportOf(const std::string& text) {
  return validateBytes(std::as_bytes(std::span(text)));
}

using Codes = std::vector<std::string>;

TEST(Report, OfAValidFileTellsOnlyOfUnknownChunks) {
  const auto report = reportOf(encodeBinary(test::fullCase()));
  EXPECT_TRUE(report.valid());
  EXPECT_TRUE(report.unlisted() == 0);
  EXPECT_EQ(codes(report), (Codes{"CHUNK_IGNORED", "CHUNK_IGNORED"}));
  EXPECT_EQ(severityOf(report.issues[0].code), Severity::Information);
  EXPECT_TRUE(reportOf(encodeJson(test::richCase())).issues.empty());
}

// The file with so many chunks more, of each of which a reader notes that it does not know it.
Bytes withNotes(const Bytes& file, std::size_t count) {
  const auto container = readContainer(file);
  std::vector<ChunkSource> chunks;
  for (const Chunk& c : container->chunks) chunks.push_back(sourceOf(c));
  chunks.insert(chunks.end(), count, ChunkSource{chunkType("abcd"), 1, false});
  return writeContainer(chunks);
}

Bytes manyFaults() {
  return tamperedFull([](Bytes& f) {
    storeLittle(&f[dataOf(f, "NRAD") + 4], -1.0f);
    storeLittle(&f[dataOf(f, "NRAD") + 8], 0.0f);
    storeLittle(&f[dataOf(f, "NPAR") + 12], 77);
    storeLittle(&f[dataOf(f, "LINK") + 4], 99u);
    storeLittle(&f[dataOf(f, "MWID")], -0.5f);
  });
}

TEST(Report, HasEveryFaultOfABinaryFile) {
  auto found = codes(reportOf(manyFaults()));
  std::erase(found, "CHUNK_IGNORED");
  EXPECT_EQ(found, (Codes{"RADIUS_RANGE", "RADIUS_RANGE", "NODE_PARENT", "BRANCH_PARENT",
                          "LINK_NODE", "WIDTH_RANGE"}));
}

TEST(Report, PlacesFaultsOfABinaryFileByByteAndByPointer) {
  const Bytes file = manyFaults();
  const auto report = reportOf(file);
  const auto found = std::find_if(report.issues.begin(), report.issues.end(),
                                  [](const Issue& e) { return e.code == ErrorCode::WidthRange; });
  ASSERT_NE(found, report.issues.end());
  EXPECT_EQ(found->offset, dataOf(file, "MWID"));
  EXPECT_EQ(found->place(), "byte " + std::to_string(dataOf(file, "MWID")));
  EXPECT_EQ(found->pointer, "/models/width/0");
  EXPECT_EQ(found->text(), "WIDTH_RANGE at byte " + std::to_string(dataOf(file, "MWID")) +
                               " (/models/width/0): found -0.5, expected more than 0 mm");
}

TEST(Report, HasTheArgumentsOfTheRule) {
  const auto report = reportOf(manyFaults());
  const std::vector<Argument> expected = {{"found", "-1"}, {"expected", "more than 0 mm"}};
  EXPECT_EQ(report.issues[0].arguments, expected) << report.issues[0].text();
}

TEST(Report, ListsSoManyButCountsAll) {
  const auto all = reportOf(manyFaults());
  EXPECT_EQ(all.counts, (IssueCounts{6, 0, 2}));
  EXPECT_EQ(all.unlisted(), 0u);
  for (const std::size_t maximum : {0u, 1u, 3u, 6u, 7u}) {
    const auto report = reportOf(manyFaults(), maximum);
    EXPECT_FALSE(report.valid()) << maximum;
    EXPECT_EQ(report.issues.size(), maximum);
    EXPECT_EQ(report.counts, all.counts) << maximum;
    EXPECT_EQ(report.unlisted(), 8 - maximum);
    for (std::size_t i = 0; i < maximum; ++i)
      EXPECT_EQ(report.issues[i].text(), all.issues[i].text());
  }
}

TEST(Report, ListsErrorsBeforeNotesHoweverManyNotesCameFirst) {
  Bytes file = withNotes(encodeBinary(test::smallestCase()), 150);
  storeLittle(&file[dataOf(file, "NCEN")], std::numeric_limits<float>::quiet_NaN());
  test::resign(file);
  for (const std::size_t maximum : {1u, 100u}) {
    const auto report = reportOf(file, maximum);
    EXPECT_FALSE(report.valid());
    EXPECT_EQ(report.counts, (IssueCounts{1, 0, 150}));
    EXPECT_EQ(codes(report).front(), "NOT_FINITE");
    EXPECT_EQ(report.issues.size(), maximum);
  }
}

// Every node has a fault, of which few are listed: the others are counted, and not built.
TEST(Report, OfAMillionFaultsTakesNoMemoryForThoseThatAreNotListed) {
  constexpr std::size_t kNodes = 1 << 20;
  Case value = test::smallestCase();
  CenterlineTree& tree = value.tree;
  tree.branches[0].nodeCount = kNodes;
  tree.centre.resize(kNodes);
  tree.direction.resize(kNodes, Vec3f{2, 0, 0});
  tree.radius.resize(kNodes, -1.0f);
  tree.height.resize(kNodes, -1.0f);
  tree.branch.resize(kNodes, 7);
  tree.parent.resize(kNodes, kNodes);
  const Bytes file = encodeBinary(value);
  test::startMeter();
  const auto report = reportOf(file, 100);
  EXPECT_FALSE(report.valid());
  EXPECT_EQ(report.issues.size(), 100u);
  EXPECT_GE(report.counts.errors, 6 * (kNodes - 1));
  EXPECT_LE(test::peakBytes(), 2 * file.size() + (1u << 20));
}

TEST(Report, HasEveryFaultOfJson) {
  std::string text = encodeJson(test::richCase());
  const auto replace = [&text](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("\"LPS\"", "\"RAS\"");
  replace("\"units\": \"mm\",", "");
  replace("\"aneurysm\"", "\"vein\"");
  EXPECT_EQ(codes(reportOf(text)), (Codes{"COORDINATE_SYSTEM", "JSON_KEY_MISSING", "ENUM_VALUE"}));
}

TEST(Report, HasEveryWrongChecksum) {
  Bytes file = encodeBinary(test::richCase());
  file[dataOf(file, "NRAD")] ^= std::byte{1};
  file[dataOf(file, "MWID")] ^= std::byte{1};
  EXPECT_EQ(codes(reportOf(file)), (Codes{"CHUNK_CHECKSUM", "CHUNK_CHECKSUM"}));
}

TEST(Report, WarnsOfANegativeZero) {
  const auto report =
      reportOf(tamperedFull([](Bytes& f) { storeLittle(&f[dataOf(f, "NCEN")], -0.0f); }));
  EXPECT_TRUE(report.valid());
  const auto found = codes(report);
  EXPECT_EQ(std::count(found.begin(), found.end(), "NEGATIVE_ZERO"), 1);
}

TEST(Report, WarnsOfChunksInAnotherOrder) {
  const Bytes file = encodeBinary(test::smallestCase());
  const auto container = readContainer(file);
  ASSERT_TRUE(container);
  std::vector<ChunkSource> chunks;
  for (const Chunk& chunk : container->chunks)
    chunks.push_back({chunk.type, 1, true, {chunk.stored.begin(), chunk.stored.end()}});
  std::swap(chunks[3], chunks[4]);
  const auto report = reportOf(writeContainer(chunks));
  EXPECT_TRUE(report.valid());
  EXPECT_EQ(codes(report), Codes{"CHUNK_ORDER"});
}

TEST(Report, OfWhatIsNoCaseSaysSo) {
  EXPECT_EQ(codes(reportOf(std::string("solid cube"))), Codes{"NOT_LUMEN"});
}

TEST(Report, PlacesValuesOfEveryArrayInTheirChunk) {
  struct Place {
    const char* chunk;
    std::size_t at;
    const char* pointer;
  };
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Place& place :
       {Place{"NCEN", 12 * 2 + 4, "/tree/centre/2/1"}, Place{"NDIR", 12 + 8, "/tree/direction/1/2"},
        Place{"NRAD", 8, "/tree/radius/2"}, Place{"NHEI", 4, "/tree/height/1"},
        Place{"NINL", 20, "/tree/inlierRate/5"}, Place{"PPOS", 12 + 8, "/points/position/1/2"},
        Place{"MCEN", 12, "/models/centre/1/0"}, Place{"MWID", 8, "/models/width/2"},
        Place{"BREC", 24 + 20, "/tree/branches/1/meanInlierRate"},
        Place{"NARR", 16, "/nodeArrays/ACME_flow.velocity/4"}}) {
    std::size_t at = 0;
    const auto result = decodeBinary(tamperedFull([&](Bytes& f) {
      at = dataOf(f, place.chunk) + place.at;
      storeLittle(&f[at], nan);
    }));
    ASSERT_FALSE(result) << place.pointer;
    EXPECT_EQ(test::codeOf(result), "NOT_FINITE") << result.error().text();
    EXPECT_EQ(result.error().offset, at) << result.error().text();
    EXPECT_EQ(result.error().pointer, place.pointer);
  }
}

TEST(Report, PlacesALabelInItsChunk) {
  const Bytes file = tamperedFull([](Bytes& f) { f[dataOf(f, "BLAB") + 8] = std::byte{0xff}; });
  const auto result = decodeBinary(file);
  ASSERT_FALSE(result);
  EXPECT_EQ(test::codeOf(result), "TEXT_UTF8");
  EXPECT_EQ(result.error().offset, dataOf(file, "BLAB") + 8);
}

// Every text and every key of a file in turn is one that would forge a line.
TEST(Report, OfHostileTextsIsLinesThatNobodyForged) {
  const std::string good = encodeJson(test::fullCase());
  const std::string evil = "\\nx: valid\\u001b[2K\\u0085\xe2\x80\xae\xe2\x80\xa8";
  std::size_t texts = 0;
  for (std::size_t at = good.find('"'); at != std::string::npos; at = good.find('"', at)) {
    const std::size_t end = good.find('"', at + 1);
    std::string text = good;
    text.replace(at + 1, end - at - 1, evil);
    at = end + 1;
    const auto report = reportOf(text);
    for (const Issue& issue : report.issues) {
      ++texts;
      ASSERT_EQ(issue.text(), printable(issue.text()));
      ASSERT_EQ(issue.place(), printable(issue.place()));
    }
  }
  EXPECT_GE(texts, 80u);
}

// Whatever goes wrong, the arguments are those that the rule declares.
TEST(Report, HasNoArgumentThatItsRuleDoesNotDeclare) {
  const Bytes good = encodeBinary(test::fullCase());
  const std::string text = encodeJson(test::fullCase());
  std::set<std::string> seen;
  const auto check = [&seen](const ValidationReport& report) {
    for (const Issue& issue : report.issues) {
      const ErrorRule& rule = errorRule(issue.code);
      ASSERT_EQ(rule.code, issue.code);
      seen.insert(rule.name);
      std::istringstream words(rule.arguments);
      const std::set<std::string> declared{std::istream_iterator<std::string>(words), {}};
      for (const Argument& argument : issue.arguments)
        ASSERT_TRUE(declared.contains(argument.name)) << rule.name << " " << argument.name;
    }
  };
  for (std::size_t at = 0; at < good.size(); ++at) {
    Bytes file = good;
    file[at] ^= std::byte{0xff};
    check(reportOf(file));
    test::resign(file);
    check(reportOf(file));
  }
  for (std::size_t at = 0; at < text.size(); ++at)
    for (const char c : {'-', '9', '"', 'x'}) {
      std::string changed = text;
      changed[at] = c;
      check(reportOf(changed));
    }
  EXPECT_GE(seen.size(), 45u);
}

}  // namespace
}  // namespace lumen::formats
