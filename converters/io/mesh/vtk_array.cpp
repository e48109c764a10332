// SPDX-License-Identifier: Apache-2.0
#include "converters/io/mesh/vtk_array.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include <tbb/parallel_for.h>
#include <zlib.h>

#include "converters/base/error.h"
#include "formats/json/base64.h"

namespace lumen::convert {
namespace {

static_assert(std::endian::native == std::endian::little,
              "numbers are written as they lie in memory");

// Bytes per compressed block; VTK's readers inflate a block at a time.
constexpr std::size_t kBlock = std::size_t{1} << 20;

// zlib's usual level takes three times as long on a surface and saves 2 % of its size.
constexpr int kLevel = Z_BEST_SPEED;

using Bytes = std::span<const std::byte>;

std::vector<std::byte> deflated(Bytes block) {
  uLongf size = compressBound(block.size());
  std::vector<std::byte> out(size);
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                reinterpret_cast<const Bytef*>(block.data()), block.size(), kLevel) != Z_OK)
    throw failed("zlib could not compress a block of the mesh");
  out.resize(size);
  return out;
}

// VTK's binary form: the number of blocks, their size, the size of a shorter last block, and the
// compressed size of each; then the blocks.
std::string coded(Bytes data) {
  const std::size_t blocks = (data.size() + kBlock - 1) / kBlock;
  std::vector<std::vector<std::byte>> packed(blocks);
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
    const std::size_t first = b * kBlock;
    packed[b] = deflated(data.subspan(first, std::min(kBlock, data.size() - first)));
  });
  std::vector<std::uint64_t> header{blocks, kBlock, data.size() % kBlock};
  std::vector<std::byte> body;
  for (const std::vector<std::byte>& block : packed) {
    header.push_back(block.size());
    body.insert(body.end(), block.begin(), block.end());
  }
  return formats::base64(std::as_bytes(std::span(header))) + formats::base64(body);
}

}  // namespace

std::string vtkElement(const std::string& attributes, std::span<const std::byte> data) {
  return "<DataArray " + attributes + " format=\"binary\">" + coded(data) + "</DataArray>\n";
}

// Each text ends with a zero; zeros within become spaces.
std::string textArray(const std::string& name, const std::vector<std::string>& texts) {
  std::string bytes;
  for (std::string text : texts) {
    std::replace(text.begin(), text.end(), '\0', ' ');
    bytes += text + '\0';
  }
  return vtkElement("type=\"String\" Name=\"" + name + "\" NumberOfTuples=\"" +
                        std::to_string(texts.size()) + "\"",
                    std::as_bytes(std::span(bytes)));
}

}  // namespace lumen::convert
