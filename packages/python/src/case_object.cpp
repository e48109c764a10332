// SPDX-License-Identifier: Apache-2.0
#include "packages/python/src/case_object.h"

#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "converters/engine/file_access.h"
#include "formats/case/case_file.h"
#include "formats/case/enum_names.h"
#include "formats/case/metadata_json.h"
#include "formats/case/vessel_system.h"
#include "formats/container/printable.h"
#include "packages/python/src/array_views.h"
#include "packages/python/src/python_error.h"

namespace py = pybind11;

namespace lumen::python {

template <>
struct Row<formats::Vec3f> {
  using Number = float;
  static constexpr py::ssize_t columns = 3;
};

namespace {

using formats::Case;
namespace fs = std::filesystem;

/// A view of the numbers of `data`, which `self`, a CaseObject, holds.
template <class Element>
py::array viewOf(const py::object& self, const std::vector<Element>& data,
                 py::ssize_t columns = Row<Element>::columns) {
  const bool isWritable = self.cast<const CaseObject&>().isWritable;
  return viewAs<typename Row<Element>::Number>(self, data, isWritable, columns);
}

const Case& caseOf(const py::object& self) {
  return self.cast<const CaseObject&>().value;
}

/// Adds an array of the tree as a property.
template <class Element>
void addArray(py::class_<CaseObject, SharedCase>& type, const char* name,
              std::vector<Element> formats::CenterlineTree::*member) {
  type.def_property_readonly(
      name, [member](const py::object& self) { return viewOf(self, caseOf(self).tree.*member); });
}

/// Adds an array of an optional part of the case, None without the part.
template <class Part, class Element>
void addArray(py::class_<CaseObject, SharedCase>& type, const char* name,
              std::optional<Part> Case::*part, std::vector<Element> Part::*member) {
  type.def_property_readonly(name, [part, member](const py::object& self) -> py::object {
    const std::optional<Part>& found = caseOf(self).*part;
    if (!found) return py::none();
    return viewOf(self, (*found).*member);
  });
}

void addTree(py::class_<CaseObject, SharedCase>& type) {
  using Tree = formats::CenterlineTree;
  addArray(type, "centre", &Tree::centre);
  addArray(type, "direction", &Tree::direction);
  addArray(type, "radius", &Tree::radius);
  addArray(type, "height", &Tree::height);
  addArray(type, "parent", &Tree::parent);
  addArray(type, "branch", &Tree::branch);
  addArray(type, "inlier_rate", &Tree::inlierRate);
  addArray(type, "links", &Tree::links);
  type.def_property_readonly("branches", [](const CaseObject& self) {
    py::list branches;
    const std::vector<formats::VesselSystem> systems = formats::readBranchSystems(self.value);
    for (const formats::Branch& b : self.value.tree.branches)
      branches.append(py::make_tuple(
          b.label, formats::enumName(formats::kBranchKindNames, b.kind), b.parentNode, b.firstNode,
          b.nodeCount, formats::enumName(formats::kStopReasonNames, b.stopReason), b.meanInlierRate,
          formats::enumName(formats::kVesselSystemNames, systems[py::len(branches)])));
    return branches;
  });
}

void addParts(py::class_<CaseObject, SharedCase>& type) {
  using formats::BlobbyModels;
  using formats::PointSets;
  addArray(type, "point_offset", &Case::points, &PointSets::offset);
  addArray(type, "point_position", &Case::points, &PointSets::position);
  addArray(type, "blob_offset", &Case::models, &BlobbyModels::offset);
  addArray(type, "blob_centre", &Case::models, &BlobbyModels::centre);
  addArray(type, "blob_width", &Case::models, &BlobbyModels::width);
  type.def_property_readonly("kernel", [](const CaseObject& self) -> py::object {
    if (!self.value.models) return py::none();
    const BlobbyModels& models = *self.value.models;
    return py::make_tuple(formats::enumName(formats::kKernelNames, models.kernel),
                          models.kernelParameter, models.isoLevel);
  });
  type.def_property_readonly("node_arrays", [](const py::object& self) {
    py::dict arrays;
    for (const formats::NodeArray& array : caseOf(self).nodeArrays)
      std::visit(
          [&](const auto& values) {
            arrays[array.name.c_str()] = viewOf(self, values, py::ssize_t{array.components});
          },
          array.values);
    return arrays;
  });
  type.def_property_readonly("metadata_json", [](const CaseObject& self) {
    return formats::metadataJson(self.value.metadata, self.value.nodeArrays);
  });
}

SharedCase readCase(const fs::path& file) {
  const auto read = released([&] { return formats::readFileBytes(file); });
  if (!read) raise(read.error(), formats::printable(file.string()));
  return decodedCase(*read, formats::printable(file.string()));
}

SharedCase decodeBytes(const py::bytes& bytes) {
  const auto text = static_cast<std::string_view>(bytes);
  return decodedCase(std::as_bytes(std::span(text.data(), text.size())));
}

/// Numbers of all poses, of which each has `columns` from the float `first` of its record on:
/// (times, nodes, columns), or (times, nodes) for one.
py::object posesOf(const py::object& self, std::size_t first, py::ssize_t columns) {
  const std::optional<formats::Motion>& motion = caseOf(self).motion;
  if (!motion) return py::none();
  constexpr auto kPose = static_cast<py::ssize_t>(sizeof(formats::Pose));
  const auto nodes = static_cast<py::ssize_t>(motion->node.size());
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(motion->time.size()), nodes};
  std::vector<py::ssize_t> strides{kPose * nodes, kPose};
  if (columns > 1) {
    shape.push_back(columns);
    strides.push_back(static_cast<py::ssize_t>(sizeof(float)));
  }
  static const formats::Pose nothing{};
  const auto* const at =
      reinterpret_cast<const float*>(motion->pose.empty() ? &nothing : motion->pose.data());
  py::array view(py::dtype::of<float>(), shape, strides, at + first, self);
  if (!self.cast<const CaseObject&>().isWritable) view.attr("setflags")(py::arg("write") = false);
  return view;
}

using Numbers = py::array_t<float, py::array::c_style | py::array::forcecast>;

/// A copy with another motion, or without one.
SharedCase withMotion(const CaseObject& self, const std::vector<double>& times,
                      const std::vector<std::uint32_t>& nodes, const Numbers& poses,
                      double period) {
  std::optional<formats::Motion> motion;
  if (!times.empty()) {
    motion = formats::Motion{times, period, nodes, {}};
    motion->pose.resize(static_cast<std::size_t>(poses.size()) / 8);
    std::memcpy(static_cast<void*>(motion->pose.data()), poses.data(),
                motion->pose.size() * sizeof(formats::Pose));
  }
  const SharedCase made = released([&] { return sharedCase(self.value); });
  made->value.motion = std::move(motion);
  requireValid(*made);
  return made;
}

void addMotion(py::class_<CaseObject, SharedCase>& type) {
  addArray(type, "motion_time", &Case::motion, &formats::Motion::time);
  addArray(type, "motion_node", &Case::motion, &formats::Motion::node);
  type.def_property_readonly("motion_period", [](const CaseObject& self) {
    return self.value.motion ? self.value.motion->period : 0.0;
  });
  type.def_property_readonly("motion_centre",
                             [](const py::object& self) { return posesOf(self, 0, 3); });
  type.def_property_readonly("motion_rotation",
                             [](const py::object& self) { return posesOf(self, 3, 4); });
  type.def_property_readonly("motion_factor",
                             [](const py::object& self) { return posesOf(self, 7, 1); });
  type.def("with_motion", &withMotion);
}

py::bytes encodeBytes(const CaseObject& self, bool isJson, bool compress, int pointBits) {
  requireValid(self);
  if (isJson)
    return released([&] {
      if (pointBits == 0) return formats::encodeJson(self.value);
      Case rounded = self.value;
      formats::quantisePoints(rounded, pointBits);
      return formats::encodeJson(rounded);
    });
  const auto bytes = released([&] {
    return formats::encodeBinary(self.value, {compress, pointBits});
  });
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void writeCase(const CaseObject& self, const fs::path& file, bool isJson, bool compress,
               int pointBits) {
  requireValid(self);
  const formats::Status status = released([&] {
    return formats::writeCaseFile(
        self.value, file, isJson ? formats::CaseEncoding::Json : formats::CaseEncoding::Binary,
        {compress, pointBits});
  });
  if (!status) raise(status.error(), formats::printable(file.string()));
}

py::tuple issuesOf(const CaseObject& self, std::size_t most) {
  formats::IssueList issues(most);
  released([&] { formats::checkCase(self.value, issues); });
  const formats::IssueCounts counts = issues.counts();
  py::list facts;
  for (const formats::Issue& issue : issues.take()) facts.append(issueFacts(issue));
  return py::make_tuple(counts.errors, counts.warnings, counts.information, facts);
}

}  // namespace

SharedCase decodedCase(std::span<const std::byte> bytes, const std::string& file) {
  auto value = released([&] { return formats::decodeCase(bytes); });
  if (!value) raise(value.error(), file);
  return sharedCase(*std::move(value));
}

void requireValid(const CaseObject& self) {
  const formats::Status valid = released([&] { return formats::validate(self.value); });
  if (!valid) raise(valid.error(), "");
}

void addCase(py::module_& module) {
  py::class_<CaseObject, SharedCase> type(module, "Case", "A case in memory, and views of it.");
  forbidNew(type);
  addTree(type);
  addParts(type);
  addMotion(type);
  type.def_readonly("writable", &CaseObject::isWritable);
  type.def_static("read", &readCase);
  type.def_static("decode", &decodeBytes);
  type.def("encode", &encodeBytes);
  type.def("write", &writeCase);
  type.def("issues", &issuesOf);
  type.def("copy", [](const CaseObject& self, bool isWritable) {
    return released([&] { return sharedCase(self.value, isWritable); });
  });
  type.def("equals", [](const CaseObject& self, const CaseObject& other) {
    return released([&] { return self.value == other.value; });
  });
}

}  // namespace lumen::python
