// SPDX-License-Identifier: Apache-2.0
// Published maxima of the format; see spec/lumen.md, "Limits".
#pragma once

#include <cstddef>

namespace lumen::formats {

constexpr std::size_t kMaxNodes = std::size_t{1} << 24;
constexpr std::size_t kMaxLinks = std::size_t{1} << 20;
constexpr std::size_t kMaxPoints = std::size_t{1} << 28;
constexpr std::size_t kMaxBlobs = std::size_t{1} << 26;
constexpr std::size_t kMaxBranches = 65535;
constexpr std::size_t kMaxTimes = 4096;                  ///< times of a motion
constexpr std::size_t kMaxPoses = std::size_t{1} << 26;  ///< times by moving nodes
constexpr std::size_t kMaxNodeArrays = 256;
constexpr std::size_t kMaxComponents = 16;  ///< components of a node array
constexpr std::size_t kMaxExtensions = 256;
constexpr std::size_t kMaxOtherChunks = 3800;  ///< chunks of unknown types
constexpr std::size_t kMaxSteps = 1024;
constexpr std::size_t kMaxParameters = 4096;  ///< parameters of one step
constexpr std::size_t kMaxNameBytes = 255;    ///< labels and all names
constexpr std::size_t kMaxTextBytes = 65535;  ///< a parameter that is a text; the note
constexpr std::size_t kMaxJsonDepth = 64;

}  // namespace lumen::formats
