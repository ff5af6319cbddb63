# Writes OUTPUT, the definitions of build_info in provenance.hpp: run at build time whenever a source has changed.
# Needs SOURCE_DIR, OUTPUT, PROJECT_VERSION, COMPILER, FLAGS.
file(GLOB_RECURSE sources RELATIVE ${SOURCE_DIR}
  ${SOURCE_DIR}/src/*.[ch]pp ${SOURCE_DIR}/integrators/*.[ch]pp ${SOURCE_DIR}/experiments/*.[ch]pp)
list(SORT sources)
set(digests "")
foreach(source IN LISTS sources)
  file(SHA256 ${SOURCE_DIR}/${source} digest)
  string(APPEND digests "${source} ${digest}\n")
endforeach()
string(SHA256 source_hash "${digests}")

set(version ${PROJECT_VERSION})
execute_process(COMMAND git describe --always --dirty --tags WORKING_DIRECTORY ${SOURCE_DIR}
  OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(described)
  string(APPEND version " (${described})")
endif()

file(WRITE ${OUTPUT} "#include \"experiments/kit/provenance.hpp\"

namespace qddot::inline kit::build_info {
const char* const version = \"${version}\";
const char* const source_hash = \"${source_hash}\";
const char* const compiler = \"${COMPILER}\";
const char* const flags = \"${FLAGS}\";
}  // namespace qddot::kit::build_info
")
