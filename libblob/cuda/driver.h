// SPDX-License-Identifier: Apache-2.0
// The functions of NVIDIA's driver that blob_cuda uses, declared as its interface documents them
// (NVIDIA, CUDA driver API, 2023), and loaded at run time.
#pragma once

#include <cstddef>
#include <string>

namespace lumen::blob::cuda {

using Result = int;  // CUresult; 0 is success
using Device = int;
using Context = struct ContextOfDriver*;
using Module = struct ModuleOfDriver*;
using Function = struct FunctionOfDriver*;
using Stream = struct CUstream_st*;
using Address = unsigned long long;  // CUdeviceptr of 64-bit systems

constexpr Result kSuccess = 0;
// CUjit_option
constexpr int kErrorLog = 5, kErrorLogBytes = 6;

struct Driver {
  Result (*init)(unsigned flags) = nullptr;
  Result (*errorString)(Result, const char** text) = nullptr;
  Result (*deviceCount)(int* count) = nullptr;
  Result (*deviceGet)(Device*, int ordinal) = nullptr;
  Result (*primaryRetain)(Context*, Device) = nullptr;
  Result (*primaryRelease)(Device) = nullptr;
  Result (*contextCurrent)(Context*) = nullptr;
  Result (*contextPush)(Context) = nullptr;
  Result (*contextPop)(Context*) = nullptr;
  Result (*moduleLoad)(Module*, const void* image, unsigned options, int* names,
                       void** values) = nullptr;
  Result (*moduleUnload)(Module) = nullptr;
  Result (*moduleFunction)(Function*, Module, const char* name) = nullptr;
  Result (*allocate)(Address*, std::size_t bytes) = nullptr;
  Result (*release)(Address) = nullptr;
  Result (*copyToDevice)(Address, const void* from, std::size_t bytes) = nullptr;
  Result (*streamSynchronize)(Stream) = nullptr;
  Result (*launch)(Function, unsigned gridX, unsigned gridY, unsigned gridZ, unsigned blockX,
                   unsigned blockY, unsigned blockZ, unsigned sharedBytes, Stream, void** arguments,
                   void** extra) = nullptr;
};

/// Loads the driver of this process; it stays loaded. Returns whether it has all functions; if not,
/// `reason` states what is missing.
bool load(Driver& driver, std::string& reason);

}  // namespace lumen::blob::cuda
