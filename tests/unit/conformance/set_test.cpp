// SPDX-License-Identifier: Apache-2.0
// Every valid file of the conformance set, cut and flipped in all places, both readers of this
// repository over the hostile files, and the verdict of each file.
//
// No byte of a valid `.lumen` file is harmless: the header and the table have a CRC-32C each, every
// chunk has one in the table whether it is known or not, what is between the chunks must be zero,
// and CRC-32C finds every change of one bit. A new version changes none of this. So each flip of
// one bit must be refused. JSON text has no checksum: a changed digit is another valid number, so
// there only cuts are sure to be found, but for white space behind the last bracket.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "formats/case/case_file.h"
#include "formats/container/container.h"
#include "formats/view/case_view.h"
#include "unit/formats/chunk_source.h"

namespace lumen::formats {
namespace {

using Bytes = std::vector<std::byte>;

/// An allocation of exactly the bytes' size, so that a sanitizer sees a read of one byte more.
class Exact {
public:
  explicit Exact(std::span<const std::byte> bytes)
      : m_data(std::make_unique<std::byte[]>(bytes.size())), m_size(bytes.size()) {
    std::copy(bytes.begin(), bytes.end(), m_data.get());
  }
  [[nodiscard]] std::span<std::byte> span() const { return {m_data.get(), m_size}; }
  [[nodiscard]] std::string_view text() const {
    return {reinterpret_cast<const char*>(m_data.get()), m_size};
  }

private:
  std::unique_ptr<std::byte[]> m_data;
  std::size_t m_size;
};

Bytes contentsOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

std::vector<std::filesystem::path> filesOf(const std::string& folder,
                                           const std::string& extension) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(LUMEN_CONFORMANCE) / folder))
    if (entry.path().extension() == extension &&
        (extension != ".json" || entry.path().stem().extension() == ".lumen"))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  EXPECT_GE(files.size(), 50u);
  return files;
}

TEST(EveryValidFile, IsRefusedAtEveryCut) {
  for (const auto& file : filesOf("valid", ".lumen")) {
    const Bytes whole = contentsOf(file);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const Exact cut{std::span<const std::byte>(whole).first(size)};
      const auto result = decodeBinary(cut.span());
      ASSERT_FALSE(result) << file << " of " << size << " bytes";
      ASSERT_EQ(result.error().code, ErrorCode::Truncated) << file << " of " << size << " bytes";
    }
  }
}

TEST(EveryValidFile, IsRefusedAfterEveryFlipOfABit) {
  for (const auto& file : filesOf("valid", ".lumen")) {
    const Exact bytes(contentsOf(file));
    ASSERT_TRUE(decodeBinary(bytes.span())) << file;
    for (std::size_t bit = 0; bit < 8 * bytes.span().size(); ++bit) {
      const auto mask = static_cast<std::byte>(1u << (bit % 8));
      bytes.span()[bit / 8] ^= mask;
      ASSERT_FALSE(decodeBinary(bytes.span())) << file << " bit " << bit;
      bytes.span()[bit / 8] ^= mask;
    }
  }
}

TEST(EveryValidFile, IsRefusedByTheViewAfterEveryFlipOfABit) {
  for (const auto& file : filesOf("valid", ".lumen")) {
    const Exact bytes(contentsOf(file));
    if (!viewCase(bytes.span(), Verify::All)) continue;  // encoded chunks cannot be viewed
    for (std::size_t bit = 0; bit < 8 * bytes.span().size(); ++bit) {
      const auto mask = static_cast<std::byte>(1u << (bit % 8));
      bytes.span()[bit / 8] ^= mask;
      ASSERT_FALSE(viewCase(bytes.span(), Verify::All)) << file << " bit " << bit;
      bytes.span()[bit / 8] ^= mask;
    }
  }
}

TEST(EveryValidJsonFile, IsRefusedAtEveryCutOfMoreThanWhiteSpace) {
  for (const auto& file : filesOf("valid", ".json")) {
    const Bytes whole = contentsOf(file);
    const std::string_view text{reinterpret_cast<const char*>(whole.data()), whole.size()};
    const std::size_t last = text.find_last_not_of(" \t\r\n");
    for (std::size_t size = 0; size <= last; ++size) {
      const Exact cut{std::span<const std::byte>(whole).first(size)};
      ASSERT_FALSE(decodeJson(cut.text())) << file << " of " << size << " bytes";
    }
    ASSERT_TRUE(decodeJson(text.substr(0, last + 1))) << file;
  }
}

// The view does not look into the metadata, so it cannot know how node arrays should be.
TEST(EveryHostileFile, IsRefusedByTheViewUnlessItsMetadataAreAtFault) {
  for (const auto& file : filesOf("hostile", ".lumen")) {
    const Bytes whole = contentsOf(file);
    const Exact bytes(whole);
    const auto decoded = decodeBinary(bytes.span());
    ASSERT_FALSE(decoded) << file;
    const std::string pointer = decoded.error().pointer.value_or("");
    const bool needsMetadata =
        std::string_view(errorName(decoded.error().code)).starts_with("JSON_") ||
        pointer.starts_with("/metadata") || pointer.starts_with("/nodeArrays") ||
        file.stem().string().starts_with("node-array-") || file.stem() == "length-narr";
    const auto view = viewCase(bytes.span(), Verify::All);
    EXPECT_TRUE(needsMetadata || !view) << file;
  }
}

// The verdict of a file does not depend on how many of its issues are listed, nor on notes that
// come before its faults.

template <class Check>
void forEachFile(const char* folder, Check check) {
  for (const char* extension : {".lumen", ".json"})
    for (const auto& file : filesOf(folder, extension)) {
      SCOPED_TRACE(file);
      check(contentsOf(file));
    }
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
