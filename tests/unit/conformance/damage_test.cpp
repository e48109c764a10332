// SPDX-License-Identifier: Apache-2.0
// Every valid file of the conformance set, cut and flipped in all places, and both readers of this
// repository over the hostile files.
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
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "formats/case/case_file.h"
#include "formats/view/case_view.h"

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
  EXPECT_FALSE(files.empty());
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

}  // namespace
}  // namespace lumen::formats
