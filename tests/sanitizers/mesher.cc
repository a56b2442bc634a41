// SPDX-License-Identifier: GPL-3.0-or-later

// Part of squeal_mesher where the address sanitizer watches it: the search for leaks traces the process from a new one, which the
// confinement of the mesher takes for another program.
extern "C" const char *__asan_default_options()
{
  return "detect_leaks=0";
}
