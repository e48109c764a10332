// SPDX-License-Identifier: Apache-2.0
// lumen/engine.h from outside: bytes in, bytes out, no file.
#include <atomic>
#include <cmath>
#include <cstring>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "converters/io/seeds/seeds.h"
#include "converters/io/volume/write_volume.h"
#include "converters/stages/phantom/phantom.h"
#include "lumen/engine.h"

namespace lumen {
namespace {

template <class Thing, void (*release)(Thing*)>
struct Release {
  void operator()(Thing* thing) const { release(thing); }
};
template <class Thing, void (*release)(Thing*)>
using Held = std::unique_ptr<Thing, Release<Thing, release>>;
using Options = Held<lumen_engine_options, lumen_engine_options_free>;
using Source = Held<lumen_engine_source, lumen_engine_free_source>;
using Made = Held<lumen_engine_case, lumen_engine_free_case>;
using Bytes = Held<lumen_engine_bytes, lumen_engine_free_bytes>;
using Surface = Held<lumen_engine_surface, lumen_engine_free_surface>;

const convert::Phantom& fork() {
  static const convert::Phantom made = [] {
    convert::PhantomOptions options;
    options.name = "bifurcation";
    options.size = 64;
    Progress progress;
    return convert::makePhantom(options, progress);
  }();
  return made;
}

const std::string& niftiOfFork() {
  static const std::string bytes =
      convert::encodeVolume(fork().volume, convert::VolumeFormat::Nifti, true, "fork.nii.gz");
  return bytes;
}

class EngineApi : public testing::Test {
protected:
  lumen_engine_fault fault{};
  lumen_engine_listener listener{};

  static lumen_engine_file fileOf(const char* name, const std::string& bytes) {
    return {name, bytes.data(), bytes.size()};
  }
  Options optionsOf(const std::vector<std::pair<const char*, const char*>>& values) {
    lumen_engine_options* made = nullptr;
    EXPECT_EQ(lumen_engine_options_create(&made, &fault), LUMEN_ENGINE_OK);
    for (const auto& [name, value] : values)
      EXPECT_EQ(lumen_engine_options_set(made, name, value, &fault), LUMEN_ENGINE_OK)
          << fault.message;
    return Options(made);
  }
  Source load(const char* name, const std::string& bytes,
              const lumen_engine_options* options = {}) {
    lumen_engine_inputs inputs{};
    inputs.main = fileOf(name, bytes);
    lumen_engine_source* source = nullptr;
    m_status = lumen_engine_load(&inputs, options, &listener, &source, &fault);
    return Source(source);
  }
  Made caseOf(const Source& source, const lumen_engine_options* options = {}) {
    lumen_engine_case* made = nullptr;
    m_status = lumen_engine_case_of(source.get(), options, &listener, &made, &fault);
    return Made(made);
  }
  std::string encoded(const Made& made, const char* format) {
    lumen_engine_bytes* bytes = nullptr;
    m_status = lumen_engine_encode(made.get(), format, nullptr, nullptr, &bytes, &fault);
    const Bytes held(bytes);
    return {static_cast<const char*>(lumen_engine_data(bytes)), lumen_engine_size(bytes)};
  }
  lumen_engine_status m_status = LUMEN_ENGINE_OK;
};

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

TEST_F(EngineApi, GivesTheSameCaseOfBytesAndOfAnArray) {
  const convert::Volume& volume = fork().volume;
  const convert::VolumeGeometry& g = volume.geometry;
  lumen_engine_volume given{};
  given.data = std::get<std::vector<std::int16_t>>(volume.voxels).data();
  given.type = LUMEN_ENGINE_INT16;
  for (int a = 0; a < 3; ++a) {
    given.size[a] = g.size[static_cast<std::size_t>(a)];
    for (int r = 0; r < 3; ++r) given.affine[r][a] = g.direction(r, a) * g.spacing[a];
    given.affine[a][3] = g.origin[a];
  }
  lumen_engine_source* taken = nullptr;
  ASSERT_EQ(lumen_engine_take_volume(&given, "fork.nrrd", 0, nullptr, &taken, &fault),
            LUMEN_ENGINE_OK)
      << fault.message;
  const std::string ofArray = encoded(caseOf(Source(taken)), "lumen.json");
  // a NIfTI rounds the spacing to a float
  const std::string nrrd =
      convert::encodeVolume(volume, convert::VolumeFormat::Nrrd, true, "fork.nrrd");
  const std::string ofBytes = encoded(caseOf(load("fork.nrrd", nrrd)), "lumen.json");
  EXPECT_GT(ofArray.size(), 1000U);
  EXPECT_TRUE(ofArray == ofBytes);

  given.affine[0][0] = NAN;
  EXPECT_EQ(lumen_engine_take_volume(&given, "x", 0, nullptr, &taken, &fault), LUMEN_ENGINE_INPUT);
  EXPECT_EQ(taken, nullptr);
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
    EXPECT_EQ(lumen_engine_options_set(coarse.get(), name, value, &fault), LUMEN_ENGINE_USAGE);
    return std::string(fault.message);
  };
  EXPECT_NE(refused("accuraci", "1").find("accuraci"), std::string::npos);
  EXPECT_NE(refused("accuracy", "thin").find("--accuracy"), std::string::npos);
  EXPECT_NE(refused("seeds", "a.json").find("opens none"), std::string::npos);
  EXPECT_NE(refused("label-table", "a.csv").find("opens none"), std::string::npos);
  // an option for meshes does nothing here, and is refused as on the command line
  const Options others = optionsOf({{"stl-solids", "true"}});
  lumen_engine_bytes* bytes = nullptr;
  EXPECT_EQ(lumen_engine_encode(made.get(), "glb", others.get(), nullptr, &bytes, &fault),
            LUMEN_ENGINE_USAGE);
  EXPECT_EQ(bytes, nullptr);
}

TEST_F(EngineApi, SeedsAmongTheInputsCountAsGiven) {
  const std::string seeds = convert::encodeSeeds(fork().seeds, "fork.json");
  const Options alone = optionsOf({{"seeds-only", "true"}});
  lumen_engine_inputs inputs{};
  inputs.main = fileOf("fork.nii.gz", niftiOfFork());
  inputs.seeds = fileOf("fork.json", seeds);
  lumen_engine_source* source = nullptr;
  ASSERT_EQ(lumen_engine_load(&inputs, alone.get(), nullptr, &source, &fault), LUMEN_ENGINE_OK)
      << fault.message;
  const Made made = caseOf(Source(source), alone.get());
  ASSERT_EQ(m_status, LUMEN_ENGINE_OK) << fault.message;
  EXPECT_NE(encoded(made, "lumen.json").find(fork().seeds.front().label), std::string::npos);
  caseOf(load("fork.nii.gz", niftiOfFork()), alone.get());
  EXPECT_EQ(m_status, LUMEN_ENGINE_USAGE);
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

TEST_F(EngineApi, SaysWhatIsWrongWithAnInput) {
  load("fork.nii.gz", niftiOfFork().substr(0, 2000));
  EXPECT_EQ(m_status, LUMEN_ENGINE_INPUT);
  EXPECT_EQ(std::string_view(fault.message).find("fork.nii.gz: "), 0U) << fault.message;
  load("fork.bmp", "BM, which is no volume");
  EXPECT_EQ(m_status, LUMEN_ENGINE_UNSUPPORTED) << fault.message;
  lumen_engine_source* source = nullptr;
  const lumen_engine_inputs none{};
  EXPECT_EQ(lumen_engine_load(&none, nullptr, nullptr, &source, &fault), LUMEN_ENGINE_USAGE);
  EXPECT_EQ(lumen_engine_load(nullptr, nullptr, nullptr, &source, nullptr), LUMEN_ENGINE_USAGE);
  EXPECT_EQ(lumen_engine_encode(nullptr, "glb", nullptr, nullptr, nullptr, &fault),
            LUMEN_ENGINE_USAGE);
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
}  // namespace lumen
