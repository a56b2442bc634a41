// SPDX-License-Identifier: GPL-3.0-or-later

// Linked into programs under the address sanitizer. Keeps the modules of Open MPI loaded until the end, so that their leaks are reported
// with symbol names and can be distinguished from leaks of the program.
extern "C" int dlclose(void *)
{
  return 0;
}
