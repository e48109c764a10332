// SPDX-License-Identifier: Apache-2.0
// lumen/engine.h from outside: bytes in, bytes out; files are those of the example.
#include "engine_api.h"

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "converters/base/run_program.h"

namespace lumen::test {
namespace {

TEST_F(EngineApi, TurnsANiftiInMemoryIntoAGlbInMemory) {
  std::set<std::string> stages;
  listener.user = &stages;
  listener.stage = [](void* user, const char* name) {
    static_cast<std::set<std::string>*>(user)->insert(name);
  };
  const Source source = load("fork.nii.gz", niftiOfFork());
  ASSERT_EQ(m_status, LUMEN_ENGINE_OK) << fault.message;
  const Made made = caseOf(source);
  ASSERT_EQ(m_status, LUMEN_ENGINE_OK) << fault.message;
  EXPECT_TRUE(encoded(made, "glb").starts_with("glTF"));
  EXPECT_TRUE(stages.contains("reading"));
  EXPECT_TRUE(stages.contains("track")) << stages.size();
  caseOf(source);
  EXPECT_EQ(m_status, LUMEN_ENGINE_USAGE);
  EXPECT_NE(std::string_view(fault.message).find("used up"), std::string_view::npos);
}

TEST_F(EngineApi, TheExampleWritesTheSameGlb) {
  const convert::PrivateFolder folder;
  const std::filesystem::path in = folder.path() / "fork.nii.gz", out = folder.path() / "fork.glb";
  std::ofstream(in, std::ios::binary) << niftiOfFork();
  constexpr unsigned kSeconds = 300;
  const convert::ProgramResult result = convert::runProgram(
      {NIFTI_TO_GLB, {in.string(), out.string()}, folder.path(), kSeconds, {}}, Progress());
  ASSERT_EQ(result.end, convert::ProgramEnd::Done) << result.errors;
  std::ifstream file(out, std::ios::binary);
  const std::string written{std::istreambuf_iterator<char>(file), {}};
  EXPECT_TRUE(written == encoded(caseOf(load("fork.nii.gz", niftiOfFork())), "glb"));
  load("fork.glb", written);
  EXPECT_EQ(m_status, LUMEN_ENGINE_OK) << fault.message;
}

TEST_F(EngineApi, GivesTheSurfaceAsArrays) {
  const Made made = caseOf(load("fork.nii.gz", niftiOfFork()));
  ASSERT_EQ(m_status, LUMEN_ENGINE_OK) << fault.message;
  lumen_engine_surface* surface = nullptr;
  ASSERT_EQ(lumen_engine_surface_of(made.get(), nullptr, nullptr, &surface, &fault),
            LUMEN_ENGINE_OK)
      << fault.message;
  const Surface held(surface);
  const lumen_engine_mesh mesh = lumen_engine_get_mesh(surface);
  ASSERT_GT(mesh.triangle_count, 100U);
  for (std::size_t t = 0; t < mesh.triangle_count; ++t) {
    for (const std::uint32_t vertex : mesh.triangle[t]) ASSERT_LT(vertex, mesh.vertex_count);
    ASSERT_LT(mesh.group[t], mesh.group_count);
  }
  for (std::size_t v = 0; v < mesh.vertex_count; ++v)
    ASSERT_NEAR(std::hypot(mesh.normal[v][0], mesh.normal[v][1], mesh.normal[v][2]), 1, 1e-4);
  EXPECT_STREQ(lumen_engine_group_name(surface, 0), "wall");
  EXPECT_EQ(lumen_engine_group_name(surface, mesh.group_count), nullptr);
  EXPECT_EQ(lumen_engine_get_mesh(nullptr).vertex_count, 0U);
}

TEST_F(EngineApi, OptionsAreThoseOfConvert) {
  const Options coarse = optionsOf({{"accuracy", "0.5"}});
  const Made made = caseOf(load("fork.nii.gz", niftiOfFork()), coarse.get());
  ASSERT_EQ(m_status, LUMEN_ENGINE_OK) << fault.message;
  EXPECT_NE(encoded(made, "lumen.json").find("\"accuracy\": 0.5"), std::string::npos);
  const auto refused = [&](const char* name, const char* value) {
    EXPECT_EQ(lumen_engine_set_option(coarse.get(), name, value, &fault), LUMEN_ENGINE_USAGE);
    return std::string(fault.message);
  };
  EXPECT_EQ(refused("accuraci", "1"),
            "\"accuraci\": there is no such option; did you mean \"accuracy\"?");
  EXPECT_EQ(refused("--accuracy", "1").find("--"), std::string::npos);
  EXPECT_NE(refused("accuracy", "thin").find("\"accuracy\": found thin"), std::string::npos);
  EXPECT_NE(refused("seeds", "a.json").find("expected its bytes as inputs.seeds"),
            std::string::npos);
  EXPECT_NE(refused("label-table", "a.csv").find("inputs.label_table"), std::string::npos);
  EXPECT_NE(refused("allow-detached", "a").find("opens none"), std::string::npos);
}

TEST_F(EngineApi, TheSameOptionsServeEachCall) {
  const Options same = optionsOf({{"accuracy", "0.5"},
                                  {"root", "900,0,0"},
                                  {"root", "0,0,0"},
                                  {"stl-solids", "true"},
                                  {"colour", "radius"}});
  const Source source = load("fork.nii.gz", niftiOfFork(), same.get());
  ASSERT_EQ(m_status, LUMEN_ENGINE_OK) << fault.message;
  caseOf(source, same.get());
  // the second root did not replace the first
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_FAILED, "\"root\" 900,0,0"));
  const Options others =
      optionsOf({{"accuracy", "0.5"}, {"stl-solids", "true"}, {"colour", "radius"}});
  const Made made = caseOf(load("fork.nii.gz", niftiOfFork(), others.get()), others.get());
  ASSERT_EQ(m_status, LUMEN_ENGINE_OK) << fault.message;
  for (const char* const format : {"glb", "stl", "swc", "lumen"}) {
    encoded(made, format, others.get());
    EXPECT_EQ(m_status, LUMEN_ENGINE_OK) << format << ": " << fault.message;
  }
  EXPECT_NE(encoded(made, "glb", others.get()), encoded(made, "glb"));
  EXPECT_STREQ(fault.message, "");
}

TEST_F(EngineApi, AnOptionThatDoesNothingForTheSourceIsRefused) {
  const Options frame = optionsOf({{"centerline-frame", "ras"}});
  load("fork.nii.gz", niftiOfFork(), frame.get());
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_USAGE, "\"centerline-frame\" is for meshes"));
}

TEST_F(EngineApi, StatesTheInterfaceThatRuns) {
  EXPECT_EQ(lumen_engine_interface(), LUMEN_ENGINE_INTERFACE);
  EXPECT_STREQ(lumen_engine_version(), LUMEN_VERSION);
}

TEST_F(EngineApi, ListsItsOptions) {
  lumen_engine_bytes* bytes = nullptr;
  ASSERT_EQ(lumen_engine_list_options(&bytes, &fault), LUMEN_ENGINE_OK);
  const Bytes held(bytes);
  const std::string list(static_cast<const char*>(lumen_engine_bytes_data(bytes)),
                         lumen_engine_bytes_size(bytes));
  const auto json = nlohmann::json::parse(list);
  std::map<std::string, nlohmann::json> rows;
  for (const auto& row : json) rows[row.at("name")] = row;
  EXPECT_EQ(rows.at("accuracy").at("value"), "MM");
  EXPECT_EQ(rows.at("dark").at("value"), "");
  EXPECT_EQ(rows.count("seeds") + rows.count("series"), 0U);
  EXPECT_EQ(rows.count("label-table"), 1U);
  EXPECT_EQ(list.find("--"), std::string::npos);
}

TEST_F(EngineApi, StatesTheTreeOfBranches) {
  const Made made = caseOf(load("fork.nii.gz", niftiOfFork()));
  const std::size_t count = lumen_engine_branch_count(made.get());
  ASSERT_GT(count, 1U);
  std::size_t roots = 0;
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_STRNE(lumen_engine_branch_name(made.get(), i), nullptr);
    const std::size_t parent = lumen_engine_branch_parent(made.get(), i);
    roots += parent == SIZE_MAX ? 1 : 0;
    EXPECT_TRUE(parent == SIZE_MAX || parent < i);
  }
  EXPECT_EQ(roots, 1U);
  EXPECT_EQ(lumen_engine_branch_name(made.get(), count), nullptr);
  EXPECT_EQ(lumen_engine_branch_parent(made.get(), count), SIZE_MAX);
  EXPECT_EQ(lumen_engine_branch_count(nullptr), 0U);
}

TEST_F(EngineApi, ReadsBackItsOwnCase) {
  const std::string json = encoded(caseOf(load("fork.nii.gz", niftiOfFork())), "lumen.json");
  const lumen_engine_file file = fileOf("fork.lumen.json", json);
  lumen_engine_case* read = nullptr;
  ASSERT_EQ(lumen_engine_open_case(&file, &read, &fault), LUMEN_ENGINE_OK) << fault.message;
  EXPECT_TRUE(encoded(Made(read), "lumen.json") == json);
  const std::string cut = json.substr(0, json.size() / 2);
  const lumen_engine_file damaged = fileOf("fork.lumen.json", cut);
  EXPECT_EQ(lumen_engine_open_case(&damaged, &read, &fault), LUMEN_ENGINE_INPUT);
  EXPECT_EQ(std::string_view(fault.message).find("fork.lumen.json: "), 0U);
}

TEST_F(EngineApi, NamesTheArgumentThatIsNull) {
  lumen_engine_source* source = nullptr;
  m_status = lumen_engine_load(nullptr, nullptr, nullptr, &source, &fault);
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_USAGE, "lumen_engine_load(): inputs is a null pointer"));
  EXPECT_EQ(lumen_engine_load(nullptr, nullptr, nullptr, &source, nullptr), LUMEN_ENGINE_USAGE);
  m_status = lumen_engine_encode(nullptr, "glb", nullptr, nullptr, nullptr, &fault);
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_USAGE, "value is a null pointer"));
  m_status = lumen_engine_set_option(nullptr, "root", "0,0,0", &fault);
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_USAGE, "options is a null pointer"));
  const lumen_engine_file none{};
  lumen_engine_case* made = nullptr;
  m_status = lumen_engine_open_case(&none, &made, &fault);
  EXPECT_TRUE(failsWith(LUMEN_ENGINE_USAGE, "file->name is a null pointer"));
}

TEST_F(EngineApi, EndsWhenTheListenerAsksForIt) {
  std::atomic<bool> isFinding = false;
  listener.user = &isFinding;
  listener.stage = [](void* user, const char* name) {
    if (std::strcmp(name, "find") == 0) *static_cast<std::atomic<bool>*>(user) = true;
  };
  listener.is_cancelled = [](void* user) -> int { return *static_cast<std::atomic<bool>*>(user); };
  const Made made = caseOf(load("fork.nii.gz", niftiOfFork()));
  EXPECT_EQ(m_status, LUMEN_ENGINE_CANCELLED) << fault.message;
  EXPECT_EQ(made, nullptr);
}

}  // namespace
}  // namespace lumen::test
