// SPDX-License-Identifier: Apache-2.0
// Guidewires (libblob/wire) for Python: one call steps all of them, and their state is in views of NumPy.
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "libblob/wire/blob_wire.h"
#include "packages/python/src/blob_records.h"
#include "packages/python/src/model_object.h"
#include "packages/python/src/python_error.h"

namespace py = pybind11;

namespace lumen::python {

namespace {

struct CloseWires {
  void operator()(blob_wires* wires) const { blob_wires_close(wires); }
};

/// Wires, which keep their vessels alive.
struct WiresObject : MadeByInit {
  std::unique_ptr<blob_wires, CloseWires> wires;
  blob_wires_state state{};
  std::vector<SharedModel> models;
};

using Column = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::unique_ptr<WiresObject> makeWires(std::size_t count, std::size_t nodes, std::size_t threads) {
  blob_wires* made = nullptr;
  const blob_status status = blob_wires_create(count, nodes, threads, &made);
  if (status == BLOB_ERROR_MEMORY) throw std::bad_alloc();
  if (status != BLOB_OK)
    throw py::value_error("found " + std::to_string(count) + " wires of " + std::to_string(nodes) +
                          " nodes, expected 1 to 1000000 of 8 to 1000");
  auto object = makeObject<WiresObject>();
  object->wires.reset(made);
  object->state = blob_wires_describe(made);
  object->models.resize(count);
  return object;
}

/// A definition with the numbers of `values`, by the names of its fields.
blob_wire_def definitionOf(const py::dict& values) {
  using Field = std::pair<const char*, double blob_wire_def::*>;
  static constexpr std::array<Field, 9> kFields{{{"spacing", &blob_wire_def::spacing},
                                                 {"radius", &blob_wire_def::radius},
                                                 {"bending", &blob_wire_def::bending},
                                                 {"tip_bending", &blob_wire_def::tip_bending},
                                                 {"tip_length", &blob_wire_def::tip_length},
                                                 {"curve_length", &blob_wire_def::curve_length},
                                                 {"curve_angle", &blob_wire_def::curve_angle},
                                                 {"friction", &blob_wire_def::friction},
                                                 {"push_limit", &blob_wire_def::push_limit}}};
  blob_wire_def def = blob_wire_def_default();
  std::size_t found = 0;
  for (const auto& [name, field] : kFields)
    if (values.contains(name)) {
      def.*field = values[name].cast<double>();
      ++found;
    }
  if (found != values.size())
    throw py::value_error("device: found a name that is no property of a wire");
  return def;
}

void setWire(WiresObject& self, std::size_t wire, const SharedModel& model, const py::dict& device,
             const std::array<double, 3>& entry, const std::array<double, 3>& direction,
             double inserted, double rotation) {
  const blob_wire_def def = definitionOf(device);
  const blob_wire_place place{{entry[0], entry[1], entry[2]},
                              {direction[0], direction[1], direction[2]},
                              inserted,
                              rotation};
  const blob_status status = released([&] {
    return blob_wires_set(self.wires.get(), wire, model == nullptr ? nullptr : model->model.get(),
                          &def, &place);
  });
  if (status == BLOB_ERROR_RANGE)
    throw py::value_error(
        "wire: found a property out of its range or an entry outside of the lumen, expected an "
        "entry "
        "at least half the wire's radius inside");
  if (status != BLOB_OK)
    throw py::index_error("wire: found " + std::to_string(wire) + ", expected the index of one");
  self.models[wire] = model;
}

void stepWires(WiresObject& self, const Column& push, const Column& turn) {
  for (const Column* column : {&push, &turn})
    if (column->ndim() != 1 || static_cast<std::size_t>(column->size()) != self.state.count)
      throw py::value_error("push, turn: expected a number for each of " +
                            std::to_string(self.state.count) + " wires");
  const double *pushes = push.data(), *turns = turn.data();
  released([&] { return blob_wires_step(self.wires.get(), pushes, turns), 0; });
}

/// Adds a column as a view; `inner`: the lengths of its axes after that of wires, 0 for the nodes.
template <class Number>
void addColumn(py::class_<WiresObject>& type, const char* name, Number* blob_wires_state::*field,
               std::vector<std::size_t> inner) {
  type.def_property_readonly(name, [field, inner](const py::object& self) {
    const auto& state = self.cast<const WiresObject&>().state;
    std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(state.count)};
    for (const std::size_t size : inner)
      shape.push_back(static_cast<py::ssize_t>(size == 0 ? state.nodes : size));
    py::array_t<std::remove_const_t<Number>> view(shape, state.*field, self);
    if (std::is_const_v<Number>) view.attr("setflags")(py::arg("write") = false);
    return view;
  });
}

}  // namespace

void addWires(py::module_& module) {
  py::class_<WiresObject> type(module, "Wires");
  type.def(py::init(&makeWires), py::arg("count"), py::arg("nodes"), py::arg("threads") = 0);
  type.def("set", &setWire, py::arg("wire"), py::arg("model"), py::arg("device"), py::arg("entry"),
           py::arg("direction"), py::arg("inserted") = 0.0, py::arg("rotation") = 0.0);
  type.def("step", &stepWires, py::arg("push"), py::arg("turn"));
  addColumn(type, "position", &blob_wires_state::position, {0, 3});
  addColumn(type, "inserted", &blob_wires_state::inserted, {});
  addColumn(type, "rotation", &blob_wires_state::rotation, {});
  addColumn(type, "force", &blob_wires_state::force, {});
  addColumn(type, "pressing", &blob_wires_state::pressing, {0, 4});
  addColumn(type, "node", &blob_wires_state::node, {0});
  addColumn(type, "free", &blob_wires_state::free, {});
  addColumn(type, "held", &blob_wires_state::held, {});
  addColumn(type, "load", &blob_wires_state::load, {0, 3});
}

}  // namespace lumen::python
