// SPDX-License-Identifier: Apache-2.0
// Bytes that a page may already have.
#pragma once

#include <memory>
#include <string>
#include <utility>

namespace lumen::viewer {

/// Bytes with a name: `tag` differs where the bytes do. Null `bytes`: there is no such part.
struct Tagged {
  std::string tag;
  std::shared_ptr<const std::string> bytes;
};

inline Tagged tagged(std::string tag, std::string bytes) {
  return {std::move(tag), std::make_shared<const std::string>(std::move(bytes))};
}

}  // namespace lumen::viewer
