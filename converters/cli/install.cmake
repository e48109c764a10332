# Files that `cmake --install BUILD --component lumen` installs: the program, its manual page and completion, which are
# made from its own options, the formats with their schemas, and the licences.
include(GNUInstallDirs)

add_executable(write_man write_man.cpp)
target_link_libraries(write_man PRIVATE lumen_command_line)
set(man_page ${CMAKE_CURRENT_BINARY_DIR}/lumen.1)
set(completions ${CMAKE_CURRENT_BINARY_DIR}/completions)
add_custom_command(OUTPUT ${man_page} COMMAND write_man ${man_page} DEPENDS write_man VERBATIM)
file(MAKE_DIRECTORY ${completions})
add_custom_command(OUTPUT ${completions}/lumen ${completions}/_lumen ${completions}/lumen.fish
  COMMAND lumen completion bash > ${completions}/lumen
  COMMAND lumen completion zsh > ${completions}/_lumen
  COMMAND lumen completion fish > ${completions}/lumen.fish
  DEPENDS lumen VERBATIM)
# schemas of the JSON answers; Debian's Python first, as in tests/tools.cmake
find_program(PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(PYTHON NAMES python3 REQUIRED)
set(spec ${PROJECT_SOURCE_DIR}/spec)
set(answers ${PROJECT_BINARY_DIR}/spec/answers)
add_custom_command(OUTPUT ${answers}/parts.schema.json
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${answers}
  COMMAND ${PYTHON} -B ${spec}/answers/make.py ${answers}
  DEPENDS ${spec}/answers/make.py ${spec}/answers/answers.txt VERBATIM)
add_custom_target(answer_schemas DEPENDS ${answers}/parts.schema.json)
# all of the component that is built: cmake --build BUILD -t lumen_program
add_custom_target(lumen_program ALL DEPENDS lumen ${man_page} ${completions}/lumen)
add_dependencies(lumen_program answer_schemas)

install(TARGETS lumen COMPONENT lumen)
if(LUMEN_FILLS)
  install(TARGETS lumen_netgen COMPONENT lumen)
endif()
install(FILES ${man_page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT lumen)
install(FILES ${completions}/lumen DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT lumen)
install(FILES ${completions}/_lumen DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT lumen)
install(FILES ${completions}/lumen.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT lumen)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/THIRD_PARTY.md ${PROJECT_SOURCE_DIR}/CITATION.cff
  DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT lumen)

set(schemas ${CMAKE_INSTALL_DATADIR}/lumen/schema)
install(DIRECTORY ${spec}/schema/ DESTINATION ${schemas} COMPONENT lumen FILES_MATCHING PATTERN "*.schema.json")
install(DIRECTORY ${answers} DESTINATION ${schemas} COMPONENT lumen)
install(FILES ${spec}/answers/README.md ${spec}/answers/answers.txt DESTINATION ${schemas}/answers COMPONENT lumen)
install(FILES ${spec}/lumen.md ${spec}/seeds.md ${spec}/errors.md ${spec}/coverage.md
  DESTINATION ${CMAKE_INSTALL_DOCDIR}/spec COMPONENT lumen)
install(DIRECTORY ${spec}/figures DESTINATION ${CMAKE_INSTALL_DOCDIR}/spec COMPONENT lumen
  FILES_MATCHING PATTERN "*.png")
# the pages of spec/ link to the schemas as files beside them
file(RELATIVE_PATH up /${CMAKE_INSTALL_DOCDIR}/spec /${schemas})
file(CREATE_LINK ${up} ${CMAKE_CURRENT_BINARY_DIR}/schema SYMBOLIC)
file(CREATE_LINK ${up}/answers ${CMAKE_CURRENT_BINARY_DIR}/answers SYMBOLIC)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/schema ${CMAKE_CURRENT_BINARY_DIR}/answers
  DESTINATION ${CMAKE_INSTALL_DOCDIR}/spec COMPONENT lumen)

# lumen-bids and the workflow of Snakemake, which run lumen; Python's standard library is all that lumen-bids needs
set(pipelines ${PROJECT_SOURCE_DIR}/converters/pipelines)
install(PROGRAMS ${pipelines}/bids/lumen-bids DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT lumen)
install(DIRECTORY ${pipelines}/bids/lumen_bids DESTINATION ${CMAKE_INSTALL_DATADIR}/lumen/pipelines/bids COMPONENT lumen
  FILES_MATCHING PATTERN "*.py" PATTERN "__pycache__" EXCLUDE)
install(DIRECTORY ${pipelines}/snakemake DESTINATION ${CMAKE_INSTALL_DATADIR}/lumen/pipelines COMPONENT lumen
  USE_SOURCE_PERMISSIONS PATTERN "__pycache__" EXCLUDE)
