// SPDX-License-Identifier: Apache-2.0
// libblob's queries for Python: batches of points, one call of libblob for each.
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "formats/case/case_file.h"
#include "formats/container/printable.h"
#include "packages/python/src/blob_records.h"
#include "packages/python/src/case_object.h"
#include "packages/python/src/model_object.h"
#include "packages/python/src/python_error.h"

namespace py = pybind11;

namespace lumen::python {

namespace {

using Samples = Records<blob_sample>;
using Hessians = Records<blob_hessian>;
using NearestPoints = Records<blob_nearest_point>;
using Hits = Records<blob_hit>;
using Approaches = Records<blob_approach>;

/// The model that `open` makes. Raises lumen.Error, which names `subject`.
template <class Open>
SharedModel opened(const std::string& subject, bool verify, const Open& open) {
  std::array<char, 500> message{};
  blob_open_def definition = blob_open_def_default();
  definition.verify = verify ? 1 : 0;
  definition.message = message.data();
  definition.message_size = message.size();
  blob_model* model = nullptr;
  const blob_status status = released([&] { return open(definition, &model); });
  if (status != BLOB_OK) {
    const std::string reason = message[0] != '\0' ? message.data() : blob_status_text(status);
    raise(invalidInput(subject + ": " + reason), subject);
  }
  auto object = std::make_shared<ModelObject>();
  object->model.reset(model);
  object->info = blob_model_describe(model);
  return object;
}

SharedModel openFile(const std::filesystem::path& file, bool verify) {
  return opened(formats::printable(file.string()), verify,
                [&](const blob_open_def& definition, blob_model** model) {
                  return blob_model_open(file.c_str(), &definition, model);
                });
}

SharedModel openCase(const CaseObject& source) {
  const auto valid = released([&] { return formats::validate(source.value); });
  if (!valid) raise(valid.error(), "");
  return opened("case", false, [&](const blob_open_def& definition, blob_model** model) {
    const auto bytes = formats::encodeBinary(source.value);
    return blob_model_open_bytes(bytes.data(), bytes.size(), &definition, model);
  });
}

/// The nodes of a cursor for `count` points, or null for None.
std::uint32_t* nodesOf(CursorObject* cursor, std::size_t count) {
  if (cursor == nullptr) return nullptr;
  if (cursor->nodes.size() != count)
    throw py::value_error("cursor: found " + std::to_string(cursor->nodes.size()) +
                          " points, expected " + std::to_string(count));
  return cursor->nodes.data();
}

py::object query(const ModelObject& self, const py::object& points, CursorObject* cursor,
                 std::uint32_t flags, const py::object& out) {
  const PackedPoints packed(points, "points");
  std::uint32_t* const nodes = nodesOf(cursor, packed.count());
  const bool isNew = out.is_none();
  py::object answer =
      isNew ? py::cast(std::make_unique<Samples>(packed.count(), packed.isSingle())) : out;
  auto& samples = answer.cast<Samples&>();
  if (samples.count != packed.count() || samples.isSingle != packed.isSingle())
    throw py::value_error("out: found an answer for " + std::to_string(samples.count) +
                          " points, expected " + std::to_string(packed.count()));
  const py::gil_scoped_release released;
  packed.forBlocks([&](std::size_t begin, std::size_t count, const double(*at)[3]) {
    blob_query_many(self.model.get(), flags, count, at, nodes == nullptr ? nullptr : nodes + begin,
                    samples.at + begin);
  });
  return answer;
}

/// Calls `each` with the index, point, cursor and record of every point.
template <class Record, class Each>
std::unique_ptr<Records<Record>> forEach(const PackedPoints& points, CursorObject* cursor,
                                         const Each& each) {
  std::uint32_t* const nodes = nodesOf(cursor, points.count());
  auto records = std::make_unique<Records<Record>>(points.count(), points.isSingle());
  const py::gil_scoped_release released;
  points.forBlocks([&](std::size_t begin, std::size_t count, const double(*at)[3]) {
    for (std::size_t i = 0; i < count; ++i)
      each(begin + i, at[i], nodes == nullptr ? nullptr : nodes + begin + i,
           &records->at[begin + i]);
  });
  return records;
}

std::unique_ptr<Hessians> hessian(const ModelObject& self, const py::object& points,
                                  CursorObject* cursor, std::uint32_t flags) {
  const PackedPoints packed(points, "points");
  return forEach<blob_hessian>(
      packed, cursor, [&](std::size_t, const double* point, std::uint32_t* node, auto* out) {
        blob_query_hessian(self.model.get(), flags, point, node, out);
      });
}

std::unique_ptr<NearestPoints> nearest(const ModelObject& self, const py::object& points,
                                       CursorObject* cursor, std::uint32_t flags, double tolerance,
                                       std::uint32_t maxSteps) {
  const PackedPoints packed(points, "points");
  return forEach<blob_nearest_point>(
      packed, cursor, [&](std::size_t, const double* point, std::uint32_t* node, auto* out) {
        blob_nearest(self.model.get(), flags, point, node, tolerance, maxSteps, out);
      });
}

/// Points of the ends of segments, as many as of their starts.
PackedPoints endsLike(const PackedPoints& starts, const py::object& ends) {
  PackedPoints packed(ends, "ends");
  if (packed.count() != starts.count())
    throw py::value_error("ends: found " + std::to_string(packed.count()) + " points, expected " +
                          std::to_string(starts.count()));
  return packed;
}

std::unique_ptr<Hits> segmentHits(const ModelObject& self, const py::object& starts,
                                  const py::object& ends, CursorObject* cursor, std::uint32_t flags,
                                  double tolerance, std::uint32_t maxSteps) {
  const PackedPoints from(starts, "starts");
  const PackedPoints to = endsLike(from, ends);
  return forEach<blob_hit>(from, cursor,
                           [&](std::size_t i, const double* point, std::uint32_t* node, auto* out) {
                             blob_segment_hit(self.model.get(), flags, point, to.point(i).data(),
                                              node, tolerance, maxSteps, out);
                           });
}

std::unique_ptr<Approaches> capsules(const ModelObject& self, const py::object& starts,
                                     const py::object& ends, double radius, CursorObject* cursor,
                                     std::uint32_t flags) {
  const PackedPoints from(starts, "starts");
  const PackedPoints to = endsLike(from, ends);
  return forEach<blob_approach>(
      from, cursor, [&](std::size_t i, const double* point, std::uint32_t* node, auto* out) {
        blob_capsule_approach(self.model.get(), flags, point, to.point(i).data(), radius, node,
                              out);
      });
}

std::unique_ptr<CursorObject> locate(const ModelObject& self, const py::object& points) {
  const PackedPoints packed(points, "points");
  auto cursor = makeObject<CursorObject>(packed.count());
  const py::gil_scoped_release released;
  packed.forBlocks([&](std::size_t begin, std::size_t count, const double(*at)[3]) {
    for (std::size_t i = 0; i < count; ++i)
      cursor->nodes[begin + i] = blob_cursor_locate(self.model.get(), at[i]);
  });
  return cursor;
}

/// Adds fields of a record as properties of its class.
template <class Record, class... Fields>
void addColumns(py::class_<Records<Record>>& type,
                const std::pair<const char*, Fields Record::*>&... fields) {
  forbidNew(type);
  type.def("__len__", [](const Records<Record>& self) { return self.count; });
  (type.def_property_readonly(
       fields.first,
       [field = fields.second](const py::object& self) { return columnOf(self, field); }),
   ...);
}

template <class Record, class Field>
std::pair<const char*, Field Record::*> column(const char* name, Field Record::*field) {
  return {name, field};
}

/// Adds bits of a field as a property of truth values.
template <class Record, class Field>
void addTruth(py::class_<Records<Record>>& type, const char* name, Field Record::*field,
              unsigned mask = ~0u) {
  type.def_property_readonly(
      name, [field, mask](const Records<Record>& self) { return truthOf(self, field, mask); });
}

void addAnswers(py::module_& module) {
  py::class_<Samples> answer(module, "Answer");
  addColumns(answer, column("value", &blob_sample::value),
             column("gradient", &blob_sample::gradient), column("distance", &blob_sample::distance),
             column("normal", &blob_sample::normal), column("node", &blob_sample::node));
  addTruth(answer, "inside", &blob_sample::state, BLOB_INSIDE);
  addTruth(answer, "not_converged", &blob_sample::state, BLOB_NOT_CONVERGED);
  py::class_<Hessians> hessians(module, "Hessian");
  addColumns(hessians, column("value", &blob_hessian::value),
             column("gradient", &blob_hessian::gradient), column("hessian", &blob_hessian::hessian),
             column("mean_curvature", &blob_hessian::mean_curvature),
             column("gaussian_curvature", &blob_hessian::gaussian_curvature));
  py::class_<NearestPoints> points(module, "Nearest");
  addColumns(points, column("point", &blob_nearest_point::point),
             column("normal", &blob_nearest_point::normal),
             column("distance", &blob_nearest_point::distance),
             column("node", &blob_nearest_point::node));
  addTruth(points, "converged", &blob_nearest_point::converged);
  py::class_<Hits> hits(module, "Hits");
  addColumns(hits, column("t", &blob_hit::t), column("point", &blob_hit::point),
             column("normal", &blob_hit::normal), column("node", &blob_hit::node));
  addTruth(hits, "hit", &blob_hit::hit);
  addTruth(hits, "complete", &blob_hit::complete);
  py::class_<Approaches> approaches(module, "Approaches");
  addColumns(approaches, column("t", &blob_approach::t), column("point", &blob_approach::point),
             column("distance", &blob_approach::distance), column("normal", &blob_approach::normal),
             column("depth", &blob_approach::depth), column("node", &blob_approach::node));
  addTruth(approaches, "not_converged", &blob_approach::state, BLOB_NOT_CONVERGED);
}

void addCursor(py::module_& module) {
  py::class_<CursorObject>(module, "Cursor")
      .def(py::init(&makeObject<CursorObject, std::size_t>), py::arg("count"))
      .def("__len__", [](const CursorObject& self) { return self.nodes.size(); })
      .def("copy", [](const CursorObject& self) { return makeObject<CursorObject>(self); })
      .def_property_readonly("node", [](const py::object& self) {
        auto& nodes = self.cast<CursorObject&>().nodes;
        return py::array_t<std::uint32_t>(static_cast<py::ssize_t>(nodes.size()), nodes.data(),
                                          self);
      });
}

void addQueries(py::class_<ModelObject, SharedModel>& model) {
  const auto cursor = py::arg("cursor") = py::none();
  const auto flags = py::arg("flags") = 0u;
  const auto tolerance = py::arg("tolerance") = 0.0;
  const auto steps = py::arg("max_steps") = 0u;
  model.def("query", &query, py::arg("points"), cursor, flags, py::arg("out") = py::none(),
            "The field at points (n, 3), mm, LPS: value, gradient, distance (mm, below 0 in the "
            "lumen), normal "
            "(outward) and node, as columns of an Answer of n rows.\n\nA cursor of n places moves "
            "along the tree "
            "with its points, and makes the query faster; without one each point is located. "
            "flags: BLENDED, LOCAL, "
            "DISTANCE_EXACT and HOLD of this module, as in blob.h. out: an Answer of n rows to "
            "write over. Releases "
            "the GIL.");
  model.def("hessian", &hessian, py::arg("points"), cursor, flags,
            "Second derivatives (n, 3, 3), 1/mm2, and the mean and Gaussian curvatures, 1/mm and "
            "1/mm2, of the level "
            "through points (n, 3), mm, LPS.");
  model.def("nearest", &nearest, py::arg("points"), cursor, flags, tolerance, steps,
            "The nearest points of the wall to points (n, 3), mm, LPS: point, normal, distance "
            "(mm, below 0 in the "
            "lumen) and converged. tolerance, mm, and max_steps: 0 takes those of blob.h.");
  model.def("segment_hits", &segmentHits, py::arg("starts"), py::arg("ends"), cursor, flags,
            tolerance, steps,
            "The first wall on each way from starts (n, 3) to ends (n, 3), mm, LPS: hit, t in [0, "
            "1], point, normal.");
  model.def("capsules", &capsules, py::arg("starts"), py::arg("ends"), py::arg("radius"), cursor,
            flags,
            "The place of each capsule, starts (n, 3) to ends (n, 3) of a radius, mm, LPS, that is "
            "nearest to the "
            "wall or deepest behind it: t in [0, 1], distance and depth, mm.");
  model.def("cursor", &locate, py::arg("points"),
            "A Cursor at the nodes in whose cells the points (n, 3), mm, LPS, lie.");
}

void addFacts(py::class_<ModelObject, SharedModel>& model) {
  model.def("__len__", [](const ModelObject& self) { return self.info.node_count; });
  model.def_property_readonly("blob_count",
                              [](const ModelObject& self) { return self.info.blob_count; });
  model.def_property_readonly("iso_level",
                              [](const ModelObject& self) { return self.info.iso_level; });
  model.def_property_readonly("bytes", [](const ModelObject& self) { return self.info.bytes; });
  model.def_property_readonly("bounds", [](const ModelObject& self) {
    py::array_t<double> box({2, 3});
    std::copy_n(self.info.low, 3, box.mutable_data(0));
    std::copy_n(self.info.high, 3, box.mutable_data(1));
    return box;
  });
}

using Words = py::array_t<std::uint32_t, py::array::c_style | py::array::forcecast>;

/// Models as the words of one buffer (blob_device.h). Raises ValueError without a model and for
/// models of 16 GiB or more, MemoryError without memory.
Words packed(const std::vector<const ModelObject*>& models) {
  std::vector<const blob_model*> pointers;
  for (const ModelObject* const model : models) {
    if (model == nullptr) throw py::type_error("models: found None");
    pointers.push_back(model->model.get());
  }
  const auto pack = [&](std::uint32_t* words, std::size_t room) {
    return released(
        [&] { return blob_device_pack(pointers.data(), pointers.size(), words, room); });
  };
  const std::size_t size = pack(nullptr, 0);
  if (size == 0) throw py::value_error("models: expected at least one, and less than 16 GiB");
  Words words(static_cast<py::ssize_t>(size / sizeof(std::uint32_t)));
  if (pack(words.mutable_data(), size) != size) throw std::bad_alloc();
  return words;
}

/// Raises lumen.Error for words that are no buffer of pack().
void checkPacked(const Words& words) {
  const auto size = static_cast<std::size_t>(words.size()) * sizeof(std::uint32_t);
  const std::uint32_t* const data = words.data();
  const blob_status status = released([&] { return blob_device_check(data, size); });
  if (status != BLOB_OK)
    raise(invalidInput(std::string("packed models: ") + blob_status_text(status)), "");
}

}  // namespace

void addBlob(py::module_& module) {
  addAnswers(module);
  addCursor(module);
  py::class_<ModelObject, SharedModel> model(module, "Model");
  model.def(py::init(&openCase), py::arg("source"));
  model.def(py::init(&openFile), py::arg("source"), py::arg("verify") = true);
  addQueries(model);
  addFacts(model);
  model.attr("__module__") = "lumen.blob";
  module.def("pack", &packed, py::arg("models"));
  module.def("check_packed", &checkPacked, py::arg("words"));
}

}  // namespace lumen::python
