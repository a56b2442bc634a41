# SPDX-License-Identifier: GPL-3.0-or-later

# squeal_import_library(NAME) makes the target squeal::NAME of a library whose package brings no CMake target on every system that
# is supported. Its headers lie where deal.II's own are looked for.
function(squeal_import_library name)
  string(TOUPPER SQUEAL_${name} file)
  find_library(${file} ${name} REQUIRED)
  mark_as_advanced(${file})
  add_library(squeal::${name} UNKNOWN IMPORTED GLOBAL)
  set_target_properties(squeal::${name} PROPERTIES IMPORTED_LOCATION ${${file}})
endfunction()
