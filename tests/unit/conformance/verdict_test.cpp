// SPDX-License-Identifier: Apache-2.0
// The verdict of a file does not depend on how many of its issues are listed, nor on notes that
// come before its faults; shown with every file of the conformance set.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "formats/case/case_file.h"
#include "formats/container/container.h"
#include "unit/formats/chunk_source.h"

namespace lumen::formats {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::byte>;

Bytes bytesOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

template <class Check>
void forEachFile(const char* folder, Check check) {
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(LUMEN_CONFORMANCE) / folder)) {
    const std::string name = entry.path().filename().string();
    if (!name.ends_with(".lumen") && !name.ends_with(".lumen.json")) continue;
    SCOPED_TRACE(name);
    check(bytesOf(entry.path()));
    ++count;
  }
  EXPECT_GE(count, 50u);
}

void expectOneVerdict(const Bytes& file, bool valid) {
  const ValidationReport all = validateBytes(file, 100000);
  EXPECT_EQ(all.valid(), valid);
  EXPECT_EQ(all.unlisted(), 0u);
  for (const std::size_t maximum : {0u, 1u, 2u}) {
    const ValidationReport cut = validateBytes(file, maximum);
    EXPECT_EQ(cut.counts, all.counts) << maximum;
    EXPECT_EQ(cut.issues.size(), std::min(maximum, all.issues.size()));
    for (std::size_t i = 0; i < cut.issues.size(); ++i)
      EXPECT_EQ(cut.issues[i].text(), all.issues[i].text());
  }
}

// The file with 150 chunks more that a reader notes and ignores, in front of all others; nothing
// if its container is at fault.
Bytes withNotes(const Bytes& file) {
  const auto container = readContainer(file);
  if (!container || container->version > kFormatVersion) return {};
  std::vector<ChunkSource> chunks(150, ChunkSource{chunkType("note"), 1, false});
  for (const Chunk& c : container->chunks) {
    if (!verifyChunk(c)) return {};
    chunks.push_back(sourceOf(c));
  }
  return writeContainer(chunks);
}

TEST(Verdict, OfEveryHostileFileIsTheSameHoweverManyIssuesAreListed) {
  forEachFile("hostile", [](const Bytes& file) {
    if (!file.empty()) expectOneVerdict(file, false);
  });
}

TEST(Verdict, OfEveryValidFileIsTheSameHoweverManyIssuesAreListed) {
  forEachFile("valid", [](const Bytes& file) { expectOneVerdict(file, true); });
}

TEST(Verdict, OfEveryHostileFileIsTheSameBehindManyNotes) {
  std::set<ErrorCode> seen;
  forEachFile("hostile", [&](const Bytes& file) {
    const Bytes noted = withNotes(file);
    if (noted.empty()) return;
    const ValidationReport plain = validateBytes(file, 1);
    const ValidationReport report = validateBytes(noted, 1);
    EXPECT_FALSE(report.valid());
    EXPECT_EQ(report.counts.errors, plain.counts.errors);
    EXPECT_GE(report.counts.total(), report.counts.errors);
    ASSERT_EQ(report.issues.size(), 1u);
    EXPECT_EQ(report.issues[0].code, plain.issues[0].code);
    seen.insert(report.issues[0].code);
  });
  EXPECT_GE(seen.size(), 30u);  // kinds of faults
}

TEST(Verdict, OfEveryValidFileIsTheSameBehindManyNotes) {
  forEachFile("valid", [](const Bytes& file) {
    const Bytes noted = withNotes(file);
    if (noted.empty()) return;
    expectOneVerdict(noted, true);
    EXPECT_GE(validateBytes(noted, 1).counts.information, 150u);
  });
}

}  // namespace
}  // namespace lumen::formats
