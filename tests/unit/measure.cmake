lumen_test(measure_test
  LABELS threads
  LIBS lumen_measure lumen_fitting lumen_phantom lumen_geometry lumen_csv
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/measure/closed_form_measures_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/measure/exact_design.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/measure/measure_tables_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/measure/sac_measures_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/measure/shapes.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/measure/uncertainty_test.cpp)
