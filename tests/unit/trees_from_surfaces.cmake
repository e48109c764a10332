lumen_test(trees_from_surfaces_test
  LABELS memory_slow threads slow
  LIBS lumen_fitting lumen_trees_from_surfaces lumen_surface
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/trees_from_surfaces/case_of_mesh_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/trees_from_surfaces/closed_mesh_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/trees_from_surfaces/label_mesh_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/trees_from_surfaces/label_naming_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/trees_from_surfaces/real_meshes_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/trees_from_surfaces/triangle_tree_test.cpp)
