// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/case_model.h"

#include <cstddef>
#include <string>
#include <vector>

#include "blob.h"
#include "converters/base/error.h"
#include "formats/case/case_encoding.h"

namespace lumen::convert {

OwnedModel openModels(const formats::Case& source) {
  const std::vector<std::byte> file = formats::encodeBinary(source);
  blob_model* model = nullptr;
  const blob_status status = blob_model_open_bytes(file.data(), file.size(), nullptr, &model);
  if (status != BLOB_OK)
    throw invalidInput(std::string("libblob refuses the models of this case: ") +
                       blob_status_text(status));
  return {model, &blob_model_close};
}

}  // namespace lumen::convert
