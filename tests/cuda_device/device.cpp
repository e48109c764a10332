// SPDX-License-Identifier: Apache-2.0
#include "device.h"

#include <dlfcn.h>

namespace lumen::cuda_device {
namespace {

using Result = int;  // CUresult; 0 is success

// CUDA_ARRAY3D_DESCRIPTOR, CUDA_MEMCPY3D, CUDA_RESOURCE_DESC and CUDA_TEXTURE_DESC of the driver.
struct ArrayDescription {
  std::size_t width, height, depth;
  int format;
  unsigned channels, flags;
};
struct CopySide {
  std::size_t x, y, z, level;
  int kind;
  const void* host;
  Address device;
  void *array, *reserved;
  std::size_t pitch, height;
};
struct Copy3d {
  CopySide from, to;
  std::size_t widthInBytes, height, depth;
};
struct Resource {
  int kind;
  void* array;
  char rest[120];
  unsigned flags;
};
struct TextureDescription {
  int address[3], filter;
  unsigned flags, anisotropy;
  int levelFilter;
  float levelBias, least, most, border[4];
  int reserved[12];
};
static_assert(sizeof(ArrayDescription) == 40 && sizeof(Copy3d) == 200 && sizeof(Resource) == 144 &&
              sizeof(TextureDescription) == 104);
constexpr int kFloat = 0x20, kHost = 1, kArray = 3, kClamp = 1, kLinear = 1;

void* library() {
  static void* const handle = dlopen("libcuda.so.1", RTLD_NOW | RTLD_NODELETE);
  if (handle == nullptr) throw NoDevice("no NVIDIA driver (libcuda.so.1)");
  return handle;
}

// A function of the driver.
template <class... Argument>
Result call(const char* name, Argument... argument) {
  void* const function = dlsym(library(), name);
  if (function == nullptr) throw NoDevice(std::string("libcuda.so.1 has no function ") + name);
  return reinterpret_cast<Result (*)(Argument...)>(function)(argument...);
}

template <class... Argument>
void require(const char* name, Argument... argument) {
  const Result result = call(name, argument...);
  if (result == 0) return;
  const char* text = nullptr;
  if (call("cuGetErrorString", result, &text) != 0 || text == nullptr) text = "unknown error";
  throw std::runtime_error(std::string(name) + ": " + text);
}

}  // namespace

Device& Device::get() {
  static Device device;
  return device;
}

Device::Device() {
  int number = 0;
  if (call("cuInit", 0U) != 0 || call("cuDeviceGet", &number, 0) != 0)
    throw NoDevice("no NVIDIA device");
  void* context = nullptr;
  require("cuDevicePrimaryCtxRetain", &context, number);
  require("cuCtxSetCurrent", context);
  require("cuStreamCreate", &m_stream, 0U);
  require("cuEventCreate", &m_begin, 0U);
  require("cuEventCreate", &m_end, 0U);
}

std::string Device::name() const {
  char text[256] = "";
  require("cuDeviceGetName", static_cast<char*>(text), static_cast<int>(sizeof text), 0);
  return text;
}

void Device::wait() {
  require("cuStreamSynchronize", m_stream);
}

void Device::begin() {
  require("cuEventRecord", m_begin, m_stream);
}

double Device::end() {
  require("cuEventRecord", m_end, m_stream);
  require("cuEventSynchronize", m_end);
  float milliseconds = 0;
  require("cuEventElapsedTime", &milliseconds, m_begin, m_end);
  return 1e-3 * static_cast<double>(milliseconds);
}

Address Device::allocate(std::size_t bytes) {
  Address memory = 0;
  if (bytes > 0) require("cuMemAlloc_v2", &memory, bytes);
  return memory;
}

void Device::release(Address memory) noexcept {
  call("cuMemFree_v2", memory);
}

void Device::upload(Address to, const void* from, std::size_t bytes) {
  wait();
  if (bytes > 0) require("cuMemcpyHtoD_v2", to, from, bytes);
}

void Device::download(void* to, Address from, std::size_t bytes) {
  wait();
  if (bytes > 0) require("cuMemcpyDtoH_v2", to, from, bytes);
}

Kernels::Kernels(const char* ptx) {
  Device::get();
  require("cuModuleLoadData", &m_module, static_cast<const void*>(ptx));
}

void Kernels::launchArguments(const char* name, std::size_t count, unsigned block,
                              void** arguments) const {
  void* function = nullptr;
  require("cuModuleGetFunction", &function, m_module, name);
  const auto blocks = static_cast<unsigned>((count + block - 1) / block);
  require("cuLaunchKernel", function, blocks, 1U, 1U, block, 1U, 1U, 0U, Device::get().stream(),
          arguments, static_cast<void**>(nullptr));
}

Texture::Texture(const std::array<std::size_t, 3>& size, const float* values) {
  Device::get().wait();
  const ArrayDescription description{size[0], size[1], size[2], kFloat, 1, 0};
  require("cuArray3DCreate_v2", &m_array, &description);
  Copy3d copy{};
  copy.from.kind = kHost;
  copy.from.host = values;
  copy.from.pitch = size[0] * sizeof(float);
  copy.from.height = size[1];
  copy.to.kind = kArray;
  copy.to.array = m_array;
  copy.widthInBytes = size[0] * sizeof(float);
  copy.height = size[1];
  copy.depth = size[2];
  require("cuMemcpy3D_v2", static_cast<const Copy3d*>(&copy));
  Resource resource{};
  resource.array = m_array;
  TextureDescription texture{};
  for (int& axis : texture.address) axis = kClamp;
  texture.filter = kLinear;
  require("cuTexObjectCreate", &m_handle, static_cast<const Resource*>(&resource),
          static_cast<const TextureDescription*>(&texture), static_cast<const void*>(nullptr));
}

Texture::~Texture() {
  call("cuTexObjectDestroy", m_handle);
  call("cuArrayDestroy", m_array);
}

}  // namespace lumen::cuda_device
