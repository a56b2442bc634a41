#include <squeal/base/exceptions.h>
#include <squeal/parameters/materials.h>
#include <squeal/parameters/number_parameter.h>

#include <deal.II/base/utilities.h>

#include <cmath>
#include <set>
#include <sstream>

namespace Squeal
{
  namespace
  {
    constexpr const char *mount_format = "surface: radial, tangential, axial; surface: ... [N/m^3]";

    std::string print_mounts(const std::vector<ElasticMount> &mounts)
    {
      std::ostringstream text;
      for (const ElasticMount &mount : mounts)
        text << (&mount == &mounts.front() ? "" : "; ") << mount.surface << ": " << exact_text(mount.radial) << ", "
             << exact_text(mount.tangential) << ", " << exact_text(mount.axial);
      return text.str();
    }

    std::vector<ElasticMount> parse_mounts(const std::string &text)
    {
      std::vector<ElasticMount> mounts;
      for (const std::string &entry : dealii::Utilities::split_string_list(text, ';'))
        {
          if (entry.empty())
            continue;
          const auto parts  = dealii::Utilities::split_string_list(entry, ':');
          const auto values = parts.size() == 2 ? dealii::Utilities::split_string_list(parts[1], ',') : std::vector<std::string>();
          if (values.size() != 3)
            throw ParameterError(in_quotes(entry) + " is not an elastic mount", "parameter Mounts/Elastic mounts",
                                 std::string("write ") + mount_format);
          std::vector<double> stiffness;
          for (const std::string &value : values)
            {
              const auto number = parse_number(value);
              if (!number)
                throw ParameterError(in_quotes(value) + " is not a number", "parameter Mounts/Elastic mounts, surface " + legible(parts[0]),
                                     std::string("write ") + mount_format);
              stiffness.push_back(*number);
            }
          mounts.push_back({parts[0], stiffness[0], stiffness[1], stiffness[2]});
        }
      return mounts;
    }

    void add_material(dealii::ParameterHandler &prm, const std::string &section, Material &material)
    {
      using dealii::Patterns::Double;
      prm.enter_subsection(section);
      add_number_parameter(prm, "Young modulus", material.young_modulus, "Young's modulus E. Units: Pa.", Double(0.));
      add_number_parameter(prm, "Poisson ratio", material.poisson_ratio, "Poisson's ratio. Units: none.", Double(-1., 0.5));
      add_number_parameter(prm, "Density", material.density, "Mass density. Units: kg/m^3.", Double(0.));
      add_number_parameter(prm, "Rayleigh alpha", material.rayleigh_alpha,
                           "Damping in proportion to the mass, C = alpha M + beta K: modes of omega are damped by the ratio "
                           "alpha / (2 omega). Units: 1/s.",
                           Double(0.));
      add_number_parameter(prm, "Rayleigh beta", material.rayleigh_beta,
                           "Damping in proportion to the stiffness of the material, mounts excluded: modes of omega are damped by the "
                           "ratio beta omega / 2. Units: s.",
                           Double(0.));
      prm.leave_subsection();
    }

    void check_material(const std::string &section, const Material &material)
    {
      if (!(material.young_modulus > 0.))
        throw ParameterError("Young's modulus is " + exact_text(material.young_modulus) + " Pa", "parameter " + section + "/Young modulus",
                             "give a positive value");
      if (!(material.poisson_ratio > -1. && material.poisson_ratio < 0.4999))
        throw ParameterError("Poisson's ratio is " + exact_text(material.poisson_ratio), "parameter " + section + "/Poisson ratio",
                             "give a value above -1 and below 0.4999 (displacement elements lock for incompressible materials)");
      if (!(material.density > 0.))
        throw ParameterError("the density is " + exact_text(material.density) + " kg/m^3", "parameter " + section + "/Density",
                             "give a positive value");
      if (!(material.rayleigh_alpha >= 0.) || !std::isfinite(material.rayleigh_alpha))
        throw ParameterError("the damping in proportion to the mass is " + exact_text(material.rayleigh_alpha) + " 1/s",
                             "parameter " + section + "/Rayleigh alpha", "give a finite value >= 0");
      if (!(material.rayleigh_beta >= 0.) || !std::isfinite(material.rayleigh_beta))
        throw ParameterError("the damping in proportion to the stiffness is " + exact_text(material.rayleigh_beta) + " s",
                             "parameter " + section + "/Rayleigh beta", "give a finite value >= 0");
    }
  } // namespace

  bool Material::is_damped() const
  {
    return rayleigh_alpha != 0. || rayleigh_beta != 0.;
  }

  void MaterialParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    add_material(prm, "Disc material", disc);
    add_material(prm, "Pin material", pin);

    prm.enter_subsection("Mounts");
    prm.declare_entry("Elastic mounts", print_mounts(mounts), dealii::Patterns::Anything(),
                      "Elastic foundations as a list `surface: radial, tangential, axial; ...`: named surface and its stiffness per "
                      "area in the directions of the disc's axis. Empty: the disc turns freely. Units: N/m^3.");
    prm.add_action("Elastic mounts", [this](const std::string &text) { mounts = parse_mounts(text); });
    prm.leave_subsection();
  }

  void MaterialParameters::check() const
  {
    check_material("Disc material", disc);
    check_material("Pin material", pin);

    std::set<std::string> seen;
    for (const ElasticMount &mount : mounts)
      {
        const std::string where = "parameter Mounts/Elastic mounts, surface " + legible(mount.surface);
        if (mount.surface.empty())
          throw ParameterError("a mount names no surface", where, std::string("write ") + mount_format);
        for (const double stiffness : {mount.radial, mount.tangential, mount.axial})
          if (!(stiffness >= 0.) || !std::isfinite(stiffness))
            throw ParameterError("the stiffness " + exact_text(stiffness) + " N/m^3 is not a finite value >= 0", where,
                                 "give zero or a positive stiffness per area");
        if (!seen.insert(mount.surface).second)
          throw ParameterError("the surface is mounted twice", where, "give each surface once, with the sum of its stiffnesses");
      }
  }

  std::vector<std::string> MaterialParameters::mounted_surfaces() const
  {
    std::vector<std::string> names;
    for (const ElasticMount &mount : mounts)
      names.push_back(mount.surface);
    return names;
  }
} // namespace Squeal
