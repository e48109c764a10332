// SPDX-License-Identifier: Apache-2.0
// A definition from a .lumen file.
#pragma once

#include <cstddef>

#include "blob.h"

namespace lumen::blob {

/// Builds a model from the bytes of a .lumen file. May throw std::bad_alloc. The message goes to
/// the definition's buffer, if it has one.
blob_status openBytes(const void* bytes, std::size_t size, const blob_open_def& def,
                      blob_model** model);
blob_status openFile(const char* path, const blob_open_def& def, blob_model** model);

}  // namespace lumen::blob
