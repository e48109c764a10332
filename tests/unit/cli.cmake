# The executable, from outside.
find_package(PNG REQUIRED)
lumen_test(cli_test
  LIBS lumen_options lumen_terminal lumen_command_line lumen_case lumen_base lumen::blob_static nlohmann_json::nlohmann_json PNG::PNG
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/centerline_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/check_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/completion_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/config_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/end_to_end_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/export_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/file_format_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/interrupt_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/file_content_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/loss_report_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/mesh_options_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/mesh_info_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/message_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/options_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/picture_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/privacy_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/pushed_tool.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/reachable_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/report_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/run_lumen.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/surfaces_in_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/terminal_progress_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/tool_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/usage_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/validate_test.cpp)
target_compile_definitions(cli_test PRIVATE LUMEN_EXECUTABLE="$<TARGET_FILE:lumen>")
add_dependencies(cli_test lumen)

# The closed surfaces that it writes, measured with CGAL and filled by TetGen.
lumen_test(closed_surface_test
  LIBS lumen_surface_facts lumen_case nlohmann_json::nlohmann_json
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/closed_surface_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/run_lumen.cpp)
target_compile_definitions(closed_surface_test PRIVATE LUMEN_EXECUTABLE="$<TARGET_FILE:lumen>")
add_dependencies(closed_surface_test lumen)

# The program as it is installed, and its answers.
find_program(PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(PYTHON NAMES python3)
if(PYTHON AND NOT LUMEN_SANITIZE)
  add_test(NAME Install.GivesAProgramThatRunsWhereverItIs
    COMMAND ${PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/cli/check_install.py ${CMAKE_COMMAND} ${PROJECT_BINARY_DIR})
  add_test(NAME View.StartsServesSavesAndEnds
    COMMAND ${PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/cli/check_view.py $<TARGET_FILE:lumen>)
  execute_process(COMMAND ${PYTHON} -c "import vtkmodules" RESULT_VARIABLE no_vtk OUTPUT_QUIET ERROR_QUIET)
  if(no_vtk)
    message(STATUS "Python's VTK (python3-vtk9) not found: lumen's files are not opened with it")
  else()
    add_test(NAME Centerline.OpensInVtkWithTheArraysOfVmtk
      COMMAND ${PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/cli/check_vtk_centerline.py $<TARGET_FILE:lumen>)
  endif()
  execute_process(COMMAND ${PYTHON} -c "import jsonschema" RESULT_VARIABLE no_jsonschema OUTPUT_QUIET ERROR_QUIET)
  if(no_jsonschema)
    message(STATUS "Python's jsonschema not found: the JSON answers are not tested")
  else()
    add_test(NAME Answers.AreWhatTheirSchemasSay
      COMMAND ${PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/cli/check_answers.py $<TARGET_FILE:lumen>)
  endif()
endif()
