// SPDX-License-Identifier: Apache-2.0
// A program that uses lumen/engine.h: handles, and calls with the status and the fault of the last.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "converters/io/volume/write_volume.h"
#include "converters/stages/phantom/phantom.h"
#include "lumen/engine.h"

namespace lumen::test {

template <class Thing, void (*release)(Thing*)>
struct Release {
  void operator()(Thing* thing) const { release(thing); }
};
template <class Thing, void (*release)(Thing*)>
using Held = std::unique_ptr<Thing, Release<Thing, release>>;
using Options = Held<lumen_engine_options, lumen_engine_free_options>;
using Source = Held<lumen_engine_source, lumen_engine_free_source>;
using Made = Held<lumen_engine_case, lumen_engine_free_case>;
using Bytes = Held<lumen_engine_bytes, lumen_engine_free_bytes>;
using Surface = Held<lumen_engine_surface, lumen_engine_free_surface>;

inline const convert::Phantom& fork() {
  static const convert::Phantom made = [] {
    convert::PhantomOptions options;
    options.name = "bifurcation";
    options.size = 64;
    Progress progress;
    return convert::makePhantom(options, progress);
  }();
  return made;
}

inline const std::string& niftiOfFork() {
  static const std::string bytes =
      convert::encodeVolume(fork().volume, convert::VolumeFormat::Nifti, true, "fork.nii.gz");
  return bytes;
}

/// The phantom as an array, which lives as long as `volume`.
inline lumen_engine_volume arrayOf(const convert::Volume& volume) {
  const convert::VolumeGeometry& g = volume.geometry;
  lumen_engine_volume array{};
  array.name = "fork.nrrd";
  array.data = std::get<std::vector<std::int16_t>>(volume.voxels).data();
  array.type = LUMEN_ENGINE_INT16;
  for (int a = 0; a < 3; ++a) {
    array.size[a] = g.size[static_cast<std::size_t>(a)];
    for (int r = 0; r < 3; ++r) array.affine[r][a] = g.direction(r, a) * g.spacing[a];
    array.affine[a][3] = g.origin[a];
  }
  return array;
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
    EXPECT_EQ(lumen_engine_create_options(&made, &fault), LUMEN_ENGINE_OK);
    for (const auto& [name, value] : values)
      EXPECT_EQ(lumen_engine_set_option(made, name, value, &fault), LUMEN_ENGINE_OK)
          << fault.message;
    return Options(made);
  }
  Source load(const lumen_engine_inputs& inputs, const lumen_engine_options* options = {}) {
    lumen_engine_source* source = nullptr;
    m_status = lumen_engine_load(&inputs, options, &listener, &source, &fault);
    return Source(source);
  }
  Source load(const char* name, const std::string& bytes,
              const lumen_engine_options* options = {}) {
    lumen_engine_inputs inputs{};
    inputs.main = fileOf(name, bytes);
    return load(inputs, options);
  }
  /// Whether the last call failed so, with these words.
  testing::AssertionResult failsWith(lumen_engine_status status, std::string_view words) const {
    const std::string_view message = fault.message;
    if (m_status == status && message.find(words) != std::string_view::npos)
      return testing::AssertionSuccess();
    return testing::AssertionFailure() << m_status << ": " << message;
  }
  Made caseOf(const Source& source, const lumen_engine_options* options = {}) {
    lumen_engine_case* made = nullptr;
    m_status = lumen_engine_case_of(source.get(), options, &listener, &made, &fault);
    return Made(made);
  }
  std::string encoded(const Made& made, const char* format,
                      const lumen_engine_options* options = {}) {
    lumen_engine_bytes* bytes = nullptr;
    m_status = lumen_engine_encode(made.get(), format, options, nullptr, &bytes, &fault);
    const Bytes held(bytes);
    return {static_cast<const char*>(lumen_engine_bytes_data(bytes)),
            lumen_engine_bytes_size(bytes)};
  }
  lumen_engine_status m_status = LUMEN_ENGINE_OK;
};

}  // namespace lumen::test
