// SPDX-License-Identifier: Apache-2.0
// Corrections of a case by hand: each returns a new case, and the change that led to it.
#include <array>
#include <cstdint>
#include <functional>
#include <string>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "converters/stages/editing/edit.h"
#include "converters/stages/editing/wall_edits.h"
#include "converters/stages/fitting/fit.h"
#include "formats/case/enum_names.h"
#include "packages/python/src/case_object.h"
#include "packages/python/src/python_error.h"
#include "packages/python/src/watched_work.h"

namespace py = pybind11;

namespace lumen::python {

namespace {

using convert::Change;
using formats::Case;
using Position = std::array<double, 3>;

Eigen::Vector3d toEigen(const Position& position) {
  return {position[0], position[1], position[2]};
}

/// The numbers as an array of NumPy with its own memory.
py::array_t<std::uint32_t> arrayOf(const std::vector<std::uint32_t>& numbers) {
  return py::array_t<std::uint32_t>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

/// The corrected copy of a valid case, and its change: sentence, indices before, stale nodes, dropped arrays.
py::tuple edited(const CaseObject& self, const std::function<Change(Case&)>& edit) {
  requireValid(self);
  Case value;
  Change change;
  std::optional<Error> failure;
  released([&] {
    try {
      value = self.value;
      change = edit(value);
    } catch (const Error& error) {
      failure = error;
    }
  });
  if (failure) raise(*failure);
  return py::make_tuple(sharedCase(std::move(value)),
                        py::make_tuple(change.sentence, arrayOf(change.before),
                                       arrayOf(change.stale), change.droppedArrays));
}

/// Adds a correction of one branch that needs nothing else.
template <Change (*function)(Case&, std::uint32_t)>
void addEdit(py::module_& module, const char* name) {
  module.def(name, [](const CaseObject& self, std::uint32_t index) {
    return edited(self, [&](Case& value) { return function(value, index); });
  });
}

void addBranchEdits(py::module_& module) {
  module.def("edit_delete", [](const CaseObject& self, std::uint32_t branch, bool hanging) {
    const auto children = hanging ? convert::Hanging::Go : convert::Hanging::Stay;
    return edited(self, [&](Case& v) { return convert::deleteBranch(v, branch, children); });
  });
  module.def("edit_cut", [](const CaseObject& self, std::uint32_t node, bool isChild,
                            const std::string& label) {
    const auto rest = isChild ? convert::Rest::Child : convert::Rest::OwnTree;
    return edited(self, [&](Case& v) { return convert::cutBefore(v, node, rest, label); });
  });
  module.def("edit_join", [](const CaseObject& self, std::uint32_t branch, std::uint32_t node) {
    return edited(self, [&](Case& v) { return convert::joinBranch(v, branch, node); });
  });
  addEdit<convert::mergeIntoParent>(module, "edit_merge");
  addEdit<convert::reverseBranch>(module, "edit_reverse");
  addEdit<convert::makeRoot>(module, "edit_root");
  module.def("edit_kind", [](const CaseObject& self, std::uint32_t branch,
                             const std::string& name) {
    const auto kind = formats::enumFromName<formats::BranchKind>(formats::kBranchKindNames, name);
    if (!kind)
      raise(Error(ErrorKind::Usage, "kind: found " + name + ", expected vessel or aneurysm"));
    return edited(self, [&](Case& v) { return convert::setKind(v, branch, *kind); });
  });
  module.def(
      "edit_rename", [](const CaseObject& self, std::uint32_t branch, const std::string& label) {
        return edited(self, [&](Case& v) { return convert::renameBranch(v, branch, label); });
      });
}

void addWallEdits(py::module_& module) {
  module.def("edit_move", [](const CaseObject& self, std::uint32_t node, const Position& position,
                             double radius) {
    return edited(self,
                  [&](Case& v) { return convert::moveNode(v, node, toEigen(position), radius); });
  });
  module.def(
      "edit_widen", [](const CaseObject& self, std::uint32_t node, double radius, double reach) {
        return edited(self, [&](Case& v) { return convert::widenAround(v, node, radius, reach); });
      });
  module.def("edit_push", [](const CaseObject& self, std::uint32_t node, const Position& at,
                             const Position& by, double radius) {
    const convert::Stroke stroke{toEigen(at), toEigen(by), radius};
    return edited(self, [&](Case& v) { return convert::pushWall(v, node, stroke); });
  });
  addEdit<convert::addNodeBehind>(module, "edit_add_node");
  addEdit<convert::deleteNode>(module, "edit_delete_node");
}

/// Fits the models of the given nodes again, with the options of the case's last fit.
SharedCase refitted(const CaseObject& self, const std::vector<std::uint32_t>& nodes,
                    const py::object& report, int threads) {
  requireValid(self);
  for (const std::uint32_t node : nodes)
    if (node >= self.value.tree.nodeCount())
      throw py::index_error("node: found " + std::to_string(node) + ", expected one below " +
                            std::to_string(self.value.tree.nodeCount()));
  const SharedCase result = released([&] { return sharedCase(self.value); });
  runWatched({report, threads}, [&](Progress& progress) {
    convert::refit(result->value, nodes, convert::recordedFitOptions(result->value), progress);
  });
  return result;
}

}  // namespace

void addEdits(py::module_& module) {
  addBranchEdits(module);
  addWallEdits(module);
  module.def("refit", &refitted);
}

}  // namespace lumen::python
