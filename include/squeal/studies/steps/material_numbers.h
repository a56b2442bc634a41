// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/model/elasticity.h>

namespace Squeal
{
  /// A number of a material that the terms of a body contain as a factor.
  struct MaterialNumber
  {
    const char *name, *unit; ///< as parameter files have them
    double Material::*value;
    std::string (*parameter)(const std::string &volume); ///< of the terms
  };

  inline constexpr MaterialNumber material_numbers[] = {{"Young modulus", "Pa", &Material::young_modulus, BodyParameter::young_modulus},
                                                        {"Density", "kg/m^3", &Material::density, BodyParameter::density},
                                                        {"Rayleigh alpha", "1/s", &Material::rayleigh_alpha, BodyParameter::rayleigh_alpha},
                                                        {"Rayleigh beta", "s", &Material::rayleigh_beta, BodyParameter::rayleigh_beta}};
} // namespace Squeal
