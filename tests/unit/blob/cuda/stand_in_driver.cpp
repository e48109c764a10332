// SPDX-License-Identifier: Apache-2.0
#include "stand_in_driver.h"

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <regex>
#include <set>

#include "fibers.h"

// the code of a device, but for its loads of 16 bytes
#define BLOB_DEVICE_SIMT 1
#define BLOB_DEVICE_KERNEL(blocks) extern "C" void
#define BLOB_DEVICE_SHARED static
#define BLOB_DEVICE_THREAD lumen::blob::test::threadIndex()
#define BLOB_DEVICE_NEXT(counter) ((*(counter))++)
#define BLOB_DEVICE_OF_FIRST(x) lumen::blob::test::ofFirstThread(x)
#define BLOB_DEVICE_SYNC() lumen::blob::test::syncBlock()
#include "libblob/device/query.cu"

namespace {

constexpr int kNotInitialized = 3, kInvalidValue = 1, kInvalidDevice = 101, kInvalidImage = 200,
              kInvalidContext = 201, kInvalidHandle = 400, kNotFound = 500;

// A kernel of the PTX, with the bytes of its parameters.
struct Kernel {
  std::string name;
  std::vector<int> parameters;
};
struct LoadedModule {
  std::map<std::string, Kernel> kernels;
};
struct StandInContext {
  bool isPrimary;
};

struct State {
  int devices = 1, retained = 0;
  bool isInitialized = false;
  std::vector<std::string> calls;
  std::map<std::string, int> faults;
  std::set<void*> memory;
  std::set<LoadedModule*> modules;
  std::vector<StandInContext*> stack;
  StandInContext primary{true}, own{false};
  CUstream_st defaultStream;
  std::vector<lumen::blob::test::stand_in::Launch> launched;
} g;

// Notes a call. Returns 0, or the fault that a test has set for this function.
int called(const char* name) {
  g.calls.emplace_back(name);
  const auto fault = g.faults.find(name);
  return fault != g.faults.end() ? fault->second : 0;
}

int calledInContext(const char* name) {
  const int result = called(name);
  if (result != 0) return result;
  if (!g.isInitialized) return kNotInitialized;
  return g.stack.empty() ? kInvalidContext : 0;
}

// The entries of a text of PTX.
std::map<std::string, Kernel> kernelsOf(const std::string& ptx) {
  std::map<std::string, Kernel> kernels;
  const std::regex entry("\\.visible \\.entry (\\w+)\\(([^)]*)\\)"), width("\\.param \\.u(\\d+)");
  for (std::sregex_iterator it(ptx.begin(), ptx.end(), entry), end; it != end; ++it) {
    Kernel kernel{(*it)[1], {}};
    const std::string parameters = (*it)[2];
    for (std::sregex_iterator p(parameters.begin(), parameters.end(), width); p != end; ++p)
      kernel.parameters.push_back(std::stoi((*p)[1]) / 8);
    kernels[kernel.name] = kernel;
  }
  return kernels;
}

// Copies an argument of a kernel; its size must be that of the parameter in the PTX.
template <class T>
T argument(const Kernel& kernel, void** arguments, std::size_t index) {
  T value{};
  if (kernel.parameters.at(index) != static_cast<int>(sizeof value)) std::abort();
  std::memcpy(&value, arguments[index], sizeof value);
  return value;
}

std::function<void()> bound(const Kernel& k, void** a, unsigned blocks, unsigned block) {
  const auto words = argument<const std::uint32_t*>(k, a, 0);
  const auto vessel = argument<std::uint32_t>(k, a, 1), flags = argument<std::uint32_t>(k, a, 2);
  const auto count = argument<std::uint32_t>(k, a, 3);
  const auto point = argument<const float*>(k, a, 4);
  const auto cursor = argument<std::uint32_t*>(k, a, 5);
  const auto answer = argument<float*>(k, a, 6), value = argument<float*>(k, a, 7);
  const auto state = argument<std::uint32_t*>(k, a, 8);
  const auto ofPoint = argument<const std::uint32_t*>(k, a, 9);
  const auto span = k.parameters.size() > 10 ? argument<std::uint32_t>(k, a, 10) : 0;
  const std::string name = k.name;
  const std::function<void()> kernel = [=] {
    const auto ofColumns = [&](auto function) {
      function(words, vessel, flags, count, point, cursor, answer, value, state, ofPoint);
    };
    const auto ofSpans = [&](auto function) {
      function(words, vessel, flags, count, point, cursor, answer, value, state, ofPoint, span);
    };
    if (name == "blob_query_points")
      ofColumns(blob_query_points);
    else if (name == "blob_query_points_cauchy")
      ofColumns(blob_query_points_cauchy);
    else if (name == "blob_query_exact_points")
      ofColumns(blob_query_exact_points);
    else if (name == "blob_blend_pairs")
      ofSpans(blob_blend_pairs);
    else if (name == "blob_blend_pairs_cauchy")
      ofSpans(blob_blend_pairs_cauchy);
    else if (name == "blob_blend_crowds")
      ofSpans(blob_blend_crowds);
    else if (name == "blob_blend_crowds_cauchy")
      ofSpans(blob_blend_crowds_cauchy);
    else
      std::abort();
  };
  return [=] {
    lumen::blob::test::runBlocks(blocks, block, kernel);
    g.launched.push_back({name, std::size_t{blocks} * block});
  };
}

}  // namespace

extern "C" {

int cuInit(unsigned flags) {
  if (const int result = called("cuInit")) return result;
  if (flags != 0) return kInvalidValue;
  g.isInitialized = true;
  return 0;
}

int cuGetErrorString(int result, const char** text) {
  if (const int fault = called("cuGetErrorString")) return fault;
  *text = result == 2 ? "out of memory" : "a fault of the stand-in";
  return 0;
}

int cuDeviceGetCount(int* count) {
  if (const int result = called("cuDeviceGetCount")) return result;
  *count = g.devices;
  return g.isInitialized ? 0 : kNotInitialized;
}

int cuDeviceGet(int* device, int ordinal) {
  if (const int result = called("cuDeviceGet")) return result;
  *device = ordinal + 10;  // a handle is no ordinal
  return ordinal >= 0 && ordinal < g.devices ? 0 : kInvalidDevice;
}

int cuDevicePrimaryCtxRetain(StandInContext** context, int device) {
  if (const int result = called("cuDevicePrimaryCtxRetain")) return result;
  if (device < 10 || device >= 10 + g.devices) return kInvalidDevice;
  ++g.retained;
  *context = &g.primary;
  return 0;
}

int cuDevicePrimaryCtxRelease_v2(int device) {
  if (const int result = called("cuDevicePrimaryCtxRelease_v2")) return result;
  if (device < 10 || device >= 10 + g.devices || g.retained == 0) return kInvalidDevice;
  --g.retained;
  return 0;
}

int cuCtxGetCurrent(StandInContext** context) {
  if (const int result = called("cuCtxGetCurrent")) return result;
  *context = g.stack.empty() ? nullptr : g.stack.back();
  return g.isInitialized ? 0 : kNotInitialized;
}

int cuCtxPushCurrent_v2(StandInContext* context) {
  if (const int result = called("cuCtxPushCurrent_v2")) return result;
  if (context != &g.primary && context != &g.own) return kInvalidContext;
  g.stack.push_back(context);
  return 0;
}

int cuCtxPopCurrent_v2(StandInContext** context) {
  if (const int result = calledInContext("cuCtxPopCurrent_v2")) return result;
  *context = g.stack.back();
  g.stack.pop_back();
  return 0;
}

int cuModuleLoadDataEx(LoadedModule** module, const void* image, unsigned options, int* names,
                       void** values) {
  if (const int result = calledInContext("cuModuleLoadDataEx")) {
    for (unsigned i = 0; i + 1 < options; ++i)
      if (names[i] == 5 && names[i + 1] == 6 &&
          reinterpret_cast<std::uintptr_t>(values[i + 1]) > 40)
        std::strcpy(static_cast<char*>(values[i]), "ptxas of the stand-in is not content");
    return result;
  }
  const std::string text = static_cast<const char*>(image);
  if (text.find(".version") == std::string::npos || text.find(".target sm_70") == std::string::npos)
    return kInvalidImage;
  *module = new LoadedModule{kernelsOf(text)};
  g.modules.insert(*module);
  return 0;
}

int cuModuleUnload(LoadedModule* module) {
  if (const int result = calledInContext("cuModuleUnload")) return result;
  if (g.modules.erase(module) == 0) return kInvalidHandle;
  delete module;
  return 0;
}

int cuModuleGetFunction(Kernel** function, LoadedModule* module, const char* name) {
  if (const int result = calledInContext("cuModuleGetFunction")) return result;
  const auto found = module->kernels.find(name);
  if (found == module->kernels.end()) return kNotFound;
  *function = &found->second;
  return 0;
}

int cuMemAlloc_v2(unsigned long long* address, std::size_t bytes) {
  if (const int result = calledInContext("cuMemAlloc_v2")) return result;
  void* const memory = std::aligned_alloc(256, (bytes + 255) / 256 * 256);
  g.memory.insert(memory);
  *address = reinterpret_cast<std::uintptr_t>(memory);
  return 0;
}

int cuMemFree_v2(unsigned long long address) {
  if (const int result = calledInContext("cuMemFree_v2")) return result;
  void* const memory = reinterpret_cast<void*>(static_cast<std::uintptr_t>(address));
  if (g.memory.erase(memory) == 0) return kInvalidValue;
  std::free(memory);
  return 0;
}

int cuMemcpyHtoD_v2(unsigned long long to, const void* from, std::size_t bytes) {
  if (const int result = calledInContext("cuMemcpyHtoD_v2")) return result;
  void* const memory = reinterpret_cast<void*>(static_cast<std::uintptr_t>(to));
  if (g.memory.count(memory) == 0) return kInvalidValue;
  std::memcpy(memory, from, bytes);
  return 0;
}

int cuLaunchKernel(Kernel* kernel, unsigned gridX, unsigned gridY, unsigned gridZ, unsigned blockX,
                   unsigned blockY, unsigned blockZ, unsigned sharedBytes, CUstream_st* stream,
                   void** arguments, void** extra) {
  if (const int result = calledInContext("cuLaunchKernel")) return result;
  if (gridX == 0 || gridY != 1 || gridZ != 1 || blockX == 0 || blockX > 1024 || blockY != 1 ||
      blockZ != 1 || sharedBytes != 0 || extra != nullptr)
    return kInvalidValue;
  CUstream_st& queue = stream == nullptr ? g.defaultStream : *stream;
  queue.launches.push_back(bound(*kernel, arguments, gridX, blockX));
  return 0;
}

int cuStreamCreate(CUstream_st** stream, unsigned flags) {
  if (const int result = calledInContext("cuStreamCreate")) return result;
  if (flags > 1) return kInvalidValue;
  *stream = new CUstream_st;
  return 0;
}

int cuStreamDestroy_v2(CUstream_st* stream) {
  if (const int result = calledInContext("cuStreamDestroy_v2")) return result;
  delete stream;
  return 0;
}

int cuStreamSynchronize(CUstream_st* stream) {
  if (const int result = calledInContext("cuStreamSynchronize")) return result;
  lumen::blob::test::stand_in::run(stream);
  return 0;
}

}  // extern "C"

namespace lumen::blob::test::stand_in {

void reset(int devices) {
  for (void* memory : g.memory) std::free(memory);
  for (LoadedModule* module : g.modules) delete module;
  g.memory.clear();
  g.modules.clear();
  g.calls.clear();
  g.faults.clear();
  g.stack.clear();
  g.launched.clear();
  g.defaultStream.launches.clear();
  g.devices = devices;
  g.retained = 0;
  g.isInitialized = false;
}

void failAt(const std::string& function, int result) {
  g.faults[function] = result;
}

std::vector<std::string> takeCalls() {
  std::vector<std::string> calls;
  calls.swap(g.calls);
  return calls;
}

void run(CUstream_st* stream) {
  CUstream_st& queue = stream == nullptr ? g.defaultStream : *stream;
  for (; !queue.launches.empty(); queue.launches.pop_front()) queue.launches.front()();
}

std::size_t waiting(CUstream_st* stream) {
  return (stream == nullptr ? g.defaultStream : *stream).launches.size();
}

std::size_t held() {
  return g.memory.size() + g.modules.size() + static_cast<std::size_t>(g.retained);
}

std::size_t entered() {
  return g.stack.size();
}

void enterOwnContext() {
  g.stack.push_back(&g.own);
}

std::vector<Launch> takeLaunches() {
  std::vector<Launch> launches;
  launches.swap(g.launched);
  return launches;
}

}  // namespace lumen::blob::test::stand_in
