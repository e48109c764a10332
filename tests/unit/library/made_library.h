// SPDX-License-Identifier: Apache-2.0
// A library and a record for tests, with something in every field.
#pragma once

#include <string>

#include "converters/library/index/library_file.h"
#include "converters/library/index/record.h"

namespace lumen::convert {

inline std::string madeDigest(char digit) {
  return std::string(64, digit);
}

inline CaseRecord madeRecord(const std::string& id = "siphon-01") {
  CaseRecord record;
  record.id = id;
  record.version = 2;
  record.date = "2026-11-22";
  record.about = {"Left carotid siphon",
                  "A siphon with \"quotes\", <b>tags</b> and é",
                  "carotid siphon",
                  {{"SNOMED CT", "86117002", "Internal carotid artery"}, {"FMA", "3947", ""}},
                  "left",
                  "XA",
                  false,
                  "CC-BY-4.0",
                  "Somebody",
                  "10.5281/zenodo.1234",
                  "a collection",
                  "given in writing",
                  "faces and names were removed"};
  record.boundsMin = {-1, 2.5, 3};
  record.boundsMax = {10, 20, 30.25};
  record.figures = {3,
                    1,
                    120,
                    88.5,
                    0.5,
                    1.25,
                    2.5,
                    0.01,
                    0.04,
                    80.5,
                    GeometryFigures{0.125, 40, 75, 62.5, 7, 3.5},
                    {}};
  record.insertions = {{"ica", "", {1, 2, 3}, {0, 0, 1}, 2.5}};
  record.ends = {{"inlet", "inlet", {1, 2, 3}, {0, 0, -1}, 2.5},
                 {"outlet-mca", "outlet", {4, 5, 6}, {1, 0, 0}, 1.5}};
  record.provenance = {
      {"case_sha256", madeDigest('a')},
      {"generator", "lumen 0.1.0"},
      {"source", {{"sha256", madeDigest('b')}}},
      {"steps",
       {{{"name", "track"},
         {"tool", "lumen 0.1.0"},
         {"parameters", {{"gamma", 0.1}, {"random-seed", 1}, {"word", "x"}, {"yes", true}}}}}}};
  record.files = {
      {"case.lumen", "case", "", "application/octet-stream", 100, madeDigest('a')},
      {"exports/mujoco/scene.xml", "export", "mujoco", "application/xml", 200, madeDigest('c')},
      {"picture.png", "picture", "", "image/png", 300, madeDigest('d')}};
  return record;
}

inline LibraryFile madeLibrary() {
  LibraryFile library;
  library.id = "0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4";
  library.revision = 7;
  library.previous = madeDigest('e');
  library.title = "Carotid siphons";
  library.description = "All of them";
  library.publisher = "A hospital";
  library.licence = "CC0-1.0";
  library.date = "2026-11-22";
  library.generator = "lumen 0.1.0";
  library.cases = {{"siphon-01", 2, "Left carotid siphon", 4021, madeDigest('f'), 3, 600},
                   {"siphon-02", 1, "Right carotid siphon", 4022, madeDigest('0'), 3, 600}};
  return library;
}

}  // namespace lumen::convert
