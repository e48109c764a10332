// SPDX-License-Identifier: Apache-2.0
#include "packages/python/src/python_error.h"

#include "converters/base/shown_text.h"
#include "formats/container/error_code.h"

namespace py = pybind11;

namespace lumen::python {

namespace {

[[noreturn]] void raiseWith(const std::string& message, ErrorKind kind, const py::dict& facts) {
  const py::object type = py::module_::import("lumen._errors").attr("Error");
  const py::object error = type(messageText(message), static_cast<int>(kind), **facts);
  PyErr_SetObject(type.ptr(), error.ptr());
  throw py::error_already_set();
}

}  // namespace

void raise(const Error& error, const std::string& file) {
  py::dict facts;
  if (!file.empty()) facts["file"] = file;
  raiseWith(error.what(), error.kind(), facts);
}

void raise(const formats::Issue& issue, const std::string& file) {
  py::dict facts;
  if (!file.empty()) facts["file"] = file;
  facts["place"] = issue.place();
  facts["code"] = formats::errorRule(issue.code).name;
  facts["number"] = static_cast<int>(issue.code);
  for (const formats::Argument& argument : issue.arguments)
    if (argument.name == "found" || argument.name == "expected")
      facts[argument.name.c_str()] = argument.value;
  const bool isOfSystem = issue.code == formats::ErrorCode::IoMissing ||
                          issue.code == formats::ErrorCode::IoRead;  // no rule of the format
  const std::string text = isOfSystem ? issue.message : issue.text();
  const bool isNamed = file.empty() || text.starts_with(file);
  raiseWith(isNamed ? text : file + ": " + text, ErrorKind::InvalidInput, facts);
}

py::dict issueFacts(const formats::Issue& issue) {
  const formats::ErrorRule& rule = formats::errorRule(issue.code);
  py::dict arguments;
  for (const formats::Argument& argument : issue.arguments)
    arguments[argument.name.c_str()] = argument.value;
  py::dict facts;
  facts["code"] = rule.name;
  facts["number"] = static_cast<int>(issue.code);
  facts["severity"] = formats::severityName(rule.severity);
  facts["offset"] = issue.offset ? py::object(py::int_(*issue.offset)) : py::object(py::none());
  facts["pointer"] = issue.pointer ? py::object(py::str(*issue.pointer)) : py::object(py::none());
  facts["arguments"] = arguments;
  facts["message"] = issue.message;
  return facts;
}

}  // namespace lumen::python
