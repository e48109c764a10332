// SPDX-License-Identifier: Apache-2.0
// The models of a case in libblob.
#pragma once

#include <memory>

#include "formats/case/case.h"

struct blob_model;

namespace lumen::convert {

using OwnedModel = std::unique_ptr<blob_model, void (*)(blob_model*)>;

/// Throws Error(InvalidInput) for a case whose models libblob refuses.
OwnedModel openModels(const formats::Case& source);

}  // namespace lumen::convert
