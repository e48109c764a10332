lumen_test(voxels_test
  LABELS memory
  LIBS lumen_voxels
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/voxels/cell_box_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/voxels/depth_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/voxels/profile_edge_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/voxels/search_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/voxels/vessel_paths_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/voxels/voxel_set_test.cpp)
