// SPDX-License-Identifier: Apache-2.0
// Ways to answer where the wall is on a graphics processor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "device.h"
#include "method.h"

namespace lumen::bench {

/// A method whose points and answers stay on the device; Method's query() copies them to and fro.
class DeviceMethod : public Method {
public:
  void place(const Start& start) override;
  void query(std::size_t first, const double* points, std::size_t count,
             const Answers& answers) override;

  /// Puts a step of the first `count` points, three floats each on the device, on the device's
  /// stream.
  virtual void step(const float* points, std::size_t count) = 0;

protected:
  /// Distance and normal, four floats of each point.
  [[nodiscard]] float* answer() const { return m_answer.data(); }

private:
  cuda_device::Column<float> m_point, m_answer;
};

using DeviceMethods = std::vector<std::unique_ptr<DeviceMethod>>;

/// libblob with such flags; the nearest point of the mesh from infinity and `coherent`, no farther
/// than the last step's distance and the way since; a texture of distances.
std::unique_ptr<DeviceMethod> cudaBlob(std::string name, std::uint32_t flags);
std::unique_ptr<DeviceMethod> cudaMesh(bool coherent);
std::unique_ptr<DeviceMethod> cudaGrid();

}  // namespace lumen::bench
