find_package(OpenMesh REQUIRED)
lumen_test(surface_test FOLDER surface WITHOUT ends_test.cpp extension_test.cpp flat_region_test.cpp random_trees_test.cpp thick_wall_test.cpp
  LABELS threads
  LIBS lumen_surface OpenMeshCore)

# Closed surfaces of random trees.
lumen_test(random_surface_test
  LIBS lumen_surface
  SLOW "RandomTrees[.]Have.*"
  SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/random_trees_test.cpp)

# Ends and crossings of closed surfaces.
lumen_test(ends_test
  LIBS lumen_surface
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/ends_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/extension_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/flat_region_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/surface/thick_wall_test.cpp)
