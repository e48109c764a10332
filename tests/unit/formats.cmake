lumen_test(formats_test
  LABELS memory
  LIBS lumen_case nlohmann_json::nlohmann_json
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/allocation_meter.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/atomic_file_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/binary_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/blobby_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/case_view_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/container_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/crc32c_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/encoding_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/file_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/full_case_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/json_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/json_text_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/places_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/memory_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/motion_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/node_origin_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/printable_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/reachability_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/report_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/sample_case.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/spec_tables.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/spec_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/topology_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/validate_test.cpp)
target_include_directories(formats_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})

# ninja write_spec && tests/write_spec spec tests: makes the generated parts of the specification anew.
add_executable(write_spec EXCLUDE_FROM_ALL
  ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/spec_tables.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/write_spec.cpp)
target_include_directories(write_spec PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(write_spec PRIVATE lumen_view nlohmann_json::nlohmann_json)
