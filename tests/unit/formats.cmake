lumen_test(formats_test FOLDER formats WITHOUT write_spec.cpp
  LABELS memory
  LIBS lumen_case nlohmann_json::nlohmann_json)
target_include_directories(formats_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})

# ninja write_spec && tests/write_spec spec tests: makes the generated parts of the specification anew.
add_executable(write_spec EXCLUDE_FROM_ALL
  ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/spec_tables.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/write_spec.cpp)
target_include_directories(write_spec PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(write_spec PRIVATE lumen_view nlohmann_json::nlohmann_json)
