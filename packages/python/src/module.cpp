// SPDX-License-Identifier: Apache-2.0
// The compiled part of the package lumen: lumen._lumen.
#include <pybind11/pybind11.h>

#include "packages/python/src/blob_records.h"
#include "packages/python/src/case_object.h"
#include "packages/python/src/engine_calls.h"
#include "packages/python/src/volume_object.h"

PYBIND11_MODULE(_lumen, module) {
  module.doc() = "The compiled part of lumen. Use lumen and lumen.blob.";
  lumen::python::addCase(module);
  lumen::python::addEdits(module);
  lumen::python::addEngine(module);
  lumen::python::addSurfaces(module);
  lumen::python::addVolumes(module);
  lumen::python::addBlob(module);
  lumen::python::addWires(module);
}
