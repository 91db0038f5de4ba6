# Run at build time: writes OUTPUT with the revision of SOURCE_DIR, touching the file only when it changes, so that a
# commit recompiles one small file and nothing is configured again. Without git or a repository it says "unknown".
find_package(Git QUIET)
set(revision "")
if(GIT_FOUND)
  execute_process(COMMAND "${GIT_EXECUTABLE}" --no-optional-locks -C "${SOURCE_DIR}" describe --always --dirty --abbrev=12 --exclude=*
                  OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(revision STREQUAL "")
  set(revision "unknown")
endif()
set(content "#pragma once\nnamespace odobench {\ninline constexpr const char* kGitRevision = \"${revision}\";\n}\n")
set(before "")
if(EXISTS "${OUTPUT}")
  file(READ "${OUTPUT}" before)
endif()
if(NOT before STREQUAL content)
  file(WRITE "${OUTPUT}" "${content}")
endif()
