// SPDX-License-Identifier: Apache-2.0
// The table of formats.
#include "converters/engine/file_format.h"

#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/engine/file_access.h"
#include "converters/io/content/file_content.h"
#include "tests/cli/run_lumen.h"

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

TEST(FileFormats, FilesOfNeighboursAreKnownByNameAndByContent) {
  const std::filesystem::path samples = LUMEN_TEST_DATA "/neighbours";
  for (const auto& [file, format] :
       std::vector<std::pair<std::string, std::string>>{{"igraph-vesselvio.graphml", "graphml"},
                                                        {"voreen_nodes.csv", "csv"},
                                                        {"amira-correlation-lines.am", "am"},
                                                        {"itk-binary.tre", "tre"}}) {
    EXPECT_EQ(inputFormat(samples / file, "").name, format);
    if (format == "csv") continue;  // a table of whatever
    EXPECT_EQ(convert::detectContent(samples / file).kind, convert::ContentKind::Centerline)
        << file;
  }
  EXPECT_EQ(inputFormat("a.ctgr", "").name, "simvascular");
  EXPECT_EQ(inputFormat("a.VMV", "").name, "vmv");
}

TEST(FileFormats, OneFolderOfSeveralFilesIsOfTheFormatThatHoldsIt) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "lumen-folders-of-formats";
  const auto formatOf = [&](const std::vector<std::string>& files) {
    std::filesystem::remove_all(folder);
    for (const std::string& file : files) {
      std::filesystem::create_directories((folder / file).parent_path());
      std::ofstream(folder / file) << "x";
    }
    return std::string(inputFormat(folder, "").name);
  };
  EXPECT_EQ(formatOf({"Paths/aorta.pth"}), "simvascular");
  EXPECT_EQ(formatOf({"aorta.ctgr"}), "simvascular");
  EXPECT_EQ(formatOf({"weights.pth", "1.dcm"}), "dicom");
  EXPECT_EQ(formatOf({"a_nodes.csv", "a_edges.csv"}), "csv");
  EXPECT_EQ(formatOf({"a_nodes.csv", "1.dcm"}), "dicom");
  EXPECT_EQ(formatOf({"c.mrk.json", "a_nodes.csv"}), "mrk.json");
  std::filesystem::remove_all(folder);
}

TEST(FileFormats, AFileThatIsNotReadIsNamedWithWhatHelps) {
  const auto refusedAs = [](const char* name, std::string_view bytes) {
    return refusal([&] { return inputFormat(InputFile(name, bytes), ""); });
  };
  EXPECT_EQ(
      refusedAs("a.3mf", "PK\3\4...."),
      "4: a.3mf: this is a mesh (3MF), not a volume; lumen does not read 3MF; the program that "
      "wrote it, MeshLab or PrusaSlicer saves it as STL or OBJ");
  EXPECT_EQ(refusedAs("s.mrb", "PK\3\4...."),
            "4: s.mrb: this is a bundle of 3D Slicer (.mrb), a zip, not a volume; unzip it: its "
            "folder Data has volumes (.nrrd), models (.vtp, .vtk) and curves (.mrk.json), which "
            "lumen reads");
  EXPECT_EQ(
      refusedAs("s.mrml", "<?xml version=\"1.0\"?>\n<MRML version=\"5\"></MRML>"),
      "4: s.mrml: this is a scene of 3D Slicer (MRML), not a volume; lumen reads the files that "
      "it names: volumes (.nrrd), models (.vtp, .vtk) and curves (.mrk.json)");
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

// The kind of a file by its content, and outputs that spare files that cannot be made again.
namespace lumen::test {

using convert::ContentKind;

class FileContentTest : public TubeTest {
protected:
  [[nodiscard]] ContentKind kindOf(const std::string& name) const {
    return convert::detectContent(path(name)).kind;
  }
};

TEST_F(FileContentTest, WhatLumenWritesIsRecognised) {
  for (const char* name : {"a.nrrd", "a.nii", "a.nii.gz", "a.mha"}) {
    ASSERT_EQ(lumen({"phantom", "tube", name, "--size", "32"}).code, 0) << name;
    EXPECT_EQ(kindOf(name), ContentKind::Volume) << name;
  }
  EXPECT_EQ(kindOf("seeds.json"), ContentKind::Seeds);
  EXPECT_EQ(kindOf("truth.lumen"), ContentKind::Case);
  ASSERT_EQ(lumen({"convert", "tube.nrrd", "a.lumen", "--seeds", "seeds.json"}).code, 0);
  ASSERT_EQ(lumen({"convert", "a.lumen", "a.lumen.json"}).code, 0);
  EXPECT_EQ(kindOf("a.lumen.json"), ContentKind::Case);
  for (const char* name : {"a.glb", "a.gltf", "a.ply"}) {
    ASSERT_EQ(lumen({"convert", "a.lumen", name}).code, 0) << name;
    EXPECT_EQ(kindOf(name), ContentKind::Mesh) << name;
  }
}

TEST_F(FileContentTest, NothingIsSaidOfWhatIsNotKnown) {
  write("empty", "");
  write("short", "N");
  write("text", "some words");
  for (const char* name : {"empty", "short", "text", "gone", "."})
    EXPECT_EQ(kindOf(name), ContentKind::Unknown) << name;
  EXPECT_EQ(convert::notA(ContentKind::Case, path("text")), "");
  EXPECT_EQ(convert::notA(ContentKind::Case, path("truth.lumen")), "");
}

TEST_F(FileContentTest, NoOutputReplacesAFileOfAnotherKind) {
  const std::vector<std::vector<std::string>> lines = {
      {"convert", "truth.lumen", "tube.nrrd", "--to", "lumen"},
      {"convert", "truth.lumen", "seeds.json"},
      {"convert", "truth.lumen", "truth.lumen", "--to", "stl"},
      {"track", "tube.nrrd", "seeds.json", "--seeds", "seeds.json"},
      {"fit", "truth.lumen", "seeds.json"},
      {"phantom", "tube", "new.nrrd", "--seeds", "truth.lumen"},
      {"phantom", "tube", "new.nrrd", "--truth", "seeds.json"}};
  const std::string volume = read("tube.nrrd"), seeds = read("seeds.json"),
                    truth = read("truth.lumen");
  for (const auto& line : lines) {
    const Outcome refused = lumen(line);
    EXPECT_EQ(refused.code, 2) << line[0] << " " << line[2] << "\n" << refused.err;
  }
  EXPECT_TRUE(read("tube.nrrd") == volume && read("seeds.json") == seeds);
  EXPECT_TRUE(read("truth.lumen") == truth);
  EXPECT_FALSE(exists("new.nrrd"));
}

TEST_F(FileContentTest, TheSameCommandMayBeRepeated) {
  for (int i = 0; i < 2; ++i) {
    make({"phantom", "tube", "tube.nrrd", "--size", "64", "--truth", "truth.lumen", "--seeds",
          "seeds.json"});
    EXPECT_EQ(lumen({"track", "tube.nrrd", "a.lumen", "--seeds", "seeds.json"}).code, 0);
    EXPECT_EQ(lumen({"fit", "a.lumen", "a.lumen"}).code, 0);
    EXPECT_EQ(lumen({"convert", "a.lumen", "a.glb"}).code, 0);
  }
}

}  // namespace lumen::test
