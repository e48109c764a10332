// SPDX-License-Identifier: Apache-2.0
// Scenes of SOFA: which meshes they load, and where they put them.
#include <string_view>

#include "converters/base/error.h"
#include "converters/io/mesh/sofa_scene.h"
#include "formats/container/printable.h"
#include "fuzz/fuzz_support.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lumen;
  using fuzz::expect;
  try {
    const auto loaders =
        convert::sofaLoaders(std::string_view(reinterpret_cast<const char*>(data), size), "scene");
    for (const convert::SofaLoader& loader : loaders)
      expect(loader.toScene.matrix().allFinite(), "what a loader does is finite");
    const convert::SofaLoader& vessels = convert::vesselLoader(loaders, "", "scene");
    expect(&vessels >= loaders.data() && &vessels < loaders.data() + loaders.size(),
           "the vessels' loader is one of the scene's");
  } catch (const Error& error) {
    expect(error.kind() == ErrorKind::InvalidInput || error.kind() == ErrorKind::Unsupported,
           "a bad scene is invalid or unsupported input");
    expect(formats::printable(error.what()) == error.what(), "messages are fit to print");
  }
  return 0;
}
