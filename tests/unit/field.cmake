lumen_test(field_test
  LIBS lumen_options lumen_case lumen_field lumen::blob_static
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob/tree.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/field/blended_field_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/field/case_field_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/field/kernel_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/field/neighbourhood_test.cpp)
target_include_directories(field_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob)
