# Writes OUT, which defines engine_version(): a fingerprint of SOURCES (a list separated by "|"), which is what makes
# light.
string(REPLACE "|" ";" sources "${SOURCES}")
set(all "")
foreach(source ${sources})
  file(SHA256 ${source} hash)
  string(APPEND all ${hash})
endforeach()
string(SHA256 all "${all}")
string(SUBSTRING ${all} 0 16 fingerprint)
file(WRITE ${OUT} "#include \"renderer/render.h\"\n\nstd::string_view translucube::engine_version() { return \"${fingerprint}\"; }\n")
