# Writes OUT, which defines engine_version(): the project's version and a fingerprint of the renderer's
# sources, SOURCES (a list separated by "|").
string(REPLACE "|" ";" sources "${SOURCES}")
set(all "")
foreach(source ${sources})
  file(SHA256 ${source} hash)
  string(APPEND all ${hash})
endforeach()
string(SHA256 all "${all}")
string(SUBSTRING ${all} 0 16 fingerprint)
file(WRITE ${OUT} "#include \"server/content.h\"\n\nstd::string_view translucube::server::engine_version() { return \"${VERSION}+${fingerprint}\"; }\n")
