# check_includes.cmake must accept a good tree and name file and line in each bad one.
# cmake -P check_includes_test.cmake

cmake_minimum_required(VERSION 3.25)
string(RANDOM LENGTH 12 suffix)
file(REAL_PATH "$ENV{TMPDIR}" temporary BASE_DIRECTORY /tmp)
set(tree ${temporary}/check_includes_${suffix})

function(write_good_tree)
  file(REMOVE_RECURSE ${tree})
  file(WRITE ${tree}/renderer/intersect.cpp "#include <embree3/rtcore.h>\n")
  file(WRITE ${tree}/renderer/image_io.cpp "// [;]\\\n\n#include <OpenImageIO/imageio.h>\n")
  file(WRITE ${tree}/renderer/image_io_file.h "#include <OpenImageIO/imageio.h>\n")
  file(WRITE ${tree}/renderer/color.cpp "#  include <OpenColorIO/OpenColorIO.h>\n")
  file(WRITE ${tree}/renderer/text.cpp "#include <ft2build.h>\n#include FT_FREETYPE_H\n")
  file(WRITE ${tree}/api/parse.cpp "#include <nlohmann/json.hpp>\n#include \"renderer/color.h\"\n")
  file(WRITE ${tree}/server/routes.cpp "#include <httplib.h>\n#include \"api/parse.h\"\n")
  file(WRITE ${tree}/server/job_store_sqlite.cpp "#include <sqlite3.h>\n")
endfunction()

function(expect result_wanted text)
  execute_process(COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${tree}
      -P ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/check_includes.cmake
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(FIND "${output}" "${text}" at)
  if((result EQUAL 0 AND result_wanted STREQUAL "bad") OR
     (NOT result EQUAL 0 AND result_wanted STREQUAL "good") OR at EQUAL -1)
    file(REMOVE_RECURSE ${tree})
    message(FATAL_ERROR "wanted ${result_wanted} with \"${text}\", got ${result}:\n${output}")
  endif()
endfunction()

function(expect_bad file content text)
  write_good_tree()
  file(WRITE ${tree}/${file} "${content}")
  expect(bad "${text}")
endfunction()

write_good_tree()
expect(good "8 files: includes point one way")
expect_bad(renderer/bad.cpp "\n\n[;]\n#include \"api/parse.h\"\n"
  "renderer/bad.cpp:4: renderer/ may not include api/parse.h")
expect_bad(renderer/bad.h "#include <nlohmann/json.hpp>\n" "renderer/bad.h:1: renderer/ may not")
expect_bad(renderer/deep/bad.h "#include <sqlite3.h>\n" "renderer/deep/bad.h:1: renderer/ may not")
expect_bad(api/bad.cpp "\n#include \"server/worker.h\"\n" "api/bad.cpp:2: api/ may not include server")
expect_bad(api/bad.cpp "\t#include <httplib.h>\n" "api/bad.cpp:1: api/ may not include httplib.h")
expect_bad(server/bad.cpp "#include <OpenImageIO/imageio.h>\n" "server/bad.cpp:1: server/ may not")
expect_bad(server/bad.cpp "#include <httplib.h>\n" "server/bad.cpp:1: only server/routes.cpp may")
expect_bad(server/bad.cpp "#include \"sqlite3.h\"\n" "only server/job_store_sqlite.cpp may")
expect_bad(renderer/bad.cpp "#include <OpenImageIO/imageio.h>\n" "renderer/bad.cpp:1: only renderer/image_io")
expect_bad(server/bad.cpp "#include \"renderer/image_io_file.h\"\n" "server/bad.cpp:1: only renderer/image_io")
expect_bad(server/bad.cpp "#include <ft2build.h>\n" "server/bad.cpp:1: only renderer/text.cpp may")
expect_bad(renderer/bad.cpp "#include <embree3/rtcore_ray.h>\n" "only renderer/intersect.cpp may")
expect_bad(renderer/bad.cpp "#include \"../api/parse.h\"\n" "not named from the repository root")
expect_bad(server/routes.cpp "\n" "server/routes.cpp: includes no header of httplib")
file(REMOVE_RECURSE ${tree})
file(MAKE_DIRECTORY ${tree})
expect(bad "no sources found")
file(REMOVE_RECURSE ${tree})
