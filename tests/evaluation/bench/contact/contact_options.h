// SPDX-License-Identifier: Apache-2.0
// Options of the benchmarks of contact.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace lumen::bench {

struct ContactOptions {
  std::string json;
  std::size_t environments = 4096;
  int turns = 7;
  std::vector<std::string> cases;
};

/// `--json FILE [--environments N] [--turns N] CASE...`, what is not given as in `options`. Throws
/// std::runtime_error with the usage where the file or a case is missing.
ContactOptions contactOptions(int argc, char** argv, ContactOptions options);

}  // namespace lumen::bench
