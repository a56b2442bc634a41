// SPDX-License-Identifier: GPL-3.0-or-later

// Linked into squeal_mesher with the address sanitizer: disables the leak check, whose tracer process the confinement of the mesher would
// treat as another program.
extern "C" const char *__asan_default_options()
{
  return "detect_leaks=0";
}
