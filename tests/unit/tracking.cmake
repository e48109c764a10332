lumen_test(tracking_test
  LABELS threads
  LIBS lumen_fitting lumen_phantom lumen_tracking
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/base/statistics_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/tracking/aneurysm_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/tracking/click_light_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/base/icosphere_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/tracking/join_to_parent_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/tracking/joins_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/tracking/cylinder_equations_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/tracking/cylinder_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/tracking/corrections_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/tracking/rays_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/tracking/real_volumes_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/tracking/smoothing_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/tracking/steepest_fall_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/tracking/vessel_at_click_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/tracking/track_into_case_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/tracking/tracked_branch_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/tracking/tip_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/tracking/track_steps_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/tracking/track_case_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/tracking/volume_doubt_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/tracking/wall_support_test.cpp)
