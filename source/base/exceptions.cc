#include <squeal/base/exceptions.h>

namespace Squeal
{
  Error::Error(const std::string &what, const std::string &where, const std::string &change)
    : std::runtime_error(what + "\n  where:  " + where + "\n  change: " + change)
    , reason(what)
    , where(where)
    , change(change)
  {}
} // namespace Squeal
