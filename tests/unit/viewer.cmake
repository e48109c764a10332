# The document of the viewer, and its server as a page meets it.
lumen_test(viewer_test
  LIBS lumen_server lumen_httplib
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/document_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/kept_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/safety_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/served_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/surroundings_test.cpp)

# The page's own units, types and style, where its packages are installed (./bootstrap.sh does it).
if(NPM AND EXISTS ${PROJECT_SOURCE_DIR}/viewer/page/node_modules/.package-lock.json)
  add_test(NAME ViewerPage.Units COMMAND ${NPM} test --silent WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}/viewer/page)
  add_test(NAME ViewerPage.TypesAndStyle
    COMMAND ${NPM} run --silent check WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}/viewer/page)
endif()
