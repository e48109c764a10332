# The document of the viewer, and its server as a page meets it.
lumen_test(viewer_test
  LIBS lumen_server lumen_httplib
  LABELS slow
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/arguments_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/document_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/kept_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/labels_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/mesh_deviation_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/moving_case_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/one_thread_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/proposals_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/safety_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/second_volume_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/served_test.cpp
    $<$<BOOL:${LUMEN_WITH_DICOM}>:${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/series_test.cpp>
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/source_match_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/work_list_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/viewer/surroundings_test.cpp)
if(LUMEN_FILLS)
  add_dependencies(viewer_test lumen_netgen)
  set_tests_properties(viewer_test PROPERTIES ENVIRONMENT "PATH=$<TARGET_FILE_DIR:lumen_netgen>:$ENV{PATH}")
endif()

# The page's own units, types and style, where its packages are installed (./bootstrap.sh does it).
if(NPM AND EXISTS ${PROJECT_SOURCE_DIR}/viewer/page/node_modules/.package-lock.json)
  add_test(NAME ViewerPage.Units COMMAND ${NPM} test --silent WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}/viewer/page)
  add_test(NAME ViewerPage.TypesAndStyle
    COMMAND ${NPM} run --silent check WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}/viewer/page)
  set_tests_properties(ViewerPage.Units ViewerPage.TypesAndStyle PROPERTIES LABELS slow)
endif()

# As a person would use it: the program, the page and Chromium, by pointer and keys. Each has a server, a port and a profile of its
# own, and keeps pictures of what it saw. Those of the night are long, or repeat in another browser what the others find.
if(NODE)
  add_executable(ask_blob ${PROJECT_SOURCE_DIR}/viewer/page/people/ask_blob.c)
  target_link_libraries(ask_blob PRIVATE blob)
  set(LUMEN_STORIES checked found_and_corrected from_disk keys_and_axe labels many_vessels mistakes slices)
  set(LUMEN_NIGHT_STORIES corrections dicom firefox firefox_serverless gallery serverless)
  foreach(story ${LUMEN_STORIES} ${LUMEN_NIGHT_STORIES})
    add_test(NAME ViewerPage.People.${story} COMMAND ${NODE} ${PROJECT_SOURCE_DIR}/viewer/page/people/run.mjs ${story})
    set_tests_properties(ViewerPage.People.${story} PROPERTIES
      LABELS foreign SKIP_RETURN_CODE 77 PROCESSORS 1 TIMEOUT 900
      ENVIRONMENT "LUMEN=$<TARGET_FILE:lumen>;LUMEN_ASK_BLOB=$<TARGET_FILE:ask_blob>;LUMEN_PICTURES=${CMAKE_BINARY_DIR}/people")
  endforeach()
  foreach(story ${LUMEN_NIGHT_STORIES})
    set_tests_properties(ViewerPage.People.${story} PROPERTIES LABELS "foreign;nightly")
  endforeach()
endif()
