# The executable, from outside.
lumen_test(cli_test
  LIBS lumen_options lumen_terminal lumen_app lumen_case nlohmann_json::nlohmann_json
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/completion_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/config_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/end_to_end_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/file_format_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/interrupt_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/file_content_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/message_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/options_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/privacy_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/run_lumen.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/terminal_progress_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/usage_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/cli/validate_test.cpp)
target_compile_definitions(cli_test PRIVATE LUMEN_EXECUTABLE="$<TARGET_FILE:lumen>")
add_dependencies(cli_test lumen)
