// SPDX-License-Identifier: Apache-2.0
// Inputs of lumen/engine.h: files and arrays, and what stands beside them.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "converters/io/seeds/seeds.h"
#include "converters/stages/editing/edit_request.h"
#include "engine_api.h"
#include "formats/case/case_encoding.h"

namespace lumen::test {
namespace {

TEST_F(EngineApi, GivesTheSameCaseOfBytesAndOfAnArray) {
  const convert::Volume& volume = fork().volume;
  lumen_engine_volume array = arrayOf(volume);
  lumen_engine_inputs inputs{};
  inputs.volume = &array;
  const std::string ofArray = encoded(caseOf(load(inputs)), "lumen.json");
  // a NIfTI rounds the spacing to a float
  const std::string nrrd =
      convert::encodeVolume(volume, convert::VolumeFormat::Nrrd, true, "fork.nrrd");
  const std::string ofBytes = encoded(caseOf(load("fork.nrrd", nrrd)), "lumen.json");
  EXPECT_GT(ofArray.size(), 1000U);
  EXPECT_TRUE(ofArray == ofBytes);
}

TEST_F(EngineApi, WhatStandsBesideAFileStandsBesideAnArray) {
  const std::string seeds = convert::encodeSeeds(fork().seeds, "fork.json");
  const Options alone = optionsOf({{"seeds-only", "true"}});
  lumen_engine_volume array = arrayOf(fork().volume);
  lumen_engine_inputs inputs{};
  inputs.volume = &array;
  inputs.seeds = fileOf("fork.json", seeds);
  const Made made = caseOf(load(inputs, alone.get()), alone.get());
  ASSERT_EQ(m_status, LUMEN_ENGINE_OK) << fault.message;
  EXPECT_NE(encoded(made, "lumen.json").find(fork().seeds.front().label), std::string::npos);
}

TEST_F(EngineApi, SaysWhatIsWrongWithAnArray) {
  lumen_engine_volume array = arrayOf(fork().volume);
  lumen_engine_inputs inputs{};
  inputs.volume = &array;
  inputs.main = fileOf("fork.nii.gz", niftiOfFork());
  load(inputs);
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_USAGE, "both main and volume"));
  inputs.main = {};
  load(inputs, optionsOf({{"crop", "0,9,0,9,0,9"}}).get());
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_USAGE, "\"crop\" is for files, and fork.nrrd is an array"));
  const int unknown = 9;  // as a program in C may hand it over
  std::memcpy(&array.type, &unknown, sizeof unknown);
  load(inputs);
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_USAGE, "type"));
  array.type = LUMEN_ENGINE_INT16;
  array.size[2] = 0;
  load(inputs);
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_INPUT, "fork.nrrd: has 0 voxels along axis 3"));
  array.size[2] = 2;
  array.affine[0][0] = NAN;
  EXPECT_EQ(load(inputs), nullptr);
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_INPUT, "fork.nrrd: "));
  array.data = nullptr;
  load(inputs);
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_USAGE, "inputs->volume->data is a null pointer"));
}

TEST_F(EngineApi, SeedsAmongTheInputsCountAsGiven) {
  const std::string seeds = convert::encodeSeeds(fork().seeds, "fork.json");
  lumen_engine_inputs inputs{};
  inputs.main = fileOf("fork.nii.gz", niftiOfFork());
  inputs.seeds = fileOf("fork.json", seeds);
  const Options alone = optionsOf({{"seeds-only", "true"}});
  load(inputs, alone.get());
  EXPECT_EQ(m_status, LUMEN_ENGINE_OK) << fault.message;
  load("fork.nii.gz", niftiOfFork(), alone.get());
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_USAGE, "\"seeds-only\" does nothing without inputs.seeds"));
}

/// The fork as the label 7.
convert::Volume labelledFork() {
  convert::Volume labels = fork().volume;
  auto& voxels = std::get<std::vector<std::int16_t>>(labels.voxels);
  const std::int16_t most = *std::max_element(voxels.begin(), voxels.end());
  for (std::int16_t& voxel : voxels) voxel = voxel > most / 2 ? 7 : 0;
  return labels;
}

TEST_F(EngineApi, AMapBesideSeedsNamesTheirVessels) {
  const std::string seeds = convert::encodeSeeds(fork().seeds, "fork.json");
  const std::string map =
      convert::encodeVolume(labelledFork(), convert::VolumeFormat::Nrrd, true, "map.nrrd");
  const std::string table = R"({"7": "basilar"})";
  lumen_engine_inputs inputs{};
  inputs.main = fileOf("fork.nii.gz", niftiOfFork());
  inputs.seeds = fileOf("fork.json", seeds);
  inputs.label_map = fileOf("map.nrrd", map);
  inputs.label_table = fileOf("names.json", table);
  const Made made = caseOf(load(inputs));
  ASSERT_EQ(m_status, LUMEN_ENGINE_OK) << fault.message;
  ASSERT_GT(lumen_engine_branch_count(made.get()), 0U);
  EXPECT_EQ(std::string_view(lumen_engine_branch_name(made.get(), 0)).find("basilar"), 0U)
      << lumen_engine_branch_name(made.get(), 0);
  const std::string surface = encoded(made, "stl");
  inputs = {};
  inputs.main = fileOf("fork.stl", surface);
  inputs.label_map = fileOf("map.nrrd", map);
  load(inputs);
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_USAGE, "inputs.label_map is for volumes"));
}

TEST_F(EngineApi, TakesACenterlineBesideASurface) {
  const Made made = caseOf(load("fork.nii.gz", niftiOfFork()));
  const std::string surface = encoded(made, "stl"), line = encoded(made, "centerline.vtp");
  lumen_engine_inputs inputs{};
  inputs.main = fileOf("fork.stl", surface);
  inputs.centerline = fileOf("fork.vtp", line);
  const Made along = caseOf(load(inputs));
  ASSERT_EQ(m_status, LUMEN_ENGINE_OK) << fault.message;
  EXPECT_EQ(lumen_engine_branch_count(along.get()), lumen_engine_branch_count(made.get()));
  inputs.centerline.size /= 2;
  load(inputs);
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_INPUT, "fork.vtp: "));
  inputs.main = fileOf("fork.nii.gz", niftiOfFork());
  load(inputs);
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_USAGE, "inputs.centerline is for meshes"));
}

TEST_F(EngineApi, NamesLabelsByATable) {
  const convert::Volume labels = labelledFork();
  const lumen_engine_volume array = arrayOf(labels);
  const std::string table = R"({"7": "basilar"})";
  lumen_engine_inputs inputs{};
  inputs.volume = &array;
  inputs.label_table = fileOf("names.json", table);
  const Made made = caseOf(load(inputs));
  ASSERT_EQ(m_status, LUMEN_ENGINE_OK) << fault.message;
  EXPECT_EQ(std::string_view(lumen_engine_branch_name(made.get(), 0)).find("basilar"), 0U)
      << lumen_engine_branch_name(made.get(), 0);
}

TEST_F(EngineApi, MakesCorrectionsOfACaseAgain) {
  const std::string found = encoded(caseOf(load("fork.nii.gz", niftiOfFork())), "lumen.json");
  formats::Case corrected = *formats::decodeJson(found);
  convert::EditRequest rename;
  rename.op = "rename";
  rename.branch = 0;
  rename.word = "trunk";
  convert::applyEdit(corrected, rename);
  const std::string json = formats::encodeJson(corrected);
  lumen_engine_inputs inputs{};
  inputs.main = fileOf("fork.nii.gz", niftiOfFork());
  inputs.corrected = fileOf("corrected.lumen.json", json);
  const Made made = caseOf(load(inputs));
  ASSERT_EQ(m_status, LUMEN_ENGINE_OK) << fault.message;
  EXPECT_STREQ(lumen_engine_branch_name(made.get(), 0), "trunk");
}

TEST_F(EngineApi, SaysWhatIsWrongWithAnInput) {
  load("fork.nii.gz", niftiOfFork().substr(0, 2000));
  EXPECT_EQ(m_status, LUMEN_ENGINE_INPUT);
  EXPECT_EQ(std::string_view(fault.message).find("fork.nii.gz: "), 0U) << fault.message;
  load("fork.bmp", "BM, which is no volume");
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_UNSUPPORTED, "expected "));
  load("fork", niftiOfFork());
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_UNSUPPORTED, "this is a file packed by gzip, but its name"));
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_UNSUPPORTED, ".nii.gz"));
  load(lumen_engine_inputs{});
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_USAGE, "neither main nor volume"));
  lumen_engine_inputs inputs{};
  inputs.main = fileOf("fork.nii.gz", niftiOfFork());
  inputs.seeds.name = "seeds.json";
  inputs.seeds.size = 9;
  load(inputs);
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_USAGE, "inputs.seeds has no bytes"));
}

}  // namespace
}  // namespace lumen::test
