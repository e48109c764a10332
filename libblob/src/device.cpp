// SPDX-License-Identifier: Apache-2.0
// The flat buffer of blob_device.h: written from models, and checked.
#include <cmath>
#include <cstring>
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

// Blocks of the buffer are those of a model, byte for byte.
static_assert(sizeof(BlobBlock) == sizeof(Word) * BLOB_DEVICE_BLOB_WORDS &&
              sizeof(NeighbourBlock) == sizeof(Word) * BLOB_DEVICE_NEIGHBOUR_WORDS);

std::size_t wordsOf(const blob_model& model) {
  return BLOB_DEVICE_NODE_WORDS * model.nodes.size() +
         BLOB_DEVICE_NEIGHBOUR_WORDS * model.neighbours.size() +
         BLOB_DEVICE_BLOB_WORDS * model.field.blocks.size();
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
  template <class Block>
  void put(const std::vector<Block>& blocks) {
    const std::size_t size = blocks.size() * sizeof(Block);
    std::memcpy(m_buffer + sizeof(Word) * m_at, blocks.data(), size);
    m_at += size / sizeof(Word);
  }
  void put(float number) { std::memcpy(m_buffer + sizeof number * m_at++, &number, sizeof number); }

private:
  unsigned char* m_buffer;
  std::size_t m_at = 0;
};

// The least float that is no less than a number: floats below the one are below the other.
float roundedUp(double number) {
  const float nearest = static_cast<float>(number);
  return double{nearest} < number ? std::nextafter(nearest, INFINITY) : nearest;
}

void putNodes(const blob_model& model, Writer& to) {
  for (const NodeRecord& node : model.nodes) {
    for (int axis = 0; axis < 3; ++axis) to.put(static_cast<float>(node.centre[axis]));
    to.put(node.radius());
    for (int axis = 0; axis < 3; ++axis) to.put(node.field.place[axis]);
    to.put(roundedUp(node.quietSquare()));
    for (const Word word : {node.field.block, Word{node.field.blockCount}, node.firstNeighbours,
                            node.neighbourBlocks})
      to.put(std::size_t{word});
    for (int axis = 0; axis < 3; ++axis) {
      const double centre = node.centre[axis];
      to.put(static_cast<float>(centre - double{static_cast<float>(centre)}));
    }
    to.put(std::size_t{0});
  }
}

// Writes a vessel's row of the table, and its arrays from `first` on; returns the word after them.
std::size_t putVessel(const blob_model& model, std::size_t row, std::size_t first, Writer& to) {
  const std::size_t neighbours = first + BLOB_DEVICE_NODE_WORDS * model.nodes.size();
  const std::size_t blobs = neighbours + BLOB_DEVICE_NEIGHBOUR_WORDS * model.neighbours.size();
  const std::size_t end = first + wordsOf(model);
  to.goTo(BLOB_DEVICE_HEADER_WORDS + BLOB_DEVICE_VESSEL_WORDS * row);
  to.put(static_cast<std::size_t>(model.field.kernel));
  for (const std::size_t word : {model.nodes.size(), first, neighbours, blobs}) to.put(word);
  to.put(static_cast<float>(model.field.isoLevel));
  to.put(static_cast<float>(model.field.transformedLevel));
  to.put(end);
  to.goTo(first);
  putNodes(model, to);
  to.put(model.neighbours);
  to.put(model.field.blocks);
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
    if (!from.areFinite(at, 8) || !from.areFinite(at + 12, 3) || !(from.number(at + 3) > 0))
      return BLOB_ERROR_RANGE;
    if (!isRangeIn(from.word(at + 8), from.word(at + 9), v.blobCount()) ||
        !isRangeIn(from.word(at + 10), from.word(at + 11), v.neighbourCount()) ||
        from.word(at + 11) == 0)
      return BLOB_ERROR_TOPOLOGY;
  }
  return BLOB_OK;
}

// The neighbour whose first word is at `at`.
blob_status checkNeighbour(const Reader& from, const Vessel& v, std::size_t at) {
  const float n[3] = {from.number(at), from.number(at + 8), from.number(at + 16)};
  const float c = from.number(at + 24), inverseTau = from.number(at + 32);
  for (const float number : {n[0], n[1], n[2], c, inverseTau})
    if (!std::isfinite(number)) return BLOB_ERROR_RANGE;
  if (!(inverseTau > 0)) return BLOB_ERROR_RANGE;
  const Word node = from.word(at + 40);
  if (node < v.nodeCount) return BLOB_OK;
  // padding is never reached
  const bool isNever = c == kNeverLess && n[0] == 0 && n[1] == 0 && n[2] == 0 && inverseTau == 1;
  return node == BLOB_NOWHERE && isNever ? BLOB_OK : BLOB_ERROR_TOPOLOGY;
}

blob_status checkElements(const Reader& from, const Vessel& v) {
  for (std::size_t block = v.neighbours; block < v.blobs; block += BLOB_DEVICE_NEIGHBOUR_WORDS)
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      if (const blob_status status = checkNeighbour(from, v, block + lane); status != BLOB_OK)
        return status;
  for (std::size_t block = v.blobs; block < v.end; block += BLOB_DEVICE_BLOB_WORDS) {
    if (!from.areFinite(block, BLOB_DEVICE_BLOB_WORDS)) return BLOB_ERROR_RANGE;
    for (std::size_t lane = block; lane < block + kLanes; ++lane) {
      const float a = from.number(lane + 24), w = from.number(lane + 32);
      if (!(a >= 0) || !(w >= 0) || (a > 0) != (w > 0)) return BLOB_ERROR_RANGE;
    }
  }
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
  for (std::size_t i = 0; i < count; ++i) first = putVessel(*models[i], i, first, to);
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
