// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

// Headers that many files include and that take long to compile. Every file still includes the headers that it uses.

#include <deal.II/base/point.h>

#include <Eigen/LU>

#include <boost/serialization/complex.hpp>
#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <complex>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>
