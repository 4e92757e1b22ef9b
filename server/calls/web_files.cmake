# Writes a table of the files of FOLDER as C++ to OUT. Text only: each is one raw string. (package.json
# is for Node.js, which tests the modules.)
file(GLOB files ${FOLDER}/*.html ${FOLDER}/*.css ${FOLDER}/*.js ${FOLDER}/*.svg)
list(SORT files)
set(table "")
foreach(file IN LISTS files)
  get_filename_component(name "${file}" NAME)
  file(READ "${file}" text)
  string(FIND "${text}" ")webfile\"" end)
  if(NOT end EQUAL -1)
    message(FATAL_ERROR "${file} holds the end of a raw string")
  endif()
  string(APPEND table "    {\"${name}\", R\"webfile(${text})webfile\"},\n")
endforeach()
file(WRITE ${OUT} "// Written by CMake from server/web/.
#include \"server/calls/web_files.h\"

namespace translucube::server {

std::span<const WebFile> web_files() {
  static constexpr WebFile files[] = {
${table}  };
  return files;
}

}  // namespace translucube::server
")
