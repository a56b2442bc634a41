// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/materials.h>
#include <squeal/parameters/number_list.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace Squeal
{
  namespace
  {
    const ListFormat mount_list = {"Mounts/Elastic mounts",
                                   "not an elastic mount",
                                   "surface: radial, tangential, axial; surface: ... [N/m^3]",
                                   "surface",
                                   {3}};

    const ListFormat dashpot_list = {"Mounts/Dashpots",
                                     "not a dashpot",
                                     "surface: radial, tangential, axial; surface: ... [N s/m^3]",
                                     "surface",
                                     {3}};

    const ListFormat mass_list = {"Mounts/Added masses", "not a mass on a surface", "surface: mass; surface: ... [kg/m^2]", "surface", {1}};

    const ListFormat volume_list = {"Materials/Volumes",
                                    "not the material of a volume",
                                    "volume: Young modulus, Poisson ratio, density, alpha, beta; volume: ... [Pa, -, kg/m^3, 1/s, s], "
                                    "or without alpha and beta",
                                    "volume",
                                    {3, 5}};

    const ListFormat orthotropic_list = {"Materials/Orthotropic",
                                         "not the orthotropic material of a volume",
                                         "volume: E1, E2, E3, nu12, nu13, nu23, G12, G13, G23, density, alpha, beta; volume: ... [Pa, Pa, "
                                         "Pa, -, -, -, Pa, Pa, Pa, kg/m^3, 1/s, s], or without alpha and beta",
                                         "volume",
                                         {10, 12}};

    const ListFormat axes_list = {"Materials/Axes",
                                  "not the axes of a volume",
                                  "volume: x, y, z, x, y, z; volume: ..., with a vector along axis 1 and a second vector in the plane of "
                                  "axes 1 and 2",
                                  "volume",
                                  {6}};

    /// Smallest determinant of the compliance relative to the product of its diagonal [-]; 4.5e-4 for an isotropic material with ν =
    /// 0.4999.
    constexpr double least_determinant = 4e-4;

    /// Sine of the angle between two vectors below which they count as parallel.
    constexpr double least_sine = 1e-6;

    void declare_material(Declarations &declarations, const std::string &section, Material &material)
    {
      declarations.enter(section);
      declarations.add("Young modulus", material.young_modulus, "Pa", "Young's modulus E.", {0.});
      declarations.add("Poisson ratio", material.poisson_ratio, "none", "Poisson's ratio.", {-1., 0.5});
      declarations.add("Density", material.density, "kg/m^3", "Mass density.", {0.});
      declarations.add(
        "Rayleigh alpha", material.rayleigh_alpha, "1/s",
        "Coefficient alpha of mass-proportional damping, C = alpha M + beta K. If alpha is the same in all bodies, it adds alpha / (2 "
        "omega) to the damping ratio of a mode with circular frequency omega.",
        {0.});
      declarations.add(
        "Rayleigh beta", material.rayleigh_beta, "s",
        "Coefficient beta of stiffness-proportional damping of the material, excluding mounts. If beta is the same in all bodies and "
        "springs have little effect, it adds beta omega / 2 to the damping ratio of a mode with circular frequency omega.",
        {0.});
    }

    /// Checks that the compliance of an orthotropic material is positive definite.
    void check_constants(const std::string &where, const Material &material)
    {
      const Orthotropy &o  = *material.orthotropy;
      const double      E1 = material.young_modulus, nu12 = material.poisson_ratio;
      const auto        refuse = [&](const std::string &what, const std::string &change) { throw ParameterError(what, where, change); };
      for (const auto &[name, value] : {std::pair("E1", E1), {"E2", o.E2}, {"E3", o.E3}, {"G12", o.G12}, {"G13", o.G13}, {"G23", o.G23}})
        if (!(value > 0.))
          refuse(text(name, " is ", exact_text(value), " Pa, but must be positive"), "give positive moduli");
      const std::string convention  = "exchange nu_ij and nu_ji if your constants do not follow the convention nu12 = -eps2/eps1 under "
                                      "stress along axis 1 (nu12/E1 = nu21/E2)";
      const auto        check_ratio = [&](const char *axes, const double nu, const double E_i, const double E_j) {
        if (!(nu * nu < E_i / E_j))
          refuse(text("the strain energy is not positive: nu", axes, "^2 is ", nu * nu, ", not below E", axes[0], "/E", axes[1], " = ",
                             E_i / E_j),
                        "give a Poisson's ratio of smaller magnitude; " + convention);
      };
      check_ratio("12", nu12, E1, o.E2);
      check_ratio("13", o.nu13, E1, o.E3);
      check_ratio("23", o.nu23, o.E2, o.E3);
      const double determinant = 1. - nu12 * nu12 * o.E2 / E1 - o.nu13 * o.nu13 * o.E3 / E1 - o.nu23 * o.nu23 * o.E3 / o.E2 -
                                 2. * nu12 * o.nu13 * o.nu23 * o.E3 / E1;
      if (!(determinant >= least_determinant))
        refuse(text("the strain energy is not positive, or the material is almost incompressible: 1 - nu12^2 E2/E1 - nu13^2 E3/E1 - nu23^2 "
                    "E3/E2 - 2 nu12 nu13 nu23 E3/E1 is ",
                    determinant, ", but must be at least ", least_determinant),
               "give Poisson's ratios of smaller magnitude; " + convention);
    }

    void check_axes(const MaterialAxes &axes)
    {
      const auto       &v     = axes.vectors;
      const double      cross = std::hypot(v[1] * v[5] - v[2] * v[4], v[2] * v[3] - v[0] * v[5], v[0] * v[4] - v[1] * v[3]);
      const double      sizes = std::hypot(v[0], v[1], v[2]) * std::hypot(v[3], v[4], v[5]);
      const std::string where = "parameter Materials/Axes, volume " + legible(axes.volume);
      if (!(sizes > 0.))
        throw ParameterError("a vector of the axes is zero", where, "give two nonzero vectors");
      if (!(cross > least_sine * sizes))
        throw ParameterError("the two vectors are parallel or nearly parallel", where,
                             "give two vectors that span the plane of axes 1 and 2");
    }

    std::function<double &(VolumeMaterial &)> orthotropic_number(double Orthotropy::*number)
    {
      return [number](VolumeMaterial &material) -> double & {
        if (!material.orthotropy)
          material.orthotropy.emplace();
        return *material.orthotropy.*number;
      };
    }

    void check_material(const std::string &section, const Material &material)
    {
      const auto require = [&](const bool is_fine, const std::string &what, const char *name, const char *change) {
        if (!is_fine)
          throw ParameterError(what, "parameter " + section + "/" + name, change);
      };
      if (material.orthotropy)
        check_constants("parameter " + section, material);
      require(material.young_modulus > 0., "Young's modulus is " + exact_text(material.young_modulus) + " Pa, but must be positive",
              "Young modulus", "give a positive value");
      require(material.orthotropy || (material.poisson_ratio > -1. && material.poisson_ratio <= 0.4999),
              "Poisson's ratio is " + exact_text(material.poisson_ratio), "Poisson ratio",
              "give a value above -1 and up to 0.4999; the bulk modulus of an incompressible material (0.5) is infinite");
      require(material.density > 0., "the density is " + exact_text(material.density) + " kg/m^3, but must be positive", "Density",
              "give a positive value");
      require(material.rayleigh_alpha >= 0. && std::isfinite(material.rayleigh_alpha),
              "the mass-proportional damping is " + exact_text(material.rayleigh_alpha) + " 1/s", "Rayleigh alpha",
              "give a finite value >= 0");
      require(material.rayleigh_beta >= 0. && std::isfinite(material.rayleigh_beta),
              "the stiffness-proportional damping is " + exact_text(material.rayleigh_beta) + " s", "Rayleigh beta",
              "give a finite value >= 0");
    }
  } // namespace

  bool Material::is_damped() const
  {
    return rayleigh_alpha != 0. || rayleigh_beta != 0.;
  }

  bool Material::has_fixed_axes() const
  {
    return orthotropy && orthotropy->axes;
  }

  double Material::least_wave_modulus() const
  {
    if (orthotropy)
      return std::min({young_modulus, orthotropy->E2, orthotropy->E3, orthotropy->G12, orthotropy->G13, orthotropy->G23});
    return young_modulus / (2. * (1. + poisson_ratio));
  }

  double Material::mean_poisson_ratio() const
  {
    if (!orthotropy)
      return poisson_ratio;
    const double E1 = young_modulus, E2 = orthotropy->E2, E3 = orthotropy->E3;
    return ((poisson_ratio + orthotropy->nu13) / E1 + orthotropy->nu23 / E2) / (1. / E1 + 1. / E2 + 1. / E3);
  }

  void MaterialParameters::declare(Declarations &declarations)
  {
    declare_material(declarations, "Disc material", disc);
    declare_material(declarations, "Pin material", pin);

    declarations.enter("Materials");
    declare_list(
      declarations, "Volumes", volumes,
      "Materials of individual volumes, for example of a single pin or of the backplate of a pad, as a list `volume: Young modulus, "
      "Poisson ratio, density, Rayleigh alpha, Rayleigh beta; ...`. The last two numbers may be omitted; the volume is then undamped. "
      "Units: Pa, none, kg/m^3, 1/s, s.",
      volume_list,
      {&VolumeMaterial::young_modulus, &VolumeMaterial::poisson_ratio, &VolumeMaterial::density, &VolumeMaterial::rayleigh_alpha,
       &VolumeMaterial::rayleigh_beta},
      &VolumeMaterial::volume);
    declare_list(
      declarations, "Orthotropic", orthotropic,
      "Orthotropic materials of individual volumes, for example of brake linings, as a list `volume: E1, E2, E3, nu12, nu13, nu23, G12, "
      "G13, G23, density, Rayleigh alpha, Rayleigh beta; ...`. The last two numbers may be omitted; the volume is then undamped. The "
      "material axes are 1 radial, 2 tangential, 3 axial about the z axis, unless Axes defines other axes. Under stress along axis i, "
      "nu_ij = -eps_j/eps_i, so that nu_ij/E_i = nu_ji/E_j. Units: Pa, none, Pa, kg/m^3, 1/s, s.",
      orthotropic_list,
      {&VolumeMaterial::young_modulus, orthotropic_number(&Orthotropy::E2), orthotropic_number(&Orthotropy::E3),
       &VolumeMaterial::poisson_ratio, orthotropic_number(&Orthotropy::nu13), orthotropic_number(&Orthotropy::nu23),
       orthotropic_number(&Orthotropy::G12), orthotropic_number(&Orthotropy::G13), orthotropic_number(&Orthotropy::G23),
       &VolumeMaterial::density, &VolumeMaterial::rayleigh_alpha, &VolumeMaterial::rayleigh_beta},
      &VolumeMaterial::volume);
    std::vector<std::function<double &(MaterialAxes &)>> components;
    for (std::size_t i = 0; i < 6; ++i)
      components.emplace_back([i](MaterialAxes &entry) -> double & { return entry.vectors[i]; });
    declare_list(
      declarations, "Axes", axes,
      "Fixed material axes of orthotropic volumes as a list `volume: x, y, z, x, y, z; ...`: a vector along axis 1 and a second vector in "
      "the plane of axes 1 and 2, both of any length. Units: none.",
      axes_list, components, &MaterialAxes::volume);

    declarations.enter("Mounts");
    declare_list(declarations, "Elastic mounts", mounts,
                 "Elastic foundations as a list `surface: radial, tangential, axial; ...`: name of the surface and stiffness per area in "
                 "cylindrical directions about the disc axis. Empty: no elastic mounts. Units: N/m^3.",
                 mount_list, {&Mount::radial, &Mount::tangential, &Mount::axial}, &Mount::surface);
    declare_list(
      declarations, "Dashpots", dashpots,
      "Viscous dampers between surfaces and the ground as a list `surface: radial, tangential, axial; ...`: name of the surface and "
      "damping coefficient per area in cylindrical directions about the disc axis. Dashpots carry no static load. Units: N s/m^3.",
      dashpot_list, {&Mount::radial, &Mount::tangential, &Mount::axial}, &Mount::surface);
    declare_list(
      declarations, "Added masses", masses,
      "Masses attached to surfaces, for example shims, clips or a piston, as a list `surface: mass; ...`: name of the surface and mass per "
      "area. Units: kg/m^2.",
      mass_list, {&SurfaceMass::mass}, &SurfaceMass::surface);
  }

  void MaterialParameters::check() const
  {
    for (const auto &[section, material] : all())
      check_material(section, material);
    const auto names = [](const std::string &volume) { return [volume](const auto &entry) { return entry.volume == volume; }; };
    for (const VolumeMaterial &own : orthotropic)
      if (std::any_of(volumes.begin(), volumes.end(), names(own.volume)))
        throw ParameterError("volume " + in_quotes(own.volume) + " has two materials, in Materials/Volumes and Materials/Orthotropic",
                             "parameter Materials/Orthotropic", "remove the volume from one of the two lists");
    for (const MaterialAxes &entry : axes)
      {
        if (std::none_of(orthotropic.begin(), orthotropic.end(), names(entry.volume)))
          throw ParameterError("volume " + in_quotes(entry.volume) + " has axes, but no orthotropic material", "parameter Materials/Axes",
                               "give its constants in Materials/Orthotropic or remove its axes");
        check_axes(entry);
      }
    const auto check_mounts = [](const std::vector<Mount> &list, const std::string &name, const std::string &quantity, const char *unit) {
      for (const Mount &mount : list)
        for (const double value : {mount.radial, mount.tangential, mount.axial})
          if (!(value >= 0.) || !std::isfinite(value))
            throw ParameterError("the " + quantity + ' ' + exact_text(value) + ' ' + unit + " is not a finite value >= 0",
                                 "parameter Mounts/" + name + ", surface " + legible(mount.surface),
                                 "give zero or a positive " + quantity + " per area");
    };
    check_mounts(mounts, "Elastic mounts", "stiffness", "N/m^3");
    check_mounts(dashpots, "Dashpots", "damping coefficient", "N s/m^3");
    for (const SurfaceMass &mass : masses)
      check_mounts({{mass.surface, mass.mass, 0., 0.}}, "Added masses", "mass", "kg/m^2");
  }

  bool is_of_disc(const std::string &volume)
  {
    return volume == "disc" || volume.rfind("disc_", 0) == 0;
  }

  Material MaterialParameters::of(const std::string &volume) const
  {
    for (const auto *list : {&volumes, &orthotropic})
      for (const VolumeMaterial &own : *list)
        if (own.volume == volume)
          {
            Material result = own;
            for (const MaterialAxes &entry : axes)
              if (result.orthotropy && entry.volume == volume)
                result.orthotropy->axes = entry.vectors;
            return result;
          }
    return is_of_disc(volume) ? disc : pin;
  }

  std::string MaterialParameters::section_of(const std::string &volume) const
  {
    return of(volume).orthotropy ? "Materials/Orthotropic" :
           has_own(volume)       ? "Materials/Volumes" :
           is_of_disc(volume)    ? "Disc material" :
                                   "Pin material";
  }

  bool MaterialParameters::has_own(const std::string &volume) const
  {
    const auto is_in = [&](const std::vector<VolumeMaterial> &list) {
      return std::any_of(list.begin(), list.end(), [&](const VolumeMaterial &own) { return own.volume == volume; });
    };
    return is_in(volumes) || is_in(orthotropic);
  }

  bool MaterialParameters::is_damped() const
  {
    const auto materials = all();
    return std::any_of(materials.begin(), materials.end(), [](const auto &entry) { return entry.second.is_damped(); });
  }

  std::vector<Material *> MaterialParameters::each()
  {
    std::vector<Material *> result = {&disc, &pin};
    for (auto *list : {&volumes, &orthotropic})
      for (VolumeMaterial &own : *list)
        result.push_back(&own);
    return result;
  }

  std::vector<std::pair<std::string, Material>> MaterialParameters::all() const
  {
    std::vector<std::pair<std::string, Material>> result = {{"Disc material", disc}, {"Pin material", pin}};
    for (const auto *list : {&volumes, &orthotropic})
      for (const VolumeMaterial &own : *list)
        result.emplace_back(section_of(own.volume) + ", " + own.volume, of(own.volume));
    return result;
  }

  std::vector<double *> MaterialParameters::mount_values()
  {
    std::vector<double *> values;
    for (std::vector<Mount> *list : {&mounts, &dashpots})
      for (Mount &mount : *list)
        values.insert(values.end(), {&mount.radial, &mount.tangential, &mount.axial});
    for (SurfaceMass &mass : masses)
      values.push_back(&mass.mass);
    return values;
  }

  std::vector<std::string> MaterialParameters::mounted_surfaces() const
  {
    std::vector<std::string> names;
    const auto               add = [&names](const std::string &surface) {
      if (std::find(names.begin(), names.end(), surface) == names.end())
        names.push_back(surface);
    };
    for (const std::vector<Mount> *list : {&mounts, &dashpots})
      for (const Mount &mount : *list)
        add(mount.surface);
    for (const SurfaceMass &mass : masses)
      add(mass.surface);
    return names;
  }

  namespace
  {
    const ListFormat ratio_list = {"Damping/Modal damping ratio",
                                   "not a frequency with its damping ratio",
                                   "frequency: ratio, frequency: ratio, ... [Hz, -]",
                                   "",
                                   {2},
                                   ',',
                                   ':'};
  } // namespace

  double DampingParameters::modal_ratio(const double frequency) const
  {
    if (modal_ratios.empty())
      return 0.;
    const auto above = std::upper_bound(modal_ratios.begin(), modal_ratios.end(), frequency,
                                        [](const double f, const ModalDampingRatio &entry) { return f < entry.frequency; });
    if (above == modal_ratios.begin())
      return above->ratio;
    const ModalDampingRatio &below = *(above - 1);
    if (above == modal_ratios.end())
      return below.ratio;
    return below.ratio + (above->ratio - below.ratio) * (frequency - below.frequency) / (above->frequency - below.frequency);
  }

  void DampingParameters::declare(Declarations &declarations)
  {
    declarations.enter("Damping");
    declare_list(
      declarations, "Modal damping ratio", modal_ratios,
      "Damping ratios of the real coupled modes as a list `frequency: ratio, ...` with ascending frequencies. The ratios are interpolated "
      "linearly, and are constant below the first and above the last frequency. Empty: no modal damping. Units: Hz and none.",
      ratio_list, {&ModalDampingRatio::frequency, &ModalDampingRatio::ratio});
  }

  void DampingParameters::check() const
  {
    const std::string where = std::string("parameter ") + ratio_list.parameter;
    for (const ModalDampingRatio &entry : modal_ratios)
      {
        if (!(entry.frequency >= 0.) || !std::isfinite(entry.frequency))
          throw ParameterError("the frequency " + exact_text(entry.frequency) + " Hz is not a finite value >= 0", where,
                               "give frequencies >= 0");
        if (!(entry.ratio >= 0. && entry.ratio < 1.))
          throw ParameterError("the damping ratio " + exact_text(entry.ratio) + " at " + exact_text(entry.frequency) +
                                 " Hz is not in [0, 1)",
                               where, "give a fraction of critical damping, for example 0.01 for 1 %");
        if (&entry != &modal_ratios.front() && !(entry.frequency > (&entry - 1)->frequency))
          throw ParameterError("the frequency " + exact_text(entry.frequency) + " Hz does not exceed the previous frequency, " +
                                 exact_text((&entry - 1)->frequency) + " Hz",
                               where, "give each frequency once, in ascending order");
      }
  }
} // namespace Squeal
