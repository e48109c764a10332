// SPDX-License-Identifier: Apache-2.0
#include "driver.h"

#include <dlfcn.h>

namespace lumen::blob::cuda {
namespace {

constexpr char kLibrary[] = "libcuda.so.1";

template <class F>
bool find(void* library, const char* name, F& function, std::string& reason) {
  function = reinterpret_cast<F>(dlsym(library, name));
  if (function == nullptr) reason = std::string(kLibrary) + " has no function " + name;
  return function != nullptr;
}

}  // namespace

bool load(Driver& d, std::string& reason) {
  // never unloaded: other parts of the program may hold its contexts
  void* const library = dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (library == nullptr) {
    const char* const text = dlerror();
    reason = text != nullptr ? text : kLibrary;
    return false;
  }
  const auto get = [&](const char* name, auto& function) {
    return find(library, name, function, reason);
  };
  const bool complete =
      get("cuInit", d.init) && get("cuGetErrorString", d.errorString) &&
      get("cuDeviceGetCount", d.deviceCount) && get("cuDeviceGet", d.deviceGet) &&
      get("cuDevicePrimaryCtxRetain", d.primaryRetain) &&
      get("cuDevicePrimaryCtxRelease_v2", d.primaryRelease) &&
      get("cuCtxGetCurrent", d.contextCurrent) && get("cuCtxPushCurrent_v2", d.contextPush) &&
      get("cuCtxPopCurrent_v2", d.contextPop) && get("cuModuleLoadDataEx", d.moduleLoad) &&
      get("cuModuleUnload", d.moduleUnload) && get("cuModuleGetFunction", d.moduleFunction) &&
      get("cuMemAlloc_v2", d.allocate) && get("cuMemFree_v2", d.release) &&
      get("cuMemcpyHtoD_v2", d.copyToDevice) && get("cuStreamSynchronize", d.streamSynchronize) &&
      get("cuLaunchKernel", d.launch);
  dlclose(library);
  return complete;
}

}  // namespace lumen::blob::cuda
