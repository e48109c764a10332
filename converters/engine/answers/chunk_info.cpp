// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/chunk_info.h"

#include <array>

#include "converters/base/error.h"
#include "formats/container/crc32c.h"
#include "formats/view/case_chunks.h"

namespace lumen::engine {

namespace {

constexpr std::array<std::string_view, 3> kEncodings = {"raw", "zstd", "draco"};

std::string encodingName(std::uint8_t encoding) {
  return encoding < kEncodings.size() ? std::string(kEncodings[encoding])
                                      : std::to_string(encoding);
}

std::string remarks(const ChunkInfo& info) {
  std::string text = info.chunk.critical ? "critical" : "";
  const auto add = [&text](bool wanted, const char* word) {
    if (wanted) text.append(text.empty() ? "" : ", ").append(word);
  };
  add(info.chunk.independent, "independent");
  add(!info.known, "unknown");
  add(!info.intact, "DAMAGED");
  return text;
}

ChunkCounts countsOf(const formats::Container& container) {
  ChunkCounts counts;
  for (const formats::Chunk& chunk : container.chunks) {
    const std::size_t rule = formats::chunkRuleIndex(chunk.type);
    if (rule >= formats::kChunkRules.size()) continue;
    const std::uint64_t elements = chunk.rawSize / formats::kChunkRules[rule].stride;
    if (chunk.type == formats::chunk::kNodeCentre) counts.nodes = elements;
    if (chunk.type == formats::chunk::kBranchRecords) counts.branches = elements;
    if (chunk.type == formats::chunk::kPointPosition) counts.points = elements;
    if (chunk.type == formats::chunk::kModelCentre) counts.blobs = elements;
  }
  return counts;
}

FileInfo described(const formats::Container& container, std::uint64_t length) {
  FileInfo info{container.version, length, countsOf(container), {}};
  for (const formats::Chunk& chunk : container.chunks) {
    ChunkInfo entry{chunk, chunk.stored.size(),
                    formats::chunkRuleIndex(chunk.type) < formats::kChunkRules.size(),
                    static_cast<bool>(formats::verifyChunk(chunk))};
    entry.chunk.stored = {};  // the bytes go with the caller
    info.chunks.push_back(entry);
  }
  return info;
}

}  // namespace

FileInfo describeChunks(std::span<const std::byte> bytes, const std::string& name) {
  if (!bytes.empty() && bytes.front() == std::byte{'{'})
    throw unsupported(name + ": --chunks is for .lumen files; JSON has no chunks");
  const auto container = formats::readContainer(bytes);
  if (!container) throw invalidInput(name + ": " + container.error().text());
  return described(*container, bytes.size());
}

Json chunkInfoJson(const FileInfo& info) {
  Json json;
  json["version"] = formats::versionText(info.version);
  json["length"] = info.length;
  json["counts"] = {{"nodes", info.counts.nodes},
                    {"branches", info.counts.branches},
                    {"points", info.counts.points},
                    {"blobs", info.counts.blobs}};
  json["chunks"] = Json::array();
  for (const ChunkInfo& entry : info.chunks)
    json["chunks"].push_back({{"type", formats::chunkName(entry.chunk.type)},
                              {"version", entry.chunk.version},
                              {"critical", entry.chunk.critical},
                              {"independent", entry.chunk.independent},
                              {"known", entry.known},
                              {"encoding", encodingName(entry.chunk.encoding)},
                              {"offset", entry.chunk.offset},
                              {"stored", entry.storedSize},
                              {"raw", entry.chunk.rawSize},
                              {"crc32c", formats::checksumText(entry.chunk.checksum)},
                              {"intact", entry.intact}});
  return json;
}

std::string chunkInfoText(const FileInfo& info) {
  std::vector<std::vector<std::string>> rows = {
      {"chunk", "encoding", "offset", "stored", "raw", "crc32c", "remarks"}};
  for (const ChunkInfo& entry : info.chunks)
    rows.push_back({formats::chunkName(entry.chunk.type), encodingName(entry.chunk.encoding),
                    std::to_string(entry.chunk.offset), std::to_string(entry.storedSize),
                    std::to_string(entry.chunk.rawSize),
                    formats::checksumText(entry.chunk.checksum), remarks(entry)});
  return "version       " + formats::versionText(info.version) + "\nbytes         " +
         std::to_string(info.length) + "\nnodes         " + std::to_string(info.counts.nodes) +
         "\nbranches      " + std::to_string(info.counts.branches) + "\npoints        " +
         std::to_string(info.counts.points) + "\nblobs         " +
         std::to_string(info.counts.blobs) + "\n\n" + alignColumns(rows);
}

}  // namespace lumen::engine
