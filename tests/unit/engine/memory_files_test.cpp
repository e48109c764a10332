// SPDX-License-Identifier: Apache-2.0
// Commands whose inputs and outputs are in memory: they read, write and look for no file.
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/engine/command.h"
#include "converters/engine/file_access.h"

namespace lumen::engine {

namespace {

namespace fs = std::filesystem;

class MemoryFilesTest : public testing::Test {
protected:
  MemoryFilesTest() {
    fs::remove_all(m_folder);
    fs::create_directories(m_folder);
  }
  ~MemoryFilesTest() override { fs::remove_all(m_folder); }

  Answer run(const Operation& operation, MemoryFiles& memory) {
    RunContext context{m_engine, m_progress};
    context.memory = &memory;
    return m_engine.run(operation, context);
  }
  [[nodiscard]] std::string path(const std::string& name) const {
    return (m_folder / name).string();
  }
  /// Voxels, truth and clicks of a small synthetic fork.
  void makeFork() {
    MemoryFiles memory;
    std::string& image = memory.keep("fork.nrrd");
    std::string& truth = memory.keep("truth.lumen");
    std::string& seeds = memory.keep("seeds.json");
    run(Operation{"phantom", {"bifurcation", "fork.nrrd"}, {}}
            .with("size", "48")
            .with("truth", "truth.lumen")
            .with("seeds", "seeds.json"),
        memory);
    m_image = image, m_truth = truth, m_seeds = seeds;
  }

  const fs::path m_folder = fs::temp_directory_path() / "lumen-memory-files-test";
  const Engine m_engine = makeEngine();
  Progress m_progress;
  std::string m_image, m_truth, m_seeds;
};

TEST_F(MemoryFilesTest, ConvertGivesTheBytesThatItWritesToAFile) {
  makeFork();
  MemoryFiles memory;
  memory.give(path("fork.nrrd"), m_image.substr(0, 100), std::string_view(m_image).substr(100));
  memory.give(path("seeds.json"), m_seeds);
  const std::string& made = memory.keep(path("made.lumen"));
  const Operation convert = Operation{"convert", {path("fork.nrrd"), path("made.lumen")}, {}}.with(
      "seeds", path("seeds.json"));
  const Answer inMemory = run(convert, memory);
  EXPECT_TRUE(fs::is_empty(m_folder));
  ASSERT_FALSE(made.empty());

  writeText(m_image, path("fork.nrrd"));
  writeText(m_seeds, path("seeds.json"));
  MemoryFiles none;
  const Answer onDisk = run(convert, none);
  EXPECT_EQ(inMemory.json, onDisk.json);
  EXPECT_EQ(inMemory.text, onDisk.text);
  const std::vector<std::byte> written = readCaseBytes(path("made.lumen"));
  EXPECT_EQ(made, std::string(reinterpret_cast<const char*>(written.data()), written.size()));
}

TEST_F(MemoryFilesTest, EveryKindOfOutputIsKept) {
  makeFork();
  const auto bytesOf = [&](const Operation& operation, const std::string& output) {
    MemoryFiles memory;
    memory.give("fork.nrrd", m_image);
    memory.give("truth.lumen", m_truth);
    const std::string& kept = memory.keep(output);
    run(operation, memory);
    return kept;
  };
  const std::string fitted = bytesOf({"convert", {"fork.nrrd", "made.lumen"}, {}}, "made.lumen");
  m_truth = fitted;
  EXPECT_TRUE(bytesOf({"convert", {"truth.lumen", "a.ply"}, {}}, "a.ply").starts_with("ply\n"));
  EXPECT_TRUE(bytesOf({"picture", {"truth.lumen", "a.png"}, {}}, "a.png").starts_with("\x89PNG"));
  EXPECT_TRUE(
      bytesOf({"report", {"truth.lumen", "a.html"}, {}}, "a.html").starts_with("<!doctype"));
  EXPECT_TRUE(bytesOf({"seeds", {"fork.nrrd", "a.json"}, {}}, "a.json").starts_with("{"));
  EXPECT_TRUE(bytesOf(Operation{"measure", {"truth.lumen"}, {}}.with("out", "a.csv"), "a.csv")
                  .starts_with("case,"));
  EXPECT_TRUE(
      bytesOf(Operation{"check", {"fork.nrrd", "truth.lumen"}, {}}.with("mask", "a.nrrd"), "a.nrrd")
          .starts_with("NRRD"));
}

TEST_F(MemoryFilesTest, AFaultNamesTheBytes) {
  MemoryFiles memory;
  memory.give("head.lumen", "no case at all");
  for (const char* command : {"info", "validate", "measure"}) {
    try {
      EXPECT_EQ(run({command, {"head.lumen"}, {}}, memory).code, kInvalidCode) << command;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::InvalidInput) << command;
      EXPECT_NE(std::string(error.what()).find("head.lumen"), std::string::npos) << command;
    }
  }
}

TEST_F(MemoryFilesTest, OtherNamesAreFiles) {
  MemoryFiles memory;
  memory.give("head.lumen", "");
  try {
    run({"info", {path("other.lumen")}, {}}, memory);
    FAIL() << "read a file that is not there";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("there is no such"), std::string::npos);
  }
}

}  // namespace

}  // namespace lumen::engine
