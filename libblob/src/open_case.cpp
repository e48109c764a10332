// SPDX-License-Identifier: Apache-2.0
#include "open_case.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "build_model.h"
#include "check_definition.h"
#include "formats/container/printable.h"
#include "formats/view/case_view.h"
#include "mapped_file.h"

namespace lumen::blob {
namespace {

using formats::ErrorCode;

blob_status fail(const blob_open_def& def, blob_status status, std::string_view sentence) {
  if (def.message != nullptr && def.message_size > 0) {
    const std::size_t size = std::min(sentence.size(), def.message_size - 1);
    std::memcpy(def.message, sentence.data(), size);
    def.message[size] = '\0';
  }
  return status;
}

blob_status statusOf(ErrorCode code) {
  switch (code) {
    case ErrorCode::HeaderChecksum:
    case ErrorCode::TableChecksum:
    case ErrorCode::ChunkChecksum:
      return BLOB_ERROR_CHECKSUM;
    case ErrorCode::ChunkEncoding:
      return BLOB_ERROR_ENCODING;
    case ErrorCode::Limit:
      return BLOB_ERROR_LIMIT;
    default:
      return BLOB_ERROR_FORMAT;
  }
}

// Fills `blobs`; false if offsets point beyond the arrays, as those of an unverified file may.
bool fillBlobs(const formats::ModelView& view, blob_blobs& blobs) {
  if (view.offset.empty() || view.offset.back() != view.centre.size() ||
      view.centre.size() != view.width.size())
    return false;
  blobs.kernel = static_cast<blob_kernel>(view.kernel);
  blobs.kernel_parameter = view.kernelParameter;
  blobs.iso_level = view.isoLevel;
  blobs.offset = view.offset.data();
  blobs.centre = reinterpret_cast<const float(*)[3]>(view.centre.data());
  blobs.width = view.width.data();
  return true;
}

blob_status build(const formats::CaseView& view, const blob_open_def& def, blob_model** model) {
  blob_model_def tree = blob_model_def_default();
  tree.node_count = view.nodeCount();
  tree.centre = reinterpret_cast<const float(*)[3]>(view.nodeCentre.data());
  tree.radius = view.nodeRadius.data();
  tree.parent = view.nodeParent.data();
  tree.link_count = view.links.size();
  tree.link = reinterpret_cast<const std::uint32_t(*)[2]>(view.links.data());
  tree.simd = def.simd;
  if (!view.models)
    return fail(def, BLOB_ERROR_NO_MODELS, "the case has no models; lumen fit makes them");
  if (!fillBlobs(*view.models, tree.blobs))
    return fail(def, BLOB_ERROR_TOPOLOGY, "offsets do not match the number of blobs");
  const blob_status status = checkDefinition(tree);
  if (status != BLOB_OK) return fail(def, status, blob_status_text(status));
  *model = buildModel(tree).release();
  return BLOB_OK;
}

}  // namespace

blob_status openBytes(const void* bytes, std::size_t size, const blob_open_def& def,
                      blob_model** model) {
  std::span<const std::byte> view(static_cast<const std::byte*>(bytes), size);
  // numbers are used in place, so unaligned bytes are copied
  std::vector<std::byte> aligned;
  if (reinterpret_cast<std::uintptr_t>(bytes) % alignof(double) != 0) {
    aligned.assign(view.begin(), view.end());
    view = aligned;
  }
  const auto opened =
      formats::viewCase(view, def.verify != 0 ? formats::Verify::All : formats::Verify::Structure);
  if (!opened)
    return fail(def, statusOf(opened.error().code), formats::printable(opened.error().message));
  return build(*opened, def, model);
}

blob_status openFile(const char* path, const blob_open_def& def, blob_model** model) {
  const MappedFile file(path);
  if (!file) return fail(def, BLOB_ERROR_FILE, blob_status_text(BLOB_ERROR_FILE));
  return openBytes(file.data(), file.size(), def, model);
}

}  // namespace lumen::blob
