// SPDX-License-Identifier: GPL-3.0-or-later

// Linked into squeal_mesher under the address sanitizer: the leak check starts a tracer process, which the confinement of the mesher would
// treat as another program.
extern "C" const char *__asan_default_options()
{
  return "detect_leaks=0";
}
