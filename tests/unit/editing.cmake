lumen_test(editing_test
  LABELS memory_slow
  LIBS lumen_editing lumen_base lumen_geometry lumen_centerline lumen_fitting lumen_phantom
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/editing/edit_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/editing/edit_request_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/editing/find_inlets_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/editing/hints_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/editing/motion_edits_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/editing/posed_case_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/editing/random_edits_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/editing/smooth_axes_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/editing/touching_vessels_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/editing/trim_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/editing/correct_topology_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/editing/wall_edits_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/sample_case.cpp)
target_include_directories(editing_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})

lumen_test(one_click_test
  LIBS lumen_check lumen_editing lumen_fitting lumen_phantom lumen_tracking
  SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/editing/one_click_test.cpp)
