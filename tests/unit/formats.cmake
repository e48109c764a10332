lumen_test(formats_test
  LIBS lumen_case
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/allocation_meter.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/binary_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/blobby_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/container_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/crc32c_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/file_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/json_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/memory_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/sample_case.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/spec_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/topology_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/validate_test.cpp)
target_include_directories(formats_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})

if(LUMEN_BUILD_BENCHMARKS)
  find_package(benchmark REQUIRED)
  add_executable(formats_bench
    ${CMAKE_CURRENT_SOURCE_DIR}/bench/formats_bench.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/sample_case.cpp)
  target_include_directories(formats_bench PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_link_libraries(formats_bench PRIVATE lumen_case GTest::gtest benchmark::benchmark_main)
endif()
