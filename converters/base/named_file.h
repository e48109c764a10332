// SPDX-License-Identifier: Apache-2.0
// Output of a writer of several files.
#pragma once

#include <string>

namespace lumen {

/// A file of a folder. `name` is relative to it, with a / between folders.
struct NamedFile {
  std::string name;
  std::string bytes;
};

}  // namespace lumen
