// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lumen {
namespace engine {}
namespace app = engine;
}  // namespace lumen
