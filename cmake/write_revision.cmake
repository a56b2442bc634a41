# SPDX-License-Identifier: GPL-3.0-or-later

# Writes FILE, which defines the revision of the sources in SOURCE_DIRECTORY, unless it is up to date:
#
#   cmake -D SOURCE_DIRECTORY=... -D FILE=... -P write_revision.cmake

set(revision "")
# The sources may be located inside an unrelated repository.
execute_process(COMMAND git -C "${SOURCE_DIRECTORY}" rev-parse --show-toplevel
                OUTPUT_VARIABLE repository OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
file(REAL_PATH "${SOURCE_DIRECTORY}" sources)
if(repository)
  file(REAL_PATH "${repository}" repository)
endif()
if(repository STREQUAL sources)
  execute_process(COMMAND git -C "${SOURCE_DIRECTORY}" describe --always --dirty
                  OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(NOT revision)
  set(revision "unknown")
endif()

set(text "#include \"revision.h\"

namespace Squeal
{
  const char *const revision = \"${revision}\";
} // namespace Squeal
")
set(former "")
if(EXISTS "${FILE}")
  file(READ "${FILE}" former)
endif()
if(NOT former STREQUAL text)
  file(WRITE "${FILE}" "${text}")
endif()
