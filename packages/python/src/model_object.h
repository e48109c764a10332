// SPDX-License-Identifier: Apache-2.0
// A model of libblob as an object of Python.
#pragma once

#include <memory>

#include "blob.h"
#include "packages/python/src/made_by_init.h"

namespace lumen::python {

struct CloseModel {
  void operator()(blob_model* model) const { blob_model_close(model); }
};

/// A model of libblob, which any number of threads may query.
struct ModelObject : MadeByInit {
  std::unique_ptr<blob_model, CloseModel> model;
  blob_model_info info{};
};
using SharedModel = std::shared_ptr<ModelObject>;

}  // namespace lumen::python
