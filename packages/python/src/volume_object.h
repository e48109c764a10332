// SPDX-License-Identifier: Apache-2.0
// Volumes between NumPy and the engine: an array with its place as a file of NRRD whose voxels are
// the array's own memory, and a volume that was read as an array.
#pragma once

#include <string>
#include <string_view>

#include <pybind11/pybind11.h>

#include "converters/io/volume/write_volume.h"

namespace lumen::python {

/// An array as Volume._parts() of lumen/_inputs.py gives it. Its memory is that of Python's tuple.
struct GivenVolume {
  explicit GivenVolume(const pybind11::tuple& parts);

  std::string type;            ///< NRRD's name
  convert::NrrdVoxels voxels;  ///< points to `type`
  std::string_view bytes;      ///< little-endian, x fastest
  GivenVolume(const GivenVolume&) = delete;
  GivenVolume& operator=(const GivenVolume&) = delete;
};

/// Adds `read_volume`, `write_volume` and the class Voxels.
void addVolumes(pybind11::module_& module);

}  // namespace lumen::python
