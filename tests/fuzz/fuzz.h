// SPDX-License-Identifier: Apache-2.0
// The fuzz targets, each of which stops the program where a property of the code does not hold, and
// what they share.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string_view>
#include <vector>

#include "formats/container/bytes.h"
#include "formats/container/container.h"
#include "formats/container/crc32c.h"

namespace lumen::fuzz {

/// Stops the program with a message if a property of the code does not hold; in every build.
inline void expect(bool holds, const char* property) {
  if (holds) return;
  std::fprintf(stderr, "broken: %s\n", property);
  std::abort();
}

inline std::span<const std::byte> bytesOf(const std::uint8_t* data, std::size_t size) {
  return std::as_bytes(std::span(data, size));
}

/// Makes checksums and the stated length right, as a hostile writer would: otherwise hardly any
/// changed input would get past them.
inline void resign(std::vector<std::byte>& file) {
  using namespace lumen::formats;
  if (file.size() < kHeaderSize) return;
  storeLittle(&file[16], static_cast<std::uint64_t>(file.size()));
  const std::size_t fitting = (file.size() - kHeaderSize) / kTableEntrySize;
  const std::size_t count = std::min<std::size_t>(loadLittle<std::uint32_t>(&file[24]), fitting);
  for (std::size_t i = 0; i < count; ++i) {
    std::byte* entry = &file[kHeaderSize + kTableEntrySize * i];
    const auto offset = loadLittle<std::uint64_t>(entry + 8);
    const auto stored = loadLittle<std::uint64_t>(entry + 16);
    if (offset <= file.size() && stored <= file.size() - offset)
      storeLittle(entry + 32, crc32c(std::span(file).subspan(offset, stored)));
  }
  storeLittle(&file[28], crc32c(std::span(file).subspan(kHeaderSize, kTableEntrySize * count)));
  storeLittle(&file[60], crc32c(std::span(file).first(60)));
}

inline std::string_view textOf(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// A target: its name, by which its corpus is called, too, and its function of one input.
struct Target {
  const char* name;
  void (*run)(std::span<const std::byte> input);
};

// The targets of each source.
std::span<const Target> caseTargets();
std::span<const Target> centerlineTargets();
std::span<const Target> meshTargets();
std::span<const Target> seedTargets();
std::span<const Target> volumeTargets();

}  // namespace lumen::fuzz
