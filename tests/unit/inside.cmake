lumen_test(inside_test
  LABELS memory threads
  LIBS lumen_fitting lumen_inside lumen_surface
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/inside/case_of_mesh_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/inside/closed_mesh_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/inside/label_mesh_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/inside/real_meshes_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/inside/triangle_tree_test.cpp)
