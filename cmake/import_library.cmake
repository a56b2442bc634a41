# SPDX-License-Identifier: GPL-3.0-or-later

# squeal_import_library(NAME HEADER [OTHER_NAME...]) creates the target squeal::NAME for a library that has no CMake
# target on some supported systems. Some systems keep the headers in a separate folder.
function(squeal_import_library name header)
  string(TOUPPER SQUEAL_${name} variable)
  find_library(${variable} NAMES ${name} ${ARGN} REQUIRED)
  find_path(${variable}_HEADERS ${header} PATH_SUFFIXES suitesparse REQUIRED)
  mark_as_advanced(${variable} ${variable}_HEADERS)
  add_library(squeal::${name} UNKNOWN IMPORTED GLOBAL)
  set_target_properties(squeal::${name} PROPERTIES IMPORTED_LOCATION ${${variable}} INTERFACE_INCLUDE_DIRECTORIES ${${variable}_HEADERS})
endfunction()
