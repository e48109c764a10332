# SPDX-License-Identifier: Apache-2.0
# cmake -DOUT=FILE.cpp -DFUNCTION=NAME "-DFILES=A|B" -DFOLDER=PATH -P write_embedded.cmake: texts as a C++ source
# (embed.cmake).
set(text "// Made by write_embedded.cmake.\n#include <span>\n\n#include \"converters/base/embedded_text.h\"\n\n")
string(APPEND text "namespace lumen::convert {\n\nstd::span<const EmbeddedText> ${FUNCTION}();\n\n")
string(APPEND text "std::span<const EmbeddedText> ${FUNCTION}() {\n  static constexpr EmbeddedText kTexts[] = {\n")
string(REPLACE "|" ";" files "${FILES}")
foreach(file ${files})
  file(READ "${FOLDER}/${file}" content)
  string(APPEND text "      {\"${file}\", R\"lumen(${content})lumen\"},\n")
endforeach()
string(APPEND text "  };\n  return kTexts;\n}\n\n}  // namespace lumen::convert\n")
file(WRITE "${OUT}" "${text}")
