// SPDX-License-Identifier: Apache-2.0
// One NVIDIA device as tests and benchmarks use it: memory, kernels and time, by the functions of
// its driver (NVIDIA, CUDA driver API, 2023), which is loaded at run time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

struct CUstream_st;

namespace lumen::cuda_device {

/// There is no driver or no device.
struct NoDevice : std::runtime_error {
  using std::runtime_error::runtime_error;
};

using Address = unsigned long long;

/// Device 0 with its primary context, current on the calling thread, and one stream. There is one
/// for a process, and it stays. Its functions throw std::runtime_error with the driver's reason.
class Device {
public:
  /// Throws NoDevice.
  static Device& get();

  [[nodiscard]] std::string name() const;
  [[nodiscard]] CUstream_st* stream() const { return m_stream; }
  void wait();

  /// Seconds on the device of what `work` puts on the stream.
  template <class Work>
  double seconds(Work&& work) {
    begin();
    work();
    return end();
  }

  Address allocate(std::size_t bytes);
  void release(Address memory) noexcept;
  void upload(Address to, const void* from, std::size_t bytes);
  void download(void* to, Address from, std::size_t bytes);

private:
  Device();
  void begin();
  double end();
  CUstream_st* m_stream = nullptr;
  void *m_begin = nullptr, *m_end = nullptr;  // events
};

/// Values of one type in the memory of the device.
template <class T>
class Column {
public:
  Column() = default;
  /// Uninitialised.
  explicit Column(std::size_t count)
      : m_count(count), m_address(Device::get().allocate(count * sizeof(T))) {}
  explicit Column(const std::vector<T>& values) : Column(values.size()) { set(values.data()); }
  Column(const Column&) = delete;
  Column& operator=(const Column&) = delete;
  Column(Column&& other) noexcept { swap(other); }
  Column& operator=(Column&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Column() {
    if (m_address != 0) Device::get().release(m_address);
  }

  [[nodiscard]] std::size_t count() const { return m_count; }
  [[nodiscard]] std::size_t bytes() const { return m_count * sizeof(T); }
  [[nodiscard]] T* data() const {
    return reinterpret_cast<T*>(static_cast<std::uintptr_t>(m_address));
  }
  void set(const T* values) { Device::get().upload(m_address, values, bytes()); }
  void get(T* values) const { Device::get().download(values, m_address, bytes()); }
  [[nodiscard]] std::vector<T> values() const {
    std::vector<T> all(m_count);
    get(all.data());
    return all;
  }

private:
  void swap(Column& other) noexcept {
    std::swap(m_count, other.m_count);
    std::swap(m_address, other.m_address);
  }
  std::size_t m_count = 0;
  Address m_address = 0;
};

/// Kernels of one text of PTX. They stay loaded.
class Kernels {
public:
  explicit Kernels(const char* ptx);
  /// Puts a kernel on the stream: `count` threads in blocks of `block`; arguments are copied.
  template <class... Argument>
  void launch(const char* name, std::size_t count, unsigned block, Argument... argument) const {
    void* arguments[] = {&argument...};
    launchArguments(name, count, block, arguments);
  }

private:
  void launchArguments(const char* name, std::size_t count, unsigned block, void** arguments) const;
  void* m_module = nullptr;
};

/// A grid of floats that the device interpolates trilinearly: value (i, j, k) is at texture
/// coordinates (i + .5, j + .5, k + .5), and coordinates beyond the edge are those at the edge.
class Texture {
public:
  Texture(const std::array<std::size_t, 3>& size, const float* values);
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;
  ~Texture();
  [[nodiscard]] std::uint64_t handle() const { return m_handle; }

private:
  void* m_array = nullptr;
  std::uint64_t m_handle = 0;
};

}  // namespace lumen::cuda_device
