// SPDX-License-Identifier: Apache-2.0
// Cases and damaged files that the tests of this folder share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "formats/case/case_file.h"
#include "formats/container/container.h"

namespace lumen::formats::test {

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

using Bytes = std::vector<std::byte>;

/// One node at (1, 2, 3) along z, radius 1 mm, in the branch "a": the smallest case.
Case smallestCase();

/// Two vessels and an aneurysm, six nodes, points, Cauchy models and every kind of metadata.
Case richCase();

/// The rich case with everything else that a file can hold: links, a note, the parent's digest,
/// quantised points, two node arrays of an extension, and two chunks of others.
Case fullCase();

/// The rich case with a periodic motion of nodes 1, 2 and 5 at three times.
Case movingCase();

/// A straight case of `nodes` nodes with so many points and blobs each, for the benchmark.
Case longCase(std::size_t nodes, std::size_t pointsPerNode, std::size_t blobsPerNode);

/// Offset of the table entry of the chunk named `type`; fails the test if there is none.
std::size_t entryOf(const Bytes& file, const std::string& type);
/// Offset of that chunk's bytes.
std::size_t dataOf(const Bytes& file, const std::string& type);

/// Makes all three kinds of checksums right again after `file` was changed, as a hostile writer
/// would.
void resign(Bytes& file);

/// The file of the rich case with `change` applied and all checksums made right again.
Bytes tampered(const std::function<void(Bytes&)>& change);

/// The file of the full case with `change` applied and all checksums made right again.
Bytes tamperedFull(const std::function<void(Bytes&)>& change);

/// The name of the rule that was broken, or "OK".
template <class Result>
std::string codeOf(const Result& result) {
  return result ? "OK" : errorName(result.error().code);
}

}  // namespace lumen::formats::test
