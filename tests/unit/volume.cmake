find_package(ZLIB REQUIRED)
lumen_test(volume_test
  LABELS memory threads
  LIBS lumen_volume lumen_labels
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume/bspline_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume/hostile_nifti_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume/detached_data_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume/header_geometry_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume/hostile_volume_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume/nifti_rotation_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume/nifti_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume/read_volume_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume/stored_types_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume/memory_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume/upright_grid_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume/stored_voxels_test.cpp)
if(LUMEN_WITH_DICOM)
  target_sources(volume_test PRIVATE
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume/dicom_frames_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume/dicom_labels_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume/dicom_series_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume/dicom_stack_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume/dicom_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume/hostile_dicom_test.cpp)
else()
  target_sources(volume_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume/no_dicom_test.cpp)
endif()
target_include_directories(volume_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume)
target_link_libraries(volume_test PRIVATE ZLIB::ZLIB)
