lumen_test(picture_test
  LABELS threads
  LIBS lumen_picture lumen::blob_static TBB::tbb
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/picture/camera_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/picture/draw_case_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/picture/marks_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/picture/trace_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/picture/volume_behind_test.cpp)
target_include_directories(picture_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit/check)
