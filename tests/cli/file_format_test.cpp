// SPDX-License-Identifier: Apache-2.0
// The table of formats.
#include "converters/engine/file_format.h"

#include <filesystem>
#include <set>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/engine/file_access.h"

namespace lumen::engine {

namespace {

/// Error that `ask` throws: the kind as its exit code, and the message; empty if it throws nothing.
template <class Ask>
std::string refusal(Ask ask) {
  try {
    (void)ask();
  } catch (const Error& error) {
    return std::to_string(static_cast<int>(error.kind())) + ": " + error.what();
  }
  return {};
}

TEST(FileFormats, EachHasANameAndATitleAndCanDoSomething) {
  for (const FileFormat& format : fileFormats()) {
    EXPECT_FALSE(format.name.empty() || format.title.empty());
    EXPECT_TRUE(canRead(format) || canWrite(format) || canWriteVolume(format)) << format.name;
  }
}

TEST(FileFormats, NamesAndEndingsAreUnique) {
  std::set<std::string_view> names, endings;
  for (const FileFormat& format : fileFormats()) {
    EXPECT_TRUE(names.insert(format.name).second) << format.name;
    for (const auto ending : format.endings) EXPECT_TRUE(endings.insert(ending).second) << ending;
  }
}

TEST(FileFormats, KindsMatchWhatIsReadAndWritten) {
  for (const FileFormat& format : fileFormats()) {
    const bool volume = format.kind == FormatKind::Volume;
    EXPECT_EQ(format.readVolume != nullptr, volume) << format.name;
    EXPECT_EQ(format.readMesh != nullptr, format.kind == FormatKind::Mesh) << format.name;
    EXPECT_FALSE(volume && canWrite(format)) << format.name;
    EXPECT_EQ(format.readCase != nullptr, format.kind == FormatKind::Case) << format.name;
  }
}

TEST(FileFormats, TheLongestEndingInAnyCaseChooses) {
  EXPECT_EQ(inputFormat("a.nii", "").name, "nii");
  EXPECT_EQ(inputFormat("b.NII.GZ", "").name, "nii.gz");
  EXPECT_EQ(inputFormat("x.y.Nrrd", "").name, "nrrd");
  EXPECT_EQ(inputFormat("a.nhdr", "").name, "nhdr");
  EXPECT_EQ(inputFormat("A.MHD", "").name, "mhd");
  EXPECT_EQ(inputFormat("a.nii.json", "").name, "lumen.json");
  EXPECT_EQ(inputFormat("a.lumen", "").name, "lumen");
  EXPECT_EQ(inputFormat("a.STL", "").name, "stl");
}

TEST(FileFormats, ANameWithoutAKnownEndingIsUnsupported) {
  for (const char* name : {"a.gz", "nii", ".nii", "a.dcm", "a.off", "photo.jpg"}) {
    const std::string refused = refusal([&] { return inputFormat(name, ""); });
    EXPECT_TRUE(refused.starts_with("4: " + std::string(name))) << refused;
    EXPECT_NE(refused.find("nrrd"), std::string::npos) << refused;
  }
}

TEST(FileFormats, AFolderIsReadAsDicom) {
  EXPECT_EQ(inputFormat(std::filesystem::temp_directory_path(), "").name, "dicom");
}

TEST(FileFormats, TheOverrideWinsOverTheName) {
  EXPECT_EQ(inputFormat("a.nii", "mha").name, "mha");
  EXPECT_EQ(outputFormat("a.glb", "obj").name, "obj");
}

TEST(FileFormats, AMeshIsNoPlaceForACase) {
  const std::string refused = refusal([] { return caseOutputFormat("a.glb", "", "the truth"); });
  EXPECT_EQ(refused, "4: a.glb: the truth is written as a case, .lumen or .lumen.json");
}

TEST(FileFormats, AVolumeIsWrittenIntoOneFile) {
  for (const char* name : {"v.png", "v.nhdr", "v.mhd", "v.glb"})
    EXPECT_EQ(refusal([&] { return volumeOutputFormat(name, "it"); }),
              "4: " + std::string(name) + ": it is written as .nrrd, .nii, .nii.gz or .mha");
}

TEST(FileFormats, TitlesAreListedOnce) {
  EXPECT_EQ(formatTitles(canReadVolume), "NRRD, NIfTI, MetaImage or a folder of DICOM");
}

TEST(WriteText, NamesTheFileThatItCannotWrite) {
  const std::string refused = refusal([] {
    writeText("x", "no/such/folder/x.stl");
    return 0;
  });
  EXPECT_TRUE(refused.starts_with("1: no/such/folder/x.stl: ")) << refused;
}

}  // namespace

}  // namespace lumen::engine
