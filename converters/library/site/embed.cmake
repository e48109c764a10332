# SPDX-License-Identifier: Apache-2.0
# cmake -DOUT=FILE.cpp "-DFILES=A|B" -P embed.cmake: files as constants of a C++ source.
set(text "// Made by embed.cmake.\n#include \"converters/library/site/site_files.h\"\n\nnamespace lumen::convert {\n\nconst std::vector<SiteFile>& siteFiles() {\n  static const std::vector<SiteFile> files = {\n")
string(REPLACE "|" ";" files "${FILES}")
foreach(file ${files})
  get_filename_component(name "${file}" NAME)
  file(READ "${file}" content)
  string(APPEND text "{\"${name}\", R\"lumen(${content})lumen\"},\n")
endforeach()
string(APPEND text "  };\n  return files;\n}\n\n}  // namespace lumen::convert\n")
file(WRITE "${OUT}" "${text}")
