lumen_test(motion_stage_test
  LABELS threads
  LIBS lumen_motion lumen_phantom lumen_tracking lumen_geometry
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/motion/posing_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/motion/search_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/motion/smooth_moves_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/motion/stations_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/motion/track_motion_test.cpp)
