// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

namespace Squeal
{
  /**
   * Revision of the sources of which the program was built, as Git describes it:
   * `-dirty` if files were changed, `unknown` without Git. Every build looks
   * anew; only the program itself depends on it.
   */
  extern const char *const revision;
} // namespace Squeal
