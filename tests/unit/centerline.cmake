lumen_test(vtk_xml_test
  LABELS memory
  LIBS lumen_vtk_xml
  SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/base/vtk_xml_test.cpp)
lumen_test(centerline_test
  LABELS memory
  LIBS lumen_centerline lumen_vtk_xml
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/centerline/case_of_centerline_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/centerline/chains_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/centerline/join_curves_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/centerline/read_swc_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/centerline/read_tre_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/centerline/write_centerline_test.cpp)
