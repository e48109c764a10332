// SPDX-License-Identifier: Apache-2.0
// Points and cells in a file between lumen and lumen-netgen: both counts, then doubles, then numbers
// from 0, as the machine has them in memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace lumen::convert {

template <std::size_t corners>
struct Exchange {
  std::vector<std::array<double, 3>> point;
  std::vector<std::array<std::uint32_t, corners>> cell;

  /// False if the file cannot be written.
  [[nodiscard]] bool write(const std::string& path) const {
    std::ofstream file(path, std::ios::binary);
    const std::array<std::uint64_t, 2> counts{point.size(), cell.size()};
    put(file, counts.data(), sizeof counts);
    put(file, point.data(), point.size() * sizeof point[0]);
    put(file, cell.data(), cell.size() * sizeof cell[0]);
    return static_cast<bool>(file.flush());
  }

  /// False unless the file holds as many points and cells as it states, and nothing else.
  [[nodiscard]] bool read(const std::string& path) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    const auto size = static_cast<std::uint64_t>(file.tellg());
    std::array<std::uint64_t, 2> counts{};
    if (!file || size < sizeof counts) return false;
    file.seekg(0);
    take(file, counts.data(), sizeof counts);
    if (counts[0] > size || counts[1] > size ||
        size != sizeof counts + counts[0] * sizeof point[0] + counts[1] * sizeof cell[0])
      return false;
    point.resize(counts[0]);
    cell.resize(counts[1]);
    take(file, point.data(), point.size() * sizeof point[0]);
    take(file, cell.data(), cell.size() * sizeof cell[0]);
    return static_cast<bool>(file);
  }

private:
  static void put(std::ofstream& file, const void* bytes, std::size_t count) {
    file.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(count));
  }
  static void take(std::ifstream& file, void* bytes, std::size_t count) {
    file.read(static_cast<char*>(bytes), static_cast<std::streamsize>(count));
  }
};

}  // namespace lumen::convert
