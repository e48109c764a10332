// SPDX-License-Identifier: Apache-2.0
// The flat buffer of blob_device.h: written from models, and checked.
#include <cmath>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

#include "blob_device.h"
#include "model.h"

namespace {

using namespace lumen::blob;
using Word = std::uint32_t;

constexpr std::size_t kMostWords = 0xFFFFFFFFU;

std::size_t alignedUp(std::size_t words) {
  return (words + BLOB_DEVICE_ALIGN_WORDS - 1) / BLOB_DEVICE_ALIGN_WORDS * BLOB_DEVICE_ALIGN_WORDS;
}

std::size_t blobsIn(const BlobBlock& block) {
  std::size_t count = 0;
  for (const float w : block.w) count += w > 0 ? 1 : 0;
  return count;
}

std::size_t neighboursIn(const NeighbourBlock& block) {
  std::size_t count = 0;
  for (int lane = 0; lane < kLanes; ++lane) count += isPadding(block, lane) ? 0 : 1;
  return count;
}

template <class Block, class Count>
std::size_t countIn(const std::vector<Block>& blocks, Count count) {
  std::size_t sum = 0;
  for (const Block& block : blocks) sum += count(block);
  return sum;
}

std::size_t wordsOf(const blob_model& model) {
  return BLOB_DEVICE_NODE_WORDS * model.nodes.size() +
         BLOB_DEVICE_NEIGHBOUR_WORDS * countIn(model.neighbours, neighboursIn) +
         BLOB_DEVICE_BLOB_WORDS * countIn(model.field.blocks, blobsIn);
}

// Writes words one after another.
class Writer {
public:
  explicit Writer(unsigned char* buffer) : m_buffer(buffer) {}
  void goTo(std::size_t word) { m_at = word; }
  [[nodiscard]] std::size_t at() const { return m_at; }
  void put(std::size_t word) {
    const Word stored = static_cast<Word>(word);
    std::memcpy(m_buffer + sizeof stored * m_at++, &stored, sizeof stored);
  }
  void put(float number) { std::memcpy(m_buffer + sizeof number * m_at++, &number, sizeof number); }

private:
  unsigned char* m_buffer;
  std::size_t m_at = 0;
};

void putBlobs(const blob_model& model, Writer& to) {
  for (const BlobBlock& block : model.field.blocks)
    for (int lane = 0; lane < kLanes; ++lane)
      if (block.w[lane] > 0)
        for (const float number :
             {block.x[lane], block.y[lane], block.z[lane], block.a[lane], block.w[lane]})
          to.put(number);
}

void putNeighbours(const blob_model& model, Writer& to) {
  for (const NeighbourBlock& block : model.neighbours)
    for (int lane = 0; lane < kLanes; ++lane)
      if (!isPadding(block, lane)) {
        for (const float number : {block.nx[lane], block.ny[lane], block.nz[lane], block.c[lane],
                                   block.inverseTau[lane]})
          to.put(number);
        to.put(std::size_t{block.node[lane]});
      }
}

// Number of blobs before each block, and of all; null without memory.
std::unique_ptr<Word[]> countBlobsBefore(const blob_model& model) {
  const std::size_t blocks = model.field.blocks.size();
  std::unique_ptr<Word[]> before(new (std::nothrow) Word[blocks + 1]);
  if (before == nullptr) return before;
  before[0] = 0;
  for (std::size_t b = 0; b < blocks; ++b)
    before[b + 1] = before[b] + static_cast<Word>(blobsIn(model.field.blocks[b]));
  return before;
}

// The nodes, whose neighbours and blobs are numbered without the padding of blocks.
void putNodes(const blob_model& model, const Word* blobsBefore, Writer& to) {
  std::size_t neighbours = 0;
  for (const NodeRecord& node : model.nodes) {
    for (int axis = 0; axis < 3; ++axis) to.put(static_cast<float>(node.centre[axis]));
    to.put(node.radius());
    for (int axis = 0; axis < 3; ++axis) to.put(node.field.place[axis]);
    to.put(static_cast<float>(node.quietSquare()));
    const Word first = blobsBefore[node.field.block];
    to.put(std::size_t{first});
    to.put(std::size_t{blobsBefore[node.field.block + node.field.blockCount] - first});
    const std::size_t before = neighbours;
    for (Word b = 0; b < node.neighbourBlocks; ++b)
      neighbours += neighboursIn(model.neighbours[node.firstNeighbours + b]);
    to.put(before);
    to.put(neighbours - before);
  }
}

// Writes a vessel's row of the table, and its arrays from `first` on; returns the word after them,
// or 0 without memory.
std::size_t putVessel(const blob_model& model, std::size_t row, std::size_t first, Writer& to) {
  const std::unique_ptr<Word[]> blobsBefore = countBlobsBefore(model);
  if (blobsBefore == nullptr) return 0;
  const std::size_t neighbours = first + BLOB_DEVICE_NODE_WORDS * model.nodes.size();
  const std::size_t blobs =
      neighbours + BLOB_DEVICE_NEIGHBOUR_WORDS * countIn(model.neighbours, neighboursIn);
  const std::size_t end = first + wordsOf(model);
  to.goTo(BLOB_DEVICE_HEADER_WORDS + BLOB_DEVICE_VESSEL_WORDS * row);
  to.put(static_cast<std::size_t>(model.field.kernel));
  for (const std::size_t word : {model.nodes.size(), first, neighbours, blobs}) to.put(word);
  to.put(static_cast<float>(model.field.isoLevel));
  to.put(static_cast<float>(model.field.transformedLevel));
  to.put(end);
  to.goTo(first);
  putNodes(model, blobsBefore.get(), to);
  putNeighbours(model, to);
  putBlobs(model, to);
  while (to.at() < alignedUp(end)) to.put(std::size_t{0});
  return to.at();
}

// A buffer as words and floats.
class Reader {
public:
  explicit Reader(const void* buffer) : m_buffer(static_cast<const unsigned char*>(buffer)) {}
  [[nodiscard]] Word word(std::size_t at) const {
    Word result;
    std::memcpy(&result, m_buffer + sizeof result * at, sizeof result);
    return result;
  }
  [[nodiscard]] float number(std::size_t at) const {
    float result;
    std::memcpy(&result, m_buffer + sizeof result * at, sizeof result);
    return result;
  }
  [[nodiscard]] bool areFinite(std::size_t at, std::size_t count) const {
    bool finite = true;
    for (std::size_t i = at; i < at + count; ++i) finite = finite && std::isfinite(number(i));
    return finite;
  }

private:
  const unsigned char* m_buffer;
};

bool isRangeIn(std::size_t first, std::size_t count, std::size_t size) {
  return first <= size && count <= size - first;
}

// The arrays of a vessel, as its row of the table states them.
struct Vessel {
  std::size_t kernel, nodeCount, nodes, neighbours, blobs, end;

  Vessel(const Reader& from, std::size_t row)
      : kernel(from.word(row)),
        nodeCount(from.word(row + 1)),
        nodes(from.word(row + 2)),
        neighbours(from.word(row + 3)),
        blobs(from.word(row + 4)),
        end(from.word(row + 7)) {}

  // Whether the arrays follow one another from `first` on, within `words`, in whole elements.
  [[nodiscard]] bool isLaidOut(std::size_t first, std::size_t words) const {
    return nodes == first && neighbours == nodes + BLOB_DEVICE_NODE_WORDS * nodeCount &&
           blobs >= neighbours && (blobs - neighbours) % BLOB_DEVICE_NEIGHBOUR_WORDS == 0 &&
           end >= blobs && (end - blobs) % BLOB_DEVICE_BLOB_WORDS == 0 && alignedUp(end) <= words;
  }
  [[nodiscard]] std::size_t neighbourCount() const {
    return (blobs - neighbours) / BLOB_DEVICE_NEIGHBOUR_WORDS;
  }
  [[nodiscard]] std::size_t blobCount() const { return (end - blobs) / BLOB_DEVICE_BLOB_WORDS; }
};

blob_status checkNodes(const Reader& from, const Vessel& v) {
  for (std::size_t i = 0; i < v.nodeCount; ++i) {
    const std::size_t at = v.nodes + BLOB_DEVICE_NODE_WORDS * i;
    if (!from.areFinite(at, 8) || !(from.number(at + 3) > 0)) return BLOB_ERROR_RANGE;
    if (!isRangeIn(from.word(at + 8), from.word(at + 9), v.blobCount()) ||
        !isRangeIn(from.word(at + 10), from.word(at + 11), v.neighbourCount()))
      return BLOB_ERROR_TOPOLOGY;
  }
  return BLOB_OK;
}

blob_status checkElements(const Reader& from, const Vessel& v) {
  for (std::size_t at = v.neighbours; at < v.blobs; at += BLOB_DEVICE_NEIGHBOUR_WORDS) {
    if (!from.areFinite(at, 5) || !(from.number(at + 4) > 0)) return BLOB_ERROR_RANGE;
    if (from.word(at + 5) >= v.nodeCount) return BLOB_ERROR_TOPOLOGY;
  }
  for (std::size_t at = v.blobs; at < v.end; at += BLOB_DEVICE_BLOB_WORDS)
    if (!from.areFinite(at, 5) || !(from.number(at + 3) > 0) || !(from.number(at + 4) > 0))
      return BLOB_ERROR_RANGE;
  return BLOB_OK;
}

blob_status checkVessel(const Reader& from, std::size_t row, std::size_t words,
                        std::size_t& first) {
  constexpr Word kKernels = BLOB_SOFT_OBJECT + 1;
  const Vessel v(from, row);
  if (v.kernel >= kKernels) return BLOB_ERROR_KERNEL;
  if (v.nodeCount == 0) return BLOB_ERROR_EMPTY;
  if (v.nodeCount > BLOB_MAX_NODES) return BLOB_ERROR_LIMIT;
  if (!v.isLaidOut(first, words)) return BLOB_ERROR_FORMAT;
  if (!from.areFinite(row + 5, 2) || !(from.number(row + 5) > 0)) return BLOB_ERROR_RANGE;
  first = alignedUp(v.end);
  const blob_status status = checkNodes(from, v);
  return status != BLOB_OK ? status : checkElements(from, v);
}

}  // namespace

extern "C" {

size_t blob_device_pack(const blob_model* const* models, size_t count, void* buffer,
                        size_t capacity) noexcept {
  if (count == 0 || count > kMostWords / BLOB_DEVICE_VESSEL_WORDS) return 0;
  const std::size_t start = alignedUp(BLOB_DEVICE_HEADER_WORDS + BLOB_DEVICE_VESSEL_WORDS * count);
  std::size_t words = start;
  for (std::size_t i = 0; i < count; ++i) words += alignedUp(wordsOf(*models[i]));
  if (words > kMostWords) return 0;
  if (capacity < words * sizeof(Word)) return words * sizeof(Word);
  std::memset(buffer, 0, start * sizeof(Word));
  Writer to(static_cast<unsigned char*>(buffer));
  for (const std::size_t word :
       {std::size_t{BLOB_DEVICE_MAGIC}, std::size_t{BLOB_DEVICE_VERSION}, words, count})
    to.put(word);
  std::size_t first = start;
  for (std::size_t i = 0; i < count; ++i) {
    first = putVessel(*models[i], i, first, to);
    if (first == 0) return 0;
  }
  return words * sizeof(Word);
}

blob_status blob_device_check(const void* buffer, size_t size) noexcept {
  if (buffer == nullptr) return BLOB_ERROR_ARGUMENT;
  const std::size_t words = size / sizeof(Word);
  if (size % sizeof(Word) != 0 || words < BLOB_DEVICE_HEADER_WORDS) return BLOB_ERROR_FORMAT;
  const Reader from(buffer);
  if (from.word(0) != BLOB_DEVICE_MAGIC || from.word(1) != BLOB_DEVICE_VERSION ||
      from.word(2) != words)
    return BLOB_ERROR_FORMAT;
  const std::size_t count = from.word(3);
  if (count == 0) return BLOB_ERROR_EMPTY;
  if (count > (words - BLOB_DEVICE_HEADER_WORDS) / BLOB_DEVICE_VESSEL_WORDS)
    return BLOB_ERROR_FORMAT;
  std::size_t first = alignedUp(BLOB_DEVICE_HEADER_WORDS + BLOB_DEVICE_VESSEL_WORDS * count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t row = BLOB_DEVICE_HEADER_WORDS + BLOB_DEVICE_VESSEL_WORDS * i;
    const blob_status status = checkVessel(from, row, words, first);
    if (status != BLOB_OK) return status;
  }
  return first == words ? BLOB_OK : BLOB_ERROR_FORMAT;
}

}  // extern "C"
