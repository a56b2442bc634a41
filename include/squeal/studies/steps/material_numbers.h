// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/model/elasticity.h>

namespace Squeal
{
  /// A material constant that is a factor of the terms of a body.
  struct MaterialNumber
  {
    const char *name, *unit; ///< name and unit in parameter files
    double Material::*value;
    std::string (*parameter)(const std::string &volume); ///< parameter of the terms
  };

  inline constexpr MaterialNumber material_numbers[] = {{"Young modulus", "Pa", &Material::young_modulus, BodyParameter::young_modulus},
                                                        {"Density", "kg/m^3", &Material::density, BodyParameter::density},
                                                        {"Rayleigh alpha", "1/s", &Material::rayleigh_alpha, BodyParameter::rayleigh_alpha},
                                                        {"Rayleigh beta", "s", &Material::rayleigh_beta, BodyParameter::rayleigh_beta}};
} // namespace Squeal
