# What a written surface is, measured on its file. CGAL, which is GPL, is only ever compared with; it is headers
# alone, and its own CMake package would hide OpenMesh's from what follows.
add_library(lumen_surface_facts STATIC
  ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/surface_facts.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/surface_shape.cpp)
target_link_libraries(lumen_surface_facts PUBLIC lumen_surface PRIVATE lumen_mesh lumen_vtk_xml gmp mpfr)
set_source_files_properties(${CMAKE_CURRENT_SOURCE_DIR}/reproduce/surface_shape.cpp
  PROPERTIES COMPILE_OPTIONS -frounding-math)

add_executable(lumen_surface_proof ${CMAKE_CURRENT_SOURCE_DIR}/reproduce/surface_proof.cpp)
target_link_libraries(lumen_surface_proof PRIVATE lumen_surface_facts lumen_case nlohmann_json::nlohmann_json)
