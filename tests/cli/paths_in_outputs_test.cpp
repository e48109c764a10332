// SPDX-License-Identifier: Apache-2.0
// A folder may have the name of a patient: no file that a command writes names a folder that a person named.
#include <filesystem>
#include <sstream>

#include <gtest/gtest.h>

#include "run_lumen.h"

namespace lumen::test {

namespace {

namespace fs = std::filesystem;

constexpr const char* kMarker = "Miller^Anna";

/// Commands; IN/ and OUT/ are folders in one with the marker.
constexpr const char* kRuns =
    R"(convert IN/tube.nrrd OUT/a.lumen --label-map IN/labels.nrrd --label-table IN/names.json
convert IN/tube.nrrd OUT/a.lumen.json --seeds IN/seeds.json --corrections IN/tube.lumen
convert IN/tube.lumen OUT/a.gltf
convert IN/tube.lumen OUT/a.glb
convert IN/tube.lumen OUT/a.stl
convert IN/tube.lumen OUT/a.obj
convert IN/tube.lumen OUT/a.ply
convert IN/tube.lumen OUT/a.vtp
convert IN/tube.lumen OUT/a.swc
convert OUT/a.stl OUT/b.lumen.json --centerline OUT/a.swc
convert OUT/a.swc OUT/c.lumen.json
track IN/tube.nrrd OUT/t.lumen.json --seeds IN/seeds.json
seeds IN/tube.nrrd OUT/s.json
seeds IN/tube.nrrd OUT/s.mrk.json
fit IN/tube.lumen OUT/f.lumen.json --image IN/tube.nrrd
trim IN/tube.lumen OUT/trimmed.lumen.json --min-length 1
check IN/tube.nrrd IN/tube.lumen --mask OUT/m.nrrd --overlay OUT/o.png
check IN/tube.nrrd IN/tube.lumen --mask OUT/m.nii
measure IN/tube.lumen IN/truth.lumen --out OUT/m.csv
measure IN/tube.lumen --out OUT/m.json
measure IN/tube.lumen --against IN/truth.lumen --out OUT/tables
motion IN/tube.lumen IN/tube.nrrd --out OUT/mo.lumen.json --reach 1
phantom --tree OUT/a.swc OUT/p.nrrd --truth OUT/pt.lumen.json --seeds OUT/ps.json
phantom tube OUT/p.mha --size 32
picture IN/tube.lumen OUT/p.png
report IN/tube.lumen OUT/r.html --volume IN/tube.nrrd
export print IN/tube.lumen OUT/x-print
export mujoco IN/tube.lumen OUT/x-mujoco
export simvascular IN/tube.lumen OUT/x-simvascular
export openfoam IN/tube.lumen OUT/x-openfoam
export svzerod IN/tube.lumen OUT/x-svzerod
export godot IN/tube.lumen OUT/x-godot
export blender IN/tube.lumen OUT/x-blender
export slicer IN/tube.lumen OUT/x-slicer
export grid IN/tube.lumen OUT/x-grid
)";

/// Commands of libraries, if the program has them.
constexpr const char* kLibraryRuns =
    R"(library init OUT/lib --title T --publisher P --licence CC-BY-4.0
library add OUT/lib IN/tube.lumen --title One --synthetic --attribution A --id one
library index OUT/lib
library extract OUT/lib OUT/own --case one
)";

class PathsInOutputsTest : public FittedTubeTest {
protected:
  void SetUp() override {
    FittedTubeTest::SetUp();
    for (const char* const folder : {"/in", "/out"})
      fs::create_directories(path(kMarker + std::string(folder)));
    ASSERT_EQ(lumen({"check", "tube.nrrd", "tube.lumen", "--mask", "labels.nrrd"}).code, 0);
    write("names.json", R"({"1": "BA"})");
    for (const char* const name :
         {"tube.nrrd", "tube.lumen", "truth.lumen", "seeds.json", "labels.nrrd", "names.json"})
      fs::copy_file(path(name), path(kMarker + std::string("/in/") + name));
  }

  void run(const std::string& lines) const {
    std::istringstream all(lines);
    for (std::string line; std::getline(all, line);) {
      std::vector<std::string> words;
      std::istringstream one(line);
      for (std::string word; one >> word;) {
        if (word.starts_with("IN/")) word = path(kMarker + ("/in/" + word.substr(3)));
        if (word.starts_with("OUT/")) word = path(kMarker + ("/out/" + word.substr(4)));
        words.push_back(word);
      }
      const Outcome done = lumen(words);
      EXPECT_EQ(done.code, 0) << line << ": " << done.err;
    }
  }

  /// Files below the outputs, each of which holds no marker.
  [[nodiscard]] std::size_t countClean() const {
    std::size_t count = 0;
    const fs::path out = path(kMarker + std::string("/out"));
    for (const auto& entry : fs::recursive_directory_iterator(out)) {
      if (!entry.is_regular_file()) continue;
      const std::string place = fs::relative(entry.path(), path("")).string();
      for (const std::string word : {"Miller", "Anna"})
        EXPECT_EQ(read(place).find(word), std::string::npos) << place;
      ++count;
    }
    return count;
  }
};

TEST_F(PathsInOutputsTest, NoFileNamesAFolderThatAPersonNamedSLOW) {
  run(kRuns);
  if (contains(lumen({"--help"}).out, "library")) run(kLibraryRuns);
  EXPECT_GT(countClean(), 60U);
}

}  // namespace

}  // namespace lumen::test
