// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lumen::blob::cuda {

/// PTX of libblob/device/query.cu, zero-terminated; the build makes it (write_ptx.cmake).
extern const char kKernels[];

}  // namespace lumen::blob::cuda
