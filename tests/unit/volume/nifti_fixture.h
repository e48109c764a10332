// SPDX-License-Identifier: Apache-2.0
// NIfTI files made by hand.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <zlib.h>

namespace lumen::convert {

/// NIfTI-1 with an identity sform.
struct MadeNiftiHeader {
  std::array<std::int16_t, 8> dim{3, 2, 2, 2, 1, 1, 1, 1};
  std::array<float, 8> pixdim{1, 1, 1, 1, 1, 1, 1, 1};
  std::int16_t type = 2, bits = 8;
  float slope = 0, intercept = 0;
  [[nodiscard]] std::string text() const {
    std::string h(352, '\0');
    const auto put = [&](std::size_t at, const auto& value) {
      std::memcpy(h.data() + at, &value, sizeof(value));
    };
    put(0, std::int32_t{348});
    put(40, dim);
    put(70, type);
    put(72, bits);
    put(76, pixdim);
    put(108, 352.0F);
    put(112, slope);
    put(116, intercept);
    put(254, std::int16_t{1});
    put(280, 1.0F);
    put(300, 1.0F);
    put(320, 1.0F);
    std::memcpy(h.data() + 344, "n+1", 4);
    return h;
  }
};

inline std::string gzipped(const std::string& text, const std::filesystem::path& scratch) {
  gzFile file = gzopen(scratch.c_str(), "wb");
  gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
  gzclose(file);
  std::ifstream stream(scratch, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace lumen::convert
