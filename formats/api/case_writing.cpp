// SPDX-License-Identifier: Apache-2.0
// The functions of lumen/case.h that write.
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <new>
#include <span>
#include <string>

#include "formats/api/handle.h"
#include "formats/case/case_file.h"

namespace lumen::formats::api {
namespace {

constexpr std::uint32_t kWriteCookie = 0x4C430001;
constexpr int kMaxPointBits = 30;

/// The reason why options are refused, or null.
const char* faultOfOptions(const lumen_case_write_def& def) {
  if (def.cookie != kWriteCookie)
    return "the options were not made by lumen_case_write_def_default()";
  if (def.point_bits < 0 || def.point_bits > kMaxPointBits) return "point_bits is not 0 to 30";
  if (def.encoding < LUMEN_CASE_BY_NAME || def.encoding > LUMEN_CASE_JSON)
    return "there is no such encoding";
  return nullptr;
}

EncodeOptions optionsOf(const lumen_case_write_def& def) {
  return {def.compress != 0, def.point_bits};
}

lumen_case_status copyOut(std::span<const std::byte> from, void** bytes, std::size_t* size) {
  void* copy = std::malloc(from.size());
  if (!copy) throw std::bad_alloc();
  std::memcpy(copy, from.data(), from.size());
  *bytes = copy;
  *size = from.size();
  return LUMEN_CASE_OK;
}

}  // namespace
}  // namespace lumen::formats::api

using namespace lumen::formats;
using namespace lumen::formats::api;

extern "C" {

lumen_case_write_def lumen_case_write_def_default(void) noexcept {
  return {LUMEN_CASE_BY_NAME, 0, 0, kWriteCookie};
}

lumen_case_status lumen_case_save(const lumen_case* value, const char* path,
                                  const lumen_case_write_def* def,
                                  lumen_case_fault* fault) noexcept {
  return guarded(fault, [&] {
    if (!value || !path)
      return refuseArgument(fault, "lumen_case_save() was handed a null pointer");
    const lumen_case_write_def options = def ? *def : lumen_case_write_def_default();
    if (const char* reason = faultOfOptions(options)) return refuseArgument(fault, reason);
    const std::filesystem::path file(path);
    const bool json = options.encoding == LUMEN_CASE_JSON ||
                      (options.encoding == LUMEN_CASE_BY_NAME && file.extension() == ".json");
    const Status status = writeCaseFile(
        value->value, file, json ? CaseEncoding::Json : CaseEncoding::Binary, optionsOf(options));
    return status ? LUMEN_CASE_OK : refuse(fault, status.error());
  });
}

lumen_case_status lumen_case_encode(const lumen_case* value, const lumen_case_write_def* def,
                                    void** bytes, size_t* size, lumen_case_fault* fault) noexcept {
  if (bytes) *bytes = nullptr;
  if (size) *size = 0;
  return guarded(fault, [&] {
    if (!value || !bytes || !size)
      return refuseArgument(fault, "lumen_case_encode() was handed a null pointer");
    const lumen_case_write_def options = def ? *def : lumen_case_write_def_default();
    if (const char* reason = faultOfOptions(options)) return refuseArgument(fault, reason);
    if (const Status valid = validate(value->value); !valid) return refuse(fault, valid.error());
    if (options.encoding != LUMEN_CASE_JSON)
      return copyOut(encodeBinary(value->value, optionsOf(options)), bytes, size);
    Case rounded = value->value;
    if (options.point_bits > 0) quantisePoints(rounded, options.point_bits);
    const std::string text = encodeJson(rounded);
    return copyOut(std::as_bytes(std::span(text)), bytes, size);
  });
}

void lumen_case_free(void* bytes) noexcept {
  std::free(bytes);
}

}  // extern "C"
