# The command line in one process, for tests in C++ and in Python.
add_library(run_here STATIC ${CMAKE_CURRENT_SOURCE_DIR}/cli/run_here.cpp)
target_link_libraries(run_here PUBLIC lumen_command_line)
lumen_compile(run_here)
add_executable(batch_lumen ${CMAKE_CURRENT_SOURCE_DIR}/cli/batch_lumen.cpp)
target_link_libraries(batch_lumen PRIVATE run_here nlohmann_json::nlohmann_json)
lumen_compile(batch_lumen)
# beside lumen, as it looks for the page of the viewer from there
set_target_properties(batch_lumen PROPERTIES RUNTIME_OUTPUT_DIRECTORY $<TARGET_FILE_DIR:lumen>)

# The commands, from outside.
find_package(PNG REQUIRED)
lumen_test(cli_test
  LABELS slow
  NIGHTLY OptionScopeTest.AnOptionThatIsTakenChangesEveryOutputThatItIsFor
    OptionScopeTest.AnOptionIsRefusedWithEveryInputAndOutputThatItIsNotFor
    ExportScopeTest.AnOptionThatATargetTakesChangesItsFolder CommandScopeTest.EveryOptionChangesEveryPhantom
    ToolTest.OfTwoHundredPointsArrivesAtEveryTipOfAPatient ToolTest.OfTwoHundredPointsArrivesAtEveryTipOfARealAngiogram
  LIBS run_here lumen_options lumen_terminal lumen_case lumen_base lumen::blob_static nlohmann_json::nlohmann_json PNG::PNG
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/batch_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/check_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/command_scope_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/config_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/early_refusal_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/end_to_end_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/ends_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/export_scope_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/export_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/file_format_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/image_border_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/interrupt_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/measure_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/mesh_options_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/message_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/motion_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/names_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/option_scope_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/picture_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/privacy_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/pushed_tool.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/reachable_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/refusal_scope_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/report_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/run_lumen.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/scope_inputs.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/stated_facts_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/surfaces_in_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/terminal_progress_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/tool_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/usage_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/validate_test.cpp)
target_compile_definitions(cli_test PRIVATE LUMEN_EXECUTABLE="$<TARGET_FILE:lumen>")
add_dependencies(cli_test lumen)
if(LUMEN_FILLS)
  add_dependencies(cli_test lumen_netgen)
  set_tests_properties(cli_test PROPERTIES ENVIRONMENT "PATH=$<TARGET_FILE_DIR:lumen_netgen>:$ENV{PATH}")
endif()
# begun first, the longest does not run alone at the end
set_tests_properties(cli_test PROPERTIES COST 1000)

# The closed surfaces that it writes, measured with CGAL and filled by TetGen.
lumen_test(closed_surface_test
  LABELS foreign
  NIGHTLY Others/PhantomSurfaceTest.* TetgenTest.MeshesTheInsideOfRealVessels
  LIBS run_here lumen_surface_facts lumen_case nlohmann_json::nlohmann_json
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/closed_surface_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/run_lumen.cpp)
target_compile_definitions(closed_surface_test PRIVATE LUMEN_EXECUTABLE="$<TARGET_FILE:lumen>")
add_dependencies(closed_surface_test lumen)

# The program as it is installed, and its answers.
python_test(Install.GivesAProgramThatRunsWhereverItIs slow
  ${CMAKE_CURRENT_SOURCE_DIR}/cli/check_install.py ${CMAKE_COMMAND} ${PROJECT_BINARY_DIR})
python_test(View.StartsServesSavesAndEnds slow ${CMAKE_CURRENT_SOURCE_DIR}/cli/check_view.py $<TARGET_FILE:lumen>)
if(HAS_VTK)
  python_test(Centerline.OpensInVtkWithTheArraysOfVmtk foreign
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/check_vtk_centerline.py $<TARGET_FILE:lumen>)
endif()
if(HAS_JSONSCHEMA)
  python_test(Answers.AreWhatTheirSchemasSay slow ${CMAKE_CURRENT_SOURCE_DIR}/cli/check_answers.py $<TARGET_FILE:batch_lumen> ${PROJECT_BINARY_DIR})
  if(LUMEN_FILLS AND TEST Answers.AreWhatTheirSchemasSay)
    set_tests_properties(Answers.AreWhatTheirSchemasSay PROPERTIES ENVIRONMENT "PATH=$<TARGET_FILE_DIR:lumen_netgen>:$ENV{PATH}")
  endif()
endif()

# Facts that files state, turned one at a time; and words that no output may hold.
set(facts ${CMAKE_CURRENT_SOURCE_DIR}/cli/facts/sweep.py $<TARGET_FILE:batch_lumen>)
python_test(Facts.OfASampleOfFilesGiveEqualCases slow ${facts} --every 23)
python_test(Facts.OfAllFilesGiveEqualCases nightly ${facts} --others)
python_test(PrivateWords.AreInNoOutput slow ${CMAKE_CURRENT_SOURCE_DIR}/cli/private_words.py $<TARGET_FILE:batch_lumen>)

# Answers to mistakes, as docs/mistakes has them.
set(mistakes ${CMAKE_CURRENT_SOURCE_DIR}/cli/mistakes/run.py --lumen $<TARGET_FILE:lumen> --batch $<TARGET_FILE:batch_lumen>)
python_test(Mistakes.AreAnsweredAsDocumented slow ${mistakes} --at-least 100)
# ninja write_mistakes: builds lumen, and writes what it answers now into docs/mistakes
add_custom_target(write_mistakes COMMAND ${PYTHON} -B ${mistakes} --fix DEPENDS lumen batch_lumen USES_TERMINAL)
