// SPDX-License-Identifier: Apache-2.0
#include "converters/io/centerline/read_text.h"

#include <cstdint>
#include <fstream>
#include <system_error>

#include "converters/base/error.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxTextBytes = std::uintmax_t{64} << 20;

}  // namespace

std::string readCenterlineText(const fs::path& file, const char* format) {
  const std::string name = formats::printable(file.string());
  std::error_code error;
  const auto size = fs::file_size(file, error);
  if (error) throw invalidInput(name + ": cannot be read (" + error.message() + ")");
  if (size > kMaxTextBytes)
    throw invalidInput(name + ": has " + std::to_string(size) +
                       " bytes; expected at most 64 MiB of " + format);
  std::string text(static_cast<std::size_t>(size), '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(text.data(), static_cast<std::streamsize>(size)))
    throw invalidInput(name + ": cannot be read");
  return text;
}

}  // namespace lumen::convert
