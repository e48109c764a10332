lumen_test(fitting_test
  LABELS threads
  LIBS lumen_fitting lumen_reproduce
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/fitting/conjugate_gradients.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/fitting/energy_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/fitting/error_of_fit_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/fitting/fit_options_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/fitting/fit_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/fitting/levenberg_marquardt_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/fitting/local_model_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/fitting/open_edges_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/fitting/refit_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/fitting/reproduce_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/fitting/seam_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/fitting/shapes.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/fitting/unmeasured_test.cpp)

if(LUMEN_BUILD_BENCHMARKS)
  find_package(benchmark REQUIRED)
  add_executable(fit_bench
    ${CMAKE_CURRENT_SOURCE_DIR}/bench/fit_bench.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/fitting/shapes.cpp)
  target_include_directories(fit_bench PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit/fitting)
  target_link_libraries(fit_bench PRIVATE lumen_fitting benchmark::benchmark_main)
endif()
