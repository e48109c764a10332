# Programs that reproduce the published figures of the tracker.
add_executable(lumen_circles
  ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/circle_search.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/circles.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/disc_image.cpp)
target_link_libraries(lumen_circles PRIVATE lumen_reproduce lumen_tracking lumen_terminal)

add_executable(lumen_tracking_report
  ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/track_score.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/tracking.cpp)
target_link_libraries(lumen_tracking_report PRIVATE
  lumen_reproduce lumen_tracking lumen_phantom lumen_compare lumen_terminal)

add_executable(lumen_vessels
  ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/timed_run.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/vessel_score.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/vessels.cpp)
target_link_libraries(lumen_vessels PRIVATE
  lumen_reproduce lumen_compare lumen_seeds lumen_geometry lumen_terminal nlohmann_json::nlohmann_json)

if(LUMEN_BUILD_BENCHMARKS)
  include(${CMAKE_CURRENT_SOURCE_DIR}/bench/convert.cmake)
endif()
