lumen_test(check_test
  LABELS threads
  LIBS lumen_check lumen_overlay lumen_fitting lumen_phantom lumen_geometry lumen_tracking lumen_geometry
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/check/check_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/check/ideal_edge_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/check/missing_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/check/picture_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/check/projection_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/check/skeleton_paths_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/check/tree_places_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/check/true_wall_test.cpp)
