// SPDX-License-Identifier: Apache-2.0
#include "formats/case/privacy.h"

#include <gtest/gtest.h>

#include "unit/formats/sample_case.h"

namespace lumen::formats {
namespace {

std::string findings(const std::string& text) {
  IssueList issues(100);
  scanText(text, "/metadata/note", issues);
  std::string codes;
  for (const Issue& issue : issues.issues())
    codes.append(codes.empty() ? "" : " ").append(errorName(issue.code));
  return codes;
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

TEST(Privacy, LooksAtEveryTextOfACase) {
  Case value = test::fullCase();
  const std::string date = "2014-03-21";
  value.tree.branches[1].label = date;
  value.metadata.note = date;
  value.metadata.steps[0].tool = date;
  value.metadata.steps[1].parameters[date] = 1.0;
  value.metadata.steps[1].parameters["when"] = date;
  value.nodeArrays[0].unit = date;
  for (const char c : "xx" + date) value.otherChunks[0].bytes.push_back(static_cast<std::byte>(c));
  IssueList issues(100);
  scanPrivacy(value, issues);
  std::vector<std::string> places;
  for (const Issue& issue : issues.issues())
    if (issue.code == ErrorCode::PrivacyDate) places.push_back(*issue.pointer);
  EXPECT_EQ(places,
            (std::vector<std::string>{
                "/tree/branches/1/label", "/metadata/note", "/metadata/steps/0/tool",
                "/metadata/steps/1/parameters/2014-03-21", "/metadata/steps/1/parameters/when",
                "/metadata/nodeArrays/0/unit", "/otherChunks/0"}));
}

TEST(Privacy, LooksAtComments) {
  std::string text = encodeJson(test::smallestCase());
  text.insert(text.find("\"units\""), "\"x-who\": [1, {\"a\": \"Doe^Jane\"}, \"fine\"], ");
  const auto report = validateBytes(std::as_bytes(std::span(text)), {100, true});
  ASSERT_EQ(report.issues.size(), 1u);
  EXPECT_EQ(report.issues[0].code, "PRIVACY_NAME");
  EXPECT_EQ(report.issues[0].place, "/metadata/x-who/1/a");
}

TEST(Privacy, LooksAtCommentsOfABinaryFile) {
  std::string metadata =
      R"({"coordinateSystem":"LPS","units":"mm","steps":[],"x-day":"2014-03-21"})";
  const auto file = encodeBinary(test::smallestCase());
  const auto container = readContainer(file);
  std::vector<ChunkSource> chunks;
  for (const Chunk& chunk : container->chunks)
    chunks.push_back({chunk.type, 1, true, {chunk.stored.begin(), chunk.stored.end()}});
  const auto bytes = std::as_bytes(std::span(metadata));
  chunks[0].bytes.assign(bytes.begin(), bytes.end());
  const auto report = validateBytes(writeContainer(chunks), {100, true});
  ASSERT_EQ(report.issues.size(), 1u);
  EXPECT_EQ(report.issues[0].pointer, "/metadata/x-day");
}

TEST(Privacy, IsLookedAtOnlyWhenAskedFor) {
  Case value = test::smallestCase();
  value.metadata.note = "2014-03-21";
  const auto file = encodeBinary(value);
  EXPECT_TRUE(validateBytes(file, {100, false}).valid());
  EXPECT_FALSE(validateBytes(file, {100, true}).valid());
}

}  // namespace
}  // namespace lumen::formats
