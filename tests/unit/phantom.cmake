lumen_test(phantom_test
  LABELS threads
  LIBS lumen_phantom lumen_geometry
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/phantom/clutter_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/phantom/hard_designs_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/phantom/intensity_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/phantom/measured_designs_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/phantom/patient_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/phantom/seeds_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/phantom/small_designs_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/phantom/tree_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/phantom/tube_tree_distance_test.cpp)
