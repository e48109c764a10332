// SPDX-License-Identifier: Apache-2.0
// Costs of opening and reading a case: time, memory, pages of the file, and bytes per node beside
// the same data as JSON and as VTK's PolyData. open_bench [FILE.lumen...]: real cases too.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>

#include "formats/case/case_file.h"
#include "formats/view/case_view.h"
#include "unit/formats/sample_case.h"

namespace lumen::formats {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double milliseconds(Clock::time_point since) {
  return std::chrono::duration<double, std::milli>(Clock::now() - since).count();
}

long minorFaults() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt + usage.ru_majflt;
}

struct OpenCost {
  double milliseconds = 0;
  long faults = 0;
  std::size_t pages = 0, filePages = 0;
  bool valid = false;
};

// Opens a mapped file as a new process would whose file is in the page cache (`cold`: is not).
OpenCost openMapped(const fs::path& file, bool cold) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  const auto size = static_cast<std::size_t>(fs::file_size(file));
  if (cold) {
    ::fdatasync(descriptor);
    ::posix_fadvise(descriptor, 0, 0, POSIX_FADV_DONTNEED);
  }
  OpenCost cost;
  const long faults = minorFaults();
  const auto start = Clock::now();
  void* data = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, descriptor, 0);
  if (cold) ::madvise(data, size, MADV_RANDOM);  // no reading ahead: every page was asked for
  const auto view = viewCase({static_cast<const std::byte*>(data), size}, Verify::Structure);
  cost.milliseconds = milliseconds(start);
  cost.faults = minorFaults() - faults;
  cost.valid = static_cast<bool>(view);
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  cost.filePages = (size + page - 1) / page;
  std::vector<unsigned char> resident(cost.filePages);
  ::mincore(data, size, resident.data());
  for (const unsigned char flags : resident) cost.pages += flags & 1u;
  ::munmap(data, size);
  ::close(descriptor);
  return cost;
}

struct ReadCost {
  double milliseconds = 0;
  long kilobytes = 0;  ///< greatest resident set of a process that does only this
};

// In a process of its own, so that its peak is that of the read.
ReadCost readInChild(const fs::path& file) {
  int ends[2];
  if (::pipe(ends) != 0) std::abort();
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(ends[1], STDOUT_FILENO);
    ::execl("/proc/self/exe", "open_bench", "--read", file.c_str(), nullptr);
    ::_exit(1);
  }
  ReadCost cost;
  if (::read(ends[0], &cost, sizeof cost) != sizeof cost) std::abort();
  ::waitpid(child, nullptr, 0);
  ::close(ends[0]);
  ::close(ends[1]);
  return cost;
}

// The greatest resident set so far, kB. (getrusage's starts with that of the parent process.)
long peakKilobytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::atol(line.c_str() + 6);
  return 0;
}

int readAndTell(const char* file) {
  const long before = peakKilobytes();
  const auto start = Clock::now();
  const auto value = readCaseFile(file);
  ReadCost cost{milliseconds(start), 0};
  cost.kilobytes = peakKilobytes() - before;
  return value && ::write(STDOUT_FILENO, &cost, sizeof cost) == sizeof cost ? 0 : 1;
}

std::size_t zlibSize(const void* data, std::size_t size) {
  auto bound = compressBound(static_cast<uLong>(size));
  std::vector<unsigned char> out(bound);
  compress2(out.data(), &bound, static_cast<const Bytef*>(data), static_cast<uLong>(size), 6);
  return bound;
}

// Bytes of the arrays of a PolyData with the same content, as VTK's writer appends them: raw with
// a size of 8 bytes each, or by zlib; about 120 bytes of XML for an array. Three pieces: nodes and
// their lines, wall points, blobs; a vertex needs its index and its offset (Int64).
struct PolyData {
  std::size_t raw = 0, compressed = 0;
  template <class T>
  void add(const std::vector<T>& values) {
    const std::size_t size = values.size() * sizeof(T);
    raw += size + 8 + 120;
    compressed += zlibSize(values.data(), size) + 32 + 120;
  }
};

void addVertices(PolyData& data, std::size_t count) {
  std::vector<std::int64_t> connectivity(count), offsets(count);
  for (std::size_t i = 0; i < count; ++i) {
    connectivity[i] = static_cast<std::int64_t>(i);
    offsets[i] = static_cast<std::int64_t>(i) + 1;
  }
  data.add(connectivity);
  data.add(offsets);
}

PolyData polyData(const Case& value) {
  PolyData data;
  const CenterlineTree& tree = value.tree;
  data.add(tree.centre);
  data.add(tree.direction);
  data.add(tree.radius);
  data.add(tree.height);
  data.add(tree.branch);
  if (!tree.inlierRate.empty()) data.add(tree.inlierRate);
  std::vector<std::int64_t> lines, offsets;
  for (std::size_t i = 0; i < tree.nodeCount(); ++i) {
    if (tree.parent[i] < 0) continue;
    lines.push_back(tree.parent[i]);
    lines.push_back(static_cast<std::int64_t>(i));
    offsets.push_back(static_cast<std::int64_t>(lines.size()));
  }
  data.add(lines);
  data.add(offsets);
  const auto addOwned = [&data](const std::vector<Vec3f>& points,
                                const std::vector<std::uint32_t>& offset) {
    std::vector<std::int32_t> owner;
    for (std::size_t i = 0; i + 1 < offset.size(); ++i)
      owner.insert(owner.end(), offset[i + 1] - offset[i], static_cast<std::int32_t>(i));
    data.add(points);
    data.add(owner);
    addVertices(data, points.size());
  };
  if (value.points) addOwned(value.points->position, value.points->offset);
  if (value.models) {
    addOwned(value.models->centre, value.models->offset);
    data.add(value.models->width);
  }
  return data;
}

void reportSizes(const Case& value) {
  const auto nodes = static_cast<double>(value.tree.nodeCount());
  const PolyData poly = polyData(value);
  const auto perNode = [nodes](std::size_t bytes) { return static_cast<double>(bytes) / nodes; };
  std::printf(
      "  bytes per node: lumen %.0f, zstd %.0f, zstd + 14-bit points %.0f, JSON %.0f, "
      "VTP raw %.0f, VTP zlib %.0f\n",
      perNode(encodeBinary(value).size()), perNode(encodeBinary(value, {true, 0}).size()),
      perNode(encodeBinary(value, {true, 14}).size()), perNode(encodeJson(value).size()),
      perNode(poly.raw), perNode(poly.compressed));
}

void report(const std::string& name, const Case& value, const fs::path& folder) {
  const fs::path binary = folder / "case.lumen", json = folder / "case.lumen.json";
  if (!writeCaseFile(value, binary) || !writeCaseFile(value, json)) std::abort();
  std::fflush(stdout);
  std::printf("%s: %zu nodes, %zu points, %zu blobs, %.2f MB\n", name.c_str(),
              value.tree.nodeCount(), value.points ? value.points->position.size() : 0,
              value.models ? value.models->width.size() : 0,
              static_cast<double>(fs::file_size(binary)) / 1e6);
  const OpenCost cold = openMapped(binary, true);
  OpenCost warm = openMapped(binary, false);
  for (int i = 0; i < 20; ++i)
    if (const OpenCost next = openMapped(binary, false); next.milliseconds < warm.milliseconds)
      warm = next;
  std::printf("  open, file in the page cache: %.3f ms, %ld page faults\n", warm.milliseconds,
              warm.faults);
  std::printf("  open, file not in memory:     %.3f ms, %zu of %zu pages read (mincore)\n",
              cold.milliseconds, cold.pages, cold.filePages);
  const ReadCost full = readInChild(binary);
  std::printf("  full read with every check:   %.1f ms, %.1f MB resident\n", full.milliseconds,
              static_cast<double>(full.kilobytes) / 1e3);
  const ReadCost text = readInChild(json);
  std::printf("  full read of JSON:            %.1f ms, %.1f MB resident\n", text.milliseconds,
              static_cast<double>(text.kilobytes) / 1e3);
  reportSizes(value);
}

int run(int argc, char** argv) {
  if (argc == 3 && std::string(argv[1]) == "--read") return readAndTell(argv[2]);
  std::string pattern = (fs::temp_directory_path() / "lumen-open-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) return 1;
  const fs::path folder = pattern;
  for (const std::size_t nodes : {10000u, 100000u})
    report("synthetic", test::longCase(nodes, 20, 6), folder);
  for (int i = 1; i < argc; ++i)
    if (const auto value = readCaseFile(argv[i])) report(argv[i], *value, folder);
  fs::remove_all(folder);
  return 0;
}

}  // namespace
}  // namespace lumen::formats

int main(int argc, char** argv) {
  return lumen::formats::run(argc, argv);
}
