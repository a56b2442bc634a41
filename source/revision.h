// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

namespace Squeal
{
  /**
   * Revision of the sources from `git describe`, with `-dirty` for changed files, or `unknown` without Git. Updated by every build; only
   * the main program depends on it.
   */
  extern const char *const revision;
} // namespace Squeal
