// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

// Boost 1.86 and newer keep this interface in namespace and folder v1.
#if __has_include(<boost/process/v1.hpp>)
#  include <boost/process/v1.hpp>
#  include <boost/process/v1/extend.hpp>

namespace Squeal
{
  namespace process = boost::process::v1;
} // namespace Squeal
#else
#  include <boost/process.hpp>
#  include <boost/process/extend.hpp>

namespace Squeal
{
  namespace process = boost::process;
} // namespace Squeal
#endif
