# Programs that reproduce the published figures of the fit, and what they share.
find_package(nlohmann_json 3.11 REQUIRED)
add_library(lumen_reproduce STATIC
  ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/convolution_shapes.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/family_fit.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/implicit_surface.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/particles.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/plot.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/report.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/seams.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/shape_fit.cpp)
target_link_libraries(lumen_reproduce PUBLIC lumen_fitting
  PRIVATE lumen_terminal nlohmann_json::nlohmann_json)

foreach(program seams four_shapes energy_terms)
  set(source ${program}.cpp)
  if(program STREQUAL seams)
    set(source seams_main.cpp)
  endif()
  add_executable(lumen_${program} ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/${source})
  target_link_libraries(lumen_${program} PRIVATE lumen_reproduce lumen_terminal)
endforeach()

add_executable(lumen_patient_fits ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/patient_fits.cpp)
target_link_libraries(lumen_patient_fits PRIVATE
  lumen_reproduce lumen_tracking lumen_phantom lumen_surface lumen_terminal)

include(${CMAKE_CURRENT_LIST_DIR}/tracking.cmake)
