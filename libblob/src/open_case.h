// SPDX-License-Identifier: Apache-2.0
// A definition from a .lumen file.
#pragma once

#include <cstddef>
#include <cstdint>

#include "blob.h"
#include "blob_pose.h"

namespace lumen::blob {

/// Builds a model from the bytes of a .lumen file. May throw std::bad_alloc. The message goes to
/// the definition's buffer, if it has one.
blob_status openBytes(const void* bytes, std::size_t size, const blob_open_def& def,
                      blob_model** model);
blob_status openFile(const char* path, const blob_open_def& def, blob_model** model);

/// Reads the motion in the bytes of a .lumen file, as above.
blob_status openMotionBytes(const void* bytes, std::size_t size, const blob_open_def& def,
                            blob_motion** motion);
blob_status openMotionFile(const char* path, const blob_open_def& def, blob_motion** motion);

/// The cookie of a blob_open_def.
constexpr std::uint32_t kOpenCookie = 0x626c6f31U;

}  // namespace lumen::blob
