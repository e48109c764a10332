// SPDX-License-Identifier: Apache-2.0
// Texts that lumen validate --privacy takes for personal.
#include "converters/base/privacy.h"

#include <set>

#include <gtest/gtest.h>

#include "formats/case/case_file.h"
#include "formats/container/container.h"

namespace lumen::test {

namespace {

using Places = std::multiset<std::string>;

std::string findings(const std::string& text) {
  std::string codes;
  for (const PrivacyFinding& finding : scanText(text, "/metadata/note"))
    codes.append(codes.empty() ? "" : " ").append(finding.code);
  return codes;
}

Places places(std::span<const std::byte> file) {
  Places found;
  for (const PrivacyFinding& finding : scanPrivacy(file)) found.insert(finding.pointer);
  return found;
}

/// One node, and every kind of text with `word` in it.
formats::Case caseWith(const std::string& word) {
  formats::Case value;
  auto& tree = value.tree;
  tree.centre = {{1, 2, 3}};
  tree.direction = {{0, 0, 1}};
  tree.radius = tree.height = {1};
  tree.parent = {-1};
  tree.branch = {0};
  formats::Branch branch;
  branch.label = word;
  branch.nodeCount = 1;
  tree.branches = {branch};
  auto& metadata = value.metadata;
  metadata.note = word;
  metadata.parentSha256 = std::string(64, '1');
  metadata.steps = {{"track", word, {{word, 1.0}, {"when", word}}}};
  metadata.extensionsUsed = {"ACME_flow"};
  value.nodeArrays = {{"ACME_flow.speed", 1, word, std::vector<float>{1}}};
  value.otherChunks = {{"acme", 1, true, 0, word.size(), {}}};
  for (const char c : word) value.otherChunks[0].bytes.push_back(static_cast<std::byte>(c));
  return value;
}

// spec: M40
TEST(Privacy, FindsDates) {
  for (const char* text : {"2014-03-21", "scan of 21.3.2014", "3/21/2014", "3/21/14", "21-03-2014",
                           "20140321", "on 21 March", "March 2014", "Mar. 3", "taken 1999.12.31"})
    EXPECT_EQ(findings(text).substr(0, 12), "PRIVACY_DATE") << text;
}

// spec: M40
TEST(Privacy, FindsPathsAndAddresses) {
  for (const char* text : {"/home/someone/scan.nrrd", "C:\\scans\\a.dcm", "see /data/x", "~/scans",
                           "file://a", "https://example.org/x", "\\\\server\\share", "../scans/a"})
    EXPECT_EQ(findings(text), "PRIVACY_PATH") << text;
  EXPECT_EQ(findings("ask someone@example.org"), "PRIVACY_ADDRESS");
}

// spec: M40
TEST(Privacy, FindsNumbersAndNames) {
  for (const char* text : {"id 4711081508", "1.2.840.10008.1.2", "1234567"})
    EXPECT_EQ(findings(text), "PRIVACY_NUMBER") << text;
  for (const char* text : {"Doe^Jane", "Mrs. Doe", "patient: Doe", "Dr Doe", "MRN 12", "born 70"})
    EXPECT_EQ(findings(text), "PRIVACY_NAME") << text;
}

TEST(Privacy, LeavesAnatomyAndParametersAlone) {
  for (const char* text : {"ICA left",
                           "MCA M1/M2 right",
                           "basilar",
                           "A1",
                           "1.5",
                           "0.2 mm",
                           "lumen 0.1.0",
                           "track",
                           "aneurysm of the anterior communicating artery",
                           "marginal branch",
                           "dome",
                           "-0.25",
                           "512 x 512 x 300",
                           "vertebral artery (left)",
                           "N/A",
                           "left/right",
                           "\xce\xb1/2",
                           "kernel-parameter",
                           "random-seed",
                           "stop 3, step 14",
                           "decoder",
                           "septal"})
    EXPECT_EQ(findings(text), "") << text;
}

TEST(Privacy, LooksAtEveryTextOfACaseInBothEncodings) {
  const formats::Case value = caseWith("2014.3.21");
  const Places expected = {"/tree/branches/0/label",
                           "/metadata/note",
                           "/metadata/steps/0/tool",
                           "/metadata/steps/0/parameters/2014.3.21",
                           "/metadata/steps/0/parameters/when",
                           "/metadata/nodeArrays/0/unit",
                           "/otherChunks/0"};
  formats::EncodeOptions compressed;
  compressed.compress = true;
  EXPECT_EQ(places(formats::encodeBinary(value)), expected);
  EXPECT_EQ(places(formats::encodeBinary(value, compressed)), expected);
  const std::string text = formats::encodeJson(value);
  EXPECT_EQ(places(std::as_bytes(std::span(text))), expected);
}

TEST(Privacy, FindsNothingInACaseWithoutPersonalTexts) {
  const formats::Case value = caseWith("carotid");
  EXPECT_EQ(places(formats::encodeBinary(value)), Places{});
  const std::string text = formats::encodeJson(value);
  EXPECT_EQ(places(std::as_bytes(std::span(text))), Places{});
}

TEST(Privacy, LooksAtComments) {
  std::string text = formats::encodeJson(caseWith("carotid"));
  text.insert(text.find("\"units\""), "\"x-who\": [1, {\"a\": \"Doe^Jane\"}, \"fine\"], ");
  const auto found = scanPrivacy(std::as_bytes(std::span(text)));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].code, "PRIVACY_NAME");
  EXPECT_EQ(found[0].pointer, "/metadata/x-who/1/a");
}

TEST(Privacy, LooksAtCommentsOfABinaryFile) {
  const std::string metadata =
      R"({"coordinateSystem":"LPS","units":"mm","steps":[],"x-day":"2014-03-21"})";
  formats::Case value = caseWith("carotid");
  value.nodeArrays.clear();
  value.otherChunks.clear();
  const auto file = formats::encodeBinary(value);
  const auto container = formats::readContainer(file);
  std::vector<formats::ChunkSource> chunks;
  for (const formats::Chunk& chunk : container->chunks)
    chunks.push_back({chunk.type, 1, true, {chunk.stored.begin(), chunk.stored.end()}});
  const auto bytes = std::as_bytes(std::span(metadata));
  chunks[0].bytes.assign(bytes.begin(), bytes.end());
  EXPECT_EQ(places(formats::writeContainer(chunks)), Places{"/metadata/x-day"});
}

TEST(Privacy, SurvivesLongTexts) {
  for (const char c : {'1', 'a', '@', '.', '/', ' ', '-'}) {
    const std::string text(65535, c);
    EXPECT_LE(scanText(text, "").size(), 2u) << c;
  }
}

}  // namespace

}  // namespace lumen::test
