# The document of the viewer, and its server as a page meets it.
lumen_test(viewer_test
  LIBS lumen_server lumen_httplib
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/document_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/safety_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/served_test.cpp)
