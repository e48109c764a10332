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
