// SPDX-License-Identifier: Apache-2.0
// Links, extensions, provenance and chunks of others, in both encodings.
#include <gtest/gtest.h>

#include "formats/container/bytes.h"
#include "unit/formats/sample_case.h"

namespace lumen::formats {
namespace {

using test::Bytes;
using test::codeOf;
using test::dataOf;
using test::entryOf;
using test::tamperedFull;

// The text of the full case with the first `from` fullReplaced.
std::string fullReplaced(const std::string& from, const std::string& to) {
  std::string text = encodeJson(test::fullCase());
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from << "\n" << text;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// spec: M14, M37
TEST(FullCase, IsGivenBackByTheBinaryEncoding) {
  const auto decoded = decodeBinary(encodeBinary(test::fullCase()));
  ASSERT_TRUE(decoded) << decoded.error().text();
  EXPECT_EQ(*decoded, test::fullCase());
}

// spec: M14, M35, M37
TEST(FullCase, IsGivenBackByJson) {
  const auto decoded = decodeJson(encodeJson(test::fullCase()));
  ASSERT_TRUE(decoded) << decoded.error().text();
  EXPECT_EQ(*decoded, test::fullCase());
}

TEST(FullCase, HasLinksOfEightBytesEach) {
  const Bytes file = encodeBinary(test::fullCase());
  const std::size_t at = dataOf(file, "LINK");
  EXPECT_EQ(loadLittle<std::uint64_t>(&file[entryOf(file, "LINK") + 16]), 24u);
  EXPECT_EQ(loadLittle<std::uint32_t>(&file[at + 8]), 2u);
  EXPECT_EQ(loadLittle<std::uint32_t>(&file[at + 12]), 4u);
}

TEST(FullCase, WritesItsNewPartsOfJsonLikeThis) {
  const std::string text = encodeJson(test::fullCase());
  for (const char* part :
       {"\"links\": [[0,4], [2,4], [4,5]]", "\"extensionsUsed\": [\"ACME_flow\", \"LAB2_tags\"]",
        "{\"name\": \"ACME_flow.velocity\", \"type\": \"f32\", \"components\": 3, \"unit\": "
        "\"mm/s\"}",
        "\"pointQuantisation\": {\"bits\": 14, \"step\": 0.001}",
        "\"LAB2_tags.kind\": [-1, 2, 3, 4, 5, 6]",
        "{\"type\": \"aaaa\", \"version\": 7, \"independent\": true, \"encoding\": 0, \"data\": "
        "\"AQID\"}",
        "{\"type\": \"Z9zz\", \"version\": 1, \"independent\": false, \"encoding\": 200, "
        "\"rawSize\": 99, \"data\": \"/w==\"}"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

// spec: M15
TEST(FullCase, LosesOnlyDependentChunksWhenItsNodesChange) {
  Case value = test::fullCase();
  dropDependentChunks(value);
  ASSERT_EQ(value.otherChunks.size(), 1u);
  EXPECT_EQ(value.otherChunks[0].type, "aaaa");
}

// spec: M36
TEST(FullCase, IsRefusedIfItRequiresAnExtensionAndThatIsNamed) {
  const auto result = decodeJson(fullReplaced(
      "\"nodeArrays\": [\n", "\"extensionsRequired\": [\"ACME_flow\"], \"nodeArrays\": [\n"));
  ASSERT_FALSE(result);
  EXPECT_EQ(test::codeOf(result), "EXTENSION_REQUIRED");
  EXPECT_EQ(result.error().place(), "/metadata/extensionsRequired/0");
  EXPECT_NE(result.error().message.find("ACME_flow"), std::string::npos);
}

struct JsonChange {
  const char* name;
  const char* from;
  const char* to;
  const char* code;
  const char* place;
};

class FullJson : public testing::TestWithParam<JsonChange> {};

// spec: M25, M33, M47
TEST_P(FullJson, IsRefused) {
  const auto result = decodeJson(fullReplaced(GetParam().from, GetParam().to));
  ASSERT_FALSE(result);
  EXPECT_EQ(test::codeOf(result), GetParam().code) << result.error().text();
  EXPECT_EQ(result.error().place(), GetParam().place);
}

INSTANTIATE_TEST_SUITE_P(
    All, FullJson,
    testing::Values(
        JsonChange{"link_of_three", "[2,4]", "[2,4,5]", "JSON_TYPE", "/tree/links/1/2"},
        JsonChange{"link_of_one", "[2,4]", "[2]", "JSON_TYPE", "/tree/links/1/1"},
        JsonChange{"link_flat", "[[0,4], [2,4]", "[0, [2,4]", "JSON_TYPE", "/tree/links/0"},
        JsonChange{"link_real", "[2,4]", "[2.0,4]", "JSON_TYPE", "/tree/links/1/0"},
        JsonChange{"link_negative", "[2,4]", "[-2,4]", "NUMBER_RANGE", "/tree/links/1/0"},
        JsonChange{"array_not_described", "\"LAB2_tags.kind\": [-1", "\"x-kind\": [-1",
                   "JSON_KEY_MISSING", "/nodeArrays"},
        JsonChange{"array_too_many", "\"LAB2_tags.kind\": [-1",
                   "\"ACME_more\": [], \"LAB2_tags.kind\": [-1", "JSON_KEY_UNKNOWN",
                   "/nodeArrays/ACME_more"},
        JsonChange{"array_type", "\"i32\"", "\"f64\"", "ENUM_VALUE", "/metadata/nodeArrays/1/type"},
        JsonChange{"array_real", "[-1, 2, 3, 4", "[-1, 2.5, 3, 4", "JSON_TYPE",
                   "/nodeArrays/LAB2_tags.kind/1"},
        JsonChange{"array_text", "[-1, 2, 3, 4", "[-1, \"2\", 3, 4", "JSON_TYPE",
                   "/nodeArrays/LAB2_tags.kind/1"},
        JsonChange{"array_of_33_bits", "[-1, 2, 3, 4", "[-1, 4294967296, 3, 4", "NUMBER_RANGE",
                   "/nodeArrays/LAB2_tags.kind/1"},
        JsonChange{"note_empty", "\"synthetic, \xc2\xb5m\"", "\"\"", "TEXT_LENGTH",
                   "/metadata/note"},
        JsonChange{"parent_empty", "\"parentSha256\": \"bbbb", "\"parentSha256\": \"\", \"x\": \"",
                   "JSON_KEY_UNKNOWN", "/metadata/x"},
        JsonChange{"extensions_text", "[\"ACME_flow\", \"LAB2_tags\"]", "\"ACME_flow\"",
                   "JSON_TYPE", "/metadata/extensionsUsed"},
        JsonChange{"extensions_number", "[\"ACME_flow\", \"LAB2_tags\"]", "[1]", "JSON_TYPE",
                   "/metadata/extensionsUsed/0"},
        JsonChange{"chunk_base64", "\"AQID\"", "\"AQI\"", "JSON_CHUNK_DATA", "/otherChunks/0/data"},
        JsonChange{"chunk_base64_bits", "\"/w==\"", "\"/x==\"", "JSON_CHUNK_DATA",
                   "/otherChunks/1/data"},
        JsonChange{"chunk_flag", "\"independent\": true", "\"independent\": 1", "JSON_TYPE",
                   "/otherChunks/0/independent"},
        JsonChange{"rates_empty", "[0, 0.25, 0.7, 1, 0.5, 0.125]", "[]", "ARRAY_LENGTH",
                   "/tree/inlierRate"}),
    [](const auto& instance) { return std::string(instance.param.name); });

struct BinaryChange {
  const char* name;
  void (*change)(Bytes&);
  const char* code;
};

class FullBinary : public testing::TestWithParam<BinaryChange> {};

// spec: M22, M24, M25, M26
TEST_P(FullBinary, IsRefused) {
  EXPECT_EQ(codeOf(decodeBinary(tamperedFull(GetParam().change))), GetParam().code);
}

void renameChunk(Bytes& file, const std::string& from, const char (&to)[5]) {
  storeLittle(&file[entryOf(file, from)], chunkType(to));
}

INSTANTIATE_TEST_SUITE_P(
    All, FullBinary,
    testing::Values(BinaryChange{"array_missing", [](Bytes& f) { renameChunk(f, "NARR", "qARR"); },
                                 "CHUNK_MISSING"},
                    BinaryChange{"links_twice",
                                 [](Bytes& f) {
                                   renameChunk(f, "NINL", "LINK");
                                   f[entryOf(f, "LINK") + 6] = std::byte{1};
                                 },
                                 "CHUNK_DUPLICATE"},
                    BinaryChange{"link_beyond",
                                 [](Bytes& f) { storeLittle(&f[dataOf(f, "LINK") + 20], 6u); },
                                 "LINK_NODE"},
                    BinaryChange{"array_short",
                                 [](Bytes& f) {
                                   const std::size_t entry = entryOf(f, "NARR");
                                   for (std::size_t i = 68; i < 72; ++i)
                                     f[dataOf(f, "NARR") + i] = {};
                                   storeLittle(&f[entry + 16], std::uint64_t{68});
                                   storeLittle(&f[entry + 24], std::uint64_t{68});
                                 },
                                 "CHUNK_LENGTH"}),
    [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace lumen::formats
