find_package(OpenMesh REQUIRED)
lumen_test(surface_test
  LABELS threads
  LIBS lumen_surface OpenMeshCore
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/extract_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/decimate_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/marching_cubes_table_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/marching_cubes_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/node_field_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/patch_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/polygonise_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/remesh_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/to_surface_mesh_test.cpp)

# Closed surfaces of random trees.
lumen_test(random_surface_test
  LIBS lumen_surface
  SLOW "RandomTrees[.]Have.*"
  SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/random_trees_test.cpp)

# Ends and crossings of closed surfaces.
lumen_test(ends_test
  LIBS lumen_surface
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/stretches_without_wall_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/crossing_search_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/ends_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/extension_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/flat_region_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/surface_size_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/thick_wall_test.cpp)
