// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/remote_info.h"

#include <cstddef>
#include <fstream>
#include <span>
#include <string>

#include "converters/base/error.h"

namespace lumen::engine {

namespace {

// bytes, which hold the headers of usual volumes, and long ones
constexpr std::uint64_t kVolumeHead = 64 * 1024, kLongVolumeHead = 4 << 20;

}  // namespace

bool isBinaryCase(const FileFormat& format) {
  return format.name == "lumen";
}

FileInfo fetchChunkTable(const convert::RemoteAddress& address, RemoteInputs& remote) {
  const FetchedFile& head = remote.fetchHead(address, kUsualTable);
  if (head.read == head.bytes) return describeChunkTable(head.path);
  const std::filesystem::path file = head.path;
  std::string start(formats::kHeaderSize, '\0');
  std::ifstream(file, std::ios::binary)
      .read(start.data(), static_cast<std::streamsize>(start.size()));
  const std::uint64_t needed = tableBytes(std::as_bytes(std::span(start)));
  if (needed <= kUsualTable) return describeChunkTable(file);
  return describeChunkTable(remote.fetchHead(address, needed).path);
}

std::filesystem::path fetchVolumeHead(const convert::RemoteAddress& address,
                                      const FileFormat& format, const VolumeArguments& volume,
                                      RemoteInputs& remote) {
  const FetchedFile head = remote.fetchHead(address, kVolumeHead);
  if (head.read == head.bytes) return head.path;
  try {
    const Progress silent;
    (void)format.readVolumeHeader(head.path, volume.options(), silent);
    return head.path;
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::Cancelled) throw;
    return remote.fetchHead(address, kLongVolumeHead).path;
  }
}

}  // namespace lumen::engine
