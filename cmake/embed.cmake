# SPDX-License-Identifier: Apache-2.0
# lumen_embed(TARGET FUNCTION FILE...): the program holds these texts. FUNCTION, in namespace lumen::convert, returns
# them as EmbeddedText of converters/base/embedded_text.h, in this order; the caller's header declares it. The name of a
# text is that of FILE, relative to the folder that calls.
function(lumen_embed target function)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp)
  string(REPLACE ";" "|" names "${ARGN}")
  add_custom_command(OUTPUT ${source}
    COMMAND ${CMAKE_COMMAND} -DOUT=${source} -DFUNCTION=${function} "-DFILES=${names}"
      -DFOLDER=${CMAKE_CURRENT_SOURCE_DIR} -P ${PROJECT_SOURCE_DIR}/cmake/write_embedded.cmake
    DEPENDS ${ARGN} ${PROJECT_SOURCE_DIR}/cmake/write_embedded.cmake VERBATIM)
  target_sources(${target} PRIVATE ${source})
endfunction()
