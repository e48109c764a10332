// SPDX-License-Identifier: Apache-2.0
#include "packages/python/src/volume_object.h"

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "converters/engine/command.h"
#include "converters/engine/file_access.h"
#include "converters/engine/tracking_input.h"
#include "packages/python/src/engine_calls.h"
#include "packages/python/src/made_by_init.h"
#include "packages/python/src/python_error.h"
#include "packages/python/src/watched_work.h"

namespace py = pybind11;

namespace lumen::python {

namespace {

using convert::Volume;

/// (3,) numbers as a tuple.
py::tuple tupleOf(const Eigen::Vector3d& v) {
  return py::make_tuple(v[0], v[1], v[2]);
}

/// The voxels as an array [k, j, i] that points into the volume.
py::array voxelsOf(const py::object& self) {
  const Volume& volume = self.cast<const Volume&>();
  const auto& size = volume.geometry.size;
  return std::visit(
      [&](const auto& voxels) -> py::array {
        using Number = typename std::decay_t<decltype(voxels)>::value_type;
        return py::array_t<Number>({size[2], size[1], size[0]}, voxels.data(), self);
      },
      volume.voxels);
}

/// The volume in a file, or in `bytes` under the name of one, and warnings.
std::pair<std::shared_ptr<Volume>, std::vector<std::string>> readVolume(
    const std::string& name, const std::optional<py::bytes>& bytes, const Options& options,
    const py::object& report) {
  const InputFile file =
      bytes ? InputFile(name, static_cast<std::string_view>(*bytes)) : InputFile(name);
  auto volume = std::make_shared<Volume>();
  const Messages messages = runWatched({report}, [&](Progress& progress) {
    OptionTable table;
    engine::VolumeArguments arguments;
    engine::addVolumeRows(table, arguments);
    engine::setRows(table, {"", {}, options});
    if (!file.isInMemory() && isAddress(name))
      throw invalidInput(std::string("volume: ") + kAddressFault);
    const engine::FileFormat& format = engine::inputFormat(file, "");
    if (format.readVolume == nullptr) throw unsupported(name + ": this is not a volume");
    *volume = engine::readVolumeFile(file, format, arguments, progress);
  });
  return {volume, messages.warnings};
}

template <class Number>
std::vector<Number> copied(std::string_view bytes) {
  const auto* const first = reinterpret_cast<const Number*>(bytes.data());
  return {first, first + bytes.size() / sizeof(Number)};
}

/// The volume of an array of one of the engine's own types.
Volume volumeOf(const GivenVolume& given) {
  Volume volume{given.voxels.geometry, {}};
  if (given.type == "unsigned char")
    volume.voxels = copied<std::uint8_t>(given.bytes);
  else if (given.type == "short")
    volume.voxels = copied<std::int16_t>(given.bytes);
  else if (given.type == "unsigned short")
    volume.voxels = copied<std::uint16_t>(given.bytes);
  else
    volume.voxels = copied<float>(given.bytes);
  return volume;
}

/// NRRD of any type, other formats of the engine's own types.
void writeVolume(const std::string& file, const py::tuple& parts) {
  const GivenVolume given(parts);
  runWatched({}, [&](Progress& progress) {
    const engine::FileFormat& format = engine::volumeOutputFormat(file, "a volume");
    const std::string bytes = format.name == "nrrd"
                                  ? convert::encodeNrrd(given.voxels, given.bytes, true)
                                  : format.encodeVolume(volumeOf(given), file);
    progress.check();
    engine::writeText(bytes, file);
  });
}

}  // namespace

GivenVolume::GivenVolume(const py::tuple& parts) : type(parts[1].cast<std::string>()) {
  const auto array = parts[0].cast<py::array>();
  const auto spacing = parts[2].cast<std::array<double, 3>>();
  const auto origin = parts[3].cast<std::array<double, 3>>();
  const auto direction = parts[4].cast<std::array<double, 9>>();
  convert::VolumeGeometry& geometry = voxels.geometry;
  for (int a = 0; a < 3; ++a) {
    const py::ssize_t size = array.shape(2 - a);
    if (size > std::numeric_limits<int>::max())
      throw py::value_error("array: an axis has more than 2147483647 voxels");
    geometry.size[static_cast<std::size_t>(a)] = static_cast<int>(size);
  }
  geometry.spacing = Eigen::Vector3d(spacing.data());
  geometry.origin = Eigen::Vector3d(origin.data());
  geometry.direction = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>(direction.data());
  voxels.type = type;
  // the engine warns of a space that does not state left and right, and of a unit that is no length
  if (!parts[5].cast<bool>()) voxels.space = "scanner-xyz";
  voxels.unit = parts[6].cast<bool>() ? "mm" : "?";
  bytes = {static_cast<const char*>(array.data()), static_cast<std::size_t>(array.nbytes())};
}

void addVolumes(py::module_& module) {
  module.def("read_volume", &readVolume);
  module.def("write_volume", &writeVolume);
  py::class_<Volume, std::shared_ptr<Volume>> type(module, "Voxels");
  forbidNew(type);
  type.def_property_readonly("array", &voxelsOf)
      .def_property_readonly("spacing",
                             [](const Volume& self) { return tupleOf(self.geometry.spacing); })
      .def_property_readonly("origin",
                             [](const Volume& self) { return tupleOf(self.geometry.origin); })
      .def_property_readonly("direction", [](const Volume& self) {
        const Eigen::Matrix3d rows = self.geometry.direction.transpose();
        return py::make_tuple(tupleOf(rows.col(0)), tupleOf(rows.col(1)), tupleOf(rows.col(2)));
      });
}

}  // namespace lumen::python
