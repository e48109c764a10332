lumen_test(compare_test
  LABELS threads
  LIBS lumen_compare lumen_geometry
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/compare/centerline_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/compare/matching_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/compare/repetition_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/compare/sampled_path_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/evaluation/reproduce/vessel_score.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/compare/vessel_score_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/compare/wall_distance_test.cpp)
target_include_directories(compare_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit/compare)
